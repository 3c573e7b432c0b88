"""Compares the cohort statistics with the results of SciPy and Pingouin on random data."""

import json
import math

import numpy as np
import pandas
import pingouin
import pytest
from scipy import optimize, stats

import spandrel

TASKS = ("slab_side", "arch_bottom", "interlayer", "pier_circle")
PHASES = ("calibration", "taking_off", "task_1", "task_2", "task_3", "task_4", "landing")
# SciPy uses different series and summation orders; the project requires nine digits.
CLOSE = 1e-9
# Tolerance between a fit by general minimization and the program's bisection.
FITTED = 1e-5
# Pingouin rounds its results to six digits or more, depending on the column.
PINGOUIN = 1e-6
PICKS = {
    "conformity": lambda record: record["scores"]["conformity"],
    "efficiency": lambda record: record["scores"]["efficiency"],
    "safety": lambda record: record["scores"]["safety"],
    "accuracy": lambda record: record["scores"]["accuracy"],
    "overall": lambda record: record["scores"]["overall"],
}
CERTIFICATION = ("conformity", "precision", "safety", "accuracy", "efficiency", "sum")
# Measures whose reliability is reported: the scores, those of the certification, and the RMS distance in percent of the threshold.
MEASURES = {
    **PICKS,
    **{f"certification_{name}": lambda record, name=name: record["certification"]["scores"][name] for name in CERTIFICATION},
    "rms_distance": lambda record: 100.0 * record["certification"]["precision"]["rms_distance_ratio"],
}


def random_certification(random):
    """Returns certification results with random scores."""
    scores = {name: float(random.uniform(20, 100)) for name in CERTIFICATION}
    precision = {"frames": 1000, "rms_speeding_ratio": 0.0, "rms_framing_deg": None, "low_clearance_share": 0.0}
    precision["rms_distance_ratio"] = float(random.uniform(0.2, 1.0))
    return {"scores": {**scores, "sum_max": 500.0}, "requirements": [], "precision": precision}


def random_record(random, trainee, number):
    """Returns a session with random scores and answers in the format of `records export`."""
    conformity, efficiency, safety, accuracy = (float(x) for x in random.uniform(20, 100, 4))
    nothing = {"bridge": 0, "terrain": 0, "water": 0, "other": 0, "vehicle": 0, "person": 0}
    task = lambda id, kind: {
        "id": id, "name": kind, "kind": kind, "attempted": True, "state": "done", "covered": 1.0, "seconds": 100.0, "on_path": float(random.uniform()), "speeding": 0.1,
        "speeding_s": 2.0, "fastest_m_s": 4.0, "off_path_s": 1.0, "off_sideways_m": None, "off_height_m": None, "crashes": nothing,
        "defects_placed": 0, "defects_found": 0,
    }
    keys = ["time_pressure", "frustration", "feedback"]
    keys += [f"{phase}.{aspect}" for phase in PHASES for aspect in ("performance", "mental_demand", "physical_demand")]
    return {
        "format": 7, "id": f"{trainee}-{number}", "fingerprint": f"{trainee}-{number}", "trainee": trainee,
        "started_unix_us": 1_700_000_000_000_000 + number, "spandrel_version": "0.1.0", "scorer_version": 1, "scenario": "two-bridges",
        "scenario_sha256": "", "vehicle": "phantom2", "vehicle_sha256": "", "telemetry_sha256": "", "seed": 7,
        "scores": {
            "conformity": conformity, "efficiency": efficiency, "safety": safety, "accuracy": accuracy,
            "overall": conformity + efficiency + safety + accuracy, "overall_max": 400.0,
        },
        "completion": {"complete": True, "tasks_done": 4, "tasks": 4, "path_share": 1.0, "landed_at_home": True, "done_share": 0.8},
        "tasks": [task(k + 1, kind) for k, kind in enumerate(TASKS)], "crashes_outside": nothing, "defects": [], "snapshots": 3, "hits": 1,
        "end_reason": "landed", "seconds": 700.0, "battery_failed": False, "battery_at_end_pct": 50.0, "covered": 1.0, "certified": False,
        "certification": random_certification(random),
        "answers": {"language": "en", "answers": {key: int(random.integers(1, 6)) for key in keys}},
    }


@pytest.fixture(scope="module", params=[1, 2, 3])
def study(request, tmp_path_factory):
    """Random sessions in chronological order, and the program's results: 40 people, 15 of them with five sessions."""
    random = np.random.default_rng(request.param)
    people = {f"p{k:02}": [random_record(random, f"p{k:02}", n) for n in range(5 if k < 15 else 1)] for k in range(40)}
    path = tmp_path_factory.mktemp("study") / "records.jsonl"
    path.write_text("".join(json.dumps(record) + "\n" for records in people.values() for record in records), encoding="utf-8")
    return people, json.loads(spandrel.run("cohort", "--records", str(path), "--repetitions", "5", "--json", "-"))


def close(ours, theirs, tolerance=CLOSE):
    return math.isclose(ours, float(theirs), rel_tol=tolerance, abs_tol=tolerance)


def test_val_distributions_match_scipy(study):
    people, cohort = study
    for one in cohort["distributions"]:
        values = np.array([PICKS[one["score"]](records[0]) for records in people.values()])
        figures = one["summary"]
        theirs = {
            "mean": values.mean(), "sd": values.std(ddof=1), "min": values.min(), "max": values.max(), "range": np.ptp(values),
            "q1": np.quantile(values, 0.25), "median": np.median(values), "q3": np.quantile(values, 0.75), "skewness": stats.skew(values),
        }
        for name, value in theirs.items():
            assert close(figures[name], value), (one["score"], name, figures[name], value)
    assert len(cohort["distributions"]) == 5


def test_val_paired_t_tests_match_scipy(study):
    people, cohort = study
    group = [records for records in people.values() if len(records) == 5]
    for one in cohort["tests"]:
        before = np.array([PICKS[one["score"]](records[one["earlier"] - 1]) for records in group])
        after = np.array([PICKS[one["score"]](records[one["later"] - 1]) for records in group])
        for tail, name in (("greater", "upper"), ("less", "lower"), ("two-sided", "two")):
            theirs = stats.ttest_rel(after, before, alternative=tail)
            assert close(one["t"], theirs.statistic) and close(one["p"][name], theirs.pvalue), (one["score"], tail)
        ends = stats.ttest_rel(after, before).confidence_interval(0.95)
        assert close(one["interval_95"][0], ends.low) and close(one["interval_95"][1], ends.high)
        difference = after - before
        assert close(one["effect_size_dz"], difference.mean() / difference.std(ddof=1))
    assert len(cohort["tests"]) == 50


def pingouin_reliability(values):
    """ICC(2,1), ICC(3,1) and the residual mean square of a table with one row per person and one column per session."""
    people, sessions = values.shape
    long = pandas.DataFrame({
        "person": np.repeat(np.arange(people), sessions), "session": np.tile(np.arange(sessions), people), "value": values.ravel(),
    })
    table = pingouin.intraclass_corr(long, targets="person", raters="session", ratings="value")
    # Single values; Pingouin 0.7 names the types after McGraw and Wong.
    named = dict(zip(table["Type"], table["ICC"]))
    pick = lambda *names: next(named[name] for name in names if name in named)
    residual = pingouin.rm_anova(long, dv="value", within="session", subject="person", detailed=True).set_index("Source").loc["Error", "MS"]
    return pick("ICC2", "ICC(A,1)"), pick("ICC3", "ICC(C,1)"), residual


def test_val_reliability_matches_pingouin(study):
    people, cohort = study
    group = [records for records in people.values() if len(records) == 5]
    measured = [one for one in cohort["reliability"] if one["measure"] in MEASURES]
    assert len(measured) == len(MEASURES)
    for one in measured:
        values = np.array([[MEASURES[one["measure"]](record) for record in records] for records in group])
        agreement, consistency, residual = pingouin_reliability(values)
        ours = one["reliability"]
        assert (ours["n"], ours["repetitions"]) == (15, 5)
        assert close(ours["icc_2_1"], agreement, PINGOUIN) and close(ours["icc_3_1"], consistency, PINGOUIN), one["measure"]
        assert close(ours["sem"], math.sqrt(residual), PINGOUIN)
        assert close(ours["minimal_detectable_change"], stats.norm.ppf(0.975) * math.sqrt(2 * residual), PINGOUIN)
        for test in (test for test in cohort["tests"] if test["score"] == one["measure"]):
            least = ours["minimal_detectable_change"] / math.sqrt(15)
            assert test["within_error"] == (abs(test["mean_difference"]) < least)
            change = values[:, test["later"] - 1] - values[:, test["earlier"] - 1]
            assert test["trainees_beyond_error"] == int(np.sum(np.abs(change) >= ours["minimal_detectable_change"]))
    # All flights take 700 s and nobody crashes: there is nothing to estimate.
    flat = {one["measure"]: one["reliability"] for one in cohort["reliability"] if one["measure"] in ("flight_time", "crashes")}
    assert flat == {"flight_time": None, "crashes": None}


def test_val_box_plots_match_numpy(study):
    people, cohort = study
    group = [records for records in people.values() if len(records) == 5]
    for one in cohort["boxes"]:
        values = np.array([PICKS[one["score"]](records[one["repetition"] - 1]) for records in group])
        q1, q3 = np.quantile(values, [0.25, 0.75])
        inside = values[(values >= q1 - 1.5 * (q3 - q1)) & (values <= q3 + 1.5 * (q3 - q1))]
        plot = one["plot"]
        assert close(plot["low_whisker"], inside.min()) and close(plot["high_whisker"], inside.max())
        assert len(plot["outliers"]) == len(values) - len(inside)


def test_val_homogeneity_test_matches_scipy(study):
    _, cohort = study
    for one in cohort["homogeneity"]:
        theirs = stats.chi2_contingency([one["group"], one["others"]], correction=False)
        assert close(one["chi_squared"], theirs.statistic) and close(one["p"], theirs.pvalue) and one["df"] == theirs.dof
        assert close(one["smallest_expected"], theirs.expected_freq.min())
    assert len(cohort["homogeneity"]) == 5


def test_val_correlations_match_scipy(study):
    people, cohort = study
    pairs = cohort["self_rating"]["people"]
    theirs = stats.spearmanr([p["self_rating"] for p in pairs], [p["measured_pct"] for p in pairs])
    ours = cohort["self_rating"]["overall"]
    assert close(ours["r"], theirs.statistic) and close(ours["p"], theirs.pvalue)
    for task, ours in cohort["self_rating"]["tasks"]:
        own = [6 - records[0]["answers"]["answers"][f"task_{task}.performance"] for records in people.values()]
        path = [records[0]["tasks"][task - 1]["on_path"] for records in people.values()]
        theirs = stats.spearmanr(own, path)
        assert close(ours["r"], theirs.statistic) and close(ours["p"], theirs.pvalue)


def regression(y, columns):
    """Least squares with SciPy: estimates, errors, p-values, intervals, R squared, and the model's p-value."""
    x = np.column_stack([np.ones(len(y)), *columns])
    estimates, _, _, _ = np.linalg.lstsq(x, y, rcond=None)
    residuals = y - x @ estimates
    df = len(y) - x.shape[1]
    errors = np.sqrt(np.diag(np.linalg.inv(x.T @ x)) * (residuals @ residuals) / df)
    p = 2 * stats.t.sf(np.abs(estimates / errors), df)
    reach = stats.t.ppf(0.975, df) * errors
    explained = 1 - (residuals @ residuals) / ((y - y.mean()) @ (y - y.mean()))
    f = explained / (1 - explained) * df / (x.shape[1] - 1)
    return estimates, errors, p, estimates - reach, estimates + reach, explained, stats.f.sf(f, x.shape[1] - 1, df)


def test_val_causal_model_matches_scipy(study):
    people, cohort = study
    answers = [records[0]["answers"]["answers"] for records in people.values()]
    demand = np.array([np.mean([a[f"{p}.{d}"] for p in PHASES for d in ("mental_demand", "physical_demand")]) for a in answers])
    strain = np.array([(a["time_pressure"] + a["frustration"]) / 2 for a in answers])
    feedback = np.array([6.0 - a["feedback"] for a in answers])
    performance = np.array([records[0]["scores"]["overall"] / 4 for records in people.values()])
    d, f = demand - demand.mean(), feedback - feedback.mean()
    for name, y, columns in (("strain", strain, (d, f, d * f)), ("performance", performance, (strain, d))):
        ours = cohort["causal"][name]
        estimates, errors, p, low, high, explained, whole = regression(y, columns)
        for k, one in enumerate(ours["coefficients"]):
            assert close(one["estimate"], estimates[k]) and close(one["standard_error"], errors[k]) and close(one["p"], p[k]), one
            assert close(one["interval_95"][0], low[k]) and close(one["interval_95"][1], high[k])
        assert close(ours["r_squared"], explained) and close(ours["p"], whole)


def test_val_learning_curves_match_scipy(study):
    people, cohort = study
    n = np.arange(1, 6)
    checked = 0
    for one in cohort["progress"]:
        for curve in one["curves"]:
            values = np.array([PICKS[curve["score"]](record) for record in people[one["trainee"]]])
            (first, exponent), _ = optimize.curve_fit(lambda n, a, b: a * n**b, n, values, p0=(values[0], 0.0), xtol=1e-14, ftol=1e-14)
            ours = np.sum((values - curve["first"] * n ** curve["exponent"]) ** 2)
            theirs = np.sum((values - first * n**exponent) ** 2)
            # SciPy's fit may converge to another local minimum; the program's fit must not be worse.
            assert ours <= theirs * (1 + CLOSE)
            if close(ours, theirs, FITTED):
                assert close(curve["first"], first, FITTED) and close(curve["exponent"], exponent, FITTED)
                checked += 1
    assert checked > 50


def test_val_paired_test_matches_the_tasbid_paper(tmp_path):
    """Eight people whose differences give t = 2.609: the TASBID paper's first test, p = 0.0175 in the upper tail."""
    random = np.random.default_rng(5)
    shape = random.normal(size=8)
    shape = (shape - shape.mean()) / shape.std(ddof=1)
    difference = 2.609 / math.sqrt(8) + shape
    records = []
    for k in range(8):
        for n in range(2):
            record = random_record(random, f"p{k}", n)
            record["scores"]["conformity"] = 60.0 + n * float(difference[k])
            records.append(record)
    path = tmp_path / "records.jsonl"
    path.write_text("".join(json.dumps(record) + "\n" for record in records), encoding="utf-8")
    cohort = json.loads(spandrel.run("cohort", "--records", str(path), "--repetitions", "2", "--json", "-"))
    test = next(one for one in cohort["tests"] if one["score"] == "conformity")
    assert round(test["t"], 3) == 2.609
    assert [round(test["p"][tail], 4) for tail in ("upper", "lower", "two")] == [0.0175, 0.9825, 0.0350]


def test_regress_incomplete_sessions_are_excluded_and_counted(tmp_path):
    """An aborted session must not count as a first session, unless requested."""
    random = np.random.default_rng(9)
    records = [random_record(random, trainee, n) for trainee in ("anna", "ben") for n in range(2)]
    broken_off = records[0]
    broken_off["completion"] |= {"complete": False, "tasks_done": 1, "path_share": 0.31, "landed_at_home": False}
    broken_off["end_reason"] = "abort"
    path = tmp_path / "records.jsonl"
    path.write_text("".join(json.dumps(record) + "\n" for record in records), encoding="utf-8")
    ask = lambda *more: json.loads(spandrel.run("cohort", "--records", str(path), "--repetitions", "1", "--json", "-", *more))
    without, asked = ask(), ask("--include-incomplete")
    assert (without["sessions"], without["left_out"]) == (3, 1) and (asked["sessions"], asked["left_out"]) == (4, 0)
    first = lambda cohort: next(one["session"] for one in cohort["individuals"] if one["trainee"] == "anna")
    assert (first(without), first(asked)) == ("anna-1", "anna-0")
    said = spandrel.run("cohort", "--records", str(path), "--repetitions", "1")
    assert "1 incomplete session excluded (use --include-incomplete to count them)" in said, said
    plan = lambda *more: json.loads(spandrel.run("plan", "anna", "--records", str(path), "--json", *more))
    assert (plan()["session"], plan()["left_out"]) == ("anna-1", 1) and plan("--include-incomplete")["left_out"] == 0
