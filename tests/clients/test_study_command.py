"""`spandrel study`: resumed after a kill, on any number of cores, and compared with single demo flights."""

import json
import pathlib
import signal
import subprocess

import pyarrow.parquet
import spandrel

STUDY = ["study", "--scenario", "drill-hover", "--skill", "novice,expert", "--seeds", "3", "--log", "error"]
FLIGHTS = 6


def tables(folder):
    return {name: (folder / name).read_bytes() for name in ("flights.parquet", "summary.md")}


def journal(folder):
    return (folder / "flights.jsonl").read_bytes()


def start(folder, *more):
    return subprocess.Popen([spandrel.PROGRAM, *STUDY, "--out", str(folder), *more], stdout=subprocess.PIPE, text=True)


def kill_after_first_flight(folder):
    """Starts a study and kills it as soon as the journal contains a flight, wherever it is in the next one."""
    path = folder / "flights.jsonl"
    process = start(folder, "--jobs", "1")
    # Without a pause between the checks: a flight takes a tenth of a second.
    while process.poll() is None and not (path.exists() and b"\n" in path.read_bytes()):
        pass
    process.send_signal(signal.SIGKILL)
    process.wait()


def test_flight_killed_study_resumes_to_the_same_tables(tmp_path):
    whole, parallel, killed = tmp_path / "whole", tmp_path / "parallel", tmp_path / "killed"
    printed = spandrel.run(*STUDY, "--out", str(whole), "--jobs", "1")
    spandrel.run(*STUDY, "--out", str(parallel), "--jobs", "3")
    kill_after_first_flight(killed)
    kept = journal(killed)
    flown = kept.count(b"\n")
    assert 1 <= flown < FLIGHTS and not (killed / "flights.parquet").exists()
    # A kill in the middle of a write leaves part of a line.
    (killed / "flights.jsonl").write_bytes(kept[: kept.rindex(b"\n") + 1] + b'{"scenario":"drill-ho')
    missing = spandrel.run(*STUDY, "--out", str(killed), "--missing").splitlines()
    assert len(missing) == FLIGHTS - flown
    spandrel.run(*STUDY, "--out", str(killed), "--jobs", "2")
    assert tables(whole) == tables(parallel) == tables(killed)
    assert sorted(journal(whole).splitlines()) == sorted(journal(killed).splitlines())
    assert journal(killed).startswith(kept[: kept.rindex(b"\n") + 1]), "a finished flight was flown again"
    assert "| flights | 3 | 3 |" in printed and printed == (whole / "summary.md").read_text(encoding="utf-8")


def test_regress_beginners_hold_the_hover_drill(tmp_path):
    """They passed its path of 0.4 m at more than the threshold, and landed without having been on it."""
    study = ["study", "--scenario", "drill-hover", "--skill", "novice,trained", "--seeds", "10-13", "--log", "error"]
    spandrel.run(*study, "--out", str(tmp_path))
    flights = [json.loads(line) for line in journal(tmp_path).splitlines()]
    incomplete = [(flight["pilot"], flight["seed"]) for flight in flights if not flight["result"]["complete"]]
    assert len(flights) == 8 and incomplete == []


def test_val_rows_match_demo_flights_and_pyarrow_reads_them(tmp_path):
    summary = json.loads(spandrel.run(*STUDY, "--out", str(tmp_path / "study"), "--json", "-"))
    table = pyarrow.parquet.read_table(tmp_path / "study" / "flights.parquet")
    rows = table.to_pylist()
    assert [(row["pilot"], row["seed"]) for row in rows] == [(pilot, seed) for pilot in ("novice", "expert") for seed in (1, 2, 3)]
    assert table.schema.field("seconds").metadata[b"unit"] == b"s"
    for row in (rows[0], rows[4]):
        sessions = tmp_path / f"{row['pilot']}-{row['seed']}"
        demo = ["demo", "--scenario", "drill-hover", "--skill", row["pilot"], "--seed", str(row["seed"]), "--speed", "max"]
        spandrel.run(*demo, "--sessions", str(sessions), "--log", "error")
        [path] = pathlib.Path(sessions).glob("*/assessment.json")
        theirs = json.loads(path.read_text(encoding="utf-8"))
        assert row["error"] is None and row["overall"] == theirs["scores"]["overall"], row
        assert row["conformity"] == theirs["scores"]["conformity"]["pct"] and row["certified"] == theirs["certification"]["passed"]
        assert row["certification_safety"] == theirs["certification"]["scores"]["safety"]
        assert row["seconds"] == theirs["end"]["seconds"] and row["pictures"] == theirs["snapshots"]["taken"]
    overall = next(one for one in summary["groups"][0]["measures"] if one["measure"] == "overall")
    counted = [row["overall"] for row in rows[:3] if row["complete"]]
    assert overall["n"] == len(counted) and abs(overall["mean"] - sum(counted) / len(counted)) < 1e-9


def test_wire_wrong_input_names_what_is_wrong(tmp_path):
    def problem(*arguments):
        done = subprocess.run([spandrel.PROGRAM, "study", "--out", str(tmp_path / "study"), *arguments], capture_output=True, text=True, check=False)
        return done.returncode, done.stderr

    for arguments, words in (
        (["--seeds", "9-3"], "'9-3' contains no seeds (allowed: a number of seeds from 1, or a range such as 21-40)"),
        (["--skill", "novice+luck"], "'novice+luck' is not a pilot: "),
        (["--flight", "61"], "--flight 61: there is no such flight (allowed: 1 to 60)"),
        (["--scenario", "no-such-job"], "no-such-job"),
    ):
        code, said = problem(*arguments)
        assert code == 2 and words in said, said
    # The same folder with another scenario under the same name.
    spandrel.run("study", "--scenario", "drill-hover", "--skill", "expert", "--seeds", "1", "--out", str(tmp_path / "study"), "--log", "error")
    changed = (spandrel.ROOT / "scenarios" / "drill-hover.toml").read_text(encoding="utf-8") + "\n# changed\n"
    (tmp_path / "drill-hover.toml").write_text(changed, encoding="utf-8")
    code, said = problem("--scenario", str(tmp_path / "drill-hover.toml"), "--skill", "expert", "--seeds", "1")
    assert code == 2 and "flights.jsonl:1: the flight 'drill-hover, expert, seed 1' was flown with another scenario" in said, said
