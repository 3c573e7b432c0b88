"""The example study, flown again: the output of `tools/cohort` must match examples/cohort."""

import json
import os
import subprocess
import sys

import spandrel

PERSON = "synthetic-01"
# Three flights at full speed, each possibly restarted on a busy machine.
PATIENCE_S = 3 * spandrel.FLIGHT_LIMIT_S


def records(path):
    """Returns one person's records in flight order."""
    every = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
    return sorted((one for one in every if one["trainee"] == PERSON), key=lambda one: one["started_unix_us"])


def test_flight_example_study_is_reproducible(tmp_path):
    tool = spandrel.ROOT / "tools" / "cohort"
    done = subprocess.run(
        [sys.executable, str(tool), str(tmp_path), "1", "1"],
        env={**os.environ, "SPANDREL": spandrel.PROGRAM}, capture_output=True, text=True, timeout=PATIENCE_S, check=False,
    )
    assert done.returncode == 0, done.stderr
    flown, kept = records(tmp_path / "records.jsonl"), records(spandrel.ROOT / "examples" / "cohort" / "records.jsonl")
    assert len(flown) == len(kept) == 3
    for ours, theirs in zip(flown, kept):
        # Same job, seed and pilot: the same scores and answers to the last digit.
        for key in ("scores", "answers", "tasks", "hits", "snapshots", "scenario_sha256", "vehicle_sha256", "seed"):
            assert ours[key] == theirs[key], key
    assert list((tmp_path / "tables").glob("*.csv")) and (tmp_path / "cohort.json").exists()
