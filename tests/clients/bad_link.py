"""Measures how often stock clients succeed, and how long they take, over links of four qualities.

    SPANDREL=target/release/spandrel .venv/bin/python tests/clients/bad_link.py --runs 20 --table table.md

With SPANDREL_PX4=DIR, the build folder of PX4 with its SIH simulator, the same clients also use a real PX4, alternating
with Spandrel.
"""

import argparse
import concurrent.futures
import dataclasses
import multiprocessing
import os
import pathlib
import queue
import statistics
import sys
import tempfile
import threading
import time

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action, ActionError
from mavsdk.plugins.ftp import Ftp, FtpResult
from mavsdk.plugins.log_files import LogFiles, LogFilesError, LogFilesResult
from mavsdk.plugins.mission_raw import MissionItem, MissionRaw, MissionRawError
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import Telemetry

import px4
import relay
import spandrel
import test_mavproxy

NAN = float("nan")
# Number of mission items (issue 16), and sizes of the file and the log, bytes.
ITEMS, FILE_BYTES, LOG_BYTES = 200, 50_000, 50_000
# Wall seconds before a client that is still trying counts as failed.
LIMIT_S = 300
# Wall seconds before a hanging client is killed: startup, LIMIT_S and shutdown of a run.
HANG_LIMIT_S = LIMIT_S + 120
# Maximum number of times that a user repeats a command that gets no response, or refreshes a list.
MAX_RETRIES = 5


class Failed(Exception):
    """The client gave up or got a wrong result."""


def error_text(error):
    """Returns the result in a plugin's error, without the call's arguments."""
    return str(error).split(";", maxsplit=1)[0]


def wait_for_result(what, predicate, limit_s=LIMIT_S):
    """Waits for a truthy value and returns it."""
    try:
        return spandrel.wait_for(what, predicate, limit_s)
    except AssertionError as error:
        raise Failed(str(error)) from None


def run_transfer(start, *args, next_result, success):
    """Runs a transfer that reports progress until it ends."""
    results = []
    start(*args, lambda result, *_: results.append(type(success)(result)))
    last = wait_for_result("the end of the transfer", lambda: next((r for r in results if r != next_result), None))
    if last != success:
        raise Failed(last.name)


def repeat_until_done(act):
    """Repeats an action if there is no response, as a user would press the button again."""
    for k in range(MAX_RETRIES):
        try:
            return act()
        except (ActionError, LogFilesError) as error:
            if k == MAX_RETRIES - 1:
                raise Failed(error_text(error)) from None
    return None


def content(length):
    """Returns bytes that do not repeat for a long time."""
    return bytes(k * k % 251 for k in range(length))


SPANDREL, PX4 = "Spandrel", "PX4"


def start(vehicle, folder, files, port, slot):
    """Starts a new real-time vehicle that serves `files` over FTP and connects to `port`."""
    if vehicle == PX4:
        return px4.start(folder, files, port, slot)
    return spandrel.start_sim(folder, port, "--files", str(files), speed=1)


class Bench:
    """A vehicle with a folder, a relay and a client for one run."""

    def __init__(self, folder, vehicle, link, seed, slot):
        self.folder = pathlib.Path(folder)
        files = self.folder / "files"
        day = files / "log" / "2026-11-20"
        day.mkdir(parents=True)
        (files / "survey.bin").write_bytes(content(FILE_BYTES))
        (day / "15_08_00.ulg").write_bytes(content(LOG_BYTES))
        self.port = spandrel.free_udp_port()
        self.relay = relay.Relay(self.port, link, seed)
        self.process = start(vehicle, folder, files, self.relay.port, slot)
        self.mavsdk = self.system = self.console = None

    def connect_mavsdk(self):
        """Connects MAVSDK and waits until it has found the vehicle."""
        self.mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
        self.mavsdk.add_any_connection(f"udpin://127.0.0.1:{self.port}")
        self.system = self.mavsdk.first_autopilot(60.0)
        if self.system is None:
            raise Failed("no vehicle found")

    def connect_mavproxy(self):
        """Connects MAVProxy and waits until it has read the vehicle's parameters."""
        self.console = test_mavproxy.Console(self.port, self.folder)
        try:
            self.console.wait("parameters to")
        except AssertionError:
            raise Failed("parameters never arrived") from None

    def close(self):
        """Stops everything that was started here."""
        if self.mavsdk is not None:
            self.mavsdk.destroy()
        if self.console is not None:
            self.console.close()
        self.relay.close()
        spandrel.end(self.process)


def mission(bench):
    """MAVSDK uploads 200 items in one attempt."""
    items = [
        MissionItem(k, 6, 16, int(k == 0), 1, 0, 0, 0, NAN, 467_052_000 + 30 * k, 83_814_000, 8.0, 0) for k in range(ITEMS)
    ]
    try:
        MissionRaw(bench.system).upload_mission(items)
    except MissionRawError as error:
        raise Failed(error_text(error)) from None


def parameters(bench):
    """MAVSDK reads all parameters in one attempt."""
    found = Param(bench.system).get_all_params()
    if len(found.int_params) + len(found.float_params) == 0:
        raise Failed("no parameters")


def flight(bench):
    """Arms, takes off, lands and disarms. Repeats commands that get no response."""
    action, telemetry = Action(bench.system), Telemetry(bench.system)
    wait_for_result("the vehicle is ready to arm", telemetry.health_all_ok)
    repeat_until_done(action.arm)
    repeat_until_done(action.takeoff)
    wait_for_result("the height", lambda: telemetry.position().relative_altitude_m > 2.0)
    repeat_until_done(action.land)
    wait_for_result("disarmed", lambda: not telemetry.armed())


def download(bench, burst):
    """Downloads a 50 kB file in one attempt."""
    down = bench.folder / "down"
    down.mkdir()
    run_transfer(Ftp(bench.system).download_async, "/survey.bin", str(down), burst, next_result=FtpResult.NEXT, success=FtpResult.SUCCESS)
    if (down / "survey.bin").read_bytes() != content(FILE_BYTES):
        raise Failed("wrong content")


def log(bench):
    """Downloads a 50 kB log; requests the list again if it does not arrive."""
    logs = LogFiles(bench.system)
    entries = repeat_until_done(logs.get_entries)
    old = next((entry for entry in entries or [] if entry.size_bytes == LOG_BYTES), None)
    if old is None:
        raise Failed("the log is not listed")
    down = bench.folder / "down.ulg"
    run_transfer(logs.download_log_file_async, old, str(down), next_result=LogFilesResult.NEXT, success=LogFilesResult.SUCCESS)
    if down.read_bytes() != content(LOG_BYTES):
        raise Failed("wrong content")


def mavproxy_get(bench):
    """Downloads a 50 kB file with MAVProxy's `ftp get` in one attempt."""
    try:
        bench.console.enter_command("ftp get /survey.bin down.bin", f"Wrote {FILE_BYTES} bytes to down.bin")
    except AssertionError:
        raise Failed("the download did not finish") from None
    wait_for_result("the content", lambda: (bench.folder / "down.bin").read_bytes() == content(FILE_BYTES), 10)


TASKS = {
    "Upload of a 200-item mission": mission,
    "Download of all parameters": parameters,
    "Arm, take off, land": flight,
    "FTP download of 50 kB, burst reads": lambda bench: download(bench, True),
    "FTP download of 50 kB, plain reads": lambda bench: download(bench, False),
    "FTP download of 50 kB, MAVProxy": mavproxy_get,
    "Download of a 50 kB log": log,
}


# Table columns.
TABLE = [link.name for link in relay.LINKS]


@dataclasses.dataclass(frozen=True)
class Run:
    """One attempt: a task over a link, with the seed for the losses."""

    vehicle: str
    name: str
    link: relay.Link
    seed: int


@dataclasses.dataclass
class Cell:
    """Results of a task over a link, for one cell of the table."""

    runs: int
    seconds: list
    failures: list

    def __str__(self):
        took = f", {statistics.median(self.seconds):.1f} s" if self.seconds else ""
        return f"{len(self.seconds)} of {self.runs}{took}"


def run(name, link, seed, vehicle=SPANDREL, slot=0, begun=lambda bench: None):
    """Runs a task over a link and returns its duration in wall seconds. Raises an error if it fails."""
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(folder, vehicle, link, seed, slot)
        begun(bench)
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


def run_in_process(results, this, slot):
    """Runs one attempt in a separate process, which is killed if its client hangs: MAVSDK occasionally deadlocks."""
    benches = []

    def end():
        results.send("the client hangs")
        for bench in benches:
            spandrel.end(bench.process)
        os._exit(1)

    timer = threading.Timer(HANG_LIMIT_S, end)
    timer.start()
    try:
        result = run(this.name, this.link, this.seed, this.vehicle, slot, benches.append)
    except Failed as error:
        result = str(error)
    timer.cancel()
    results.send(result)


def attempt(this, slots):
    """Returns the duration in seconds, or the reason for a failure."""
    context, slot = multiprocessing.get_context("spawn"), slots.get()
    try:
        receiver, sender = context.Pipe(duplex=False)
        process = context.Process(target=run_in_process, args=(sender, this, slot))
        process.start()
        sender.close()
        try:
            return receiver.recv()
        except EOFError:
            raise RuntimeError(f"{this} ended without a result") from None
        finally:
            process.join()
    finally:
        slots.put(slot)


def cell(begun):
    """Returns a table cell that summarizes its runs."""
    results = [future.result() for future in begun]
    seconds = [result for result in results if isinstance(result, float)]
    return Cell(len(results), seconds, [result for result in results if isinstance(result, str)])


def measure(vehicles, tasks, links, seeds, at_once):
    """Returns the lines of the table. Runs with the same seed follow each other, so that the machine's load affects
    all vehicles equally."""
    slots = queue.Queue()
    for slot in range(at_once):
        slots.put(slot)
    with concurrent.futures.ThreadPoolExecutor(at_once) as pool:
        begun = {}
        for name in tasks:
            for link in links:
                for seed in seeds:
                    for vehicle in vehicles:
                        future = pool.submit(attempt, Run(vehicle, name, link, seed), slots)
                        begun.setdefault((name, vehicle, link), []).append(future)
        cells = {}
        for (name, vehicle, link), futures in begun.items():
            cells[name, vehicle, link] = found = cell(futures)
            print(f"{name} | {vehicle} | {link.name}: {found} {sorted(set(found.failures))}", flush=True)
    return [
        f"| {name} | {vehicle} | " + " | ".join(str(cells[name, vehicle, link]) for link in links) + " |"
        for name in tasks
        for vehicle in vehicles
    ]


def main():
    """Measures everything, or the selected parts, and prints the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--first", type=int, default=0, help="seed of the first run")
    parser.add_argument("--at-once", type=int, default=1, help="number of parallel runs; each run mostly waits")
    parser.add_argument("--vehicle", action="append", choices=[SPANDREL, PX4], help="default: Spandrel, and PX4 if SPANDREL_PX4 is set")
    parser.add_argument("--task", action="append", choices=list(TASKS))
    parser.add_argument("--link", action="append", choices=[link.name for link in (*relay.LINKS, relay.LOSS_15)])
    parser.add_argument("--table", type=pathlib.Path)
    args = parser.parse_args()
    if PX4 in (args.vehicle or []) and not px4.BUILD:
        parser.error("--vehicle PX4 requires SPANDREL_PX4, the build folder of PX4 with SIH")
    if not px4.BUILD:
        print("SPANDREL_PX4 is not set: the table does not include PX4", file=sys.stderr)
    vehicles = args.vehicle or ([SPANDREL, PX4] if px4.BUILD else [SPANDREL])
    links = [link for link in (*relay.LINKS, relay.LOSS_15) if link.name in (args.link or TABLE)]
    lines = ["| task | vehicle | " + " | ".join(link.name for link in links) + " |", "|---" * (len(links) + 2) + "|"]
    lines += measure(vehicles, args.task or list(TASKS), links, range(args.first, args.first + args.runs), args.at_once)
    if PX4 in vehicles:
        lines += ["", f"PX4 {px4.version()}"]
    print("\n".join(lines))
    if args.table is not None:
        args.table.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
