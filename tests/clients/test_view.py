"""`spandrel view`: the window on a virtual display, with screenshots and flight keys, and messages if something is
missing."""

import json
import os
import signal
import subprocess

import numpy
import pytest

import asking
import display
import spandrel

# Colors of the HUD (crates/view/src/hud/mod.rs).
GREEN, YELLOW, WHITE = (0, 190, 130), (240, 228, 66), (245, 245, 245)
# Time limit for a software driver on a busy machine to compile its shaders and render, wall seconds (ten times the
# usual).
DRAW_LIMIT_S = 400
# Wall seconds before a key without an effect is pressed again; a frame takes at most one second.
PRESS_AGAIN_S = 20.0


@pytest.fixture
def screen(tmp_path):
    """A virtual display; half of it has the aspect ratio of the camera's sensor."""
    opened = display.Display(tmp_path, width=1280, height=480)
    yield opened
    opened.close()


def open_view(screen, tmp_path, *args, environment=None):
    """Opens a window that covers the display and waits until it has rendered both views."""
    log = open(tmp_path / "view.txt", "w", encoding="utf-8")
    size = f"{screen.size[0]}x{screen.size[1]}"
    process = subprocess.Popen(
        [spandrel.COCKPIT, "view", "--scenario", "drill-hover", "--seed", "7", "--size", size, "--announce", *args],
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=log, text=True, env=screen.environment() | (environment or {}),
    )
    said = process.stdout.readline()
    assert said, (tmp_path / "view.txt").read_text(encoding="utf-8")
    return process, json.loads(said)


def brightness_deviation(part):
    """Returns the standard deviation of the brightness, 0 for a blank area."""
    return part.mean(axis=2).std()


@pytest.mark.timeout(900)
def test_wire_window_shows_both_views_and_flies_with_keys(screen, tmp_path):
    """With a simulator in real time: screenshots must show two different views and the HUD; keys change the layout,
    hide the map and fly."""
    watcher, dial, payload = (spandrel.free_udp_port() for _ in range(3))
    sim = spandrel.start_sim(tmp_path, watcher, speed=1, gcs_port=dial, payload_port=payload)
    window = None
    try:
        window, told = open_view(
            screen, tmp_path, "--connect", f"127.0.0.1:{payload}", "--fly", f"127.0.0.1:{dial}",
            "--profiles", str(tmp_path),
        )
        assert told["quality"] == "low" and (told["width"], told["height"]) == screen.size, told
        (photograph,) = spandrel.wait_for("a screenshot with the HUD", lambda: screenshot_with_hud(screen), DRAW_LIMIT_S, pause_s=spandrel.LOOK_PAUSE_S)
        height, width, _ = photograph.shape
        left, right = photograph[:, : width // 2], photograph[:, width // 2 :]
        assert brightness_deviation(left) > 10 and brightness_deviation(right) > 10, "no view may be blank"
        assert numpy.abs(left - right).mean() > 10, "the views must be different"
        # Battery upper right and speed upper left, only in the camera view on the right.
        rows, columns = display.pixels_of(photograph, GREEN).T
        assert rows.max() < 0.2 * height and columns.min() > 0.8 * width, "the battery must be at the upper right"
        speed = right[: height // 6, : width // 6]
        assert len(display.pixels_of(speed, WHITE)) > 20, "the speed must be visible"
        assert len(display.pixels_of(left[: height // 6, : width // 6], WHITE)) == 0
        # The instruments are below the inspector's view: navigation, map and side profile from left to right.
        assert len(display.pixels_of(profile_of(photograph), YELLOW)) > 10, "the side profile must show the drone"
        assert os.getpriority(os.PRIO_PROCESS, window.pid) > os.getpriority(os.PRIO_PROCESS, sim.pid), "the simulator must have a higher priority"

        screen.focus()
        # The first press may come before the window has the focus, so keys without an effect are pressed again.
        again = asking.Repeater(lambda: screen.tap("m"), again_s=PRESS_AGAIN_S)

        def hidden():
            again.if_due()
            return len(display.pixels_of(profile_of(screen.photograph()), YELLOW)) == 0

        spandrel.wait_for("map and profile are hidden", hidden, DRAW_LIMIT_S, pause_s=spandrel.LOOK_PAUSE_S)
        screen.tap("Tab")
        spandrel.wait_for("the camera view is the inset", lambda: camera_view_is_inset(screen), DRAW_LIMIT_S, pause_s=spandrel.LOOK_PAUSE_S)

        link = asking.connect(watcher)
        spandrel.wait_for("the vehicle is ready to arm", lambda: is_armable(link), DRAW_LIMIT_S)
        arm = asking.Repeater(lambda: screen.tap("1"), again_s=PRESS_AGAIN_S)

        def armed():
            arm.if_due()
            beat = link.recv_match(type="HEARTBEAT", blocking=True, timeout=1)
            return beat and beat.get_srcComponent() == 1 and beat.base_mode & 128

        spandrel.wait_for("motors on", armed, DRAW_LIMIT_S)
        screen.key("w", True)
        asking.receive(link, "LOCAL_POSITION_NED", lambda p: p.z < -2.0)
        screen.key("w", False)
        asking.receive(link, "LOCAL_POSITION_NED", lambda p: abs(p.vz) < 0.2)
        window.send_signal(signal.SIGINT)
        assert window.wait(timeout=60) == 0, (tmp_path / "view.txt").read_text(encoding="utf-8")
    finally:
        for process in filter(None, (window, sim)):
            spandrel.end(process)


def screenshot_with_hud(screen):
    """Returns a screenshot if it shows the battery, otherwise None."""
    photograph = screen.photograph()
    return [photograph] if len(display.pixels_of(photograph, GREEN)) > 0 else []


def profile_of(photograph):
    """Returns the part of the window with the side profile."""
    height, width, _ = photograph.shape
    return photograph[2 * height // 3 :, 3 * width // 8 : width // 2 - 2]


def camera_view_is_inset(screen):
    """Returns whether the camera view, and with it the battery, is in the middle of the window's lower edge."""
    green = display.pixels_of(screen.photograph(), GREEN)
    if len(green) == 0:
        return False
    rows, columns = green.T
    return rows.min() > 0.65 * screen.size[1] and 0.35 * screen.size[0] < columns.min() and columns.max() < 0.65 * screen.size[0]


def is_armable(link):
    """Returns whether the vehicle's filter has settled, so that its position is known."""
    return link.recv_match(type="GLOBAL_POSITION_INT", blocking=True, timeout=1)


@pytest.mark.timeout(600)
def test_wire_missing_prerequisites_give_one_message(screen, tmp_path):
    """Without a display or Vulkan, or with an invalid key file, the program must exit with an error code and one
    message."""

    def view(environment, *args):
        return subprocess.run(
            [spandrel.COCKPIT, "view", "--scenario", "drill-hover", *args], env=environment, capture_output=True, text=True,
            timeout=DRAW_LIMIT_S, check=False, stdin=subprocess.DEVNULL,
        )

    blind = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET")}
    def said(*args):
        return subprocess.run(
            [spandrel.COCKPIT, *args], env=blind, capture_output=True, text=True, timeout=DRAW_LIMIT_S, check=False,
            stdin=subprocess.DEVNULL,
        )

    refused = view(blind)
    assert refused.returncode == 1 and refused.stderr.count("no display") == 1, refused.stderr
    # The message must suggest possible actions and must not contain source locations in libraries.
    assert "neither DISPLAY nor WAYLAND_DISPLAY is set" in refused.stderr and ".rs" not in refused.stderr, refused.stderr
    refused = view(blind | {"DISPLAY": ":4711"})
    assert refused.returncode == 1 and "DISPLAY=:4711 cannot be opened" in refused.stderr and ".rs" not in refused.stderr, refused.stderr
    refused = view(screen.environment() | {"VK_DRIVER_FILES": str(tmp_path / "none.json")})
    assert refused.returncode == 1 and "no Vulkan" in refused.stderr and "mesa-vulkan-drivers" in refused.stderr, refused.stderr
    keys = tmp_path / "keys.toml"
    keys.write_text('format = 1\n[window]\nmap = "b"\n', encoding="utf-8")
    refused = view(blind, "--keys", str(keys))
    assert refused.returncode == 2 and "already bound to lamp" in refused.stderr, refused.stderr
    for asked in (["train", "--keys", str(keys)], ["train", "--quality", "best"]):
        refused = said(*asked, "--sessions", str(tmp_path / "sessions"))
        assert refused.returncode == 2 and asked[2].split("/")[-1] in refused.stderr, refused.stderr
    assert not (tmp_path / "sessions").exists(), "no session may be started"
    keys.write_text('format = 1\n[window]\npause = "q"\n[actions]\nland = "escape"\n', encoding="utf-8")
    refused = said("rc", "--keyboard", "--keys", str(keys))
    assert refused.returncode == 2 and 'land = "escape"' in refused.stderr, refused.stderr


@pytest.mark.timeout(600)
@pytest.mark.parametrize(("asked", "title"), [(["--scenario", "drill-hover"], "Drill: hover"), ([], "using the command line: anonymous flies two-bridges")])
def test_wire_training_continues_without_a_display(tmp_path, asked, title):
    """`train` reports the missing display and the job, and still waits for the flight."""
    blind = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET")}
    log = open(tmp_path / "train.txt", "w", encoding="utf-8")
    training = subprocess.Popen(
        [spandrel.COCKPIT, "train", *asked, "--ports", "ephemeral", "--sessions", str(tmp_path / "sessions")],
        env=blind, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
    )
    try:
        told = tmp_path / "train.txt"
        spandrel.wait_for("the message that the session continues", lambda: "the session continues without it" in told.read_text(encoding="utf-8"), DRAW_LIMIT_S)
        spandrel.wait_for("the start of the flight", lambda: "Take off, fly the tasks" in told.read_text(encoding="utf-8"), DRAW_LIMIT_S)
        assert title in told.read_text(encoding="utf-8")
        assert "no display" in told.read_text(encoding="utf-8") and training.poll() is None
        assert "A window shows" not in told.read_text(encoding="utf-8"), "the output must not mention a window"
    finally:
        spandrel.end(training)
