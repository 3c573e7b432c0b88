"""Stock clients over links of four qualities: how often they succeed and how long they take.

    SPANDREL=target/release/spandrel .venv/bin/python tests/clients/bad_link.py --runs 20 --table table.md
"""

import argparse
import dataclasses
import pathlib
import statistics
import tempfile
import time

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action, ActionError
from mavsdk.plugins.ftp import Ftp, FtpResult
from mavsdk.plugins.log_files import LogFiles, LogFilesError, LogFilesResult
from mavsdk.plugins.mission_raw import MissionItem, MissionRaw, MissionRawError
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import Telemetry

import relay
import spandrel
import test_mavproxy

NAN = float("nan")
# Items of the mission (issue 16), bytes of the file and of the log.
ITEMS, FILE_BYTES, LOG_BYTES = 200, 50_000, 50_000
# Wall seconds after which a client that still tries counts as failed.
LIMIT_S = 300
# How often a person presses a button again whose command got no answer, and clicks "refresh" of a list.
PRESSES = 5


class Failed(Exception):
    """The client gave up, or got something else than there is."""


def why(error):
    """The result in a plug-in's error, without the arguments of the call."""
    return str(error).split(";", maxsplit=1)[0]


def settled(what, predicate, limit_s=LIMIT_S):
    """Waits for a truthy value."""
    try:
        return spandrel.wait_for(what, predicate, limit_s)
    except AssertionError as error:
        raise Failed(str(error)) from None


def ended(start, *args, next_result, success):
    """Runs a transfer that reports progress to its end."""
    results = []
    start(*args, lambda result, *_: results.append(type(success)(result)))
    last = settled("the end of the transfer", lambda: next((r for r in results if r != next_result), None))
    if last != success:
        raise Failed(last.name)


def pressed(act):
    """A button that is pressed again when nothing answers."""
    for k in range(PRESSES):
        try:
            return act()
        except (ActionError, LogFilesError) as error:
            if k == PRESSES - 1:
                raise Failed(why(error)) from None
    return None


def content(length):
    """Bytes that repeat nowhere soon."""
    return bytes(k * k % 251 for k in range(length))


class Bench:
    """A vehicle with a folder, a relay and a client behind it, for one run."""

    def __init__(self, folder, link, seed):
        self.folder = pathlib.Path(folder)
        files = self.folder / "files"
        day = files / "log" / "2026-11-20"
        day.mkdir(parents=True)
        (files / "survey.bin").write_bytes(content(FILE_BYTES))
        (day / "15_08_00.ulg").write_bytes(content(LOG_BYTES))
        self.port = spandrel.free_udp_port()
        self.relay = relay.Relay(self.port, link, seed)
        self.process = spandrel.start_sim(folder, self.relay.port, "--files", str(files), speed=1)
        self.mavsdk = self.system = self.console = None

    def connect_mavsdk(self):
        """MAVSDK has found the vehicle."""
        self.mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
        self.mavsdk.add_any_connection(f"udpin://127.0.0.1:{self.port}")
        self.system = self.mavsdk.first_autopilot(60.0)
        if self.system is None:
            raise Failed("no vehicle found")

    def connect_mavproxy(self):
        """MAVProxy has found the vehicle and read its parameters."""
        self.console = test_mavproxy.Console(self.port, self.folder)
        self.console.wait("parameters to")

    def close(self):
        """Ends what was started here."""
        if self.mavsdk is not None:
            self.mavsdk.destroy()
        if self.console is not None:
            self.console.close()
        self.relay.close()
        spandrel.end(self.process)


def mission(bench):
    """200 items go up by MAVSDK, one try."""
    items = [
        MissionItem(k, 6, 16, int(k == 0), 1, 0, 0, 0, NAN, 467_052_000 + 30 * k, 83_814_000, 8.0, 0) for k in range(ITEMS)
    ]
    try:
        MissionRaw(bench.system).upload_mission(items)
    except MissionRawError as error:
        raise Failed(why(error)) from None


def parameters(bench):
    """MAVSDK reads all parameters, one try."""
    found = Param(bench.system).get_all_params()
    if len(found.int_params) + len(found.float_params) == 0:
        raise Failed("no parameters")


def flight(bench):
    """Arm, take off, land, disarmed: a command that nothing answers is given again."""
    action, telemetry = Action(bench.system), Telemetry(bench.system)
    settled("a vehicle that would arm", telemetry.health_all_ok)
    pressed(action.arm)
    pressed(action.takeoff)
    settled("the height", lambda: telemetry.position().relative_altitude_m > 2.0)
    pressed(action.land)
    settled("disarmed", lambda: not telemetry.armed())


def download(bench, burst):
    """A file of 50 kB comes down, one try."""
    down = bench.folder / "down"
    down.mkdir()
    ended(Ftp(bench.system).download_async, "/survey.bin", str(down), burst, next_result=FtpResult.NEXT, success=FtpResult.SUCCESS)
    if (down / "survey.bin").read_bytes() != content(FILE_BYTES):
        raise Failed("another content")


def log(bench):
    """A log of 50 kB comes down; the list is asked for again when it does not come."""
    logs = LogFiles(bench.system)
    entries = pressed(logs.get_entries)
    old = next((entry for entry in entries or [] if entry.size_bytes == LOG_BYTES), None)
    if old is None:
        raise Failed("the log is not listed")
    down = bench.folder / "down.ulg"
    ended(logs.download_log_file_async, old, str(down), next_result=LogFilesResult.NEXT, success=LogFilesResult.SUCCESS)
    if down.read_bytes() != content(LOG_BYTES):
        raise Failed("another content")


def mavproxy_get(bench):
    """A file of 50 kB comes down by MAVProxy's `ftp get`, one try."""
    try:
        bench.console.say("ftp get /survey.bin down.bin", f"Wrote {FILE_BYTES} bytes to down.bin")
    except AssertionError:
        raise Failed("never ended") from None
    settled("the content", lambda: (bench.folder / "down.bin").read_bytes() == content(FILE_BYTES), 10)


TASKS = {
    "Mission of 200 items, upload": mission,
    "All parameters": parameters,
    "Arm, take off, land": flight,
    "FTP, 50 kB, burst": lambda bench: download(bench, True),
    "FTP, 50 kB, plain reads": lambda bench: download(bench, False),
    "FTP, 50 kB, MAVProxy": mavproxy_get,
    "Log of 50 kB": log,
}


# The columns of the table.
TABLE = [link.name for link in relay.LINKS]


@dataclasses.dataclass
class Cell:
    """What came of a task on a link."""

    runs: int
    seconds: list
    failures: list

    def __str__(self):
        took = f", {statistics.median(self.seconds):.1f} s" if self.seconds else ""
        return f"{len(self.seconds)} of {self.runs}{took}"


def run(name, link, seed):
    """Wall seconds of one task on a link; raises when it fails."""
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(folder, link, seed)
        try:
            if TASKS[name] is mavproxy_get:
                bench.connect_mavproxy()
            else:
                bench.connect_mavsdk()
            begin = time.monotonic()
            TASKS[name](bench)
            return time.monotonic() - begin
        finally:
            bench.close()


def measure(name, link, seeds):
    """A cell of the table."""
    cell = Cell(len(seeds), [], [])
    for seed in seeds:
        try:
            cell.seconds.append(run(name, link, seed))
        except Failed as error:
            cell.failures.append(str(error))
    print(f"{name} | {link.name}: {cell} {sorted(set(cell.failures))}", flush=True)
    return cell


def main():
    """Measures all, or what is named, and prints the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--first", type=int, default=0, help="seed of the first run")
    parser.add_argument("--task", action="append", choices=list(TASKS))
    parser.add_argument("--link", action="append", choices=[link.name for link in (*relay.LINKS, relay.LOSS_15)])
    parser.add_argument("--table", type=pathlib.Path)
    args = parser.parse_args()
    tasks, links = args.task or list(TASKS), [link for link in (*relay.LINKS, relay.LOSS_15) if link.name in (args.link or TABLE)]
    seeds = range(args.first, args.first + args.runs)
    lines = ["| task | " + " | ".join(link.name for link in links) + " |", "|---" * (len(links) + 1) + "|"]
    for name in tasks:
        lines.append(f"| {name} | " + " | ".join(str(measure(name, link, seeds)) for link in links) + " |")
    print("\n".join(lines))
    if args.table is not None:
        args.table.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
