"""`spandrel train` and its flights: the vehicle keeps running after the session, flight logs can be downloaded, and a
killed monitor is replaced."""

import json
import os
import pathlib
import signal
import subprocess

import pytest
from mavsdk.plugins.log_files import LogFiles, LogFilesResult
from pymavlink import mavutil

import sdk
import spandrel
from spandrel import wait_for
from test_autopilots import build

# Height that counts as flying in the drill's session, m.
HEIGHT_M = 2.0
# Number of heartbeats after the session that prove that the vehicle is still running; one per second of vehicle time.
BEATS = 5


class Training:
    """`train` without its window on unused ports, as started by a ground station user."""

    def __init__(self, folder, *more):
        self.folder = pathlib.Path(folder)
        self.sessions = self.folder / "sessions"
        self.sdk_port, self.gcs_port = spandrel.free_udp_port(), spandrel.free_udp_port()
        self.log = open(self.folder / "train.txt", "w", encoding="utf-8")
        self.process = subprocess.Popen(
            [
                spandrel.PROGRAM, "train", "--scenario", "drill-hover", "--no-view", "--seed", "7", "--ports", "ephemeral", "--speed",
                str(spandrel.SPEED), "--gcs", f"127.0.0.1:{self.gcs_port}", "--sdk", f"127.0.0.1:{self.sdk_port}", "--web", "none",
                "--sessions", str(self.sessions), *more,
            ],
            stdin=subprocess.DEVNULL, stdout=self.log, stderr=self.log,
        )

    def output(self):
        """Returns the output so far."""
        return (self.folder / "train.txt").read_text(encoding="utf-8")

    def session(self):
        """Returns the only session folder."""
        return wait_for("a session folder", lambda: next((f for f in self.sessions.glob("*") if f.is_dir()), None))

    def child(self, subcommand):
        """Returns the process ID of the running child with this subcommand."""
        def find():
            for place in pathlib.Path("/proc").glob("[0-9]*"):
                try:
                    stat = (place / "stat").read_text(encoding="utf-8")
                    words = (place / "cmdline").read_bytes().split(b"\0")
                except OSError:
                    continue
                if int(stat.rsplit(")", 1)[1].split()[1]) == self.process.pid and words[1:2] == [subcommand.encode()]:
                    return int(place.name)
            return None
        return wait_for(f"the {subcommand}", find)

    def end(self):
        """Interrupts the process and returns its exit code."""
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(timeout=60)

    def close(self):
        """Stops the process and prints its output."""
        spandrel.end(self.process)
        self.log.close()
        print(self.output()[-3000:])


@pytest.fixture
def training(tmp_path):
    """Returns a running `train` on unused ports."""
    training = Training(tmp_path)
    yield training
    training.close()


def land(action, telemetry):
    """Lands and waits until disarmed."""
    action.land()
    wait_for("disarmed", lambda: not telemetry.armed())


def heartbeats(link, count):
    """Waits for a number of new autopilot heartbeats."""
    while link.recv_match(blocking=False) is not None:
        pass
    heard = 0

    def step():
        nonlocal heard
        message = link.recv_match(type="HEARTBEAT", blocking=True, timeout=1)
        heard += message is not None and message.get_srcComponent() == 1
        return heard >= count

    wait_for("heartbeats", step, limit_s=60)


@pytest.mark.timeout(600)
def test_regress_vehicle_stays_connected_after_landing(training, tmp_path, measured):
    """After the session is scored, a connected ground station stays connected, downloads the flight log, and flies
    again."""
    station = mavutil.mavlink_connection(f"udpin:127.0.0.1:{training.gcs_port}")
    mavsdk, system = sdk.connect(training.sdk_port)
    action, telemetry = sdk.take_off(system, HEIGHT_M)
    land(action, telemetry)
    session = training.session()
    wait_for("the scores", lambda: "stays connected: download" in training.output())
    assert (session / "assessment.json").is_file() and (session / "report.html").is_file()
    heartbeats(station, BEATS)
    assert training.process.poll() is None, training.output()
    # Downloads the log of this flight like QGroundControl's Log Download page.
    logs = LogFiles(system)
    entries = logs.get_entries()
    assert len(entries) == 1 and entries[0].size_bytes > 0, entries
    done = []
    target = tmp_path / "flight.ulg"
    logs.download_log_file_async(entries[0], str(target), lambda result, _progress, _data: done.append(LogFilesResult(result)))
    wait_for("the download", lambda: any(result != LogFilesResult.NEXT for result in done))
    kept = next(session.glob("vehicle/log/*/*.ulg"))
    assert target.read_bytes() == kept.read_bytes()
    # A second flight with the same vehicle must not change the session's scores.
    before = (session / "assessment.json").read_bytes()
    action, telemetry = sdk.take_off(system, HEIGHT_M)
    land(action, telemetry)
    assert len(list(session.glob("vehicle/log/*/*.ulg"))) == 2 and (session / "assessment.json").read_bytes() == before
    mavsdk.destroy()
    assert training.end() == 0
    size_kb = sum(file.stat().st_size for file in session.glob("vehicle/log/*/*")) // 1000
    measured(f"two short flights of `train` keep {size_kb} kB of flight logs (ULog and MCAP)")


@pytest.mark.timeout(600)
def test_train_once_quits_after_scoring(tmp_path):
    """With `--once`, for scripts, `train` quits when the session is scored."""
    training = Training(tmp_path, "--once")
    try:
        mavsdk, system = sdk.connect(training.sdk_port)
        action, _telemetry = sdk.take_off(system, HEIGHT_M)
        action.land()
        assert training.process.wait(timeout=spandrel.FLIGHT_LIMIT_S) == 0
        assert (training.session() / "assessment.json").is_file()
        mavsdk.destroy()
    finally:
        training.close()


@pytest.mark.timeout(600)
def test_regress_killed_monitor_is_replaced_in_the_same_session(training):
    """The monitor is killed in flight: the flight continues, and the complete session is scored."""
    mavsdk, system = sdk.connect(training.sdk_port)
    action, telemetry = sdk.take_off(system, HEIGHT_M)
    session = training.session()
    wait_for("telemetry of the flight", lambda: (session / "telemetry.tlog").stat().st_size > 200_000)
    killed = training.child("monitor")
    os.kill(killed, signal.SIGKILL)
    wait_for("another monitor", lambda: training.child("monitor") != killed)
    described = lambda: json.loads((session / "session.json").read_text(encoding="utf-8"))["monitor_starts"] == 2
    wait_for("its session.json", described)
    land(action, telemetry)
    wait_for("the scores", lambda: (session / "assessment.json").is_file())
    assert telemetry.health_all_ok() is not None and training.process.poll() is None
    assert len([f for f in training.sessions.glob("*") if f.is_dir()]) == 1
    assert json.loads((session / "assessment.json").read_text(encoding="utf-8"))["end"]["reason"] == "landed"
    events = (session / "events.jsonl").read_text(encoding="utf-8")
    assert events.count("monitor_restarted") == 1 and events.count('"lift_off"') == 1
    mavsdk.destroy()
    assert training.end() == 0


def test_session_contains_the_output_and_the_record_of_another_autopilot(tmp_path):
    training = Training(tmp_path, "--autopilot", "px4", "--px4", str(build(tmp_path)))
    try:
        folder = training.session() / "autopilot"
        wait_for("the output", (folder / "output.log").exists)
        record = json.loads(wait_for("the record", lambda: (folder / "autopilot.json").exists() and (folder / "autopilot.json").read_text(encoding="utf-8")))
        assert record["autopilot"] == "PX4" and record["version"]["number"] == "1.16.0", record
    finally:
        training.close()
