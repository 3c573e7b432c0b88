"""The same flight in lockstep over UDP gives identical results in the debug and release builds."""

import os
import pathlib
import subprocess

import pytest
from pymavlink.dialects.v20 import common as mavlink
from pymavlink import mavutil

import spandrel

DEBUG = pathlib.Path(os.environ.get("SPANDREL_DEBUG", spandrel.ROOT / "target" / "debug" / "spandrel"))
# Stick inputs (forward, right, up from 0 to 1000) and their durations, s of simulation time, starting at 3.5 s: climb,
# sideways into the girder of the suspension bridge, away from it. Then the motors are stopped; after a fall into the
# lake and three seconds there, the flight continues.
SCRIPT = [(7, (0, 0, 800)), (15, (0, -1000, 500)), (4, (0, 1000, 500)), (9, (0, 0, 500)), (4, (500, 0, 600))]
ARM_AT_S, BEGIN_S, STOP_AT_S, END_S = 3.0, 3.5, 29.5, 42.5
POSCTL, FORCE = 3, 21196


def sticks_at(seconds):
    """Returns the sticks of the script at a time."""
    begin = BEGIN_S
    for length, sticks in SCRIPT:
        if begin <= seconds < begin + length:
            return sticks
        begin += length
    return (0, 0, 500)


class Script:
    """Answers each TIMESYNC after sending everything scheduled up to its time."""

    def __init__(self, link):
        self.link, self.armed, self.stopped, self.steps = link, False, False, 0
        self.counts = {"hits": 0, "respawns": 0}

    def command(self, number, *values):
        self.link.mav.command_long_send(1, 1, number, 0, *values, *[0.0] * (7 - len(values)))

    def send_scheduled_inputs(self, seconds):
        """Sends the scheduled commands and sticks for this time."""
        forward, right, up = sticks_at(seconds)
        self.link.mav.manual_control_send(1, forward, right, up, 0, 0)
        if seconds >= ARM_AT_S and not self.armed:
            self.armed = True
            self.command(mavlink.MAV_CMD_DO_SET_MODE, 1.0, float(POSCTL))
            self.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1.0)
        if seconds >= STOP_AT_S and not self.stopped:
            self.stopped = True
            self.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0.0, float(FORCE))

    def receive(self, message):
        """Processes a message from the vehicle."""
        if message.get_type() == "NAMED_VALUE_INT" and message.name in self.counts:
            self.counts[message.name] = max(self.counts[message.name], message.value)
        if message.get_type() != "TIMESYNC" or message.tc1 != 0:
            return
        self.steps += 1
        if self.steps % 2 == 0:
            self.send_scheduled_inputs(message.ts1 / 1e9)
        self.link.mav.timesync_send(message.ts1 + 1, message.ts1)


def fly(program):
    """Returns a flight's digest and its event counts."""
    port = spandrel.free_udp_port()
    link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", dialect="common", source_system=255, source_component=190)
    arguments = [
        "sim", "--scenario", "two-bridges", "--seed", "7", "--speed", "max", "--gcs", f"127.0.0.1:{port}", "--sdk", "none",
        "--gcs-port", "0", "--payload-port", "none", "--tcp-port", "none", "--monitor-port", "none",
        "--lockstep", f"127.0.0.1:{port}", "--after-crash", "respawn", "--end-after", str(END_S), "--digest", "--log", "warn",
    ]
    process = subprocess.Popen([str(program), *arguments], stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True)
    script = Script(link)
    try:
        while process.poll() is None:
            message = link.recv_match(blocking=True, timeout=0.2)
            if message is not None:
                script.receive(message)
        digest = process.stdout.read().strip()
    finally:
        spandrel.end(process)
        link.close()
    assert process.returncode == 0
    return digest, script.counts


@pytest.mark.timeout(600)
def test_regress_debug_and_release_builds_give_identical_flights():
    """The flight includes gusts, a collision, a fall into the water and a respawn."""
    release, counts = fly(spandrel.PROGRAM)
    assert len(release) == 64 and counts["hits"] > 0 and counts["respawns"] > 0, counts
    assert DEBUG.exists(), f"{DEBUG}: build it first (cargo build)"
    assert fly(DEBUG) == (release, counts)
