"""Every subcommand that writes, with a disk that is full, fails, writes short, or a kill at each of its file operations.

`faults.c` stands between the program and the C library. After a fault the program ends with a message and its exit code, never by a panic; a
file that it replaces is the old one or the new one; and the same command without the fault then gives what it gives on a sound disk."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import threading

import pytest
from pymavlink import mavutil

import sdk
import spandrel
from spandrel import wait_for

HERE = pathlib.Path(__file__).parent
# Of a command with many operations every n-th is tried, so that a kind of fault costs at most so many runs.
TRIED_MOST = 24
# Faults that are no longer met when a command has fewer operations than this; a bound for a loop, far above any command here.
OPERATIONS_MOST = 10_000
# Height that counts as flying for the drill's session, m.
HEIGHT_M = 2.0


@pytest.fixture(scope="session")
def shim(tmp_path_factory):
    """The library that injects faults."""
    built = tmp_path_factory.mktemp("faults") / "faults.so"
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", str(built), str(HERE / "faults.c"), "-ldl"], check=True)
    return built


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """A session as a sound disk keeps it."""
    sessions = tmp_path_factory.mktemp("flown") / "sessions"
    spandrel.run("demo", "--scenario", "drill-hover", "--seed", "3", "--speed", "max", "--trainee", "anna", "--sessions", str(sessions))
    place = ["--sessions", str(sessions), "--database", str(sessions.parent / "records.sqlite")]
    spandrel.run("records", "import", *place)
    (sessions.parent / "records.jsonl").write_text(spandrel.run("records", "export", *place), encoding="utf-8")
    return next(path for path in sessions.iterdir() if path.is_dir())


def environment(shim, under, kind, first=1, count=1, log=None):
    """Environment of a program that meets faults below a folder."""
    return os.environ | {
        "LD_PRELOAD": str(shim), "FAULT_UNDER": str(under), "FAULT_KIND": kind, "FAULT_FIRST": str(first), "FAULT_COUNT": str(count),
        "FAULT_LOG": str(log or os.devnull),
    }


def operations(log):
    """Lines of the log of operations."""
    return log.read_text(encoding="utf-8").splitlines() if log.is_file() else []


# Arguments by name; {s} is the folder of sessions, {d} the session, {r} its records, {o} a folder for results. Typed answers where the command asks.
COMMANDS = {
    "assess": (["assess", "{d}", "--json", "{o}/scores.json"], ""),
    "report": (["report", "{d}"], ""),
    "frames": (["export", "{d}", "--frames", "{o}/frames.csv"], ""),
    "geometry": (["export", "{d}", "--glb", "{o}/site.glb"], ""),
    "plan": (["export", "{d}", "--plan", "{o}/tasks.plan"], ""),
    "recording": (["export", "{d}", "--mcap", "{o}/flight.mcap"], ""),
    "parquet": (["export", "{d}", "--parquet", "{o}/frames.parquet"], ""),
    "scorm": (["export", "{d}", "--scorm", "{o}/result.zip"], ""),
    "xapi": (["export", "{d}", "--xapi", "{o}/statements.jsonl"], ""),
    "questionnaire": (["questionnaire", "{d}"], "2\n" * 24),
    "import": (["records", "import", "--sessions", "{s}", "--database", "{o}/records.sqlite"], ""),
    "cohort": (["cohort", "--scenario", "drill-hover", "--repetitions", "1", "--records", "{r}", "--csv", "{o}/tables", "--report", "{o}/cohort.html"], ""),
    "parameters": (
        ["sim", "--scenario", "drill-hover", "--speed", "max", "--end-after", "1", "--ports", "ephemeral", "--params", "{o}/vehicle.params",
         "--files", "{o}/files"],
        "",
    ),
}
# Databases and recordings hold times and ids of their own; of these the command itself says whether they are right.
COMPARED = (".json", ".csv", ".glb", ".plan", ".parquet", ".zip", ".jsonl", ".html", ".params")


class Place:
    """A copy of the session, and a folder for results."""

    def __init__(self, folder, flown):
        self.root = folder
        self.sessions, self.out = folder / "sessions", folder / "out"
        self.session, self.records = self.sessions / flown.name, flown.parents[1] / "records.jsonl"
        shutil.copytree(flown, self.session)
        self.out.mkdir(exist_ok=True)

    def run(self, name, env=None):
        """Runs a command here."""
        words, typed = COMMANDS[name]
        args = [word.format(s=self.sessions, d=self.session, o=self.out, r=self.records) for word in words]
        return subprocess.run(
            [spandrel.PROGRAM, *args], input=typed, env=env, capture_output=True, text=True, timeout=spandrel.FLIGHT_LIMIT_S, check=False
        )

    def results(self):
        """Files that can be compared, by their place."""
        found = [path for path in self.root.rglob("*") if path.is_file() and path.suffix in COMPARED]
        return {str(path.relative_to(self.root)): path.read_bytes() for path in found}


@pytest.mark.timeout(1200)
@pytest.mark.parametrize("kind", ["enospc", "eio", "short", "kill"])
@pytest.mark.parametrize("name", list(COMMANDS))
def test_regress_a_fault_at_any_operation_leaves_whole_files(shim, flown, tmp_path, name, kind, measured):
    sound = Place(tmp_path / "sound", flown)
    log = tmp_path / "operations"
    done = sound.run(name, environment(shim, sound.root, "none", log=log))
    assert done.returncode == 0, done.stderr
    expected, total = sound.results(), len(operations(log))
    assert 0 < total < OPERATIONS_MOST, "the command writes"
    step = max(1, total // TRIED_MOST)
    hit = 0
    for first in range(1, total + 1, step):
        place = Place(tmp_path / "faulty", flown)
        before = place.results()
        log.unlink(missing_ok=True)
        done = place.run(name, environment(shim, place.root, kind, first, log=log))
        hit += any(line.endswith(" fault") for line in operations(log))
        if kind == "kill":
            assert done.returncode in (-signal.SIGKILL, 0), (first, done.stderr)
        else:
            assert done.returncode in (0, 1, 2) and "panicked" not in done.stderr, (first, done.returncode, done.stderr)
            assert done.returncode == 0 or str(place.root) in done.stderr, (first, "the message names the file", done.stderr)
        for file, content in place.results().items():
            whole = (before.get(file), expected.get(file))
            # The answers so far are whole answers, too.
            assert content in whole or file.endswith("answers.json"), (first, file, "is neither the old file nor the new one")
        again = place.run(name)
        assert again.returncode == 0, (first, again.stderr)
        assert place.results() == expected, (first, "the command gives the same on a sound disk")
        shutil.rmtree(place.root)
    assert hit > 0 or kind == "short" or kind == "enospc", "no fault was met"
    measured(f"{name} with {kind}: {total} file operations, {hit} faults met")


def listen(port, texts, over):
    """Gathers the texts that a ground station gets; a socket that nobody reads would be full soon."""
    station = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}")
    while not over.is_set():
        message = station.recv_match(type="STATUSTEXT", blocking=True, timeout=0.2)
        if message is not None:
            texts.append(message.text)


class Watched:
    """A simulator, and a monitor that meets faults when it writes telemetry."""

    def __init__(self, shim, folder, **fault):
        self.folder, self.sessions = folder, folder / "sessions"
        self.sessions.mkdir()
        self.sdk_port, self.gcs_port, self.payload = (spandrel.free_udp_port() for _ in range(3))
        self.sim = spandrel.start_sim(folder, self.sdk_port, "--gcs", f"127.0.0.1:{self.gcs_port}", payload_port=self.payload)
        self.place = ["--connect", f"127.0.0.1:{self.payload}", "--port", "0"]
        self.monitor = subprocess.Popen(
            [spandrel.PROGRAM, "monitor", "--scenario", "drill-hover", "--sessions", str(self.sessions), *self.place],
            env=environment(shim, self.sessions, **fault), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=open(folder / "monitor.txt", "w", encoding="utf-8"),
        )

    def session(self):
        """The one session folder."""
        return wait_for("a session", lambda: next((f for f in self.sessions.glob("*") if f.is_dir()), None))

    def fly(self):
        """Up and down, to the scores."""
        mavsdk, system = sdk.connect(self.sdk_port)
        action, telemetry = sdk.take_off(system, HEIGHT_M)
        action.land()
        ended = self.monitor.wait(timeout=spandrel.FLIGHT_LIMIT_S)
        # MAVSDK ends the process when it goes before what came from it.
        del action, telemetry, system
        mavsdk.destroy()
        assert ended == 0, self.printed()

    def printed(self):
        """What the monitor said."""
        return (self.folder / "monitor.txt").read_text(encoding="utf-8")

    def close(self):
        """Ends both."""
        spandrel.end(self.monitor)
        spandrel.end(self.sim)


@pytest.mark.timeout(600)
@pytest.mark.parametrize("kind", ["enospc", "eio", "short"])
def test_regress_a_disk_that_fails_in_flight_costs_no_telemetry(shim, tmp_path, kind):
    """From the 24th operation on 10 fail (some two seconds of a flight): the pilot is warned, the flight goes on, nothing is lost."""
    watched = Watched(shim, tmp_path, kind=kind, first=24, count=10, log=tmp_path / "operations")
    texts, over = [], threading.Event()
    listener = threading.Thread(target=listen, args=(watched.gcs_port, texts, over))
    listener.start()
    try:
        watched.fly()
        words = {"enospc": "Disk full: recording paused", "eio": "Disk error: recording paused", "short": "Armed"}[kind]
        wait_for("the pilot's texts", lambda: words in texts, limit_s=30)
        session = watched.session()
        assert any(line.endswith(" fault") for line in operations(tmp_path / "operations")), "no fault was met"
        if kind == "short":
            assert not any("recording" in text for text in texts), "a short write is no fault of the disk"
        else:
            wait_for("the end of the warning", lambda: "Recording resumed" in texts, limit_s=30)
            assert "trying again" in watched.printed() and "takes the session again" in watched.printed()
        # Whole and in order: the stored flight gives the scores of the live one, frame by frame.
        assert spandrel.run("assess", str(session), "--json", "-") == (session / "assessment.json").read_text(encoding="utf-8")
        assert json.loads((session / "assessment.json").read_text(encoding="utf-8"))["telemetry"]["missing_frames"] == 0
        lines = (session / "events.jsonl").read_text(encoding="utf-8").splitlines()
        assert [json.loads(line)["event"] for line in lines].count("lift_off") == 1
    finally:
        over.set()
        listener.join()
        watched.close()


@pytest.mark.timeout(600)
def test_regress_a_second_monitor_is_refused_and_the_end_is_synced(shim, tmp_path):
    """One session has one writer, and its files reach the disk itself when it ends."""
    log = tmp_path / "operations"
    watched = Watched(shim, tmp_path, kind="none", log=log)
    try:
        session = watched.session()
        telemetry = session / "telemetry.tlog"
        wait_for("telemetry", lambda: telemetry.is_file() and telemetry.stat().st_size > 10_000)
        second = subprocess.run(
            [spandrel.PROGRAM, "monitor", "--session", str(session), *watched.place], capture_output=True, text=True, timeout=60, check=False
        )
        assert second.returncode == 2 and "another monitor records this session" in second.stderr, second.stderr
        watched.fly()
        synced = {pathlib.Path(line.split()[2]).name for line in operations(log) if line.split()[1] == "fsync"}
        wanted = {"telemetry.tlog", "events.jsonl", "assessment.json", "session.json", "report.html", "scenario.toml", session.name}
        assert wanted <= synced, wanted - synced
        assert spandrel.run("assess", str(session), "--json", "-") == (session / "assessment.json").read_text(encoding="utf-8")
    finally:
        watched.close()
