"""`spandrel train` in its window: selection, controller check, tutorial, flight, pause, restart, and end with scores,
all with the keyboard."""

import json
import os
import signal
import subprocess

import numpy
import pytest
from PIL import Image

import asking
import display
import spandrel
from speakers import RATE_HZ, Speakers

# Colors of pages (crates/view/src/hud/mod.rs): background, focused row, score bar.
NIGHT, FOCUS, BLUE = (20, 24, 30), (20, 92, 140), (86, 180, 233)
# Color of the status in the HUD while the flight is frozen.
ORANGE = (240, 150, 20)
# Color of the battery in the HUD, which shows that a flight is being rendered.
GREEN = (0, 190, 130)
# Time limit for a software driver on a busy machine to compile its shaders and render, or for a session to be written,
# wall seconds (ten times the usual).
LIMIT_S = 400
# Wall seconds before a key without an effect is pressed again.
AGAIN_S = 20.0
# X names of the keys that navigate the rows of a window.
ENTER, DOWN, UP, LEFT, RIGHT, ESCAPE = "Return", "Down", "Up", "Left", "Right", "Escape"


# Message of `train` to a window that is started alone.
OFFERS = {
    "is": "offers", "trainees": [], "web": None, "scenarios": [{"name": "drill-hover", "title": "Drill", "kind": "1 task"}],
    "choice": {"trainee": "nina", "scenario": "drill-hover", "purpose": "practice"},
}


@pytest.fixture
def screen(tmp_path):
    """A virtual display that is large enough for legible text."""
    opened = display.Display(tmp_path, width=1280, height=560)
    yield opened
    opened.close()


@pytest.fixture
def speakers(tmp_path):
    """A sound server that records what is played."""
    opened = Speakers(tmp_path)
    yield opened
    opened.close()


class Training:
    """`train` with its window on a display, using free ports."""

    def __init__(self, screen, folder, *args, speakers=None):
        self.screen, self.folder = screen, folder
        # Without speakers, the sound has no device to play on.
        self.sound = speakers.environment() if speakers else {"PULSE_SERVER": "unix:/nonexistent"}
        self.sessions = folder / "sessions"
        self.out = open(folder / "train.txt", "w", encoding="utf-8")
        # Folder for screenshots, for inspection after the test.
        self.album = os.environ.get("SPANDREL_ALBUM")
        self.process = subprocess.Popen(
            [spandrel.COCKPIT, "train", "--ports", "ephemeral", "--sessions", str(self.sessions), "--web", "none", *args],
            stdin=subprocess.DEVNULL, stdout=self.out, stderr=self.out, env=screen.environment() | self.environment(),
        )

    def environment(self):
        """Returns the speakers, and an empty user configuration."""
        return self.sound | {"XDG_CONFIG_HOME": str(self.folder / "config")}

    def output(self):
        """Returns the output so far."""
        return (self.folder / "train.txt").read_text(encoding="utf-8")

    def save_screenshot(self, name, photograph):
        """Stores a screenshot in the album folder, if there is one."""
        if self.album:
            Image.fromarray(photograph.astype(numpy.uint8)).save(os.path.join(self.album, f"{name}.png"))

    def wait_for_screenshot(self, name, predicate, key=None):
        """Waits until a screenshot meets a condition. Presses a key first, and again if nothing happens, because the
        window may not have the focus at the first press."""
        pressed = spandrel.time.monotonic() - AGAIN_S if key else None

        def look():
            nonlocal pressed
            assert self.process.poll() is None, self.output()
            photograph = self.screen.photograph()
            if predicate(photograph):
                return [photograph]
            if pressed is not None and spandrel.time.monotonic() - pressed >= AGAIN_S:
                pressed = spandrel.time.monotonic()
                self.screen.focus()
                self.screen.tap(key)
            return []

        (photograph,) = spandrel.wait_for(name, look, LIMIT_S, pause_s=spandrel.LOOK_PAUSE_S)
        self.save_screenshot(name, photograph)
        return photograph

    def close(self):
        """Ends the process."""
        spandrel.end(self.process)
        self.out.close()


def count(photograph, color):
    """Returns the number of pixels with a color."""
    return len(display.pixels_of(photograph, color))


def is_page(photograph):
    """Returns whether a page covers the window."""
    return count(photograph[:6], NIGHT) > 0.9 * photograph[:6].shape[0] * photograph.shape[1] and count(photograph, FOCUS) > 500


def is_start_page(photograph):
    """Returns whether the start page is shown with the picture of the job, which appears later. Without a picture, only the page's
    background is there."""
    height, width = photograph.shape[:2]
    picture = photograph[int(0.56 * height) : int(0.63 * height), int(0.615 * width) : int(0.69 * width)]
    return is_page(photograph) and count(picture, NIGHT) == 0


def focus(photograph):
    """Returns the center of the focused row as fractions of the width and height."""
    rows, columns = display.pixels_of(photograph, FOCUS).T
    return columns.mean() / photograph.shape[1], rows.mean() / photograph.shape[0]


def other_page(before):
    """Returns a predicate for a page that differs from `before` in more than the focus."""
    return lambda photograph: is_page(photograph) and numpy.abs(photograph - before).mean() > 3.0


def in_flight(photograph):
    """Returns whether the views are rendered with the HUD."""
    return count(photograph, GREEN) > 50 and count(photograph, FOCUS) < 200


def acknowledge(training, name):
    """Confirms the site check of the briefing with which a flight from the command line begins, and waits for the flight."""
    training.wait_for_screenshot(f"{name}-briefing", is_page)
    assert not folders(training), "the flight must wait for the site check"
    return training.wait_for_screenshot(name, in_flight, ENTER)


def was_site_check_acknowledged(session):
    """Returns whether the session records a site check before its start."""
    return 0 < session.get("site_check_unix_us", 0) <= session["started_unix_us"]


def paused(photograph):
    """Returns whether a page is displayed over the flight."""
    return count(photograph, FOCUS) > 500 and count(photograph, GREEN) > 50


def folders(training):
    """Returns the session folders so far, excluding the camera view's file, which is in the same folder while a window
    is open, and the hidden folder with the ghost's flight."""
    entries = training.sessions.iterdir() if training.sessions.is_dir() else []
    return sorted(folder for folder in entries if folder.is_dir() and not folder.name.startswith("."))


@pytest.mark.timeout(2400)
def test_wire_keyboard_controls_a_complete_session(screen, speakers, tmp_path):
    """Start page, controller check, tutorial, briefing, flight, pause, restart, end; takes a screenshot of every page."""
    training = Training(screen, tmp_path, "--trainee", "nina", "--scenario", "drill-hover", "--choose", "--seed", "7", speakers=speakers)
    try:
        start = training.wait_for_screenshot("start", is_start_page)
        # Moves the focus down past the recommendation, the job, the aircraft and the purpose to "Next", which opens the controller check.
        moved = training.wait_for_screenshot("focus-moves", lambda photograph: is_page(photograph) and focus(photograph)[1] > focus(start)[1] + 0.03, DOWN)
        assert focus(moved)[1] < 0.5
        for _ in range(4):
            screen.tap(DOWN)
        controls = training.wait_for_screenshot("controls", other_page(moved), ENTER)
        screen.key("w", True)
        training.wait_for_screenshot("stick-follows-the-key", lambda photograph: is_page(photograph) and numpy.abs(photograph - controls).sum() > 20_000)
        screen.key("w", False)
        page = training.wait_for_screenshot("tutorial-1", other_page(controls), ENTER)
        for number in range(2, 7):
            page = training.wait_for_screenshot(f"tutorial-{number}", other_page(page), ENTER)
        page = training.wait_for_screenshot("briefing", other_page(page), ENTER)
        training.wait_for_screenshot("flight", in_flight, ENTER)
        training.wait_for_screenshot("paused", paused, ESCAPE)
        spandrel.wait_for("the simulation is paused", lambda: "simulation paused" in training.output(), LIMIT_S)
        training.wait_for_screenshot("flies-on", in_flight, ESCAPE)
        assert len(folders(training)) == 1

        # Restart: after a confirmation, there is a second session.
        training.wait_for_screenshot("asked-once-more", paused, "BackSpace")
        screen.tap(ENTER)
        spandrel.wait_for("a second session", lambda: len(folders(training)) == 2, LIMIT_S)
        training.wait_for_screenshot("second-flight", in_flight)
        screen.focus()
        # Flies for a short time: arming and takeoff are repeated until they succeed, because the filter must settle
        # first.
        again = asking.Repeater(lambda: (screen.tap("1"), screen.tap("t")))
        photograph = asking.Repeater(lambda: screen.tap("p"))

        def flies():
            again.if_due()
            return "lift-off" in training.output().split("the attempt has ended; the recorded data")[-1]

        spandrel.wait_for("lift-off", flies, LIMIT_S)

        def taken():
            photograph.if_due()
            return '"event":"snapshot"' in (folders(training)[-1] / "events.jsonl").read_text(encoding="utf-8")

        spandrel.wait_for("a photograph", taken, LIMIT_S)
        # The second of the takeoff alone does not suffice: the blade frequency still rises in it.
        spandrel.wait_for("the sound of the propellers", lambda: propellers_share(speakers.recording) > MIN_HARMONIC_SHARE, LIMIT_S)
        training.wait_for_screenshot("paused-again", paused, ESCAPE)
        screen.tap(UP)
        over = training.wait_for_screenshot("over", lambda photograph: is_page(photograph) and count(photograph, BLUE) > 200, ENTER)
        assert focus(over)[0] > 0.5, "the next steps must be on the right"
        screen.tap(UP)
        screen.tap(ENTER)
        # The program ends after the photos have been rendered.
        assert training.process.wait(timeout=LIMIT_S) == 0, training.output()
    finally:
        training.close()
    sessions = [json.loads((folder / "session.json").read_text(encoding="utf-8")) for folder in folders(training)]
    assert [session["purpose"] for session in sessions] == ["practice"] * 2 and {session["trainee"] for session in sessions} == {"nina"}
    assert all(was_site_check_acknowledged(session) for session in sessions), sessions
    drawn = sorted((folders(training)[1] / "snapshots").glob("*.jpg"))
    assert drawn and all(Image.open(path).size[0] > 600 for path in drawn)
    assert "data:image/jpeg;base64," in (folders(training)[1] / "report.html").read_text(encoding="utf-8")


def propellers_share(recording):
    """Returns the share of the power at the harmonics of a blade frequency, in the last complete second of the audio output. The fundamental alone isn't a
    criterion, because two rotors in opposite phase cancel it, but not their second harmonic."""
    data = recording.read_bytes()
    samples = numpy.frombuffer(data[: len(data) // 2 * 2], dtype="<i2").astype(float)[-RATE_HZ:]
    power = numpy.abs(numpy.fft.rfft(samples * numpy.hanning(len(samples)))) ** 2
    if len(samples) < RATE_HZ or not power.any():
        return 0.0
    # A Phantom's rotors have two blades and turn at about 60 to 150 revolutions per second.
    return max(power_at_harmonics(power, hz) for hz in range(120, 301)) / power.sum()


# Share of the power within the bands around three harmonics. White noise has 5 % there.
MIN_HARMONIC_SHARE = 0.6


def power_at_harmonics(power, hz):
    """Returns the power around the first three harmonics of a frequency. The bands, 6 % wide, leave room for rotors at different speeds."""
    return sum(power[int(0.97 * k * hz) : int(1.03 * k * hz) + 1].sum() for k in (1, 2, 3))


@pytest.mark.timeout(1200)
def test_wire_assessment_can_be_ended_but_not_paused_or_restarted(screen, tmp_path):
    """The pause key asks whether to end the session while the flight continues."""
    training = Training(screen, tmp_path, "--trainee", "otto", "--scenario", "drill-hover", "--purpose", "assessment", "--no-sound")
    try:
        acknowledge(training, "assessment")
        screen.focus()
        again = asking.Repeater(lambda: screen.tap("BackSpace"), again_s=AGAIN_S)

        def refused():
            again.if_due()
            return "cannot be restarted" in training.output()

        spandrel.wait_for("'cannot be restarted'", refused, LIMIT_S)
        training.wait_for_screenshot("assessment-asked", paused, ESCAPE)
        training.wait_for_screenshot("assessment-goes-on", in_flight, ESCAPE)
        assert "simulation paused" not in training.output() and len(folders(training)) == 1
        training.wait_for_screenshot("assessment-asked-again", paused, ESCAPE)
        screen.tap(DOWN)
        training.wait_for_screenshot("assessment-over", is_page, ENTER)
        assert "so there is no session to score" in training.output(), "the output must explain that there was no takeoff"
    finally:
        training.close()
    (folder,) = folders(training)
    assert was_site_check_acknowledged(json.loads((folder / "session.json").read_text(encoding="utf-8")))


@pytest.mark.timeout(1200)
def test_wire_an_expert_flies_while_the_trainee_watches(screen, tmp_path):
    """The expert starts once the window shows the flight, lands, and leaves the trainee's own choice selected."""
    training = Training(screen, tmp_path, "--trainee", "nina", "--scenario", "drill-hover", "--choose", "--seed", "7", "--no-sound", "--speed", "4")
    try:
        start = training.wait_for_screenshot("start", is_start_page)
        moved = training.wait_for_screenshot("focus-moves", lambda photograph: is_page(photograph) and focus(photograph)[1] > focus(start)[1] + 0.03, DOWN)
        # Below the recommendation: job, aircraft, purpose, controller check, expert. Another aircraft is chosen on the way.
        for key in (DOWN, DOWN, RIGHT, DOWN, DOWN, DOWN):
            screen.tap(key)
        spandrel.wait_for("the focus on the expert", lambda: focus(screen.photograph())[1] > focus(moved)[1] + 0.2, LIMIT_S, pause_s=spandrel.LOOK_PAUSE_S)
        training.wait_for_screenshot("expert-flies", in_flight, ENTER)
        training.wait_for_screenshot("expert-over", lambda photograph: is_page(photograph) and count(photograph, BLUE) > 200)
        (session,) = folders(training)
        told = json.loads((session / "session.json").read_text(encoding="utf-8"))
        assert (told["trainee"], told["purpose"]) == ("synthetic-expert", "practice"), told
        assert told["vehicle"] == "elios3", told
        assert "site_check_unix_us" not in told, "nobody has acknowledged a site check"
        ended = json.loads((session / "assessment.json").read_text(encoding="utf-8"))
        assert ended["end"]["reason"] == "landed" and ended["tasks"][0]["attempted"], ended["end"]
        # The first row flies the job oneself.
        training.wait_for_screenshot("own-flight", in_flight_or_briefing, ENTER)
    finally:
        training.close()


@pytest.mark.timeout(1800)
def test_wire_practice_freezes_rewinds_and_shows_a_ghost(screen, tmp_path):
    """The keys for freeze, rewind and ghost: the window shows the freeze and the ghost, and the session records the aids."""
    training = Training(screen, tmp_path, "--trainee", "nina", "--scenario", "drill-hover", "--seed", "7", "--no-sound")

    def press_until(what, key, done):
        again = asking.Repeater(lambda: screen.tap(key), again_s=AGAIN_S)

        def step():
            again.if_due()
            return done()

        spandrel.wait_for(what, step, LIMIT_S)

    def events(kind):
        lines = (folders(training)[-1] / "events.jsonl").read_text(encoding="utf-8").splitlines()
        return [event["count"] for event in map(json.loads, lines) if event["event"] == kind]

    try:
        acknowledge(training, "practice")
        screen.focus()
        press_until("rewind is refused on the ground", "z", lambda: "Rejected: not flown yet" in training.output())
        fly = asking.Repeater(lambda: (screen.tap("1"), screen.tap("t")))
        spandrel.wait_for("lift-off", lambda: fly.if_due() or "lift-off" in training.output(), LIMIT_S)
        # An expert flies the drill in the background, once.
        press_until("the ghost is shown", "g", lambda: "Ghost: the expert's flight." in training.output())
        training.wait_for_screenshot("ghost", lambda photograph: len(ghost_pixels(photograph)) > 20)
        press_until("frozen", "x", lambda: events("freeze") == [1])
        frozen = training.wait_for_screenshot("frozen", lambda photograph: count(photograph, ORANGE) > 20)
        assert in_flight(frozen), "the pictures must stay visible"
        screen.tap("x")
        training.wait_for_screenshot("continued", lambda photograph: count(photograph, ORANGE) == 0)
        press_until("rewound", "z", lambda: events("rewind"))
        training.wait_for_screenshot("rewound", lambda photograph: count(photograph, ORANGE) > 20)
        # A stick continues the flight.
        screen.key("w", True)
        training.wait_for_screenshot("flies-on-after-rewind", lambda photograph: count(photograph, ORANGE) == 0)
        screen.key("w", False)
        training.wait_for_screenshot("practice-paused", paused, ESCAPE)
        screen.tap(UP)
        training.wait_for_screenshot("practice-over", lambda photograph: is_page(photograph) and count(photograph, BLUE) > 200, ENTER)
    finally:
        training.close()
    (session,) = folders(training)
    assessment = json.loads((session / "assessment.json").read_text(encoding="utf-8"))
    assert assessment["practice_aids"]["freezes"] == 1 and assessment["practice_aids"]["rewinds"] >= 1, assessment["practice_aids"]
    assert "so it was practice" in assessment["certification"]["unmet"][0]
    assert [path.suffix for path in (training.sessions / ".ghosts").iterdir()] == [".tlog"]


def ghost_pixels(photograph):
    """Returns the pixels with the ghost's hue, which blends with the background."""
    red, green, blue = (photograph[:, :, k] for k in range(3))
    return numpy.argwhere((red - green > 45) & (blue - green > 20) & (red > blue))


def in_flight_or_briefing(photograph):
    """Returns whether the briefing of the trainee's own flight or the flight is displayed."""
    return is_page(photograph) and count(photograph, BLUE) == 0 or in_flight(photograph)


def window_of(training):
    """Returns the process of the window that `train` has started."""
    with open(f"/proc/{training.process.pid}/task/{training.process.pid}/children", encoding="utf-8") as listed:
        children = [int(pid) for pid in listed.read().split()]
    for pid in children:
        with open(f"/proc/{pid}/cmdline", "rb") as words:
            if b"--led" in words.read().split(b"\0"):
                return pid
    return None


@pytest.mark.timeout(900)
def test_wire_flight_survives_its_window(screen, tmp_path):
    """A killed window is reported once; the simulator and the monitor continue."""
    training = Training(screen, tmp_path, "--scenario", "drill-hover", "--no-sound")
    try:
        acknowledge(training, "flight-before-the-window-is-killed")
        spandrel.wait_for("the controller connection", lambda: "has connected" in training.output(), LIMIT_S)
        os.kill(spandrel.wait_for("a window", lambda: window_of(training), LIMIT_S), signal.SIGKILL)
        spandrel.wait_for("the message about the lost window", lambda: "the session continues without it" in training.output(), LIMIT_S)
        assert training.process.poll() is None and training.output().count("the window failed") == 1
    finally:
        training.close()


@pytest.mark.timeout(900)
def test_wire_invalid_lines_are_reported_once_without_closing_the_window(screen, tmp_path):
    """Invalid lines have no effect; the end of the pipe closes the window."""
    log = open(tmp_path / "view.txt", "w", encoding="utf-8")
    window = subprocess.Popen(
        [spandrel.COCKPIT, "view", "--led", "--leash", "--no-sound"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=log,
        env=screen.environment() | {"XDG_CONFIG_HOME": str(tmp_path)},
    )
    try:
        assert json.loads(window.stdout.readline()) == {"is": "ready"}
        window.stdin.write(b"rubbish\n\xff\xfe\n{}\n" + json.dumps(OFFERS).encode() + b"\n")
        window.stdin.flush()
        spandrel.wait_for("the start page", lambda: is_page(screen.photograph()), LIMIT_S, pause_s=spandrel.LOOK_PAUSE_S)
        window.stdin.close()
        assert window.wait(timeout=LIMIT_S) == 0
    finally:
        spandrel.end(window)
        log.close()
    output = (tmp_path / "view.txt").read_text(encoding="utf-8")
    assert output.count("is not a valid message between `spandrel train` and its window") == 1 and "rubbish" in output, output
