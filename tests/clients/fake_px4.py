"""A small autopilot in a process of its own. It obeys the rules of PX4's simulator interface and misbehaves on request.

It is started in place of PX4. The file `behavior` in its build folder selects how it behaves:
  fly       answers every HIL_SENSOR 0 with motor commands and takes MANUAL_CONTROL and arming commands
  absent    never connects
  mute      connects and never answers
  babble    connects and sends bytes that are no answers
  silent    answers for a while, then only keeps the connection open
  chatter   answers for a while, then sends bytes that are no answers
  close     takes off, then closes the connection in flight
  exit      takes off, then exits in flight
  garbage   like fly, with bytes between the answers that are no messages
  version   like fly, with a version that Spandrel has not been flown with
"""

import os
import pathlib
import re
import socket
import sys
import time

os.environ["MAVLINK20"] = "1"
from pymavlink.dialects.v20 import common as mavlink  # noqa: E402

# Readings before the first answer, until the autopilot can arm, and until it misbehaves.
SILENT_READINGS, READY, MISBEHAVES = 10, 250, 1500
# Bytes that are no message, and the time between them, s.
NOISE, NOISE_PAUSE_S = b"\x00\xfdnoise", 0.1
# Versions as in AUTOPILOT_VERSION: major, minor, patch, release type.
VERSION, OTHER_VERSION = bytes((255, 0, 16, 1)), bytes((255, 0, 9, 9))
GIT_HASH = 0x1234_5678_9ABC_DEF0
PARAMETERS = {b"MPC_XY_CRUISE": 5.0, b"MIS_TAKEOFF_ALT": 2.5}
# Motor command at hover (phantom2), gains on the angular rate (per rad/s) and the specific force (per m/s2), and the
# change of the command at full throttle.
HOVER, RATE_GAIN, TILT_GAIN, CLIMB = 0.59, 0.05, 0.004, 0.06
ARMED = mavlink.MAV_MODE_FLAG_SAFETY_ARMED
ROTORS = ((-1, 1), (1, -1), (1, 1), (-1, -1))


class Autopilot:
    """The autopilot's state and its two connections."""

    def __init__(self, instance):
        own, remote = re.search(r"-u (\d+) -o (\d+)", pathlib.Path("px4-rc.mavlink").read_text(encoding="utf-8")).groups()
        self.udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.udp.bind(("127.0.0.1", int(own)))
        self.udp.setblocking(False)
        self.remote = ("127.0.0.1", int(remote))
        self.mav = mavlink.MAVLink(None, srcSystem=instance + 1, srcComponent=1)
        self.mav.robust_parsing = True
        self.wire = mavlink.MAVLink(None, srcSystem=instance + 1, srcComponent=1)
        self.wire.robust_parsing = True
        self.readings, self.armed, self.throttle = 0, False, 0.0
        self.version = VERSION

    def say(self, message):
        """Sends a message on the MAVLink link."""
        self.udp.sendto(message.pack(self.mav), self.remote)

    def report(self):
        """Sends the periodic messages."""
        self.say(mavlink.MAVLink_heartbeat_message(2, 12, self.mode(), 3 << 16, 3, 3))
        self.report_state()

    def can_arm(self):
        """Returns whether the checks before arming pass."""
        return self.readings > READY

    def report_state(self):
        """Sends the messages that the autopilots have in common."""
        health = mavlink.MAV_SYS_STATUS_PREARM_CHECK if self.can_arm() else 0
        self.say(mavlink.MAVLink_sys_status_message(0, 0, health, 0, 12000, 0, 100, 0, 0, 0, 0, 0, 0))
        flying = self.armed and self.throttle > 0.4
        self.say(mavlink.MAVLink_extended_sys_state_message(0, 2 if flying else 1))
        custom, version = GIT_HASH.to_bytes(8, "little"), int.from_bytes(self.version, "little")
        self.say(mavlink.MAVLink_autopilot_version_message(0, version, 0, 0, 0, custom, custom, custom, 0, 0, 0))

    def hear(self):
        """Handles the messages on the MAVLink link."""
        while True:
            try:
                data = self.udp.recv(65536)
            except BlockingIOError:
                return
            for message in self.mav.parse_buffer(data) or []:
                self.handle(message)

    def handle(self, message):
        """Handles a message for the autopilot."""
        kind = message.get_type()
        if kind == "MANUAL_CONTROL":
            self.throttle = message.z / 1000.0
        elif kind == "PARAM_REQUEST_LIST":
            for index, (name, value) in enumerate(PARAMETERS.items()):
                self.say(mavlink.MAVLink_param_value_message(name, value, mavlink.MAV_PARAM_TYPE_REAL32, len(PARAMETERS), index))
        elif kind == "COMMAND_LONG" and message.target_component <= 1:
            if message.command == mavlink.MAV_CMD_COMPONENT_ARM_DISARM:
                self.armed = message.param1 > 0.5
            self.say(mavlink.MAVLink_command_ack_message(message.command, 0, 0, 0, message.get_srcSystem(), message.get_srcComponent()))

    def mode(self):
        """Returns the mode flags."""
        return mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | (ARMED if self.armed else 0)

    def controls(self, sensor):
        """Returns the motor commands for a reading."""
        controls = [0.0] * 16
        if self.armed:
            roll = TILT_GAIN * sensor.yacc - RATE_GAIN * sensor.xgyro
            pitch = -TILT_GAIN * sensor.xacc - RATE_GAIN * sensor.ygyro
            lift = 0.1 if self.throttle < 0.02 else HOVER + CLIMB * (self.throttle - 0.5) * 2
            for rotor, (side, front) in enumerate(ROTORS):
                controls[rotor] = min(max(lift + side * roll + front * pitch, 0.0), 1.0)
        return controls

    def answer(self, sensor):
        """Returns the frame with the motor commands for a reading."""
        message = mavlink.MAVLink_hil_actuator_controls_message(sensor.time_usec, self.controls(sensor), self.mode(), 1)
        return message.pack(self.wire)


def main():
    """Connects as PX4 does and runs until the simulator closes the connection."""
    build = pathlib.Path(sys.argv[0]).resolve().parents[1]
    behavior = (build / "behavior").read_text(encoding="utf-8").strip()
    instance = int(sys.argv[sys.argv.index("-i") + 1])
    script = pathlib.Path("px4-rc.mavlinksim")
    port = int(re.search(r"-c (\d+)", script.read_text(encoding="utf-8"))[1]) if script.exists() else 4560 + instance
    if behavior == "absent":
        time.sleep(3600)
    autopilot = Autopilot(instance)
    autopilot.version = OTHER_VERSION if behavior == "version" else VERSION
    link = socket.create_connection(("127.0.0.1", port))
    link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    while data := link.recv(65536):
        for message in autopilot.wire.parse_buffer(data) or []:
            if message.get_type() != "HIL_SENSOR" or message.id != 0:
                continue
            autopilot.readings += 1
            autopilot.hear()
            if autopilot.readings % 50 == 1:
                autopilot.report()
            if behavior == "babble":
                link.sendall(NOISE)
            if behavior in ("mute", "babble") or autopilot.readings <= SILENT_READINGS:
                continue
            if behavior in ("close", "exit"):
                autopilot.armed, autopilot.throttle = True, 1.0
            if autopilot.readings > MISBEHAVES:
                misbehave(link, behavior)
            link.sendall((NOISE if behavior == "garbage" else b"") + autopilot.answer(message))


def misbehave(link, behavior):
    """Does what the behavior demands after a while. Some don't return."""
    if behavior == "silent":
        time.sleep(3600)
    while behavior == "chatter":
        link.sendall(NOISE)
        time.sleep(NOISE_PAUSE_S)
    if behavior in ("close", "exit"):
        link.close()
        time.sleep(0 if behavior == "exit" else 3600)
        sys.exit(7)


if __name__ == "__main__":
    main()
