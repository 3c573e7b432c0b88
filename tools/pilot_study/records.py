"""Sessions from a file of records, and what `spandrel cohort` computes from them."""

import json
import pathlib
import subprocess
import sys

from pilot_study import paper


def cohort_results(program, path):
    """Returns the results of `spandrel cohort`, which also validates the records."""
    command = [program, "cohort", "--records", str(path), "--include-incomplete", "--json", "-", "--log", "error"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        sys.exit(f"{program}: {error.strerror}; build the program with cargo build --release, or set SPANDREL")
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


def sessions_of(path):
    """Returns the records of the first, second and third sessions, each in the order of the people's names."""
    records = [json.loads(line) for line in pathlib.Path(path).read_text(encoding="utf-8").splitlines()]
    people = {}
    for record in sorted(records, key=lambda record: (record["trainee"], record["started_unix_us"])):
        people.setdefault(record["trainee"], []).append(record)
    sessions = [[own[k] for own in people.values() if len(own) > k] for k in range(3)]
    found, design = [len(session) for session in sessions], [paper.PEOPLE, paper.REPEATING, paper.REPEATING]
    if found != design or len(records) != sum(design):
        sys.exit(f"{path}: {found} people flew a first, second and third session, of {len(records)} sessions; the pilot study needs {design}")
    if any(len(record["tasks"]) != len(paper.PLACES) - 1 for record in records):
        sys.exit(f"{path}: each session must have {len(paper.PLACES) - 1} tasks")
    return sessions


def places(record):
    """Returns one session's crashes in each task and outside, by what was hit."""
    return [*(task["crashes"] for task in record["tasks"]), record["crashes_outside"]]


def crashes_by_place(record):
    """Returns one session's number of crashes in each task and outside."""
    return [sum(place.values()) for place in places(record)]


def row(record):
    """Returns a record's results as `spandrel study` writes them."""
    kept = {key: record[key] for key in ("seconds", "end_reason")}
    crashes = " ".join(map(str, crashes_by_place(record)))
    return {**record["scores"], **kept, "crashes_by_task": crashes, "complete": record["completion"]["complete"]}


def conformity_parts(record):
    """Returns the points of the conformity score that each task adds for time on the path, and those that speeding takes away.

    An on-path share of 1 in each of the tasks would add 50 points to the 50 of a trainee who never enters a path; speeding throughout at three
    times the limit would take 50.
    """
    tasks = record["tasks"]
    return [(50 / len(tasks) * task["on_path"], 50 / 3 / len(tasks) * task["speeding"]) for task in tasks]
