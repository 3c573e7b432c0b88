"""Starts the program with unused ports and reads its output."""

import json
import os
import pathlib
import signal
import socket
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("SPANDREL", str(ROOT / "target" / "release" / "spandrel"))
# The program with windows and rendering: tools/test builds the debug version with all features, and the release version
# for headless machines.
COCKPIT = os.environ.get("SPANDREL_COCKPIT", str(ROOT / "target" / "debug" / "spandrel"))
# Time limit for a complete flight at the speed below on a busy two-core machine, wall seconds (ten times the usual time).
FLIGHT_LIMIT_S = 600
# Speed of vehicle time relative to wall time. Clients use their own wall clocks, so it must be small.
SPEED = 4


def run(*args, program=PROGRAM):
    """Runs the program to its end and returns its output."""
    done = subprocess.run([program, *args], capture_output=True, text=True, timeout=FLIGHT_LIMIT_S, check=False)
    assert done.returncode == 0, f"{args}: exit {done.returncode}\n{done.stderr}"
    return done.stdout


def free_udp_port():
    """Returns a currently unused UDP port."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def start_sim(folder, client_port, *more, speed=SPEED, gcs_port=0, payload_port="none", scenario="drill-hover"):
    """Starts only a simulator, which runs in accelerated time and connects to one client."""
    log = open(pathlib.Path(folder) / "sim.txt", "w", encoding="utf-8")
    arguments = [
        "sim", "--scenario", scenario, "--seed", "7", "--speed", str(speed), "--gcs", f"127.0.0.1:{client_port}",
        "--sdk", "none", "--gcs-port", str(gcs_port), "--payload-port", str(payload_port), "--tcp-port", "none", "--monitor-port",
        "none", *more,
    ]
    return subprocess.Popen([PROGRAM, *arguments], stdout=log, stderr=log, stdin=subprocess.DEVNULL)


def end(process):
    """Stops a process that was started here."""
    if process.poll() is None:
        process.send_signal(signal.SIGINT)
        try:
            process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


class Flight:
    """A simulator and a monitor with unused ports, and the session that they write."""

    def __init__(self, folder, scenario="two-bridges", seed=7, speed=SPEED, flavor="px4", gcs_port=0):
        self.sessions = pathlib.Path(folder) / "sessions"
        self.log = open(pathlib.Path(folder) / "log.txt", "w", encoding="utf-8")
        self.client_port = free_udp_port()
        payload, monitor = free_udp_port(), free_udp_port()
        self.payload_port = payload
        common = ["--scenario", scenario, "--seed", str(seed)]
        self.sim = self._start(
            "sim", *common, "--flavor", flavor, "--speed", str(speed), "--gcs", f"127.0.0.1:{self.client_port}", "--sdk", "none",
            "--gcs-port", str(gcs_port), "--tcp-port", "none", "--payload-port", str(payload), "--monitor-port", str(monitor),
        )
        self.monitor = self._start(
            "monitor", "--scenario", scenario, "--sessions", str(self.sessions), "--port", str(monitor),
            "--connect", f"127.0.0.1:{payload}", "--trainee", "client-test",
        )

    def _start(self, *args):
        return subprocess.Popen([PROGRAM, *args], stdout=self.log, stderr=self.log, stdin=subprocess.DEVNULL)

    def session(self):
        """Returns the only session folder."""
        folders = sorted(self.sessions.iterdir())
        assert len(folders) == 1, folders
        return folders[0]

    def assessment(self):
        """Waits until the monitor ends and returns its assessment."""
        assert self.monitor.wait(timeout=FLIGHT_LIMIT_S) == 0
        return json.loads((self.session() / "assessment.json").read_text(encoding="utf-8"))

    def close(self):
        """Stops only the processes that were started here."""
        for process in (self.monitor, self.sim):
            end(process)
        self.log.close()


# Pause between two looks at a window, s: a look takes processor time that the window's frames need.
LOOK_PAUSE_S = 0.1


def wait_for(what, predicate, limit_s=FLIGHT_LIMIT_S, pause_s=0.01):
    """Polls until the predicate returns a truthy value; the limit only prevents a broken run from hanging."""
    end = time.monotonic() + limit_s
    while time.monotonic() < end:
        value = predicate()
        if value:
            return value
        time.sleep(pause_s)
    raise AssertionError(f"timed out waiting for: {what}")
