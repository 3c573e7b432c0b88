"""The lesson `first-flight` in the window, with nothing but the keyboard: each step is done by key presses, and a wrong action is
answered by what went wrong."""

import json
import math

import pytest

import asking
import spandrel
from stick_client import Client, M
from test_flow import AGAIN_S, ENTER, ESCAPE, LIMIT_S, UP, Training, acknowledge, count, folders, is_page, paused
from test_flow import screen  # noqa: F401 (fixture)
from test_lesson import RING, lesson_texts

# Outside the ring, m east, north, up.
BEYOND_RING = (0.0, 14.0, 5.0)
# Time that a pilot looks ahead, s: about the time in which the drone stops.
LOOKAHEAD_S = 0.9
# Distances at which a key is pressed, m: well inside the ring, which has a radius of 2 m.
HORIZONTAL_M, VERTICAL_M = 0.7, 0.5
# Time in the ring before it is left, vehicle milliseconds. From 2 s, leaving is a mistake.
INSIDE_MS = 4000
# Color of the ground in the side profile (crates/view/src/hud/mod.rs), and a number of pixels that only the large map has at the right.
EARTH, EARTH_PX = (112, 84, 56), 2000


class KeyPilot:
    """Flies with the keys of the window, and reads position and texts over a link of its own, on which it sends nothing else."""

    def __init__(self, screen, client):
        self.screen, self.client, self.held = screen, client, set()

    def hold(self, keys):
        """Holds these keys and releases the others."""
        for key in self.held - keys:
            self.screen.key(key, False)
        for key in keys - self.held:
            self.screen.key(key, True)
        self.held = set(keys)

    def keys_towards(self, target):
        """Returns the keys that lead to a place."""
        here, yaw = self.client.here()
        moving = self.client.state["LOCAL_POSITION_NED"]
        velocity = (moving.vy, moving.vx, -moving.vz)
        east, north, up = (t - h - LOOKAHEAD_S * v for t, h, v in zip(target, here, velocity))
        cos, sin = math.cos(yaw), math.sin(yaw)
        ways = [
            (north * cos + east * sin, HORIZONTAL_M, "Up", "Down"),
            (east * cos - north * sin, HORIZONTAL_M, "Right", "Left"),
            (up, VERTICAL_M, "w", "s"),
        ]
        return {plus if way > 0 else minus for way, least, plus, minus in ways if abs(way) > least}

    def fly(self, what, target, done):
        """Flies toward a place, and stays there, until `done` returns true."""

        def step():
            self.hold(self.keys_towards(target))
            return done()

        self.client.wait(what, step)
        self.hold(set())

    def tap_until(self, what, key, done):
        """Presses a key, and again if nothing happens."""
        again = asking.Repeater(lambda: self.screen.tap(key), again_s=AGAIN_S)
        self.client.wait(what, lambda: again.if_due() or done())


@pytest.mark.timeout(1200)
def test_wire_the_lesson_is_done_with_the_keyboard(screen, tmp_path):  # noqa: F811
    """Arm, take off, hover and turn; motors stopped too early and a ring left too early are remarked. The large map opens and closes."""
    gcs_port = spandrel.free_udp_port()
    training = Training(screen, tmp_path, "--trainee", "nina", "--scenario", "first-flight", "--seed", "7", "--no-sound", "--gcs", f"127.0.0.1:{gcs_port}")
    try:
        acknowledge(training, "lesson")
        client = Client(gcs_port, scenario="first-flight")
        said = lambda words: any(words in text for text in lesson_texts(client))  # noqa: E731
        now_ms = lambda: client.state["ATTITUDE"].time_boot_ms  # noqa: E731
        is_armed = lambda: client.state["HEARTBEAT"].base_mode & M.MAV_MODE_FLAG_SAFETY_ARMED  # noqa: E731
        client.wait("position", lambda: {"LOCAL_POSITION_NED", "ATTITUDE", "GPS_GLOBAL_ORIGIN"} <= client.state.keys() or client.ask_origin())
        client.wait("the first step", lambda: said("1/11 arm the motors"))
        pilot = KeyPilot(screen, client)
        screen.focus()

        pilot.tap_until("the second step", "1", lambda: said("2/11 take off to 2 m"))
        pilot.tap_until("a remark on the motors", "0", lambda: said("the motors are off: arm them again"))
        assert not said("3/11"), "without a takeoff, the lesson waits"
        again = asking.Repeater(lambda: (screen.tap("1"), screen.tap("t")))
        client.wait("the third step", lambda: again.if_due() or said("3/11 hover in the ring for 10 s"))
        assert is_armed()

        pilot.fly("the ring", RING, lambda: math.dist(client.here()[0], RING) < 1.0)
        since = now_ms()
        pilot.fly("a moment in the ring", RING, lambda: now_ms() > since + INSIDE_MS)
        assert not said("4/11"), "10 s are not over"
        pilot.fly("a remark on the ring", BEYOND_RING, lambda: said("you left the ring: stay 10 s"))
        training.wait_for_screenshot("lesson-remark", lambda photograph: True)
        assert not said("4/11")
        pilot.fly("the fourth step", RING, lambda: said("4/11 turn by 90 deg"))
        pilot.hold({"d"})
        client.wait("the fifth step", lambda: said("5/11 fly along the path"))
        pilot.hold(set())

        right = lambda photograph: photograph[:, photograph.shape[1] // 2 :]  # noqa: E731
        assert count(right(screen.photograph()), EARTH) < EARTH_PX
        training.wait_for_screenshot("lesson-large-map", lambda photograph: count(right(photograph), EARTH) > EARTH_PX, "c")
        training.wait_for_screenshot("lesson-map-closed", lambda photograph: count(right(photograph), EARTH) < EARTH_PX, "c")

        training.wait_for_screenshot("lesson-paused", paused, ESCAPE)
        screen.tap(UP)
        training.wait_for_screenshot("lesson-over", is_page, ENTER)
        spandrel.wait_for("the assessment", lambda: (folders(training)[0] / "assessment.json").exists(), LIMIT_S)
    finally:
        training.close()
    lines = (folders(training)[0] / "events.jsonl").read_text(encoding="utf-8").splitlines()
    steps = [event["done"] for event in map(json.loads, lines) if event.get("event") == "lesson_step"]
    assert steps == [1, 2, 3, 4], steps
