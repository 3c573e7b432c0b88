"""The lesson `first-flight` with a gamepad: `spandrel rc` flies the vehicle with the raw events of a device, which this test plays, and with the
device's profile."""

import contextlib
import json
import subprocess

import pytest

import spandrel
from lesson_pilot import LessonPilot, do_the_first_steps, do_the_other_steps
from stick_client import Client

DEVICE, IDENTITY = "Test pad", "045e:028e"
# Raw numbers of the axes on Linux.
LEFT_HORIZONTAL, LEFT_VERTICAL, RIGHT_HORIZONTAL, RIGHT_VERTICAL = 196608, 196609, 196611, 196612
# Deflection of a stick that is pushed; a key deflects it by 0.5.
PUSHED = 0.55
# Axis and raw value of a stick in each direction, in mode 2. As on real gamepads, up is negative.
DIRECTIONS = {
    "forward": (RIGHT_VERTICAL, -PUSHED), "back": (RIGHT_VERTICAL, PUSHED), "right": (RIGHT_HORIZONTAL, PUSHED), "left": (RIGHT_HORIZONTAL, -PUSHED),
    "up": (LEFT_VERTICAL, -PUSHED), "down": (LEFT_VERTICAL, PUSHED), "clockwise": (LEFT_HORIZONTAL, PUSHED), "counterclockwise": (LEFT_HORIZONTAL, -PUSHED),
}
ACTIONS = ["arm", "disarm", "take_off", "land", "lamp", "snapshot", "gimbal_up", "gimbal_down"]
# Wall seconds before a button without an effect is pressed again.
AGAIN_S = 5.0


def profile():
    """Returns the profile of the device."""
    axes = [("left_vertical", LEFT_VERTICAL, 1.0), ("left_horizontal", LEFT_HORIZONTAL, -1.0), ("right_vertical", RIGHT_VERTICAL, 1.0), ("right_horizontal", RIGHT_HORIZONTAL, -1.0)]
    tables = [f"[{name}]\naxis = {axis}\nlow = {low}\ncentre = 0.0\nhigh = {-low}\n" for name, axis, low in axes]
    buttons = "".join(f"{action} = [{button}]\n" for button, action in enumerate(ACTIONS))
    return f'format = 1\ndevice = "{DEVICE}"\nid = "{IDENTITY}"\nstick_mode = 2\n' + "".join(tables) + "[buttons]\n" + buttons


class Gamepad:
    """`spandrel rc` with a device whose events are written to its standard input."""

    def __init__(self, folder, vehicle_port):
        (folder / "pad.toml").write_text(profile(), encoding="utf-8")
        self.held = set()
        self.log = open(folder / "rc.txt", "w", encoding="utf-8")
        self.process = subprocess.Popen(
            [spandrel.PROGRAM, "rc", "--replay", "-", "--profile", str(folder / "pad.toml"), "--connect", f"127.0.0.1:{vehicle_port}"],
            stdin=subprocess.PIPE, stdout=self.log, stderr=self.log, text=True,
        )
        self.write({"format": 1, "device": DEVICE, "id": IDENTITY})
        for axis in (LEFT_HORIZONTAL, LEFT_VERTICAL, RIGHT_HORIZONTAL, RIGHT_VERTICAL):
            self.write({"t_s": 0, "axis": axis, "value": 0.0})

    def write(self, line):
        """Writes a line of the device's input."""
        self.process.stdin.write(json.dumps(line) + "\n")
        self.process.stdin.flush()

    def hold(self, directions):
        """Deflects the sticks in these directions and releases the others."""
        for direction in self.held - directions:
            self.write({"t_s": 0, "axis": DIRECTIONS[direction][0], "value": 0.0})
        for direction in directions - self.held:
            axis, value = DIRECTIONS[direction]
            self.write({"t_s": 0, "axis": axis, "value": value})
        self.held = set(directions)

    def tap(self, action):
        """Presses the button of an action."""
        for pressed in (True, False):
            self.write({"t_s": 0, "button": ACTIONS.index(action), "pressed": pressed})

    def close(self):
        """Closes the device's input, which ends the program. Returns its exit code."""
        # A program that has ended already is reported by its exit code.
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()
        code = self.process.wait(timeout=spandrel.FLIGHT_LIMIT_S)
        self.log.close()
        return code


@pytest.mark.timeout(600)
def test_wire_the_lesson_is_done_with_a_gamepad(tmp_path):
    """All steps are done with sticks and buttons, and mistakes are remarked. An invalid event is reported and has no effect."""
    gcs_port = spandrel.free_udp_port()
    with contextlib.ExitStack() as stack:
        flight = spandrel.Flight(tmp_path, scenario="first-flight", speed=2, gcs_port=gcs_port)
        stack.callback(flight.close)
        pad = Gamepad(tmp_path, gcs_port)
        stack.callback(pad.close)
        pilot = LessonPilot(pad, Client(flight.client_port, scenario="first-flight"), AGAIN_S)
        pad.write({"t_s": 0, "axis": LEFT_VERTICAL, "value": -2.0})
        do_the_first_steps(pilot)
        do_the_other_steps(pilot)
        assert flight.assessment()["end"]["reason"] == "landed"
        lines = (flight.session() / "events.jsonl").read_text(encoding="utf-8").splitlines()
        steps = [event["done"] for event in map(json.loads, lines) if event.get("event") == "lesson_step"]
        assert steps == list(range(1, 12)), steps
        code = pad.close()
    told = (tmp_path / "rc.txt").read_text(encoding="utf-8")
    assert code == 0, told
    assert "standard input:6: value = -2.0 (allowed: -1 to 1); the line has no effect" in told, told
