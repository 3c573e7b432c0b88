"""Measures the window on a virtual display with software Vulkan: the frame rate of the whole window during a flight, and the time
from a key press until the picture changes. Prints the numbers for docs/src/measured/cost.md.

usage: SPANDREL_COCKPIT=PROGRAM tests/clients/window_speed.py

PROGRAM must be a release build with the view. Nothing else should run on the machine.
"""

import pathlib
import re
import signal
import statistics
import subprocess
import sys
import tempfile
import time

import numpy

import asking
import display
import spandrel

SIZE = (1280, 720)
# Required frame rate of the whole window, frames/s.
TARGET_HZ = 15.0
# Duration of the measured flight, wall s, after the scene is loaded.
FLIGHT_S = 60.0
# Number of key presses of each kind.
PRESSES = 15
# Time limit for a picture to change, s.
LIMIT_S = 5.0
# Side of the square that is watched, px.
SQUARE_PX = 96
# A change is visible if the mean difference of the pixel values exceeds that of two pictures without a key press by this factor.
VISIBLE_FACTOR = 3.0
# Smallest change that counts, of 255.
VISIBLE_CHANGE = 4.0


def middle(screen):
    """Returns the pixels of a square right of the window's center, which the camera view covers."""
    x, y = int(0.6 * SIZE[0]) - SQUARE_PX // 2, SIZE[1] // 2 - SQUARE_PX // 2
    image = screen.root.get_image(x, y, SQUARE_PX, SQUARE_PX, display.X.ZPixmap, 0xFFFFFFFF)
    return numpy.frombuffer(image.data, dtype=numpy.uint8).reshape(SQUARE_PX, SQUARE_PX, 4)[:, :, :3].astype(int)


def difference(one, other):
    return numpy.abs(one - other).mean()


def time_to_change(screen, press):
    """Presses a key and returns the time until the picture changes, s."""
    first = middle(screen)
    quiet = 0.0
    for _ in range(10):
        time.sleep(0.05)
        quiet = max(quiet, difference(middle(screen), first))
    limit, start = max(VISIBLE_FACTOR * quiet, VISIBLE_CHANGE), time.monotonic()
    press()
    while time.monotonic() - start < LIMIT_S:
        if difference(middle(screen), first) > limit:
            return time.monotonic() - start
    sys.exit(f"the picture did not change within {LIMIT_S} s")


def start(screen, folder, *args):
    """Starts the program with the quality `low` and returns it with its output file."""
    settings = pathlib.Path(folder) / "spandrel" / "settings.toml"
    settings.parent.mkdir()
    settings.write_text('format = 1\n[display]\nquality = "low"\n', encoding="utf-8")
    out = open(pathlib.Path(folder) / "out.txt", "w", encoding="utf-8")
    command = [spandrel.COCKPIT, *args, "--sessions", f"{folder}/sessions"]
    return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=out, env=screen.environment() | {"XDG_CONFIG_HOME": folder}), out


def output(folder):
    return (pathlib.Path(folder) / "out.txt").read_text(encoding="utf-8")


def frame_rate(screen, folder):
    """Returns the frame rate while an expert flies, frames/s."""
    process, _ = start(screen, folder, "demo", "--view", "--skill", "expert", "--speed", "1", "--seed", "7")
    try:
        spandrel.wait_for("the expert's takeoff", lambda: "flight time" in output(folder), 300.0)
        time.sleep(FLIGHT_S)
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(timeout=60)
    told = re.search(r"rendered \d+ frames of both views \(([\d.]+) frames per second\)", output(folder))
    return float(told.group(1)) if told else sys.exit(output(folder))


def delays(screen, folder):
    """Returns the times for a key that changes the layout, and for a key that turns the aircraft, s."""
    process, _ = start(screen, folder, "train", "--ports", "ephemeral", "--web", "none", "--no-sound", "--scenario", "drill-hover")
    try:
        spandrel.wait_for("the window", screen.windows, 300.0)
        # The briefing comes first; Enter confirms its site check.
        confirm = asking.Repeater(lambda: (screen.focus(), screen.tap("Return")))
        spandrel.wait_for("the flight", lambda: confirm.if_due() or "Take off, fly the tasks" in output(folder), 300.0)
        spandrel.wait_for("the controller", lambda: "has connected" in output(folder), 300.0)
        time.sleep(10.0)
        screen.focus()
        layout = [time_to_change(screen, lambda: screen.tap("Tab")) for _ in range(PRESSES)]
        for key in ("1", "t"):
            screen.tap(key)
            time.sleep(8.0)
        turn = []
        for k in range(PRESSES):
            key = "ad"[k % 2]
            turn.append(time_to_change(screen, lambda: screen.key(key, True)))
            screen.key(key, False)
            time.sleep(3.0)
        return layout, turn
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(timeout=60)


def main():
    with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
        screen = display.Display(one, *SIZE)
        try:
            rate = frame_rate(screen, one)
            is_fast = rate >= TARGET_HZ
            print(f"whole window, {SIZE[0]} x {SIZE[1]}, low: {rate:.1f} frames/s (at least {TARGET_HZ:.0f}): {'ok' if is_fast else 'MISSED'}")
            for name, times in zip(("layout key", "turn key, in hover"), delays(screen, other)):
                print(f"{name} to a changed picture: median {1e3 * statistics.median(times):.0f} ms, at most {1e3 * max(times):.0f} ms")
        finally:
            screen.close()
    return 0 if is_fast else 1


if __name__ == "__main__":
    sys.exit(main())
