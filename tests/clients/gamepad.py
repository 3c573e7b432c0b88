"""A virtual Linux gamepad (uinput), which programs detect like a real one."""

import fcntl
import os
import pathlib
import struct
import time

DEVICE = "/dev/uinput"
NAME, VENDOR, PRODUCT = "Spandrel test pad", 0x0483, 0x5710

# From linux/uinput.h and linux/input-event-codes.h; the ioctl numbers are those of x86, ARM and RISC-V.
CREATE, DESTROY, SETUP, ABS_SETUP, SET_EVBIT, SET_KEYBIT = 0x5501, 0x5502, 0x405C5503, 0x401C5504, 0x40045564, 0x40045565
SYSNAME_BYTES = 64
SYSNAME = 2 << 30 | SYSNAME_BYTES << 16 | 0x552C
EV_SYN, EV_KEY, EV_ABS, BUS_USB = 0, 1, 3, 3
X, Y, LEFT_TRIGGER, RIGHT_X, RIGHT_Y, RIGHT_TRIGGER = range(6)
SOUTH, EAST, NORTH, WEST = 0x130, 0x131, 0x133, 0x134
BUTTONS = (SOUTH, EAST, NORTH, WEST, 0x136, 0x137, 0x13A, 0x13B, 0x13C)
STICK, TRIGGER = (-32768, 32767), (0, 255)
AXES = {X: STICK, Y: STICK, LEFT_TRIGGER: TRIGGER, RIGHT_X: STICK, RIGHT_Y: STICK, RIGHT_TRIGGER: TRIGGER}
# Seconds for the system to create the device node and set its permissions.
NODE_LIMIT_S = 10


class GamepadUnavailable(Exception):
    """This machine cannot create virtual gamepads."""


class Gamepad:
    """Two sticks, two triggers and nine buttons, initially at rest."""

    def __init__(self):
        try:
            self.file = os.open(DEVICE, os.O_WRONLY | os.O_NONBLOCK)
        except OSError as error:
            raise GamepadUnavailable(f"{DEVICE} cannot be opened ({error.strerror}): run `modprobe uinput` and check the write permission") from error
        try:
            self._create()
            self.node = self._node()
        except OSError as error:
            os.close(self.file)
            raise GamepadUnavailable(f"{DEVICE} cannot create a gamepad: {error.strerror}") from error
        except GamepadUnavailable:
            self.close()
            raise

    def _create(self):
        for kind in (EV_KEY, EV_ABS):
            fcntl.ioctl(self.file, SET_EVBIT, kind)
        for button in BUTTONS:
            fcntl.ioctl(self.file, SET_KEYBIT, button)
        for axis, (low, high) in AXES.items():
            # Initial value, minimum, maximum, fuzz, flat, resolution.
            fcntl.ioctl(self.file, ABS_SETUP, struct.pack("H2x6i", axis, 0, low, high, 0, 0, 0))
        fcntl.ioctl(self.file, SETUP, struct.pack("HHHH80sI", BUS_USB, VENDOR, PRODUCT, 1, NAME.encode(), 0))
        fcntl.ioctl(self.file, CREATE)

    def _node(self):
        """Returns the device node once programs may open it."""
        name = fcntl.ioctl(self.file, SYSNAME, bytes(SYSNAME_BYTES)).split(b"\0")[0].decode()
        end = time.monotonic() + NODE_LIMIT_S
        while time.monotonic() < end:
            for event in pathlib.Path("/sys/devices/virtual/input", name).glob("event*"):
                node = pathlib.Path("/dev/input", event.name)
                if os.access(node, os.R_OK | os.W_OK):
                    return node
            time.sleep(0.05)
        raise GamepadUnavailable(f"the gamepad's node in /dev/input did not appear or cannot be opened ({name})")

    def environment(self):
        """Returns the environment that programs need to find the gamepad; without udev, they must search /dev/input
        themselves."""
        return {} if os.path.exists("/run/udev/control") else {"GILRS_DISABLE_UDEV": "1"}

    def _emit(self, kind, code, value):
        for event in ((kind, code, value), (EV_SYN, 0, 0)):
            os.write(self.file, struct.pack("llHHi", 0, 0, *event))

    def axis(self, axis, part):
        """Moves an axis to a fraction of its range, -1 to 1; a trigger rests at -1."""
        low, high = AXES[axis]
        self._emit(EV_ABS, axis, round((low + high) / 2 + part * (high - low) / 2))

    def press(self, button):
        """Presses and releases a button."""
        for pressed in (1, 0):
            self._emit(EV_KEY, button, pressed)
            time.sleep(0.05)

    def close(self):
        """Disconnects the gamepad; further calls have no effect."""
        if self.file is not None:
            fcntl.ioctl(self.file, DESTROY)
            os.close(self.file)
            self.file = None
