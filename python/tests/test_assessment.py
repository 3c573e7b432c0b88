"""Tests that this package scores its own recorded flights correctly."""

import dataclasses
import json
import math
import os
import subprocess

import pytest

import spandrel

JOB, AIRCRAFT = "drill-straight-line", "phantom2"


@pytest.fixture(scope="module")
def flight(tmp_path_factory):
    """Records a flight that starts and ends on the pad."""
    path = tmp_path_factory.mktemp("flight") / "flight.tlog"
    vehicle = spandrel.Vehicle(JOB, AIRCRAFT, seed=7)
    with vehicle.record(path):
        vehicle.arm()
        vehicle.take_off(5)
        vehicle.run_until(lambda state: state.height_m > 4.7, sim_s=20)
        east, north, up = vehicle.state.position_enu_m
        vehicle.go_to(east, north + 12.0, up)
        vehicle.run_until(lambda state: state.position_enu_m[1] > north + 11.0, sim_s=30)
        vehicle.command(2000, 0.0, 0.0, 1.0, 0.0)
        vehicle.go_to(east, north, up)
        vehicle.run_until(lambda state: math.dist(state.position_enu_m, (east, north, up)) < 0.5, sim_s=30)
        vehicle.land()
        vehicle.run_until(lambda state: not state.armed, sim_s=30)
        vehicle.run_for(2.0)
    return path


def test_tables_match_the_assessment(flight):
    assessment = spandrel.assess(flight, JOB, AIRCRAFT)
    scores = assessment.data["scores"]
    table = assessment.scores
    # The flight did not follow the drill's line to its end.
    assert assessment.completion == assessment.data["completion"] and assessment.completion["complete"] is False
    assert assessment.overall is None and math.isnan(table.loc["overall", "pct"])
    complete = dataclasses.replace(assessment, data={**assessment.data, "completion": {**assessment.completion, "complete": True}})
    assert complete.scores.loc["overall", "pct"] == complete.overall == scores["overall"] > 0.0
    for name in ("conformity", "efficiency", "safety"):
        assert table.loc[name, "pct"] == scores[name]["pct"]
        assert table.loc[name, "raw"] == scores[name]["raw"]
    assert "accuracy" not in table.index, "no defects in this job"
    assert list(assessment.tasks.index) == [task["id"] for task in assessment.data["tasks"]]
    assert list(assessment.tasks["covered"]) == [task["covered"] for task in assessment.data["tasks"]]
    assert len(assessment.snapshots) == assessment.data["snapshots"]["taken"] == 1
    assert list(assessment.requirements.columns)[3:] == ["limit", "reached", "applies", "met"]
    assert assessment.certified == bool(assessment.requirements["met"].all())
    frames = assessment.frames
    assert len(frames) == assessment.data["end"]["frames"] > 300
    assert frames["up_m"].max() > 4.0
    assert set(frames["contact"]) == {"none"}
    assert frames["snapshot"].sum() == 1


def test_scores_match_the_program(flight, tmp_path):
    program = os.environ.get("SPANDREL")
    if program is None:
        pytest.skip("SPANDREL is not set to the path of the program")
    said = subprocess.run(
        [program, "assess", str(flight), "--scenario", JOB, "--vehicle", AIRCRAFT, "--json", "-"],
        capture_output=True, text=True, check=True, timeout=60,
    )
    assert spandrel.assess(flight, JOB, AIRCRAFT).data == json.loads(said.stdout)


def test_exact_unscorable_logs_raise_errors(flight, tmp_path):
    with pytest.raises(spandrel.AssessmentError, match="scn_crc"):
        spandrel.assess(flight, "drill-hover", AIRCRAFT)
    with pytest.raises(OSError, match="nowhere.tlog"):
        spandrel.assess(tmp_path / "nowhere.tlog", JOB, AIRCRAFT)
    empty = tmp_path / "empty.tlog"
    empty.write_bytes(b"")
    with pytest.raises(spandrel.AssessmentError):
        spandrel.assess(empty, JOB, AIRCRAFT)


def test_exact_unwritable_log_raises_an_error(tmp_path):
    with pytest.raises(OSError, match="flight.tlog"), spandrel.Vehicle().record(tmp_path / "no" / "flight.tlog"):
        pass


def test_exact_the_flown_form_is_found_in_the_log(tmp_path):
    path = tmp_path / "flight.tlog"
    vehicle = spandrel.Vehicle("pilot-study@B", AIRCRAFT, seed=7)
    with vehicle.record(path):
        vehicle.arm()
        vehicle.take_off(3)
        vehicle.run_for(8.0)
        vehicle.land()
        vehicle.run_until(lambda state: not state.armed, sim_s=30)
        vehicle.run_for(2.0)
    found = spandrel.assess(path, "pilot-study", AIRCRAFT)
    assert found.data == spandrel.assess(path, "pilot-study@B", AIRCRAFT).data
    with pytest.raises(spandrel.AssessmentError, match="pilot-study"):
        spandrel.assess(path, "pilot-study@A", AIRCRAFT)
    with pytest.raises(spandrel.JobError, match=r"'X' \(allowed: A, B, C, H\)"):
        spandrel.Vehicle("pilot-study@X", AIRCRAFT, seed=7)
