"""Flies a study (`spandrel study`) on a Ray cluster: one task per flight.

    python -m spandrel.ray_study [--address ADDRESS] [--program PROGRAM] [OPTIONS OF spandrel study]

The results are the same files, with the same bytes, as those of `spandrel study` on one machine. If a worker is lost, Ray starts
its flights again on another one. If this program is interrupted, run the same command again: it flies only the missing flights.

Every machine of the cluster needs Ray and the program `spandrel` of the same version, under the same path. Scenario and aircraft
files must have the same path on every machine; shipped ones are part of the program.
"""

from __future__ import annotations

import argparse
import fcntl
import json
import os
import pathlib
import subprocess
import sys
from collections.abc import Callable, Sequence
from typing import Any

MAX_RETRIES = 10
"""How often Ray starts a flight again whose worker was lost. A flight that fails is not flown again: it always fails."""
MAX_PENDING = 1000
"""Number of flights that are submitted at the same time, so that a study of any size needs little memory."""


class StudyError(RuntimeError):
    """A study cannot be flown: the program failed, or the machines of the cluster differ."""


def _run(command: Sequence[str]) -> str:
    """Runs the program and returns its standard output."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise StudyError(f"{' '.join(command)}: exit {done.returncode}\n{done.stderr.strip()}")
    return done.stdout


def fly_missing(
    arguments: Sequence[str],
    out: str | os.PathLike[str],
    program: str = "spandrel",
    on_row: Callable[[int, int], None] | None = None,
) -> int:
    """Flies the missing flights of a study on the Ray cluster that `ray.init` connected to, and returns their number.

    `arguments` are options of `spandrel study` without `--out`. Each finished flight is added to the journal in `out` at once;
    `on_row` receives the numbers of finished and of all missing flights. Run `spandrel study` afterward to write the tables.
    """
    import ray

    folder = pathlib.Path(out)
    command = [program, "study", *arguments]
    lines = _run([*command, "--out", str(folder), "--missing"]).splitlines()
    missing = [(int(number), fingerprint) for number, fingerprint in (line.split() for line in lines)]

    # Defined here, so that Ray sends its code to the workers, which then don't need this package.
    def fly(command: Sequence[str], number: int) -> tuple[str, int, str, str]:
        import socket
        import subprocess

        done = subprocess.run([*command, "--flight", str(number)], capture_output=True, text=True, check=False)
        return socket.gethostname(), done.returncode, done.stdout, done.stderr

    task: Any = ray.remote(num_cpus=1, max_retries=MAX_RETRIES, scheduling_strategy="SPREAD")(fly)
    with (folder / "flights.jsonl").open("a", encoding="utf-8") as journal:
        try:
            fcntl.flock(journal, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise StudyError(f"{journal.name}: another process is flying this study") from error
        pending: dict[Any, tuple[int, str]] = {}
        waiting = iter(missing)
        finished = 0
        while finished < len(missing):
            while len(pending) < MAX_PENDING and (flight := next(waiting, None)) is not None:
                pending[task.remote(command, flight[0])] = flight
            [ready], _ = ray.wait(list(pending), num_returns=1)
            number, fingerprint = pending.pop(ready)
            journal.write(_checked_row(ray.get(ready), number, fingerprint))
            journal.flush()
            finished += 1
            if on_row is not None:
                on_row(finished, len(missing))
    return len(missing)


def _checked_row(result: tuple[str, int, str, str], number: int, fingerprint: str) -> str:
    """Returns a flight's line for the journal, if the worker had the same program and files as this machine."""
    host, code, row, problem = result
    if code != 0:
        raise StudyError(f"flight {number} on {host}: exit {code}\n{problem.strip()}")
    if json.loads(row)["fingerprint"] != fingerprint:
        raise StudyError(f"flight {number} on {host}: this machine has another version of the program, or other scenario or aircraft files")
    return row


def main() -> int:
    """Runs the command line and returns the exit code."""
    import ray

    parser = argparse.ArgumentParser(
        prog="python -m spandrel.ray_study", description="Fly a study on a Ray cluster. All other options are those of `spandrel study`."
    )
    parser.add_argument("--address", help="address of the Ray cluster; 'auto' for the one of this machine (default: start Ray on this machine only)")
    parser.add_argument("--program", default=os.environ.get("SPANDREL", "spandrel"), help="the program, under the same path on all machines")
    parser.add_argument("--out", default="study", help="folder for the results (default: study)")
    own, arguments = parser.parse_known_args()
    ray.init(address=own.address, log_to_driver=False)
    try:
        fly_missing(arguments, own.out, own.program, lambda done, missing: print(f"{done} of {missing} flights", file=sys.stderr))
    except StudyError as error:
        print(error, file=sys.stderr)
        return 1
    finally:
        ray.shutdown()
    return subprocess.run([own.program, "study", *arguments, "--out", own.out], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
