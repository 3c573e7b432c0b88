"""Enters MAVProxy commands as a user would, through a pipe."""

import pathlib
import queue
import subprocess
import sys
import threading
import time

import pytest

import spandrel

# Time limit for a line from MAVProxy on a busy machine, wall seconds (ten times the usual).
LIMIT_S = 120
# Time limit for MAVProxy to end, wall seconds.
END_S = 10
# Position of the drill's pad; 1e-5 degrees of latitude are about a meter.
LAT, LON = 46.70520, 8.38140


class Console:
    """MAVProxy's prompt, with its input and output lines."""

    def __init__(self, port, folder):
        script = pathlib.Path(sys.executable).with_name("mavproxy.py")
        self.process = subprocess.Popen(
            [sys.executable, "-u", str(script), "--master", f"udpin:127.0.0.1:{port}", "--state-basedir", str(folder)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, bufsize=1, cwd=folder,
        )
        self.lines, self.heard = queue.Queue(), []
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.put(line.rstrip())

    def wait(self, text):
        """Waits for the next line that contains a text."""
        while True:
            try:
                line = self.lines.get(timeout=LIMIT_S)
            except queue.Empty:
                raise AssertionError(f"no output of '{text}':\n" + "\n".join(self.heard[-60:])) from None
            self.heard.append(line)
            if text in line:
                return line

    def enter_command(self, command, answer):
        """Enters a command and waits for its response."""
        self.process.stdin.write(command + "\n")
        self.process.stdin.flush()
        return self.wait(answer) if answer else None

    def repeat_until(self, command, answer, patience_s=1):
        """Enters a command repeatedly until its response arrives, because MAVProxy processes commands
        asynchronously."""
        for _ in range(LIMIT_S // patience_s):
            self.process.stdin.write(command + "\n")
            self.process.stdin.flush()
            end = time.monotonic() + patience_s
            try:
                while True:
                    self.heard.append(self.lines.get(timeout=max(end - time.monotonic(), 0.01)))
                    if answer in self.heard[-1]:
                        return
            except queue.Empty:
                pass
        raise AssertionError(f"no output of '{answer}':\n" + "\n".join(self.heard[-60:]))

    def close(self):
        """Ends MAVProxy, or kills it: when asked to end, it joins its threads, and sometimes one of them hangs."""
        self.process.stdin.close()
        self.process.terminate()
        try:
            self.process.wait(timeout=END_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


@pytest.fixture
def console(tmp_path):
    """A vehicle, and a MAVProxy that has fetched its parameters."""
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port, speed=2)
    console = Console(port, tmp_path)
    console.wait("parameters to")
    yield console, tmp_path
    console.close()
    spandrel.end(process)


def plan(folder, name, rows):
    """Writes a plan in the text format of Mission Planner and MAVProxy."""
    lines = ["QGC WPL 110"]
    for seq, (frame, command, params, north_m, height) in enumerate(rows):
        values = "\t".join(str(p) for p in params)
        lines.append(f"{seq}\t0\t{frame}\t{command}\t{values}\t{LAT + north_m * 1e-5:.7f}\t{LON:.7f}\t{height:.6f}\t1")
    path = folder / name
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


@pytest.mark.timeout(600)
def test_wire_mavproxy_uses_parameters_channels_and_lamp(console):
    """Parameters, a rejected arming attempt with its reason, a climb with RC channels, the relay, released channels."""
    typed, _folder = console
    typed.enter_command("param show MIS_TAKEOFF_ALT", "MIS_TAKEOFF_ALT  2.5")
    typed.enter_command("param set MPC_XY_CRUISE 4", None)
    typed.repeat_until("param fetch MPC_XY_CRUISE", "MPC_XY_CRUISE = 4.0")
    typed.enter_command("mode", "Available modes")
    typed.enter_command("rc 3 1900", None)
    typed.repeat_until("arm throttle", "Sticks not centered")
    typed.enter_command("rc all 1500", None)
    typed.repeat_until("arm throttle", "ARMED")
    typed.enter_command("rc 3 1800", "Takeoff detected")
    typed.enter_command("relay set 0 1", "DO_SET_RELAY: ACCEPTED")
    typed.enter_command("rc clear", "manual control lost")
    assert "breach" not in "\n".join(typed.heard)


@pytest.mark.timeout(600)
def test_wire_mavproxy_transfers_plans(console):
    """A mission, a fence and a rally point are uploaded and downloaded. A fence with two corners is rejected."""
    typed, folder = console
    nothing = (0.0, 0.0, 0.0, 0.0)
    mission = plan(folder, "mission.txt", [(3, 22, nothing, 0, 5), (3, 16, nothing, 10, 6), (3, 21, nothing, 0, 0)])
    typed.enter_command(f"wp load {mission}", "Loaded 3 waypoints")
    typed.wait("Got MISSION_ACK: TYPE_MISSION: ACCEPTED")
    typed.enter_command("wp list", "Requesting 3 waypoints")
    corners = [(0, 5001, (4.0, 0.0, 0.0, 0.0), north, 0) for north in (-50, 50)]
    typed.enter_command(f"fence load {plan(folder, 'fence.txt', [(0, 5003, (80.0, 0.0, 0.0, 0.0), 0, 0)])}", "Got MISSION_ACK: TYPE_FENCE: ACCEPTED")
    typed.enter_command("fence list", "Requesting 1 fence")
    typed.enter_command(f"fence load {plan(folder, 'torn.txt', corners)}", "Got MISSION_ACK: TYPE_FENCE: INVALID_PARAM1")
    typed.enter_command(f"rally load {plan(folder, 'rally.txt', [(3, 5100, nothing, 20, 5)])}", "Got MISSION_ACK: TYPE_RALLY: ACCEPTED")
    typed.enter_command("rally list", "Requesting 1 rally")


@pytest.mark.timeout(600)
def test_wire_mavproxy_needs_the_signing_key(tmp_path):
    """A vehicle that requires signatures ignores commands without the passphrase and accepts them with it."""
    key = tmp_path / "key"
    key.write_text("steelspan\n", encoding="utf-8")
    key.chmod(0o600)
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port, "--signing-key", str(key), speed=2)
    typed = Console(port, tmp_path)
    try:
        typed.wait("Detected vehicle")
        typed.enter_command("arm throttle force", None)
        typed.enter_command("signing key steelspan", None)
        typed.repeat_until("param fetch MIS_TAKEOFF_ALT", "MIS_TAKEOFF_ALT = 2.5")
        assert "ARMED" not in "\n".join(typed.heard), "the vehicle armed without a signature"
        typed.repeat_until("arm throttle force", "ARMED")
    finally:
        typed.close()
        spandrel.end(process)
