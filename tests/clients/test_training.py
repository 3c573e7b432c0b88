"""The steps from one flight to the next on the command line: questionnaire, records and plan."""

import contextlib
import csv
import json
import os
import pathlib
import random
import sqlite3
import subprocess

import pytest

import spandrel

TASKS = ("slab_side", "arch_bottom", "interlayer", "pier_circle")


def run_with(text, *args):
    """Runs the program with typed input; returns exit code, output and errors."""
    done = subprocess.run([spandrel.PROGRAM, *args], input=text, capture_output=True, text=True, timeout=spandrel.FLIGHT_LIMIT_S, check=False)
    return done.returncode, done.stdout, done.stderr


@pytest.fixture(scope="module")
def sessions(tmp_path_factory):
    """Two real sessions by a trained pilot in a separate folder. Novices don't complete every session, and plans leave incomplete ones out."""
    folder = tmp_path_factory.mktemp("training") / "sessions"
    for seed in ("7", "8"):
        spandrel.run("demo", "--skill", "trained", "--seed", seed, "--speed", "max", "--trainee", "anna", "--sessions", str(folder))
    return folder


def folders(sessions):
    return sorted(path for path in sessions.iterdir() if path.is_dir())


def test_session_produces_a_record_and_a_plan(sessions):
    place = ["--sessions", str(sessions)]
    session = folders(sessions)[0]
    # Answers half of the questions now and the rest later: saved answers are not requested again.
    code, output, _ = run_with("2\n" * 10 + "q\n", "questionnaire", str(session))
    assert code == 0 and "10 of 24 answered" in output
    code, output, _ = run_with("9\n" + "3\n" * 14, "questionnaire", str(session))
    assert code == 0 and "24 of 24 answered" in output and "[1/14]" in output and "Please enter a whole number" in output
    answers = json.loads((session / "answers.json").read_text(encoding="utf-8"))["answers"]
    assert sorted(answers.values()) == [2] * 10 + [3] * 14

    assert "2 new or changed, 0 unchanged, 0 skipped" in spandrel.run("records", "import", *place)
    assert "0 new or changed, 2 unchanged, 0 skipped" in spandrel.run("records", "import", *place)
    records = json.loads(spandrel.run("records", "list", "--json", *place))
    assert [record["id"] for record in records] == [path.name for path in folders(sessions)]
    for record, path in zip(records, folders(sessions), strict=True):
        assessment = json.loads((path / "assessment.json").read_text(encoding="utf-8"))
        described = json.loads((path / "session.json").read_text(encoding="utf-8"))
        assert record["scores"]["overall"] == assessment["scores"]["overall"]
        assert record["scenario_sha256"] == described["scenario_sha256"] and record["trainee"] == "anna"
        assert [task["kind"] for task in record["tasks"]] == list(TASKS)
        crashes = sum(sum(task["crashes"].values()) for task in record["tasks"]) + sum(record["crashes_outside"].values())
        assert crashes == sum(assessment["crashes"]["by_task"].values())
        assert sum(defect["found"] for defect in record["defects"]) == assessment["snapshots"]["defects_found"]
        assert len(record["defects"]) == 10
    assert records[0]["answers"]["answers"] == answers

    # A changed answer changes the record.
    run_with("1\n" + "\n" * 23, "questionnaire", str(session), "--again")
    assert "1 new or changed, 1 unchanged" in spandrel.run("records", "import", *place)
    before = spandrel.run("records", "export", *place)
    assert "2 sessions, 0 skipped" in spandrel.run("records", "rebuild", *place)
    assert spandrel.run("records", "export", *place) == before

    plan = json.loads(spandrel.run("plan", "anna", "--json", *place))
    assert plan["steps"] and plan["session"] == records[1]["id"] and plan["changes"]["since"] == records[0]["id"]
    cohort = json.loads(spandrel.run("cohort", "--repetitions", "2", "--json", "-", *place))
    assert (cohort["trainees"], cohort["sessions"], cohort["group"]) == (1, 2, ["anna"])
    assert any("78" in words for words in cohort["warnings"])


def test_csv_tables_are_readable(sessions, tmp_path):
    place = ["--sessions", str(sessions), "--database", str(tmp_path / "records.sqlite")]
    spandrel.run("records", "import", *place)
    spandrel.run("cohort", "--repetitions", "2", "--csv", str(tmp_path / "tables"), *place)
    tables = {path.name: list(csv.DictReader(path.open(encoding="utf-8"))) for path in (tmp_path / "tables").iterdir()}
    assert len(tables) == 17
    assert [row["repetition"] for row in tables["progress.csv"]] == ["1", "2"]
    assert [row["task"] for row in tables["conformity_by_task.csv"]] == ["1", "2", "3", "4"]
    assert all(None not in row and None not in row.values() for rows in tables.values() for row in rows)


def test_errors_include_file_key_and_value(sessions, tmp_path):
    session = folders(sessions)[1]
    (session / "answers.json").write_text('{"format": 1, "language": "en", "answers": {"feedback": 9}}', encoding="utf-8")
    code, _, errors = run_with("", "questionnaire", str(session))
    assert code == 2 and "answers.json:1: feedback = 9" in errors and "1 to 5" in errors
    code, output, errors = run_with("", "records", "import", "--sessions", str(sessions), "--database", str(tmp_path / "r.sqlite"))
    assert code == 0 and "1 skipped" in output and "feedback = 9" in errors
    (session / "answers.json").unlink()
    code, _, errors = run_with("", "questionnaire", str(tmp_path))
    assert code == 2 and "not a session folder" in errors
    broken = tmp_path / "broken.jsonl"
    broken.write_text('{"format": 1}\n', encoding="utf-8")
    code, _, errors = run_with("", "cohort", "--records", str(broken))
    assert code == 2 and "broken.jsonl:1: not a valid record" in errors
    code, _, errors = run_with("", "plan", "nobody", "--sessions", str(sessions))
    assert code == 2 and "no sessions of 'nobody'" in errors


def test_trainee_data_can_be_exported_and_erased(sessions):
    place = ["--sessions", str(sessions)]
    spandrel.run("demo", "--scenario", "drill-hover", "--seed", "3", "--speed", "max", "--trainee", "ben", "--sessions", str(sessions))
    spandrel.run("records", "import", *place)
    spandrel.run("records", "trainee", "ben", "--age-band", "35-44", "--gaming-experience", "some", *place)
    kept = json.loads(spandrel.run("records", "export", "--trainee", "ben", *place))
    assert kept["trainee"]["age_band"] == "35-44" and len(kept["sessions"]) == 1 and len(kept["folders"]) == 1
    # The first command only announces the erasure, the second performs it.
    assert "use --yes to erase them" in spandrel.run("records", "erase", "--trainee", "ben", *place)
    assert pathlib.Path(kept["folders"][0]).is_dir()
    assert "erased 'ben': 1 sessions" in spandrel.run("records", "erase", "--trainee", "ben", "--yes", *place)
    assert not pathlib.Path(kept["folders"][0]).exists()
    assert not any(b"35-44" in path.read_bytes() for path in sessions.iterdir() if path.is_file())
    code, _, errors = run_with("", "records", "export", "--trainee", "ben", *place)
    assert code == 2 and "no data about 'ben'" in errors
    assert len(folders(sessions)) == 2, "other trainees' sessions must remain"
    assert "0 sessions and 0 folders" in spandrel.run("records", "retention", "--days", "1", "--yes", *place)


def test_rebuild_keeps_sessions_of_other_stations(sessions, tmp_path):
    database = ["--database", str(tmp_path / "records.sqlite")]
    spandrel.run("records", "import", "--sessions", str(sessions), *database)
    other = tmp_path / "other"
    other.mkdir()
    code, _, errors = run_with("", "records", "rebuild", "--sessions", str(other), *database)
    assert code == 2 and "2 sessions have no folder on this machine" in errors
    assert len(json.loads(spandrel.run("records", "list", "--json", *database))) == 2
    # With confirmation, the sessions are removed from the records. They were not erased, so they reappear when their
    # folders are imported.
    assert "0 sessions, 0 skipped, 2 without a folder on this machine deleted" in spandrel.run("records", "rebuild", "--yes", "--sessions", str(other), *database)
    assert "2 new or changed" in spandrel.run("records", "import", "--sessions", str(sessions), *database)


def test_killed_import_leaves_complete_records_and_continues(tmp_path):
    """Two hundred sessions (copies of one), with the import killed twenty times: at random times, and right after a
    batch."""
    spandrel.run("demo", "--scenario", "drill-hover", "--seed", "3", "--speed", "max", "--sessions", str(tmp_path / "one"))
    original = folders(tmp_path / "one")[0]
    many = tmp_path / "many"
    for k in range(200):
        copy = many / f"{original.name}-{k:03}"
        copy.mkdir(parents=True)
        for file in ("telemetry.tlog", "scenario.toml", "vehicle.toml", "session.json"):
            os.link(original / file, copy / file)
    place = ["--sessions", str(many), "--database", str(tmp_path / "records.sqlite")]

    def stored():
        try:
            with contextlib.closing(sqlite3.connect(f"file:{tmp_path / 'records.sqlite'}?mode=ro", uri=True)) as database:
                return database.execute("SELECT COUNT(*) FROM sessions").fetchone()[0]
        except sqlite3.Error:
            return 0  # The database does not exist yet.

    chance = random.Random(1)
    counts, killed = [], 0
    for turn in range(20):
        process = subprocess.Popen([spandrel.PROGRAM, "records", "import", *place], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        if turn % 2:
            # At a random time.
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(timeout=chance.uniform(0.0, 0.6))
        else:
            # Right after a batch was stored, in the middle of the import.
            before = counts[-1] if counts else 0
            spandrel.wait_for("another parcel", lambda: stored() > before or process.poll() is not None)
        killed += process.poll() is None
        process.kill()
        process.wait()
        records = json.loads(spandrel.run("records", "list", "--json", *place))
        assert len({record["id"] for record in records}) == len(records) and all(len(record["tasks"]) == 1 for record in records)
        counts.append(len(records))
    assert killed and any(0 < count < 200 for count in counts), f"no kill occurred during an import: {counts}"
    assert counts == sorted(counts), "imported sessions must not be lost"
    spandrel.run("records", "import", *place)
    assert len(json.loads(spandrel.run("records", "list", "--json", *place))) == 200
    assert "0 new or changed, 200 unchanged, 0 skipped" in spandrel.run("records", "import", *place)
