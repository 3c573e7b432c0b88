"""The settings page of the window: a key is changed, stored, and flown with; an invalid file is reported and kept."""

import json
import subprocess
import tomllib

import numpy
import pytest

import asking
import spandrel
from test_flow import AGAIN_S, DOWN, ENTER, ESCAPE, LIMIT_S, NIGHT, OFFERS, UP, Training, count, focus, in_flight, is_page, is_start_page, other_page, screen  # noqa: F401  (the fixture)

# Number of rows above "take off" in the list of keys: eight stick directions and four actions.
ROWS_ABOVE_TAKE_OFF = 12


def settings_of(training):
    """Returns the stored settings, or nothing if there are none yet."""
    path = training.folder / "config" / "spandrel" / "settings.toml"
    return tomllib.loads(path.read_text(encoding="utf-8")) if path.is_file() else None


def move_focus(training, key, rows, page=None):
    """Moves the focus by a number of rows, and returns the page with the focus there. `page` is the page before."""
    photograph = training.screen.photograph() if page is None else page
    for _ in range(rows):
        before = focus(photograph)[1]
        photograph = training.wait_for_screenshot("focus", lambda now, at=before: is_page(now) and abs(focus(now)[1] - at) > 0.02, key)
    return photograph


@pytest.mark.timeout(1800)
def test_wire_a_changed_key_is_stored_and_flies_the_drone(screen, tmp_path):  # noqa: F811
    """Changes the key for takeoff from T to Y on the settings page, and takes off with it."""
    training = Training(screen, tmp_path, "--trainee", "nina", "--scenario", "drill-hover", "--choose", "--seed", "7", "--no-sound")
    try:
        training.wait_for_screenshot("start", is_start_page)
        # The settings are above the language, the quality of the pictures and "Quit", the last rows.
        training.wait_for_screenshot("last-row", lambda photograph: is_page(photograph) and focus(photograph)[1] > 0.75, UP)
        settings = training.wait_for_screenshot("settings", other_page(move_focus(training, UP, 3)), ENTER)
        # The first row of the settings is the language.
        keys = training.wait_for_screenshot("keys", other_page(move_focus(training, DOWN, 1, settings)), ENTER)
        for _ in range(ROWS_ABOVE_TAKE_OFF):
            screen.tap(DOWN)
        training.wait_for_screenshot("awaits-a-key", lambda photograph: is_page(photograph) and abs(photograph - keys).mean() > 0.1, ENTER)
        screen.tap("y")
        spandrel.wait_for("the stored key", lambda: (settings_of(training) or {}).get("actions", {}).get("take_off") == "y", LIMIT_S)
        stored = settings_of(training)
        assert stored["format"] == 1 and stored["actions"]["arm"] == "1", stored
        assert stored["sound"]["on"], "--no-sound applies to this run only"
        # Back to the start page; "Next" is five rows down: recommendation, job, aircraft, purpose, next.
        page = training.wait_for_screenshot("settings-again", other_page(screen.photograph()), ESCAPE)
        page = training.wait_for_screenshot("start-again", is_start_page, ESCAPE)
        for _ in range(5):
            screen.tap(DOWN)
        page = training.wait_for_screenshot("controls", other_page(page), ENTER)
        page = training.wait_for_screenshot("tutorial", other_page(page), ENTER)
        # The last row skips the tutorial.
        screen.tap(UP)
        training.wait_for_screenshot("briefing", other_page(page), ENTER)
        training.wait_for_screenshot("flight", in_flight, ENTER)
        screen.focus()
        again = asking.Repeater(lambda: (screen.tap("1"), screen.tap("y")), again_s=AGAIN_S)

        def flies():
            again.if_due()
            return "lift-off" in training.output()

        spandrel.wait_for("lift-off with the new key", flies, LIMIT_S)
    finally:
        training.close()


@pytest.mark.timeout(600)
def test_wire_the_language_changes_the_pages_at_once(screen, tmp_path):
    """Selects German on the start page; the page changes at once, and so do the texts that `train` sends."""
    training = Training(screen, tmp_path, "--trainee", "nina", "--scenario", "drill-hover", "--choose", "--no-sound")
    try:
        training.wait_for_screenshot("start", is_start_page)
        training.wait_for_screenshot("last-row", lambda photograph: is_page(photograph) and focus(photograph)[1] > 0.75, UP)
        english = move_focus(training, UP, 2)
        german = training.wait_for_screenshot("german", lambda photograph: is_page(photograph) and numpy.abs(photograph - english).mean() > 2.0, "Right")
        spandrel.wait_for("the stored language", lambda: (settings_of(training) or {}).get("display", {}).get("language") == "de", LIMIT_S)
        # The names of the jobs, which `train` sends, follow.
        training.wait_for_screenshot("german-jobs", lambda photograph: is_page(photograph) and numpy.abs(photograph - german).mean() > 0.05)
    finally:
        training.close()


@pytest.mark.timeout(900)
def test_wire_an_invalid_settings_file_is_reported_and_kept(screen, tmp_path):  # noqa: F811
    """The window opens with the defaults, and the file stays as it is."""
    path = tmp_path / "spandrel" / "settings.toml"
    path.parent.mkdir()
    text = 'format = 1\n[display]\ntext_scale_pct = 130\n'
    path.write_text(text, encoding="utf-8")
    log = open(tmp_path / "view.txt", "w", encoding="utf-8")
    window = subprocess.Popen(
        [spandrel.COCKPIT, "view", "--led", "--leash"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=log,
        env=screen.environment() | {"XDG_CONFIG_HOME": str(tmp_path)},
    )
    try:
        assert json.loads(window.stdout.readline()) == {"is": "ready"}
        window.stdin.write(json.dumps(OFFERS).encode() + b"\n")
        window.stdin.flush()
        # A message covers the lower edge of the page.
        spandrel.wait_for("the start page", lambda: count(screen.photograph()[:200], NIGHT) > 100_000, LIMIT_S, pause_s=spandrel.LOOK_PAUSE_S)
        window.stdin.close()
        assert window.wait(timeout=LIMIT_S) == 0
    finally:
        spandrel.end(window)
        log.close()
    output = (tmp_path / "view.txt").read_text(encoding="utf-8")
    assert f"{path}:3: display.text_scale_pct = 130: unknown size (allowed: 100, 125, 150, 200)" in output, output
    assert path.read_text(encoding="utf-8") == text
