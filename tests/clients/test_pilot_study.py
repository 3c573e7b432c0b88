"""Checks the tables and charts of docs/src/measured/paper-cohort.md, which `tools/pilot-study` makes from examples/cohort, against the records."""

import importlib.machinery
import importlib.util
import json
import math
import os
import re
import subprocess
import sys

import numpy as np
import pandas
import pytest
from scipy import stats

import spandrel

TOOLS = spandrel.ROOT / "tools"
RECORDS = spandrel.ROOT / "examples" / "cohort" / "records.jsonl"
PAGE = spandrel.ROOT / "docs" / "src" / "measured" / "paper-cohort.md"
CHARTS = spandrel.ROOT / "docs" / "src" / "images" / "pilot-study"
SCORES = ("conformity", "efficiency", "safety", "accuracy", "overall")
PLACES = ("slab side", "arch bottom", "interlayer", "pier")
# Simpson's rule with 2000 steps against SciPy's beta function.
P_TOLERANCE = 1e-9
# The paper prints t and p with three decimals; rounding t changes p by up to 0.0005 more.
PAPER_P_TOLERANCE = 0.001
# Sum of eight parts in another order, points.
PARTS_TOLERANCE = 1e-9
# The charts state coordinates with one decimal, so a length between two of them is off by at most 0.1.
SVG_TOLERANCE = 0.1
# First cells of the tables on the page that are written by hand.
BY_HAND = ("number", "in the paper", "", "cue")


@pytest.fixture(scope="module")
def modules():
    """Returns the tool's modules."""
    sys.path.insert(0, str(TOOLS))
    from pilot_study import figures, paper, records, repeated_tables, t_tests

    yield {"figures": figures, "paper": paper, "records": records, "repeated": repeated_tables, "t_tests": t_tests}
    sys.path.remove(str(TOOLS))


def run(*args):
    environment = {**os.environ, "SPANDREL": spandrel.PROGRAM}
    return subprocess.run([sys.executable, str(TOOLS / "pilot-study"), *map(str, args)], capture_output=True, text=True, env=environment, check=False)


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    """Returns the tool's output and the folder with its charts."""
    folder = tmp_path_factory.mktemp("charts")
    done = run("--records", RECORDS, "--figures", folder)
    assert done.returncode == 0, done.stderr
    return done.stdout, folder


@pytest.fixture(scope="module")
def sessions():
    """Returns the records as a table: one row per session, numbered for each person."""
    records = [json.loads(line) for line in RECORDS.read_text(encoding="utf-8").splitlines()]
    rows = []
    for one in records:
        row = {"person": one["trainee"], "time": one["started_unix_us"], "minutes": one["seconds"] / 60, "end": one["end_reason"], **one["scores"]}
        row |= {f"on_path_{task['id']}": task["on_path"] for task in one["tasks"]}
        row |= {f"crashes_{task['id']}": sum(task["crashes"].values()) for task in one["tasks"]}
        rows.append(row | {"crashes_0": sum(one["crashes_outside"].values()), "answers": one["answers"]["answers"]})
    table = pandas.DataFrame(rows).sort_values(["person", "time"])
    table["session"] = table.groupby("person").cumcount() + 1
    return table


def blocks(text):
    """Returns the Markdown tables of a text, each as a list of rows of cells."""
    found = re.findall(r"(?:^\|.*\n)+", text, flags=re.MULTILINE)
    return [[[cell.strip() for cell in line[1:-1].split("|")] for line in block.splitlines()] for block in found]


def table_with(printed, *head):
    """Returns the rows of the printed table whose titles begin with these."""
    (found,) = [block for block in blocks(printed[0]) if tuple(block[0][: len(head)]) == head]
    return found[2:]


def repeated(sessions, score):
    """Returns a score's values of the people with three sessions: one row per person."""
    wide = sessions.pivot(index="person", columns="session", values=score).dropna()
    assert wide.shape == (8, 3)
    return wide.to_numpy()


def test_exact_page_has_the_tables_that_the_tool_prints(printed):
    page = [block for block in blocks(PAGE.read_text(encoding="utf-8")) if block[0][0] not in BY_HAND]
    assert page == blocks(printed[0]) and len(page) == 19


def test_exact_charts_are_those_of_the_records(printed):
    drawn = {path.name: path.read_text(encoding="utf-8") for path in printed[1].iterdir()}
    assert drawn == {path.name: path.read_text(encoding="utf-8") for path in CHARTS.iterdir()} and len(drawn) == 4


def test_val_paper_p_values_follow_from_its_t_values(modules):
    """The paper's 12 t values give the p values that it prints, in the tails that it names."""
    tail_p = modules["t_tests"].tail_p
    exact = {"upper": lambda t: stats.t.sf(t, 7), "lower": lambda t: stats.t.cdf(t, 7), "two": lambda t: 2 * stats.t.sf(abs(t), 7)}
    for pair, (t, p, tail) in modules["paper"].TESTS.items():
        assert abs(tail_p(t, 7, tail) - p) <= PAPER_P_TOLERANCE, pair
        for one, expected in exact.items():
            assert abs(tail_p(t, 7, one) - expected(t)) <= P_TOLERANCE, (pair, one)


def test_exact_paper_means_are_sums_of_whole_numbers(modules):
    """The means of 22 whole numbers, which together give the overall mean; the crashes and one crash into traffic give the mean of safety."""
    paper = modules["paper"]
    sums = {score: round(mean * paper.PEOPLE) for score, mean in paper.MEANS.items()}
    assert all(round(total / paper.PEOPLE, 2) == paper.MEANS[score] for score, total in sums.items())
    assert sums["overall"] == sum(sums[score] for score in paper.SCORES)
    # Each of 203 crashes costs 3 points; the person who hit traffic loses all 100 points, whatever the other crashes cost.
    lost = 100 * paper.PEOPLE - sums["safety"]
    own_crashes = (100 * paper.TRAFFIC_CRASHES - (lost - 3 * paper.CRASHES)) / 3
    assert own_crashes == 8


def test_val_quartiles_match_numpy(printed, sessions):
    first = sessions[sessions["session"] == 1]
    rows = table_with(printed, "score", "lowest")
    assert [row[0] for row in rows] == list(SCORES)
    for score, *cells in rows:
        values = first[score]
        expected = [*np.quantile(values, [0, 0.25, 0.5, 0.75, 1]), np.ptp(values)]
        assert cells == [*(f"{one:.1f}" for one in expected), f"{stats.skew(values):+.2f}"], score
    rows = table_with(printed, "task", "on path, mean")
    for task, (place, *cells) in enumerate(rows, 1):
        shares = 100 * first[f"on_path_{task}"]
        assert place == PLACES[task - 1]
        assert cells[:-1] == [f"{one:.0f}%" for one in (shares.mean(), *np.quantile(shares, [0, 0.25, 0.5, 0.75, 1]))]


def test_val_repeated_scores_match_numpy(printed, sessions):
    rows = table_with(printed, "score", "session", "mean")
    assert len(rows) == 15
    for score, session, *cells in rows:
        values = repeated(sessions, score)[:, int(session) - 1]
        expected = [values.mean(), values.std(ddof=1), *np.quantile(values, [0, 0.25, 0.5, 0.75, 1])]
        assert cells[:-1] == [f"{one:.1f}" for one in expected], (score, session)
    for score, higher, *ratios in table_with(printed, "score", "higher mean in session 2 or 3"):
        values = repeated(sessions, score)
        spread = values.std(axis=0, ddof=1)
        assert higher == ("yes" if values[:, 1:].mean(axis=0).max() > values[:, 0].mean() else "no")
        assert ratios == [f"{one / spread[0]:.2f} ({'yes' if one < spread[0] else 'no'})" for one in spread[1:]]


def test_val_tails_and_influence_match_scipy(printed, sessions, modules):
    alternatives = {"upper": "greater", "lower": "less", "two": "two-sided"}
    tails = table_with(printed, "score", "sessions", "tail")
    assert len(tails) == 12
    for score, pair, tail, paper_p, _, p, difference, _ in tails:
        early, late = (int(one) - 1 for one in pair.split(", "))
        values = repeated(sessions, score)
        expected = stats.ttest_rel(values[:, late], values[:, early], alternative=alternatives[tail]).pvalue
        paper = modules["paper"].TESTS[score, early + 1, late + 1]
        assert (paper_p, p, difference) == (f"{paper[1]:.3f}", f"{expected:.3f}", f"{expected - paper[1]:+.3f}"), (score, pair)
    influence = table_with(printed, "score", "sessions", "paper's d_z", "d_z", "without one person")
    assert len(influence) == 12
    for score, pair, _, dz, span, person, changed, p in influence:
        early, late = (int(one) - 1 for one in pair.split(", "))
        change = np.diff(repeated(sessions, score)[:, [early, late]]).ravel()
        size = lambda own: own.mean() / own.std(ddof=1)
        without = [size(np.delete(change, k)) for k in range(8)]
        assert (dz, span) == (f"{size(change):.2f}", f"{min(without):.2f} to {max(without):.2f}")
        k = int(np.argmax(np.abs(np.array(without) - size(change))))
        left = stats.ttest_1samp(np.delete(change, k), 0.0)
        assert (person, changed, p) == (str(k + 1), f"{without[k]:.2f}", f"{left.pvalue:.3f}")


def test_val_crashes_and_people_match_the_records(printed, sessions):
    first = sessions[sessions["session"] == 1].reset_index()
    columns = [f"crashes_{place}" for place in (1, 2, 3, 4, 0)]
    people = table_with(printed, "person")
    assert len(people) == 22
    for k, (number, *cells) in enumerate(people):
        one = first.loc[k]
        assert number == str(k + 1) and one["person"].endswith(f"{k + 1:02}")
        assert cells[:6] == [*(f"{one[score]:.1f}" for score in SCORES), f"{one['minutes']:.1f}"]
        assert cells[6:] == [", ".join(f"{100 * one[f'on_path_{t}']:.0f}" for t in (1, 2, 3, 4)), ", ".join(str(one[name]) for name in columns)]
    # Four tables have these titles; the crashes are in the one that states the number of all of them.
    (facts,) = [dict((row[0], row[1:]) for row in block) for block in blocks(printed[0]) if any(row[0] == "all crashes" for row in block)]
    total = int(first[columns].to_numpy().sum())
    assert facts["all crashes"] == ["203", str(total), f"{total - 203:+}"]
    bottom = int(first["crashes_2"].sum())
    points = 100 * (bottom / total - 63 / 203)
    assert facts["crashes at the arch bottom"][1:] == [f"{bottom} ({100 * bottom / total:.0f}%)", f"{bottom - 63:+} ({points:+.0f} points)"]
    others = total - bottom - int(first["crashes_4"].sum())
    assert facts["crashes at the other places together"][1].startswith(f"{others} (")
    assert facts["most crashes of a person"][1] == str(first[columns].sum(axis=1).max())


def test_val_answers_match_the_records(printed, sessions, modules):
    keys = list(sessions["answers"].iloc[0])
    count = lambda table, key: [sum(answers[key] == n for answers in table["answers"]) for n in range(1, 6)]
    first = sessions[sessions["session"] == 1]
    group = sessions[sessions["person"].isin(sessions[sessions["session"] == 3]["person"])]
    rows = table_with(printed, "question")
    assert len(rows) == len(keys) == 24
    for key, (_, *cells) in zip(keys, rows):
        agreed = [sum(count(group[group["session"] == n], key)[:2]) for n in (1, 2, 3)]
        assert cells == [*map(str, count(first, key)), ", ".join(map(str, agreed))], key
    stated = table_with(printed, "agree or strongly agree, first sessions")
    assert len(stated) == len(modules["paper"].AGREED)
    for (key, theirs), (_, paper, ours) in zip(modules["paper"].AGREED.items(), stated):
        assert paper.startswith(f"{theirs} of 22 (") and ours == f"{sum(count(first, key)[:2])} of 22", key


def test_exact_parts_of_conformity_add_up_to_the_score(modules):
    """The points that the chart shows, and the 50 points of someone who never enters a path, are the score."""
    for session in modules["records"].sessions_of(RECORDS):
        for record in session:
            parts = modules["records"].conformity_parts(record)
            total = 50 + sum(gain - loss for gain, loss in parts)
            assert math.isclose(total, record["scores"]["conformity"], abs_tol=PARTS_TOLERANCE), record["id"]


def test_exact_bars_are_as_high_as_their_numbers(printed, sessions):
    """In each chart of bars, height is proportional to the number in the bar's tip, and the numbers are all of the records'."""
    bar = re.compile(r'<rect x="[^"]+" y="[^"]+" width="[^"]+" height="([^"]+)" fill="[^"]+"><title>([^<]+)</title>')
    read = lambda name: [(float(height), tip) for height, tip in bar.findall((printed[1] / name).read_text(encoding="utf-8"))]
    first = sessions[sessions["session"] == 1]
    crashes = [(height, int(tip.rsplit(": ", 1)[1])) for height, tip in read("crashes.svg")]
    assert sum(number for _, number in crashes) == first[[f"crashes_{k}" for k in range(5)]].to_numpy().sum()
    conformity = [(height, abs(float(tip.rsplit(": ", 1)[1]))) for height, tip in read("conformity.svg")]
    assert len(conformity) == 2 * 4 * 22
    for bars in (crashes, conformity):
        height, number = max(bars)
        # The number has two decimals at most.
        slack = SVG_TOLERANCE + 0.005 * height / number
        assert all(abs(one - own * height / number) <= slack * 2 for one, own in bars)
    people = [int(tip.split()[0]) for _, tip in read("scores.svg")]
    assert sum(people) == 22 * len(SCORES)


def test_exact_records_and_flights_are_the_same_people(tmp_path, printed, modules):
    """The records have the people's seeds, and rows of flights with their results give the same tables as the records."""
    loader = importlib.machinery.SourceFileLoader("pilot_study_program", str(TOOLS / "pilot-study"))
    program = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(program)
    for number, session in enumerate(modules["records"].sessions_of(RECORDS), 1):
        for person, record in enumerate(session):
            assert (record["seed"], record["form"]) == (program.seed_of(28, person, number), program.FORMS[number - 1])
            name = f"{person + 1:02}-{number}"
            (tmp_path / f"pilot-{name}.toml").write_text(program.pilot_text(28, person, number), encoding="utf-8")
            (tmp_path / f"row-{name}.json").write_text(json.dumps({"result": modules["records"].row(record)}), encoding="utf-8")
    done = run(tmp_path)
    assert done.returncode == 0, done.stderr
    flown = blocks(done.stdout)
    assert len(flown) == 4 and all(block in blocks(printed[0]) for block in flown)


def test_exact_wrong_input_is_an_error(tmp_path):
    """Records of another design, broken records and wrong options are refused with the reason."""
    lines = RECORDS.read_text(encoding="utf-8").splitlines()
    fewer = tmp_path / "fewer.jsonl"
    fewer.write_text("\n".join(lines[:-1]) + "\n", encoding="utf-8")
    done = run("--records", fewer)
    assert done.returncode == 1 and f"{fewer}: [22, 8, 7] people" in done.stderr and "needs [22, 8, 8]" in done.stderr, done.stderr
    broken = tmp_path / "broken.jsonl"
    broken.write_text("{\n", encoding="utf-8")
    done = run("--records", broken)
    assert done.returncode == 1 and "broken.jsonl" in done.stderr and "Traceback" not in done.stderr, done.stderr
    absent = subprocess.run(
        [sys.executable, str(TOOLS / "pilot-study"), "--records", str(RECORDS)],
        capture_output=True, text=True, env={**os.environ, "SPANDREL": str(tmp_path / "none")}, check=False,
    )  # fmt: skip
    assert absent.returncode == 1 and "none: No such file or directory; build the program" in absent.stderr, absent.stderr
    for wrong in ((), (tmp_path / "a", "--records", RECORDS), (tmp_path / "a", "--figures", tmp_path)):
        done = run(*wrong)
        assert done.returncode == 1 and "usage: tools/pilot-study FOLDER" in done.stderr and not (tmp_path / "a").exists(), wrong
