"""A virtual display that takes screenshots and sends key presses."""

import os
import pathlib
import subprocess

import numpy
from Xlib import X, XK
from Xlib import display as xdisplay
from Xlib.ext import xtest

# Driver manifests of the software driver, for any processor.
DRIVERS = sorted(pathlib.Path("/usr/share/vulkan/icd.d").glob("lvp_icd*.json"))


class Display:
    """An X server without a screen for one test."""

    def __init__(self, folder, width=1280, height=360):
        self.size = (width, height)
        self.log = open(pathlib.Path(folder) / "xvfb.txt", "w", encoding="utf-8")
        reader, writer = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writer), "-screen", "0", f"{width}x{height}x24", "-nolisten", "tcp"],
            pass_fds=(writer,), stdout=self.log, stderr=self.log, stdin=subprocess.DEVNULL,
        )
        os.close(writer)
        with os.fdopen(reader) as said:
            number = said.readline().strip()
        assert number, "Xvfb did not start"
        self.name = f":{number}"
        self.connection = xdisplay.Display(self.name)
        self.root = self.connection.screen().root

    def environment(self):
        """Returns the environment for a program that draws on this display with Mesa's software driver."""
        assert DRIVERS, "Mesa's software Vulkan is missing: apt-get install mesa-vulkan-drivers"
        kept = {key: value for key, value in os.environ.items() if key not in ("WAYLAND_DISPLAY", "WAYLAND_SOCKET")}
        return kept | {"DISPLAY": self.name, "VK_DRIVER_FILES": str(DRIVERS[0])}

    def photograph(self):
        """Returns a screenshot as rows of RGB pixels."""
        width, height = self.size
        image = self.root.get_image(0, 0, width, height, X.ZPixmap, 0xFFFFFFFF)
        pixels = numpy.frombuffer(image.data, dtype=numpy.uint8).reshape(height, width, 4)
        # Differences of two photographs fit, and large arrays would take time that the window needs.
        return pixels[:, :, 2::-1].astype(numpy.int16)

    def windows(self):
        """Returns the visible windows."""
        return [w for w in self.root.query_tree().children if w.get_attributes().map_state == X.IsViewable]

    def focus(self):
        """Gives the keyboard focus to the only window, because there is no window manager."""
        windows = self.windows()
        assert windows, "no window is open"
        windows[-1].set_input_focus(X.RevertToParent, X.CurrentTime)
        self.connection.sync()

    def key(self, name, pressed):
        """Presses or releases a key, given by its X name."""
        code = self.connection.keysym_to_keycode(XK.string_to_keysym(name))
        xtest.fake_input(self.connection, X.KeyPress if pressed else X.KeyRelease, code)
        self.connection.sync()

    def tap(self, name):
        """Presses and releases a key."""
        self.key(name, True)
        self.key(name, False)

    def close(self):
        """Ends the server."""
        self.connection.close()
        self.server.terminate()
        self.server.wait()
        self.log.close()


def pixels_of(photograph, color, tolerance=3):
    """Returns the rows and columns of the pixels with a color."""
    near = numpy.ones(photograph.shape[:2], dtype=bool)
    for channel, value in enumerate(color):
        near &= numpy.abs(photograph[:, :, channel] - value) <= tolerance
    return numpy.argwhere(near)
