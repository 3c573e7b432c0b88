"""Tests pymavlink with and without the vehicle's signing key, over every link type and across a restart."""

import contextlib
import hashlib
import itertools
import json
import os
import pty
import select
import signal
import socket
import subprocess
import time
import tty

import pytest
from pymavlink import mavutil
from pymavlink.dialects.v20 import common as mavlink

import spandrel

PASSPHRASE = "bridge over water"
# Wall seconds to wait for a response that must not arrive; responses usually arrive within milliseconds.
SILENCE_S = 1.0


@pytest.fixture
def vehicle(tmp_path):
    """A simulator that requires signatures, and its port."""
    key = tmp_path / "key"
    key.write_text(PASSPHRASE + "\n", encoding="utf-8")
    key.chmod(0o600)
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port, "--signing-key", str(key))
    yield port
    spandrel.end(process)


def acknowledged(link):
    """Returns whether a command is acknowledged."""
    link.mav.command_long_send(1, 1, mavlink.MAV_CMD_REQUEST_MESSAGE, 0, mavlink.MAVLINK_MSG_ID_HEARTBEAT, 0, 0, 0, 0, 0, 0)
    return link.recv_match(type="COMMAND_ACK", blocking=True, timeout=SILENCE_S) is not None


@pytest.mark.timeout(120)
def test_wire_pymavlink_needs_the_signing_key(vehicle):
    """Sends commands unsigned, signed with another key, and signed with the key; also checks the signatures of the
    vehicle's messages."""
    link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{vehicle}", dialect="common", source_system=255)
    assert link.wait_heartbeat(timeout=60)
    assert not acknowledged(link)
    link.setup_signing(hashlib.sha256(b"another bridge").digest(), sign_outgoing=True)
    link.mav.signing.timestamp = int((time.time() - 1420070400) * 1e5)
    assert not acknowledged(link)
    link.setup_signing(hashlib.sha256(PASSPHRASE.encode()).digest(), sign_outgoing=True)
    assert acknowledged(link)
    for _ in range(200):
        message = link.recv_match(blocking=True, timeout=10)
        assert message is not None
        # pymavlink does not verify messages that its dialect does not contain.
        assert message.get_type().startswith("UNKNOWN") or message.get_signed(), message
    link.close()


class Wire:
    """Bytes to and from the vehicle over one kind of link."""

    def __init__(self, kind):
        self.kind = kind
        self.socket, self.ours, self.theirs = None, None, None
        if kind == "serial":
            try:
                self.ours, self.theirs = pty.openpty()
            except OSError as error:
                pytest.skip(f"this machine has no pseudo-terminals: {error}")
            tty.setraw(self.ours)
            tty.setraw(self.theirs)

    def arguments(self):
        """Returns the vehicle's arguments for this link."""
        return ["--serial", f"{os.ttyname(self.theirs)}:115200"] if self.kind == "serial" else []

    def connect(self, ports):
        """Connects to a vehicle that has announced its ports."""
        if self.kind == "tcp":
            self.socket = socket.create_connection(("127.0.0.1", ports["tcp_port"]))
        elif self.kind == "udp":
            self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            self.socket.connect(("127.0.0.1", ports["gcs_port"]))

    def write(self, data):
        """Sends a frame."""
        os.write(self.ours if self.socket is None else self.socket.fileno(), data)

    def read(self):
        """Returns the bytes that arrive within a second."""
        place = self.ours if self.socket is None else self.socket.fileno()
        ready, _, _ = select.select([place], [], [], 1.0)
        return os.read(place, 65_536) if ready else b""

    def close(self):
        """Closes the connection after the vehicle has stopped; a serial line stays open."""
        if self.socket is not None:
            self.socket.close()


class Signer:
    """Creates frames, signed with a key or unsigned. Each signer is a separate stream because of its link ID."""

    def __init__(self, passphrase, link_id):
        self.mav = mavlink.MAVLink(None, srcSystem=255, srcComponent=190)
        if passphrase is not None:
            self.mav.signing.secret_key = hashlib.sha256(passphrase.encode()).digest()
            self.mav.signing.sign_outgoing = True
            self.mav.signing.link_id = link_id
            self.mav.signing.timestamp = int((time.time() - 1420070400) * 1e5)

    def lamp(self, on):
        """Returns the bytes of a lamp command."""
        return self.mav.command_long_encode(1, 1, mavlink.MAV_CMD_ILLUMINATOR_ON_OFF, 0, on, 0, 0, 0, 0, 0, 0).pack(self.mav)

    def request_bytes(self, number):
        """Returns the bytes of a request whose response contains the given number."""
        return self.mav.timesync_encode(0, number).pack(self.mav)


COMMANDS, QUESTIONS = 7, 8
NUMBERS = itertools.count(1_000)


def is_acknowledged(wire, frame):
    """Returns whether a lamp command is acknowledged before a valid request that is sent after it."""
    good, ears = Signer(PASSPHRASE, QUESTIONS), mavlink.MAVLink(None)
    ears.robust_parsing = True
    wire.write(frame)
    acknowledged, asked = [], set()

    def answered():
        asked.add(number := next(NUMBERS))
        wire.write(good.request_bytes(number))
        heard = ears.parse_buffer(wire.read()) or []
        acknowledged.extend(m for m in heard if m.get_type() == "COMMAND_ACK" and m.command == mavlink.MAV_CMD_ILLUMINATOR_ON_OFF)
        return any(m.get_type() == "TIMESYNC" and m.ts1 in asked for m in heard)

    spandrel.wait_for("a response to the signed request", answered, 60)
    return bool(acknowledged)


@contextlib.contextmanager
def running(wire, key):
    """A vehicle that requires signatures, and a link to it."""
    arguments = ["sim", "--scenario", "drill-hover", "--seed", "7", "--ports", "ephemeral", "--tcp-port", "0", "--announce",
                 "--signing-key", str(key), *wire.arguments()]
    process = subprocess.Popen([spandrel.PROGRAM, *arguments], stdout=subprocess.PIPE, stdin=subprocess.DEVNULL)
    try:
        wire.connect(json.loads(process.stdout.readline()))
        yield process
    finally:
        spandrel.end(process)
        process.stdout.close()
        wire.close()


@pytest.mark.timeout(240)
@pytest.mark.parametrize("kind", ["udp", "tcp", "serial"])
@pytest.mark.parametrize("ended", [signal.SIGINT, signal.SIGKILL])
def test_wire_signed_frames_cannot_be_replayed_on_any_link_or_after_a_restart(tmp_path, kind, ended):
    """Sends a command unsigned, signed with another key, correctly signed, and replayed; then restarts the vehicle
    and repeats everything."""
    key = tmp_path / "key"
    key.write_text(PASSPHRASE + "\n", encoding="utf-8")
    key.chmod(0o600)
    wire = Wire(kind)
    with running(wire, key) as process:
        bare, forged, good = (Signer(phrase, COMMANDS).lamp(1.0) for phrase in (None, "another bridge", PASSPHRASE))
        assert not is_acknowledged(wire, bare)
        assert not is_acknowledged(wire, forged)
        assert is_acknowledged(wire, good)
        assert not is_acknowledged(wire, good), "a replayed command must be ignored"
        # The signing memory file is written once per second and at a normal exit.
        memory = key.with_name("key.heard.1")
        stream = f"255 190 {COMMANDS} "
        spandrel.wait_for("the memory", lambda: memory.exists() and stream in memory.read_text(encoding="utf-8"), 60)
        process.send_signal(ended)
        process.wait(timeout=60)
    with running(wire, key):
        assert not is_acknowledged(wire, good), "a replayed command must be ignored after a restart"
        assert is_acknowledged(wire, Signer(PASSPHRASE, COMMANDS).lamp(0.0))


@pytest.mark.timeout(60)
def test_wire_invalid_signing_memory_is_rejected_with_its_line(tmp_path):
    """An invalid signing memory file is reported and not overwritten."""
    key = tmp_path / "key"
    key.write_text(PASSPHRASE + "\n", encoding="utf-8")
    key.chmod(0o600)
    key.with_name("key.heard.1").write_text("500\n255 190 zero 400\n", encoding="utf-8")
    process = spandrel.start_sim(tmp_path, spandrel.free_udp_port(), "--signing-key", str(key))
    assert process.wait(timeout=60) == 2
    assert "key.heard.1:2" in (tmp_path / "sim.txt").read_text(encoding="utf-8")
