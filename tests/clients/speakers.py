"""A PulseAudio server whose output is recorded instead of played."""

import os
import subprocess

import spandrel

RATE_HZ = 24_000
# Time for the server to start on a busy machine, s.
LIMIT_S = 60


class Speakers:
    """A sound server for one test. Its only device discards the samples at the speed of a real one."""

    def __init__(self, folder):
        self.socket = folder / "pulse.sock"
        self.recording = folder / "played.raw"
        self.log = open(folder / "pulseaudio.txt", "w", encoding="utf-8")
        self.home = folder / "pulse"
        self.home.mkdir()
        options = ["-n", "--daemonize=no", "--use-pid-file=no", "--exit-idle-time=-1", "--disallow-module-loading"]
        modules = ["module-null-sink sink_name=speakers", f"module-native-protocol-unix auth-anonymous=1 socket={self.socket}"]
        self.server = self.start("pulseaudio", *options, *(word for module in modules for word in ("-L", module)))
        spandrel.wait_for("PulseAudio", lambda: self.socket.exists(), LIMIT_S)
        form = ["--raw", "--format=s16le", "--channels=1", f"--rate={RATE_HZ}"]
        self.recorder = self.start("parec", *form, "-d", "speakers.monitor", str(self.recording))

    def start(self, *command):
        """Starts a program that uses this server."""
        return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self.log, stderr=self.log, env=os.environ | self.environment())

    def environment(self):
        """Returns the environment for a program that plays on this server."""
        return {"PULSE_SERVER": f"unix:{self.socket}", "PULSE_COOKIE": str(self.home / "cookie"), "PULSE_RUNTIME_PATH": str(self.home)}

    def close(self):
        """Ends the recording and the server."""
        for process in (self.recorder, self.server):
            spandrel.end(process)
        self.log.close()
