"""A small autopilot in a process of its own that obeys the rules of ArduPilot's JSON interface and misbehaves on request.

It is started in place of ArduPilot. The file `behavior` beside it selects how it behaves:
  fly       answers every state with motor outputs and takes MANUAL_CONTROL, arming and reboot commands
  absent    never sends a packet
  blind     cannot read the states, as another version of ArduPilot might: sends its first packet again each second
  silent    answers for a while, then sends nothing
  exit      takes off, then exits in flight
  garbage   like fly, with datagrams between the answers that are no packets
  resend    like fly, and sends some packets twice, as ArduPilot does if a reply is lost
  version   like fly, with a version that Spandrel has not been flown with
"""

import json
import os
import pathlib
import re
import socket
import struct
import sys
import time

import fake_px4
from fake_px4 import mavlink

# Header of a packet with 16 outputs, and the rate in it, Hz.
MAGIC, RATE_HZ, OUTPUTS = 18_458, 1_000, 16
# Pulse width of a motor that is off, and the width of the range, us.
OFF_US, RANGE_US = 1000, 1000
# Time after which a packet without a reply is sent again, s, as in ArduPilot.
RESEND_S = 1.0
# States until the autopilot can arm, until it misbehaves, and between two packets that are sent twice.
READY, MISBEHAVES, TWICE = 1_000, 6_000, 100
STABILIZE, LOITER = 0, 5
VERSION = bytes((255, 3, 6, 4))


class Sensor:
    """The readings in a state, by the names of HIL_SENSOR."""

    def __init__(self, state):
        self.xgyro, self.ygyro, self.zgyro = state["imu"]["gyro"]
        self.xacc, self.yacc, self.zacc = state["imu"]["accel_body"]


class Autopilot(fake_px4.Autopilot):
    """The autopilot's state and its MAVLink connection."""

    def __init__(self, arguments):
        host, port = re.fullmatch(r"udpclient:(.*):(\d+)", arguments["serial0"]).groups()
        self.udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.udp.setblocking(False)
        self.remote = (host, int(port))
        self.mav = mavlink.MAVLink(None, srcSystem=int(arguments["instance"]) + 1, srcComponent=1)
        self.mav.robust_parsing = True
        self.readings, self.armed, self.throttle, self.reboots = 0, False, 0.0, False
        self.version = VERSION

    def report(self):
        """Sends the periodic messages."""
        self.say(mavlink.MAVLink_heartbeat_message(2, mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA, self.mode(), LOITER, 3, 3))
        self.report_state()

    def can_arm(self):
        """Returns whether the checks before arming pass."""
        return self.readings > READY

    def handle(self, message):
        """Handles a message for the autopilot."""
        reboot = mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN
        self.reboots |= message.get_type() == "COMMAND_LONG" and message.command == reboot
        super().handle(message)

    def packet(self, frame, sensor):
        """Returns the packet with the motor outputs."""
        pulses = [OFF_US + round(RANGE_US * control) for control in (self.controls(sensor) if sensor else [0.0] * OUTPUTS)]
        return struct.pack(f"<HHI{OUTPUTS}H", MAGIC, RATE_HZ, frame, *pulses)


def misbehave(behavior):
    """Does what the behavior demands after a while. Some don't return."""
    if behavior == "silent":
        time.sleep(3600)
    if behavior == "exit":
        sys.exit(7)


def main():
    """Exchanges packets and states as ArduPilot does, until it is ended."""
    behavior = pathlib.Path(sys.argv[0]).resolve().with_name("behavior").read_text(encoding="utf-8").strip()
    arguments = dict(zip((name.removeprefix("--") for name in sys.argv[1::2]), sys.argv[2::2]))
    pathlib.Path("arguments.txt").write_text(" ".join(sys.argv[1:]) + "\n", encoding="utf-8")
    if behavior == "absent":
        time.sleep(3600)
    autopilot = Autopilot(arguments)
    autopilot.version = fake_px4.OTHER_VERSION if behavior == "version" else VERSION
    simulator = ("127.0.0.1", int(arguments["sim-port-out"]))
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    link.settimeout(RESEND_S)
    frame, sensor, states, owner = 0, None, 0, os.getppid()
    while os.getppid() == owner:
        packet = autopilot.packet(frame, sensor)
        if behavior == "garbage":
            link.sendto(fake_px4.NOISE, simulator)
        link.sendto(packet, simulator)
        if behavior == "resend" and states % TWICE == TWICE - 1:
            link.sendto(packet, simulator)
        try:
            state = link.recv(65536)
        except TimeoutError:
            continue
        if behavior == "blind":
            time.sleep(RESEND_S)
            continue
        sensor, frame, states = Sensor(json.loads(state)), frame + 1, states + 1
        autopilot.readings += 1
        autopilot.hear()
        if autopilot.readings % 200 == 1:
            autopilot.report()
        if autopilot.reboots:
            frame, autopilot.readings, autopilot.armed, autopilot.reboots = 0, 0, False, False
        if behavior == "exit":
            autopilot.armed, autopilot.throttle = True, 1.0
        if states > MISBEHAVES:
            misbehave(behavior)


if __name__ == "__main__":
    main()
