"""The lesson `first-flight` in the window, with nothing but the keyboard: the steps are done by key presses as their texts say, and a wrong
action is answered by what went wrong. All eleven steps take five minutes of software rendering, so they are done only with SPANDREL_LONG=1;
otherwise the first four."""

import json
import os

import pytest

import spandrel
from lesson_pilot import LessonPilot, do_the_first_steps, do_the_other_steps
from stick_client import Client
from test_flow import AGAIN_S, BLUE, LIMIT_S, Training, acknowledge, count, folders, is_page
from test_flow import screen  # noqa: F401 (fixture)

# Whether to do the whole lesson.
WHOLE = os.environ.get("SPANDREL_LONG") == "1"
# Simulated seconds per second. The test waits for the vehicle's time, so a faster flight only has coarser steps.
SPEED = "2"
# X names of the keys for the sticks and actions.
STICK_KEYS = {"forward": "Up", "back": "Down", "right": "Right", "left": "Left", "up": "w", "down": "s", "clockwise": "d", "counterclockwise": "a"}
ACTION_KEYS = {
    "arm": "1", "disarm": "0", "take_off": "t", "land": "l", "lamp": "b", "snapshot": "p", "gimbal_up": "Prior", "gimbal_down": "Next",
}
# Color of the ground in the side profile (crates/view/src/hud/mod.rs), and a number of pixels that only the large map has at the right.
EARTH, EARTH_PX = (112, 84, 56), 2000


class Keyboard:
    """The keys of a window on a display."""

    def __init__(self, screen):
        self.screen, self.held = screen, set()

    def hold(self, directions):
        """Holds the keys for these directions and releases the others."""
        for direction in self.held - directions:
            self.screen.key(STICK_KEYS[direction], False)
        for direction in directions - self.held:
            self.screen.key(STICK_KEYS[direction], True)
        self.held = set(directions)

    def tap(self, action):
        """Presses the key for an action."""
        self.screen.tap(ACTION_KEYS[action])


def open_and_close_the_large_map(training):
    """Shows the large map and hides it again."""
    earth = lambda photograph: count(photograph[:, photograph.shape[1] // 2 :], EARTH)  # noqa: E731
    assert earth(training.screen.photograph()) < EARTH_PX
    training.wait_for_screenshot("lesson-large-map", lambda photograph: earth(photograph) > EARTH_PX, "c")
    training.wait_for_screenshot("lesson-map-closed", lambda photograph: earth(photograph) < EARTH_PX, "c")


@pytest.mark.timeout(2400)
def test_wire_the_lesson_is_done_with_the_keyboard(screen, tmp_path):  # noqa: F811
    """Mistakes are remarked, and the end page says that the lesson is done. The large map opens and closes."""
    gcs_port = spandrel.free_udp_port()
    training = Training(screen, tmp_path, "--trainee", "nina", "--scenario", "first-flight", "--seed", "7", "--speed", SPEED, "--no-sound", "--gcs", f"127.0.0.1:{gcs_port}")
    look = lambda name: training.wait_for_screenshot(name, lambda photograph: True)  # noqa: E731
    try:
        acknowledge(training, "lesson")
        pilot = LessonPilot(Keyboard(screen), Client(gcs_port, scenario="first-flight"), AGAIN_S)
        screen.focus()
        do_the_first_steps(pilot, mistake_seen=lambda: look("lesson-remark"))
        open_and_close_the_large_map(training)
        if WHOLE:
            do_the_other_steps(pilot, defect_seen=lambda: look("lesson-defect"))
            over = training.wait_for_screenshot("lesson-over", is_page)
            assert count(over, BLUE) == 0, "the scores of a lesson don't matter, so the page shows none"
            spandrel.wait_for("the assessment", lambda: (folders(training)[0] / "assessment.json").exists(), LIMIT_S)
    finally:
        training.close()
    lines = (folders(training)[0] / "events.jsonl").read_text(encoding="utf-8").splitlines()
    steps = [event["done"] for event in map(json.loads, lines) if event.get("event") == "lesson_step"]
    assert steps == list(range(1, 12 if WHOLE else 5)), steps
