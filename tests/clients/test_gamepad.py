"""`spandrel rc` with a virtual Linux gamepad (uinput): calibrated with the wizard, used to fly, and unplugged in
flight."""

import os
import subprocess
import threading
import time

import pytest
from pymavlink import mavutil

import asking
import gamepad
import spandrel

# Actions in the wizard's button prompts: three get a button, the rest get none.
BUTTON_ACTIONS = (("the lamp", gamepad.SOUTH), ("a snapshot", gamepad.EAST), ("arming", gamepad.NORTH), ("takeoff", None), ("landing", None),
          ("camera up", None), ("camera down", None))
# On a gamepad, up is the lower value.
PUSHES = (("LEFT stick fully UP", gamepad.Y, -1), ("LEFT stick fully to the RIGHT", gamepad.X, 1),
          ("RIGHT stick fully UP", gamepad.RIGHT_Y, -1), ("RIGHT stick fully to the RIGHT", gamepad.RIGHT_X, 1))
# Time limit for the wizard's next prompt on a busy machine, wall seconds (ten times the usual).
LIMIT_S = 60


@pytest.fixture(name="pad")
def fixture_pad():
    """Returns a gamepad that the program can read; otherwise skips the test with the reason."""
    try:
        pad = gamepad.Gamepad()
    except gamepad.GamepadUnavailable as missing:
        pytest.skip(f"no gamepad available: {missing}")
    listed = subprocess.run([spandrel.COCKPIT, "rc", "--list"], capture_output=True, text=True, timeout=LIMIT_S, check=False)
    if "this build does not support gamepads" in listed.stderr:
        pad.close()
        pytest.skip(f"{spandrel.COCKPIT} was built without the `gamepad` feature")
    yield pad
    pad.close()


class Bridge:
    """`rc` with the gamepad. Reads the output as it arrives."""

    def __init__(self, pad, profiles, *args):
        command = [spandrel.COCKPIT, "rc", "--device", gamepad.NAME, "--profiles", str(profiles), *args]
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=os.environ | pad.environment(),
        )
        self.lines, self.read = [], 0
        threading.Thread(target=lambda: self.lines.extend(self.process.stderr), daemon=True).start()

    def receive(self, words):
        """Waits for the next line that contains these words."""
        def said():
            for k in range(self.read, len(self.lines)):
                if words in self.lines[k]:
                    self.read = k + 1
                    return True
            return False

        spandrel.wait_for(f"'{words}' after line {self.read} of {self.lines}", said, LIMIT_S)

    def enter(self):
        """Presses Enter."""
        self.process.stdin.write("\n")
        self.process.stdin.flush()


def is_listed(pad, profiles):
    """Returns the gamepad's line in the output of `rc --list`."""
    listed = subprocess.run(
        [spandrel.COCKPIT, "rc", "--list", "--profiles", str(profiles)],
        capture_output=True, text=True, timeout=LIMIT_S, check=False, env=os.environ | pad.environment(),
    )
    assert listed.returncode == 0, listed.stderr
    return next((line for line in listed.stdout.splitlines() if gamepad.NAME in line), None)


def calibrate(pad, profiles):
    """Follows the wizard like a user who touches the triggers first."""
    wizard = Bridge(pad, profiles, "--calibrate")
    try:
        wizard.receive("Release both sticks")
        wizard.enter()
        wizard.receive("Move both sticks through their full range")
        touched = (gamepad.LEFT_TRIGGER, gamepad.RIGHT_TRIGGER, *(axis for _, axis, _ in PUSHES))
        for axis in touched:
            for part in (-1, 1, -1 if gamepad.AXES[axis] == gamepad.TRIGGER else 0):
                pad.axis(axis, part)
                time.sleep(0.05)
        # The wizard has processed the events of all axes, except perhaps the one that centers the last axis. After Enter, it waits until that
        # axis is centered as well.
        wizard.receive(f"Axes found: {len(touched)} ")
        wizard.enter()
        for words, axis, part in PUSHES:
            wizard.receive(f"Push the {words}")
            pad.axis(axis, part)
            wizard.receive("Center the sticks" if (words, axis, part) != PUSHES[-1] else f"button for {BUTTON_ACTIONS[0][0]}")
            pad.axis(axis, 0)
        for (_, button), following in zip(BUTTON_ACTIONS, [*BUTTON_ACTIONS[1:], None]):
            if button is None:
                wizard.enter()
            else:
                pad.press(button)
            if following:
                wizard.receive(f"button for {following[0]}")
        kept, _ = wizard.process.stdout.read(), wizard.process.wait(timeout=LIMIT_S)
        assert wizard.process.returncode == 0, wizard.lines
        return kept.strip()
    finally:
        spandrel.end(wizard.process)


@pytest.mark.timeout(600)
def test_wire_gamepad_is_calibrated_and_its_loss_triggers_the_failsafe(pad, tmp_path):
    """Covers everything from system events to flight: the wizard's profile, sticks, buttons, and the failsafe after the
    gamepad is lost."""
    profiles = tmp_path / "profiles"
    assert spandrel.wait_for("the system lists the gamepad", lambda: is_listed(pad, profiles), LIMIT_S).endswith("not calibrated")
    kept = calibrate(pad, profiles)
    assert kept.startswith(str(profiles)) and is_listed(pad, profiles).endswith("  calibrated")
    watcher, dial = spandrel.free_udp_port(), spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, watcher, speed=1, gcs_port=dial)
    bridge = Bridge(pad, profiles, "--connect", f"127.0.0.1:{dial}")
    try:
        link = asking.connect(watcher)
        assert asking.command(link, mavutil.mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 376, 200_000) == 0
        bridge.receive("connected to the vehicle")
        arm = asking.Repeater(lambda: pad.press(gamepad.NORTH))

        def armed(beat):
            arm.if_due()
            return beat.get_srcComponent() == 1 and beat.base_mode & mavutil.mavlink.MAV_MODE_FLAG_SAFETY_ARMED

        asking.receive(link, "HEARTBEAT", armed)
        pad.axis(gamepad.Y, -1)
        asking.receive(link, "RC_CHANNELS", lambda rc: rc.chan3_raw == 2000)
        asking.receive(link, "LOCAL_POSITION_NED", lambda p: -p.z > 3)
        pad.axis(gamepad.Y, 0)
        pad.axis(gamepad.RIGHT_Y, -1)
        asking.receive(link, "LOCAL_POSITION_NED", lambda p: (p.vx**2 + p.vy**2) ** 0.5 > 1)
        pad.axis(gamepad.RIGHT_Y, 0)
        asking.receive(link, "RC_CHANNELS", lambda rc: {rc.chan1_raw, rc.chan2_raw, rc.chan3_raw, rc.chan4_raw} == {1500})
        pad.press(gamepad.SOUTH)
        asking.receive(link, "RELAY_STATUS", lambda relay: relay.on & 1)
        pad.press(gamepad.EAST)
        asking.receive(link, "CAMERA_IMAGE_CAPTURED")
        pad.close()
        bridge.receive("disconnected: stick input centered, then stopped")
        asking.receive(link, "STATUSTEXT", lambda text: "manual control lost" in text.text)
        beat = asking.receive(link, "HEARTBEAT", lambda b: b.get_srcComponent() == 1)
        assert beat.base_mode & mavutil.mavlink.MAV_MODE_FLAG_SAFETY_ARMED, "the vehicle must hold its position"
    finally:
        spandrel.end(bridge.process)
        spandrel.end(process)
    assert bridge.process.returncode == 0, bridge.lines
