"""A PostgreSQL server for one test, on a socket in its own folder. It runs as an unprivileged user, because PostgreSQL
refuses to run as root."""

import os
import pathlib
import shutil
import subprocess
import tempfile

import spandrel

# User ID of Debian's `nobody`.
NOBODY = 65534


def programs():
    """Returns the folder of PostgreSQL's programs, from Debian's location or the PATH."""
    found = sorted(path.parent for path in pathlib.Path("/usr/lib/postgresql").glob("*/bin/initdb"))
    on_path = shutil.which("initdb")
    assert found or on_path, "no PostgreSQL: apt-get install postgresql"
    return found[-1] if found else pathlib.Path(on_path).parent


class Postgres:
    """A server that starts on creation; `stop` and `start` simulate a restart of its machine."""

    def __init__(self):
        # Not a folder of pytest: the server's user could not enter it, because every run of pytest closes the parent folder to other users.
        self.home = pathlib.Path(tempfile.mkdtemp(prefix="postgres-"))
        self.data = self.home / "data"
        self.user = {"user": NOBODY, "group": NOBODY, "extra_groups": []} if os.geteuid() == 0 else {}
        if self.user:
            os.chown(self.home, NOBODY, NOBODY)
        self.process = None
        self._run("initdb", "-D", self.data, "-U", "spandrel", "-A", "trust", "-E", "UTF8", "--no-locale", "--no-sync")
        self.start()

    def _run(self, name, *arguments):
        done = subprocess.run(
            [programs() / name, *arguments], cwd=self.home, capture_output=True, text=True, timeout=spandrel.FLIGHT_LIMIT_S, check=False,
            **self.user,
        )
        assert done.returncode == 0, done.stderr

    def start(self):
        """Starts the server and waits until it responds."""
        with open(self.home / "server.txt", "ab") as log:
            self.process = subprocess.Popen(
                [programs() / "postgres", "-D", self.data, "-k", self.home, "-c", "listen_addresses=", "-c", "fsync=off"],
                cwd=self.home, stdin=subprocess.DEVNULL, stdout=log, stderr=log, **self.user,
            )
        ready = lambda: subprocess.run([programs() / "pg_isready", "-q", "-h", self.home, "-t", "1"], check=False).returncode == 0
        spandrel.wait_for("PostgreSQL", ready)

    def stop(self):
        """Stops the server with all its connections."""
        self._run("pg_ctl", "stop", "-D", self.data, "-m", "fast", "-s")
        self.process.wait()

    def remove(self):
        """Stops the server and deletes its data."""
        self.stop()
        shutil.rmtree(self.home)

    @property
    def url(self):
        """Returns the URL of the server's socket."""
        return f"postgres://spandrel@localhost/postgres?host={self.home}"
