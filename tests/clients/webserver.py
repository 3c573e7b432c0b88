"""A server for one test, on an unused port and with its own folder."""

import json
import os
import pathlib
import re
import struct
import subprocess
import urllib.error
import urllib.parse
import urllib.request
import zlib

import spandrel

PASSWORD = "correct horse battery"
# Time limit for a response on a busy two-core machine, wall seconds (many times the usual time).
PATIENCE_S = 300


class Server:
    """`spandrel serve` on an unused port."""

    def __init__(self, sessions, *more, vehicle="none", program=None, env=None):
        self.sessions = sessions
        arguments = ["serve", "--sessions", str(sessions), "--listen", "127.0.0.1:0", "--vehicle", vehicle, "--announce", "--leash", *more]
        self.log = open(str(sessions) + ".log", "a", encoding="utf-8")
        self.process = subprocess.Popen(
            [program or spandrel.PROGRAM, *arguments], env=env, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.log, text=True
        )
        line = self.process.stdout.readline()
        assert line, open(self.log.name, encoding="utf-8").read()
        self.address = json.loads(line)["address"]

    def close(self):
        """Stops the server by closing its standard input. It must shut down cleanly in any state."""
        self.process.stdin.close()
        self.process.wait(timeout=PATIENCE_S)
        self.log.close()
        said = pathlib.Path(self.log.name).read_text(encoding="utf-8")
        assert self.process.returncode == 0 and "panicked" not in said and "please report this bug" not in said, said

    def kill(self):
        """Kills the server, as a power cut would."""
        self.process.kill()
        self.process.wait()
        self.log.close()


def set_password(sessions, name, role, *more, password=PASSWORD):
    """Sets a password as an administrator does on the command line."""
    done = subprocess.run(
        [spandrel.PROGRAM, "serve", "--sessions", str(sessions), "--set-password", name, "--role", role, *more],
        input=password + "\n", capture_output=True, text=True, timeout=PATIENCE_S, check=False,
    )
    assert done.returncode == 0, done.stderr


def set_passwords(sessions, *trainees):
    """Sets the passwords of these trainees, of the instructor Ida and of the administrator Ada."""
    for name in trainees:
        set_password(sessions, name, "trainee")
    set_password(sessions, "ida", "instructor")
    set_password(sessions, "ada", "administrator")


class NoRedirect(urllib.request.HTTPRedirectHandler):
    """Handler that does not follow redirects."""

    def redirect_request(self, *_):
        return None


class Browser:
    """A minimal browser with manual cookies, which lets tests control every header."""

    def __init__(self, address):
        self.address = address
        self.cookie, self.device = None, None
        self.opener = urllib.request.build_opener(NoRedirect)

    def ask(self, path, form=None, headers=None, body=None, method=None, keep_cookie=True):
        """Sends a request; returns status, headers, text."""
        data = urllib.parse.urlencode(form).encode() if form is not None else body
        request = urllib.request.Request(self.address + path, data=data, headers=dict(headers or {}), method=method)
        if self.cookie and not request.has_header("Cookie"):
            request.add_header("Cookie", "; ".join(filter(None, (self.cookie, self.device))))
        try:
            answer = self.opener.open(request, timeout=PATIENCE_S)
        except urllib.error.HTTPError as error:
            answer = error
        text = answer.read().decode("utf-8", "replace")
        for fresh in answer.headers.get_all("Set-Cookie", []) if keep_cookie else []:
            pair = fresh.split(";")[0]
            if pair.split("=")[0].endswith("-device"):
                self.device = pair
            elif not pair.startswith("spandrel-language="):
                self.cookie = pair
        return answer.status, answer.headers, text

    def token(self, path):
        """Returns the token of a page's forms."""
        status, _, text = self.ask(path)
        found = re.search(r'name="token" value="([0-9a-f]{64})"', text)
        assert status == 200 and found, (status, text)
        return found.group(1)

    def log_in(self, name, password=PASSWORD):
        """Logs in and returns the status."""
        token = self.token("/login")
        status, _, _ = self.ask("/login", {"token": token, "name": name, "password": password})
        return status

    def post(self, page, path, form, **more):
        """Submits a form of a page."""
        return self.ask(path, {"token": self.token(page), **form}, **more)

    def upload(self, page, path, fields, file, name="file.tlog", token=None):
        """Submits a form with a file."""
        boundary = "spandrel-test-boundary"
        parts = [("token", token or self.token(page)), *fields.items()]
        body = b"".join(
            f'--{boundary}\r\nContent-Disposition: form-data; name="{key}"\r\n\r\n{value}\r\n'.encode() for key, value in parts
        )
        body += f'--{boundary}\r\nContent-Disposition: form-data; name="file"; filename="{name}"\r\n\r\n'.encode()
        body += file + f"\r\n--{boundary}--\r\n".encode()
        return self.ask(path, body=body, headers={"Content-Type": f"multipart/form-data; boundary={boundary}"})


def png(width=40, height=30):
    """Returns a gray PNG file."""
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    rows = (b"\0" + b"\x80" * width) * height
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def flown(folder, *trainees, seed=7, skill="novice"):
    """Creates real sessions of a hover drill, the shortest flight, one for each trainee."""
    for k, trainee in enumerate(trainees):
        spandrel.run(
            "demo", "--scenario", "drill-hover", "--skill", skill, "--seed", str(seed + k), "--speed", "max", "--trainee", trainee,
            "--sessions", str(folder),
        )
    return sorted(path for path in folder.iterdir() if (path / "telemetry.tlog").is_file())
