"""The certification, recomputed by an independent program from the exported numbers."""

import csv
import io
import json
import pathlib
import tomllib

import pytest
import recompute_certification

import spandrel

# Rounding errors of sums over some ten thousand frames, and of angles exported in degrees.
TOLERANCE = 1e-7


def fly(folder, scenario, skill, seed):
    """Flies one demo and returns its session folder. A form may follow the scenario's name after @."""
    name, _, form = scenario.partition("@")
    spandrel.run(
        "demo", "--scenario", name, *(["--form", form] if form else []), "--skill", skill, "--seed", str(seed), "--speed", "max",
        "--sessions", str(folder), "--log", "error",
    )
    (session,) = pathlib.Path(folder).iterdir()
    return session


def recompute(session):
    rows = list(csv.DictReader(io.StringIO(spandrel.run("export", str(session), "--frames", "-"))))
    scenario = json.loads(spandrel.run("export", str(session), "--scenario", "-"))
    assessment = json.loads(spandrel.run("assess", str(session), "--json", "-"))
    camera = tomllib.loads((session / "vehicle.toml").read_text(encoding="utf-8"))["camera"]
    return recompute_certification.certify(rows, scenario, camera, assessment), assessment["certification"]


def close(ours, theirs):
    return ours is None if theirs is None else ours == pytest.approx(theirs, rel=TOLERANCE, abs=TOLERANCE)


@pytest.mark.parametrize(
    "scenario, skill",
    [("two-bridges", "novice"), ("two-bridges", "expert"), ("drill-hover", "trained"), ("certification@B", "trained")],
)
def test_val_certification_is_recomputed_from_the_exports(scenario, skill, tmp_path, measured):
    ours, theirs = recompute(fly(tmp_path, scenario, skill, 2))
    for name, value in theirs["scores"].items():
        if name != "sum_max":
            assert close(ours["scores"][name], value), (name, ours["scores"][name], value)
    assert ours["passed"] == theirs["passed"], theirs["unmet"]
    for name, value in (theirs["precision"] or {}).items():
        assert close(ours["precision"][name], value), (name, ours["precision"][name], value)
    assert all(close(a, task["coverage"]) for a, task in zip(ours["coverage"], theirs["tasks"]))
    assert (ours["onsets"], ours["contacts"]) == (theirs["crash_onsets"], len(theirs["crashes"]))
    assert close(ours["exposure_s"], theirs["exposure_s"]) and close(ours["needed_s"], theirs["time"]["needed_s"])
    assert ours["pictures"] == tuple(theirs["accuracy"][key] for key in ("taken", "hits", "found", "placed"))
    measured(f"certification, {scenario}, {skill}: {theirs['scores']}, certified: {theirs['passed']}")
