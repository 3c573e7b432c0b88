"""A ground station based on pymavlink that flies with MANUAL_CONTROL, like a pilot with a gamepad."""

import os
import time

os.environ["MAVLINK20"] = "1"

from pymavlink import mavutil

import asking
import handpilot
from spandrel import wait_for

M = mavutil.mavlink
CAMERA = 100
MONITOR = 191
# Main mode number of PX4's POSCTL, and number of ArduCopter's POSHOLD.
POSITION_MODE = {M.MAV_AUTOPILOT_PX4: 3, M.MAV_AUTOPILOT_ARDUPILOTMEGA: 16}
# Telemetry rate for a stick control loop, Hz in vehicle time.
RATE_HZ = 50
# Rate of messages that are only observed, Hz.
SLOW_HZ = 4


class Client:
    """A ground station based on pymavlink, which automatically sends only heartbeats."""

    def __init__(self, port, scenario="two-bridges"):
        self.scenario = scenario
        self.link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=255, source_component=190, dialect="all")
        beat = wait_for("a heartbeat", lambda: (b := self.link.wait_heartbeat(timeout=60)) and b.get_srcComponent() == 1 and b)
        self.autopilot = beat.autopilot
        if self.autopilot == M.MAV_AUTOPILOT_ARDUPILOTMEGA:
            # pymavlink cannot parse all streams at the fast rate on a busy machine, and sticks based on outdated
            # positions cause a crash.
            for group, rate_hz in ((M.MAV_DATA_STREAM_ALL, SLOW_HZ), (M.MAV_DATA_STREAM_POSITION, RATE_HZ), (M.MAV_DATA_STREAM_EXTRA1, RATE_HZ)):
                self.link.mav.request_data_stream_send(self.link.target_system, 1, group, rate_hz, 1)
        self.state = {}
        self.texts = []
        # The monitor's way to the next place.
        self.way = None
        self.beat_at = 0.0

    def pump(self):
        """Processes all messages that have arrived."""
        if time.monotonic() - self.beat_at > 0.5:
            self.beat_at = time.monotonic()
            self.link.mav.heartbeat_send(M.MAV_TYPE_GCS, M.MAV_AUTOPILOT_INVALID, 0, 0, M.MAV_STATE_ACTIVE)
        while True:
            message = self.link.recv_match(blocking=False)
            if message is None:
                return
            if message.get_type() == "STATUSTEXT":
                self.texts.append((message.get_srcComponent(), message.text))
            if message.get_srcComponent() == MONITOR and message.get_type() == "NAV_CONTROLLER_OUTPUT":
                self.way = message
            if message.get_srcComponent() in (1, CAMERA):
                self.state[message.get_type()] = message

    def wait(self, what, predicate):
        """Processes messages until the predicate is true."""

        def step():
            self.pump()
            return predicate()

        return wait_for(what, step)

    def command(self, number, *params, component=1):
        """Sends a command and returns the result of its acknowledgment."""
        params = list(params) + [0] * (7 - len(params))
        self.state.pop("COMMAND_ACK", None)
        again = asking.Repeater(lambda: self.link.mav.command_long_send(self.link.target_system, component, number, 0, *params))

        def answered():
            ack = self.state.get("COMMAND_ACK")
            if ack and ack.command == number:
                return ack
            again.if_due()
            return None

        return self.wait(f"acknowledgment of {number}", answered).result

    def here(self):
        """Returns the position in meters east, north and up of the job's origin, and the heading in radians."""
        p, (east, north, up) = self.state["LOCAL_POSITION_NED"], self.local_origin()
        return (east + p.y, north + p.x, up - p.z), self.state["ATTITUDE"].yaw

    def ask_origin(self):
        """Requests GPS_GLOBAL_ORIGIN, because ArduPilot sends it only on request."""
        self.link.mav.command_long_send(self.link.target_system, 1, M.MAV_CMD_REQUEST_MESSAGE, 0, M.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN, 0, 0, 0, 0, 0, 0)

    def local_origin(self):
        """Returns the origin of the vehicle's local frame in meters east, north and up of the job's origin."""
        o = self.state["GPS_GLOBAL_ORIGIN"]
        return handpilot.local_origin(self.scenario, o.latitude * 1e-7, o.longitude * 1e-7, o.altitude * 1e-3)

    def sticks(self, axes):
        """Sends one MANUAL_CONTROL."""
        forward, right, up, yaw = (int(round(1000 * a)) for a in axes)
        self.link.mav.manual_control_send(self.link.target_system, forward, right, 500 + up // 2, yaw, 0)

    def ready(self):
        """Waits until the vehicle may be armed and sends its position, and selects the mode for flying with sticks."""
        prearm = M.MAV_SYS_STATUS_PREARM_CHECK
        self.wait("ready", lambda: (s := self.state.get("SYS_STATUS")) and s.onboard_control_sensors_health & prearm)
        self.wait("position", lambda: {"LOCAL_POSITION_NED", "ATTITUDE", "GPS_GLOBAL_ORIGIN"} <= self.state.keys() or self.ask_origin())
        self.sticks((0, 0, 0, 0))
        assert self.command(M.MAV_CMD_DO_SET_MODE, 1, POSITION_MODE[self.autopilot]) == M.MAV_RESULT_ACCEPTED

    def fly_to(self, target, look_yaw, done=None, cruise=handpilot.CRUISE_M_S):
        """Holds the sticks toward a target until it is reached or `done` returns true."""
        last = [None]

        def step():
            here, yaw = self.here()
            stamp = self.state["ATTITUDE"].time_boot_ms
            if stamp != last[0]:
                last[0] = stamp
                self.sticks(handpilot.sticks_towards(here, yaw, target, look_yaw(here), cruise))
            return done(here) if done else handpilot.distance(here, target) < handpilot.REACHED_M

        self.wait(f"reaching {target}", step)
