"""Tests every subcommand that writes files with a full disk, failing or short writes, or a kill at each of its file
operations.

`faults.c` is loaded between the program and the C library. After a fault, the program must end with a message and its
exit code, never with a panic; a replaced file must have either its old or its new content; and the same command without
the fault must then give the same result as on a fault-free disk."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import threading

import pyulog
import pytest
from pymavlink import mavutil

import display
import sdk
import spandrel
import test_controller
import webserver
from spandrel import wait_for

HERE = pathlib.Path(__file__).parent
# For a command with many operations, only every n-th operation is tried, which limits the number of runs per fault kind
# to this value.
MAX_ATTEMPTS = 24
# Upper bound for the number of operations, far above the number that any command here needs.
MAX_OPERATIONS = 10_000
# Height that counts as flying in the drill's session, m.
HEIGHT_M = 2.0
# Number of operations tried for commands that take seconds (such as a complete flight): the first, the last, and one in
# between.
SLOW_TRIED = 3
KINDS = ["enospc", "eio", "short", "kill"]


@pytest.fixture(scope="session")
def shim(tmp_path_factory):
    """Returns the library that injects faults."""
    built = tmp_path_factory.mktemp("faults") / "faults.so"
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", str(built), str(HERE / "faults.c"), "-ldl"], check=True)
    return built


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """Returns a session written by a fault-free disk."""
    sessions = tmp_path_factory.mktemp("flown") / "sessions"
    spandrel.run("demo", "--scenario", "drill-hover", "--seed", "3", "--speed", "max", "--trainee", "anna", "--sessions", str(sessions))
    place = ["--sessions", str(sessions), "--database", str(sessions.parent / "records.sqlite")]
    spandrel.run("records", "import", *place)
    (sessions.parent / "records.jsonl").write_text(spandrel.run("records", "export", *place), encoding="utf-8")
    spandrel.run("export", "drill-gap", "--glb", str(sessions.parent / "bridge.glb"))
    return next(path for path in sessions.iterdir() if path.is_dir())


def environment(shim, under, kind, first=1, count=1, log=None):
    """Returns the environment of a program with faults in a folder."""
    return os.environ | {
        "LD_PRELOAD": str(shim), "FAULT_UNDER": str(under), "FAULT_KIND": kind, "FAULT_FIRST": str(first), "FAULT_COUNT": str(count),
        "FAULT_LOG": str(log or os.devnull),
    }


def operations(log):
    """Returns the lines of the file operation log."""
    return log.read_text(encoding="utf-8").splitlines() if log.is_file() else []


# Arguments by name; {s} is the folder of sessions, {d} the session, {r} its records, {o} a folder for results. Includes
# input for commands that prompt for it.
COMMANDS = {
    "assess": (["assess", "{d}", "--json", "{o}/scores.json"], ""),
    "report": (["report", "{d}"], ""),
    "frames": (["export", "{d}", "--frames", "{o}/frames.csv"], ""),
    "geometry": (["export", "{d}", "--glb", "{o}/site.glb"], ""),
    "bridge": (["import", "{b}", "--out", "{o}/bridge", "--overwrite"], ""),
    "plan": (["export", "{d}", "--plan", "{o}/tasks.plan"], ""),
    "recording": (["export", "{d}", "--mcap", "{o}/flight.mcap"], ""),
    "parquet": (["export", "{d}", "--parquet", "{o}/frames.parquet"], ""),
    "scorm": (["export", "{d}", "--scorm", "{o}/result.zip"], ""),
    "xapi": (["export", "{d}", "--xapi", "{o}/statements.jsonl"], ""),
    "questionnaire": (["questionnaire", "{d}"], "2\n" * 24),
    "import": (["records", "import", "--sessions", "{s}", "--database", "{o}/records.sqlite"], ""),
    "cohort": (["cohort", "--scenario", "drill-hover", "--repetitions", "1", "--records", "{r}", "--csv", "{o}/tables", "--report", "{o}/cohort.html"], ""),
    "study": (["study", "--scenario", "drill-hover", "--skill", "expert", "--seeds", "1", "--jobs", "1", "--out", "{o}/study"], ""),
    "parameters": (
        ["sim", "--scenario", "drill-hover", "--speed", "max", "--end-after", "1", "--ports", "ephemeral", "--params", "{o}/vehicle.params",
         "--files", "{o}/files"],
        "",
    ),
}
# Databases and recordings contain times and IDs that differ between runs; the command's own check validates them.
COMPARED = (".toml", ".json", ".csv", ".glb", ".plan", ".parquet", ".zip", ".jsonl", ".html", ".params")


class SessionCopy:
    """A copy of the session, with a folder for results."""

    def __init__(self, folder, flown):
        self.root = folder
        self.sessions, self.out = folder / "sessions", folder / "out"
        self.session, self.records = self.sessions / flown.name, flown.parents[1] / "records.jsonl"
        self.bridge = flown.parents[1] / "bridge.glb"
        shutil.copytree(flown, self.session)
        self.out.mkdir(exist_ok=True)

    def run(self, name, env=None):
        """Runs a command in this folder."""
        words, typed = COMMANDS[name]
        args = [word.format(s=self.sessions, d=self.session, o=self.out, r=self.records, b=self.bridge) for word in words]
        return subprocess.run(
            [spandrel.PROGRAM, *args], input=typed, env=env, capture_output=True, text=True, timeout=spandrel.FLIGHT_LIMIT_S, check=False
        )

    def results(self):
        """Returns the files that can be compared, by path."""
        found = [path for path in self.root.rglob("*") if path.is_file() and path.suffix in COMPARED]
        return {str(path.relative_to(self.root)): path.read_bytes() for path in found}


@pytest.mark.timeout(1200)
@pytest.mark.parametrize("kind", ["enospc", "eio", "short", "kill"])
@pytest.mark.parametrize("name", list(COMMANDS))
def test_regress_fault_at_any_operation_leaves_complete_files(shim, flown, tmp_path, name, kind, measured):
    sound = SessionCopy(tmp_path / "sound", flown)
    log = tmp_path / "operations"
    done = sound.run(name, environment(shim, sound.root, "none", log=log))
    assert done.returncode == 0, done.stderr
    expected, total = sound.results(), len(operations(log))
    assert 0 < total < MAX_OPERATIONS, "the command must write files"
    step = max(1, total // MAX_ATTEMPTS)
    hit = 0
    for first in range(1, total + 1, step):
        place = SessionCopy(tmp_path / "faulty", flown)
        before = place.results()
        log.unlink(missing_ok=True)
        done = place.run(name, environment(shim, place.root, kind, first, log=log))
        hit += any(line.endswith(" fault") for line in operations(log))
        if kind == "kill":
            assert done.returncode in (-signal.SIGKILL, 0), (first, done.stderr)
        else:
            assert done.returncode in (0, 1, 2) and "panicked" not in done.stderr, (first, done.returncode, done.stderr)
            assert done.returncode == 0 or str(place.root) in done.stderr, (first, "the message must name the file", done.stderr)
        for file, content in place.results().items():
            whole = (before.get(file), expected.get(file))
            # Partial answers are also valid, and the journal of a study may contain only the first flights or, after a kill, a part of one.
            partial = file.endswith("answers.json") or (file.endswith("flights.jsonl") and expected[file].startswith(content))
            assert content in whole or partial, (first, file, "is neither the old file nor the new one")
        again = place.run(name)
        assert again.returncode == 0, (first, again.stderr)
        assert place.results() == expected, (first, "the command must give the same result on a fault-free disk")
        shutil.rmtree(place.root)
    assert hit > 0 or kind == "short" or kind == "enospc", "no fault occurred"
    measured(f"{name} with {kind}: {total} file operations, {hit} faults injected")


def spread(total, most=SLOW_TRIED):
    """Returns operation numbers spread from the first to the last."""
    return sorted({1 + round(k * (total - 1) / (most - 1)) for k in range(most)})


def check_clean_exit(done, kind, place):
    """Checks that a program with a fault ends with a message that names the file, and never with a panic."""
    assert "panicked" not in done.stderr, done.stderr
    if kind == "kill":
        assert done.returncode in (-signal.SIGKILL, 0, 1), (done.returncode, done.stderr)
    else:
        assert done.returncode in (0, 1, 2), (done.returncode, done.stderr)
        assert done.returncode == 0 or str(place) in done.stderr, ("the message must name the file", done.stderr)


# Small renderings of a session; {d} is the session, {o} a folder for results.
DRAWN = {
    "photographs": ["render", "{d}", "--snapshots", "--masks", "--quality", "low", "--size", "64x48"],
    "film": ["render", "{d}", "--video", "{o}/film.mp4", "--span", "20,21", "--fps", "2", "--quality", "low", "--size", "64x48"],
}
DRAWN_FILES = (".jpg", ".png", ".json", ".mp4", ".vtt", ".html")


@pytest.fixture(scope="module")
def photographed(tmp_path_factory):
    """A session with photos, and the settings for rendering on this machine."""
    if not display.DRIVERS:
        pytest.skip("Mesa's software Vulkan is missing: apt-get install mesa-vulkan-drivers")
    sessions = tmp_path_factory.mktemp("photographed") / "sessions"
    # A short job with few photos: everything is rendered dozens of times.
    spandrel.run("demo", "--scenario", "drill-framing", "--seed", "7", "--speed", "max", "--trainee", "anna", "--sessions", str(sessions))
    (session,) = sessions.iterdir()
    drawn = subprocess.run([spandrel.COCKPIT, "render", str(session), "--out", "-"], capture_output=True, timeout=120, check=False)
    if b"built without the view" in drawn.stderr:
        pytest.skip(f"{spandrel.COCKPIT} was built without the `view` feature")
    assert drawn.returncode == 0, drawn.stderr
    return session


@pytest.mark.timeout(1200)
@pytest.mark.parametrize("name", list(DRAWN))
def test_regress_fault_while_rendering_leaves_complete_pictures(shim, photographed, tmp_path, name, measured):
    """After a fault, each photo, video and picture is either the old or the new one; rendering again completes them."""
    def draw(root, env):
        session, out = root / "sessions" / photographed.name, root / "out"
        if not session.is_dir():
            shutil.copytree(photographed, session)
            out.mkdir()
        args = [word.format(d=session, o=out) for word in DRAWN[name]]
        drivers = {"VK_DRIVER_FILES": str(display.DRIVERS[0])}
        return subprocess.run(
            [spandrel.COCKPIT, *args], env=env | drivers, capture_output=True, text=True, timeout=spandrel.FLIGHT_LIMIT_S, check=False
        )

    def files(root):
        found = [path for path in root.rglob("*") if path.is_file() and path.suffix in DRAWN_FILES]
        return {str(path.relative_to(root)): path.read_bytes() for path in found}

    log, before = tmp_path / "operations", files(photographed.parents[1])
    sound = tmp_path / "sound"
    done = draw(sound, environment(shim, sound, "none", log=log))
    assert done.returncode == 0, done.stderr
    expected, total = files(sound), len(operations(log))
    assert total > 0 and expected != before, "something must be rendered"
    hit = 0
    for kind in KINDS:
        for first in spread(total):
            root = tmp_path / f"{kind}-{first}"
            log.unlink(missing_ok=True)
            done = draw(root, environment(shim, root, kind, first, log=log))
            hit += any(line.endswith(" fault") for line in operations(log))
            check_clean_exit(done, kind, root)
            for file, content in files(root).items():
                assert content in (before.get(file), expected.get(file)), (kind, first, file, "is neither the old file nor the new one")
    again = draw(root, dict(os.environ))
    assert again.returncode == 0 and files(root) == expected, (again.stderr, "rendering must be complete after a kill")
    assert hit > 0, "no fault occurred"
    measured(f"rendering {name}: {total} file operations, {hit} faults injected")


@pytest.mark.timeout(1200)
def test_regress_demo_with_faults_ends_with_a_session_or_a_reason(shim, tmp_path, measured):
    """Faults occur in the file operations of the simulator, monitor and pilot. Either the session is scored, or a
    message states the reason."""
    def demo(sessions, env):
        args = ["demo", "--scenario", "drill-hover", "--seed", "3", "--speed", "max", "--sessions", str(sessions)]
        return subprocess.run([spandrel.PROGRAM, *args], env=env, capture_output=True, text=True, timeout=spandrel.FLIGHT_LIMIT_S, check=False)

    log, sound = tmp_path / "operations", tmp_path / "sound"
    done = demo(sound, environment(shim, sound, "none", log=log))
    assert done.returncode == 0, done.stderr
    total, hit, scored = len(operations(log)), 0, 0
    (expected,) = [path.read_text(encoding="utf-8") for path in sound.glob("*/assessment.json")]
    for kind in KINDS:
        for first in spread(total):
            sessions = tmp_path / f"{kind}-{first}"
            log.unlink(missing_ok=True)
            done = demo(sessions, environment(shim, sessions, kind, first, log=log))
            hit += any(line.endswith(" fault") for line in operations(log))
            check_clean_exit(done, kind, sessions)
            for file in sessions.glob("*/*.json"):
                json.loads(file.read_text(encoding="utf-8"))
            for file in sessions.glob("*/report.html"):
                assert file.read_text(encoding="utf-8").rstrip().endswith("</html>"), (kind, first)
            for file in sessions.glob("*/assessment.json"):
                assert file.read_text(encoding="utf-8") == expected, (kind, first, "the scores must be those of a fault-free disk")
                scored += 1
    assert hit > 0 and scored > 0, "no fault occurred"
    measured(f"demo: {total} file operations, {hit} faults injected, {scored} sessions scored")


@pytest.mark.timeout(1200)
def test_regress_flight_continues_without_its_log(shim, tmp_path, measured):
    """`sim --files` in flight: the pilot lands despite disk faults, and the written part of the log can be read."""
    def fly(files, env):
        files.parent.mkdir()
        pilot = subprocess.Popen(
            [spandrel.PROGRAM, "pilot", "--scenario", "drill-hover", "--seed", "3", "--port", "0", "--announce", "--leash"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
        )
        address = f"127.0.0.1:{json.loads(pilot.stdout.readline())['port']}"
        sim = subprocess.Popen(
            [spandrel.PROGRAM, "sim", "--scenario", "drill-hover", "--seed", "3", "--speed", "max", "--ports", "ephemeral", "--gcs", address,
             "--lockstep", address, "--files", str(files), "--leash"],
            env=env, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
        )
        lines, told = [], []
        readers = [
            threading.Thread(target=lambda: lines.append(pilot.stdout.readline())), threading.Thread(target=lambda: told.append(sim.stderr.read())),
        ]
        for reader in readers:
            reader.start()
        # If the simulator dies before its first heartbeat, the pilot keeps waiting.
        wait_for("the landing, or the end of the simulator", lambda: lines or sim.poll() is not None, limit_s=spandrel.FLIGHT_LIMIT_S)
        sim.stdin.close()
        code = sim.wait(timeout=spandrel.FLIGHT_LIMIT_S)
        pilot.stdin.close()
        pilot.wait(timeout=spandrel.FLIGHT_LIMIT_S)
        for reader in readers:
            reader.join()
        return json.loads(lines[0] or "{}"), told[0], code

    log, sound = tmp_path / "operations", tmp_path / "sound" / "files"
    said, told, code = fly(sound, environment(shim, sound.parent, "none", log=log))
    assert said["reason"] == "landed" and code == 0, told
    total, hit, read = len(operations(log)), 0, 0
    for kind in KINDS:
        for first in spread(total):
            files = tmp_path / f"{kind}-{first}" / "files"
            log.unlink(missing_ok=True)
            said, told, code = fly(files, environment(shim, files.parent, kind, first, log=log))
            faults = [line for line in operations(log) if line.endswith(" fault")]
            hit += len(faults)
            assert "panicked" not in told, told
            if kind == "kill":
                assert code == -signal.SIGKILL, (first, told)
            elif code == 0:
                assert said["reason"] == "landed", (kind, first, told)
                # A fault in the log is reported once, with the name of the file.
                assert told.count("cannot write") <= 1, told
                assert kind == "short" or not faults or str(files) in told, (kind, first, faults, told)
            else:
                assert str(files) in told, (kind, first, told)
            for ulog in files.rglob("*.ulg"):
                if ulog.stat().st_size > 16:
                    assert pyulog.ULog(str(ulog)).data_list is not None, ulog
                    read += 1
    assert hit > 0 and read > 0, "no fault occurred"
    measured(f"sim --files in flight: {total} file operations, {hit} faults injected, {read} logs read")


@pytest.mark.timeout(1200)
def test_regress_server_on_a_bad_disk_imports_only_complete_sessions(shim, flown, tmp_path, measured):
    """Uploads a recording and saves an answer while the disk fails. Each is stored completely or not at all, and the
    page reports the result."""
    recording = (flown / "telemetry.tlog").read_bytes()
    fields = {"trainee": "carl", "scenario": "drill-hover", "vehicle": "phantom2"}
    template = tmp_path / "template" / "sessions"
    shutil.copytree(flown, template / flown.name)
    spandrel.run("records", "import", "--sessions", str(template))

    def serve(root, env):
        sessions = root / "sessions"
        if not sessions.is_dir():
            shutil.copytree(template, sessions)
        try:
            server = webserver.Server(sessions, env=env)
        except AssertionError as refused:
            # The server did not start; its last output is the reason.
            return [], str(refused)
        statuses = []
        try:
            browser = webserver.Browser(server.address)
            page = f"/sessions/{flown.name}/questions"
            statuses.append(browser.post(page, page, {"frustration": "3"}, headers={"Accept": "application/json"})[0])
            statuses.append(browser.upload("/upload", "/upload", fields, recording[: len(recording) - 300])[0])
        except (OSError, AssertionError, ValueError):
            statuses.append(None)
        server.process.stdin.close()
        server.process.wait(timeout=webserver.PATIENCE_S)
        server.log.close()
        return statuses, pathlib.Path(server.log.name).read_text(encoding="utf-8")

    log, sound = tmp_path / "operations", tmp_path / "sound"
    statuses, told = serve(sound, environment(shim, sound, "none", log=log))
    assert statuses == [200, 303], told
    total, hit = len(operations(log)), 0
    wanted = {path.name for path in next(p for p in (sound / "sessions").iterdir() if "-carl-" in p.name).iterdir() if path.is_file()}
    for kind in KINDS:
        for first in spread(total, 2 * SLOW_TRIED):
            root = tmp_path / f"{kind}-{first}"
            log.unlink(missing_ok=True)
            statuses, told = serve(root, environment(shim, root, kind, first, log=log))
            hit += any(line.endswith(" fault") for line in operations(log))
            assert "panicked" not in told and "please report this bug" not in told, (kind, first, told)
            taken = [path for path in (root / "sessions").iterdir() if "-carl-" in path.name and not path.name.startswith(".")]
            confirmed = statuses[1:] == [303]
            assert len(taken) == 1 if confirmed else len(taken) <= 1, (kind, first, statuses, taken)
            for folder in taken:
                there = {path.name for path in folder.iterdir() if path.is_file()}
                assert wanted - there <= {"report.html", "advice.json"}, (kind, first, "a session must be complete", wanted - there)
            answers = root / "sessions" / flown.name / "answers.json"
            if statuses[:1] == [200]:
                assert json.loads(answers.read_text(encoding="utf-8"))["answers"]["frustration"] == 3, (kind, first)
    statuses, told = serve(root, dict(os.environ))
    # 409 means that the recording was imported before the kill; a second upload must not create another session.
    assert statuses in ([200, 303], [200, 409]), (told, "the server must work as before after a kill")
    assert hit > 0, "no fault occurred"
    measured(f"serve: {total} file operations, {hit} faults injected")


def listen(port, texts, over):
    """Collects the texts sent to a ground station. The socket must be read, or it would fill up."""
    station = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}")
    while not over.is_set():
        message = station.recv_match(type="STATUSTEXT", blocking=True, timeout=0.2)
        if message is not None:
            texts.append(message.text)


class MonitoredFlight:
    """A simulator, and a monitor with faults when it writes telemetry."""

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
        """Returns the only session folder."""
        return wait_for("a session", lambda: next((f for f in self.sessions.glob("*") if f.is_dir()), None))

    def fly(self):
        """Takes off, lands and waits for the scores."""
        mavsdk, system = sdk.connect(self.sdk_port)
        action, telemetry = sdk.take_off(system, HEIGHT_M)
        action.land()
        ended = self.monitor.wait(timeout=spandrel.FLIGHT_LIMIT_S)
        # MAVSDK crashes the process if it is released before the objects that it created.
        del action, telemetry, system
        mavsdk.destroy()
        assert ended == 0, self.output()

    def output(self):
        """Returns the monitor's output."""
        return (self.folder / "monitor.txt").read_text(encoding="utf-8")

    def close(self):
        """Stops both processes."""
        spandrel.end(self.monitor)
        spandrel.end(self.sim)


# Controller input: a moving axis and a photo; seconds since the vehicle was found.
REPORTED = [{"t_s": round(0.05 * k, 2), "axis": test_controller.YAW, "value": round(0.01 * k, 2)} for k in range(10)]


class RecordedInput:
    """`spandrel rc --record` with a vehicle on a fault-free disk; a recording replaces the controller."""

    def __init__(self, shim, folder):
        self.shim, self.log = shim, folder / "operations"
        self.profiles, self.played, self.out = folder / "profiles", folder / "played.jsonl", folder / "out"
        for made in (self.profiles, self.out):
            made.mkdir()
        (self.profiles / "test-transmitter-0483-5710.toml").write_text(test_controller.PROFILE, encoding="utf-8")
        head = {"format": 1, "device": test_controller.DEVICE, "id": test_controller.IDENTITY}
        self.played.write_text("\n".join(json.dumps(line) for line in [head, *REPORTED]), encoding="utf-8")
        self.dial = spandrel.free_udp_port()
        self.sim = spandrel.start_sim(folder, spandrel.free_udp_port(), speed=1, gcs_port=self.dial)

    def fly(self, kind, first=1):
        """Runs a flight with a fault. Returns its result and the complete lines of its recording, without their
        times."""
        kept = self.out / "kept.jsonl"
        kept.unlink(missing_ok=True)
        self.log.unlink(missing_ok=True)
        command = [spandrel.PROGRAM, "rc", "--replay", str(self.played), "--record", str(kept), "--profiles", str(self.profiles)]
        done = subprocess.run(
            [*command, "--connect", f"127.0.0.1:{self.dial}"], env=environment(self.shim, self.out, kind, first, log=self.log),
            stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, check=False,
        )
        text = kept.read_text(encoding="utf-8") if kept.exists() else ""
        assert text == "" or text.endswith("\n"), "all lines must be complete"
        return done, [{k: v for k, v in json.loads(line).items() if k != "t_s"} for line in text.splitlines()]


@pytest.fixture(name="recorded")
def fixture_recorded(shim, tmp_path):
    """A vehicle, and the files needed to fly it."""
    made = RecordedInput(shim, tmp_path)
    yield made
    spandrel.end(made.sim)


@pytest.mark.timeout(300)
@pytest.mark.parametrize("kind", KINDS)
def test_regress_fault_ends_the_input_recording_but_not_the_flight(recorded, kind, measured):
    """The recording contains complete lines up to the fault. Only a recording that cannot be created ends the
    command, with a message that names the file."""
    sound, lines = recorded.fly("none")
    total = len(operations(recorded.log))
    assert sound.returncode == 0 and len(lines) == 1 + len(REPORTED), (sound.stderr, lines)
    for first in spread(total):
        done, kept = recorded.fly(kind, first)
        assert any(line.endswith(" fault") for line in operations(recorded.log)) or kind == "short", "a fault must have occurred"
        assert kept == lines[: len(kept)] and "panicked" not in done.stderr, (first, kept, done.stderr)
        if kind == "kill":
            assert done.returncode == -signal.SIGKILL and len(kept) < len(lines), (first, done.returncode)
        elif kind == "short":
            assert done.returncode == 0 and kept == lines, (first, done.stderr)
        elif first <= 2:
            assert done.returncode != 0 and "kept.jsonl" in done.stderr, (first, done.stderr)
        else:
            assert done.returncode == 0 and "the recording ends here, the flight continues" in done.stderr, (first, done.stderr)
    measured(f"rc --record with {kind}: {total} file operations")


@pytest.mark.timeout(600)
@pytest.mark.parametrize("kind", ["enospc", "eio", "short"])
def test_regress_disk_failure_in_flight_loses_no_telemetry(shim, tmp_path, kind):
    """From the 24th operation on, 10 fail (about two seconds of a flight): the pilot is warned, the flight continues,
    and no data is lost."""
    watched = MonitoredFlight(shim, tmp_path, kind=kind, first=24, count=10, log=tmp_path / "operations")
    texts, over = [], threading.Event()
    listener = threading.Thread(target=listen, args=(watched.gcs_port, texts, over))
    listener.start()
    try:
        watched.fly()
        words = {"enospc": "Disk full: recording paused", "eio": "Disk error: recording paused", "short": "Armed"}[kind]
        wait_for("the pilot's texts", lambda: words in texts, limit_s=30)
        session = watched.session()
        assert any(line.endswith(" fault") for line in operations(tmp_path / "operations")), "no fault occurred"
        if kind == "short":
            assert not any("recording" in text for text in texts), "a short write must not be reported as a disk error"
        else:
            wait_for("the end of the warning", lambda: "Recording resumed" in texts, limit_s=30)
            assert "retrying" in watched.output() and "recording to disk resumed" in watched.output()
        # Complete and in order: the stored flight gives the same scores as the live one, frame by frame.
        assert spandrel.run("assess", str(session), "--json", "-") == (session / "assessment.json").read_text(encoding="utf-8")
        assert json.loads((session / "assessment.json").read_text(encoding="utf-8"))["telemetry"]["missing_frames"] == 0
        lines = (session / "events.jsonl").read_text(encoding="utf-8").splitlines()
        assert [json.loads(line)["event"] for line in lines].count("lift_off") == 1
    finally:
        over.set()
        listener.join()
        watched.close()


@pytest.mark.timeout(600)
def test_regress_second_monitor_is_rejected_and_files_are_synced(shim, tmp_path):
    """A session has only one writer, and its files are synced to disk when it ends."""
    log = tmp_path / "operations"
    watched = MonitoredFlight(shim, tmp_path, kind="none", log=log)
    try:
        session = watched.session()
        telemetry = session / "telemetry.tlog"
        wait_for("telemetry", lambda: telemetry.is_file() and telemetry.stat().st_size > 10_000)
        second = subprocess.run(
            [spandrel.PROGRAM, "monitor", "--session", str(session), *watched.place], capture_output=True, text=True, timeout=60, check=False
        )
        assert second.returncode == 2 and "another monitor is recording this session" in second.stderr, second.stderr
        watched.fly()
        synced = {pathlib.Path(line.split()[2]).name for line in operations(log) if line.split()[1] == "fsync"}
        wanted = {"telemetry.tlog", "events.jsonl", "assessment.json", "session.json", "advice.json", "report.html", "scenario.toml", session.name}
        assert wanted <= synced, wanted - synced
        assert spandrel.run("assess", str(session), "--json", "-") == (session / "assessment.json").read_text(encoding="utf-8")
    finally:
        watched.close()
