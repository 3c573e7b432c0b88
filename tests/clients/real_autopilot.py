"""A vehicle flown by a real PX4 or ArduPilot (or by the built-in autopilot), in lockstep with a pymavlink client."""

import json
import math
import os
import pathlib
import subprocess

os.environ["MAVLINK20"] = "1"

from pymavlink import mavutil

import spandrel

mavutil.set_dialect("all")
M = mavutil.mavlink
# Environment variables that contain the program, which Spandrel reads as well.
VARIABLES = {"px4": "SPANDREL_PX4", "ardupilot": "SPANDREL_ARDUPILOT"}
# Wall seconds without messages before a test gives up; an autopilot may start for a minute on a busy machine.
STUCK_S = 300.0
# Instance of the first vehicle. Two instances of PX4 on a machine need different numbers, so another PX4 may run beside the tests.
INSTANCE = 50
STICK_RATE_HZ, TRUTH_RATE_HZ, SETPOINT_RATE_HZ = 25, 50, 10
# SET_POSITION_TARGET_LOCAL_NED: ignore all but the velocity and the yaw angle.
VELOCITY_AND_YAW = 0x09C7
EARTH_RADIUS_M = 6_371_000.0
# Custom modes, as parameters 2 and 3 of DO_SET_MODE.
MODES = {
    "px4": {"sticks": (3, 0), "hold": (4, 3), "external": (6, 0), "land": (4, 6)},
    "ardupilot": {"sticks": (5, 0), "hold": (5, 0), "external": (4, 0), "land": (9, 0)},
}


class Vehicle:
    """A simulator in lockstep with this client: 20 ms of simulation time pass with each step."""

    def __init__(self, folder, autopilot, *more, flavor=None, scenario="drill-hover", vehicle="phantom2"):
        """`flavor` selects the interface of the built-in autopilot; without it, the real autopilot flies."""
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.autopilot = autopilot
        port = spandrel.free_udp_port()
        here = f"127.0.0.1:{port}"
        self.link = mavutil.mavlink_connection(f"udpin:{here}", source_system=255, source_component=190, dialect="all")
        kind = ["--flavor", flavor] if flavor else ["--autopilot", autopilot, "--autopilot-dir", str(self.folder / "work"), "--instance", str(INSTANCE)]
        self.truth_component = 1 if flavor else 192
        self.log = open(self.folder / "sim.txt", "w", encoding="utf-8")
        command = [
            spandrel.PROGRAM, "sim", "--scenario", scenario, "--vehicle", vehicle, "--seed", "7", "--speed", "max", "--ports", "ephemeral",
            "--gcs", here, "--lockstep", here, *kind, *more,
        ]
        self.process = subprocess.Popen(command, stdout=self.log, stderr=self.log, stdin=subprocess.DEVNULL)
        self.now, self.system = 0.0, 1 if flavor else 1 + INSTANCE
        self.last, self.params, self.texts, self.track = {}, {}, [], []
        # MANUAL_CONTROL: x, y, z, r. None: no sticks.
        self.sticks = (0, 0, 500, 0)
        self.velocity = None
        self.due = dict.fromkeys(("beat", "sticks", "setpoint"), 0.0)
        self.origin = None

    def close(self):
        """Ends the simulator and prints its log."""
        self.link.close()
        spandrel.end(self.process)
        self.log.close()
        print(self.output()[-3000:], *self.texts[-30:], sep="\n")

    def output(self):
        """Returns the simulator's log so far."""
        return (self.folder / "sim.txt").read_text(encoding="utf-8")

    def record(self):
        """Returns autopilot.json."""
        return json.loads((self.folder / "work" / "autopilot.json").read_text(encoding="utf-8"))

    # Time control

    def step(self):
        """Advances by 20 ms."""
        while True:
            message = self.link.recv_match(blocking=True, timeout=STUCK_S)
            assert message is not None, f"no message at {self.now:.2f} s (exit code {self.process.poll()}); {self.texts[-5:]}"
            kind = message.get_type()
            if kind == "TIMESYNC" and message.tc1 == 0:
                self.now = message.ts1 / 1e9
                self.send_inputs()
                self.link.mav.timesync_send(1, message.ts1)
                return
            if kind == "BAD_DATA":
                continue
            if kind.startswith("UNKNOWN_"):
                # pymavlink's class for unknown messages does not contain the sender.
                self.last[kind] = message
                continue
            if message.get_srcSystem() != self.system:
                continue
            self.last[kind, message.get_srcComponent()] = self.last[kind] = message
            if kind == "PARAM_VALUE":
                self.params[message.param_id] = message.param_value
            if kind == "STATUSTEXT":
                self.texts.append(f"{self.now:.1f} {message.get_srcComponent()} {message.text}")
            if kind == "HIL_STATE_QUATERNION":
                self.track.append((self.now, self.position(), self.true_velocity()))

    def send_inputs(self):
        """Sends the heartbeat, the sticks and the velocity setpoint at their rates."""
        def due(what, rate_hz):
            if self.now < self.due[what]:
                return False
            self.due[what] = self.now + 1 / rate_hz
            return True
        if due("beat", 1):
            self.link.mav.heartbeat_send(M.MAV_TYPE_GCS, M.MAV_AUTOPILOT_INVALID, 0, 0, 0)
        if self.sticks is not None and due("sticks", STICK_RATE_HZ):
            self.link.mav.manual_control_send(self.system, *self.sticks, 0)
        if self.velocity is not None and due("setpoint", SETPOINT_RATE_HZ):
            north, east, down, yaw = self.velocity
            self.link.mav.set_position_target_local_ned_send(
                0, self.system, 1, M.MAV_FRAME_LOCAL_NED, VELOCITY_AND_YAW, 0, 0, 0, north, east, down, 0, 0, 0, yaw, 0)

    def wait_until(self, what, predicate, limit_s=300):
        """Waits until the predicate is truthy and returns its value. The limit in simulation time is only against hanging."""
        end = self.now + limit_s
        while not (value := predicate()):
            assert self.now <= end, f"not within {limit_s} s: {what}; {self.texts[-8:]}"
            self.step()
        return value

    def pass_time(self, seconds):
        """Lets some simulation time pass and returns the true track during this time."""
        end, start = self.now + seconds, len(self.track)
        while self.now < end:
            self.step()
        return self.track[start:]

    # State

    def position(self):
        """Returns the true position north, east and down of the first position, m."""
        truth = self.last["HIL_STATE_QUATERNION"]
        here = (truth.lat / 1e7, truth.lon / 1e7, truth.alt / 1e3)
        self.origin = self.origin or here
        degree = math.radians(1) * EARTH_RADIUS_M
        east = (here[1] - self.origin[1]) * degree * math.cos(math.radians(here[0]))
        return (here[0] - self.origin[0]) * degree, east, self.origin[2] - here[2]

    def true_velocity(self):
        """Returns the true velocity north, east and down, m/s."""
        truth = self.last["HIL_STATE_QUATERNION"]
        return truth.vx / 100, truth.vy / 100, truth.vz / 100

    def heading(self):
        """Returns the true heading, rad."""
        w, x, y, z = self.last["HIL_STATE_QUATERNION"].attitude_quaternion
        return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))

    def height(self):
        """Returns the height above the first position, m."""
        return -self.position()[2]

    def armed(self):
        """Returns whether the autopilot reports that it is armed."""
        beat = self.last.get(("HEARTBEAT", 1))
        return beat is not None and bool(beat.base_mode & M.MAV_MODE_FLAG_SAFETY_ARMED)

    def mode(self):
        """Returns main mode and submode for PX4, the mode and 0 for ArduPilot."""
        custom = self.last["HEARTBEAT", 1].custom_mode
        return (custom >> 16 & 0xFF, custom >> 24) if self.autopilot == "px4" else (custom, 0)

    def ready(self):
        """Returns whether the autopilot reports that it can arm."""
        status = self.last.get(("SYS_STATUS", 1))
        return status is not None and bool(status.onboard_control_sensors_health & M.MAV_SYS_STATUS_PREARM_CHECK)

    def text(self, *words):
        """Returns the texts so far that contain one of these words."""
        return [text for text in self.texts if any(word.lower() in text.lower() for word in words)]

    # Requests

    def command(self, component, number, *params):
        """Sends a command until it is acknowledged, and returns the result."""
        values = list(params) + [0.0] * (7 - len(params))
        for _ in range(5):
            self.last.pop("COMMAND_ACK", None)
            self.link.mav.command_long_send(self.system, component, number, 0, *values)
            end = self.now + 3
            while self.now < end:
                self.step()
                ack = self.last.get("COMMAND_ACK")
                if ack is not None and ack.command == number and ack.result != M.MAV_RESULT_IN_PROGRESS:
                    return ack.result
        raise AssertionError(f"no acknowledgment of {number}; {self.texts[-5:]}")

    def set_mode(self, name):
        """Sets a mode and waits until the heartbeat reports it."""
        wanted = MODES[self.autopilot][name]
        for _ in range(20):
            self.command(1, M.MAV_CMD_DO_SET_MODE, M.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, *wanted)
            end = self.now + 2
            while self.now < end:
                self.step()
                if self.mode() == wanted:
                    return
        raise AssertionError(f"mode {name} was not set; {self.texts[-8:]}")

    def set_param(self, name, value, kind=M.MAV_PARAM_TYPE_REAL32):
        """Sets a floating-point parameter. Its previous value may arrive first: Spandrel requests all parameters for the session's record."""
        for _ in range(5):
            self.params.pop(name, None)
            self.link.mav.param_set_send(self.system, 1, name.encode(), value, kind)
            end = self.now + 3
            while self.now < end:
                self.step()
                if math.isclose(self.params.get(name, math.nan), value, rel_tol=1e-5):
                    return
        raise AssertionError(f"parameter {name} was not set: {self.params.get(name)}")

    def get_ready(self):
        """Waits until the vehicle can arm and sends the streams that the tests use."""
        self.wait_until("heartbeat", lambda: ("HEARTBEAT", 1) in self.last)
        for message, rate_hz in ((M.MAVLINK_MSG_ID_SYS_STATUS, 5), (M.MAVLINK_MSG_ID_EXTENDED_SYS_STATE, 5), (M.MAVLINK_MSG_ID_LOCAL_POSITION_NED, 5)):
            self.command(1, M.MAV_CMD_SET_MESSAGE_INTERVAL, message, 1e6 / rate_hz)
        self.command(self.truth_component, M.MAV_CMD_SET_MESSAGE_INTERVAL, M.MAVLINK_MSG_ID_HIL_STATE_QUATERNION, 1e6 / TRUTH_RATE_HZ)
        self.wait_until("the truth", lambda: "HIL_STATE_QUATERNION" in self.last)
        self.wait_until("ready to arm", self.ready)

    def arm(self):
        """Arms as soon as the vehicle allows it."""
        def armed():
            if self.armed():
                return True
            if self.command(1, M.MAV_CMD_COMPONENT_ARM_DISARM, 1) != M.MAV_RESULT_ACCEPTED:
                self.pass_time(1)
            else:
                self.pass_time(0.5)
            return self.armed()
        self.wait_until("armed", armed)

    def take_off(self, height_m):
        """Arms and climbs to a height, then holds the position."""
        base = self.height()
        if self.autopilot == "px4":
            self.set_param("MIS_TAKEOFF_ALT", height_m)
            self.set_mode("hold")
            self.arm()
            nan = math.nan
            assert self.command(1, M.MAV_CMD_NAV_TAKEOFF, nan, 0, 0, nan, nan, nan, nan) == M.MAV_RESULT_ACCEPTED
        else:
            self.set_mode("external")
            self.arm()
            assert self.command(1, M.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, height_m) == M.MAV_RESULT_ACCEPTED
        self.wait_until("the takeoff", lambda: self.height() - base > height_m - 1)
        self.pass_time(5)
        self.set_mode("hold")
        self.pass_time(5)

    def land(self):
        """Lands and waits until the autopilot has disarmed."""
        self.velocity = None
        self.set_mode("land")
        self.wait_until("disarmed", lambda: not self.armed())

    def fly_square(self, side_m, speed_m_s):
        """Flies a square by velocity setpoints and returns, for each leg, the highest speed and the largest distance from the leg, m."""
        yaw = self.heading()
        self.velocity = (0, 0, 0, yaw)
        self.pass_time(1)
        self.set_mode("external")
        self.pass_time(1)
        legs = []
        for north, east in ((1, 0), (0, 1), (-1, 0), (0, -1)):
            start = self.position()
            self.velocity = (speed_m_s * north, speed_m_s * east, 0, yaw)
            first = len(self.track)
            along = lambda: (self.position()[0] - start[0]) * north + (self.position()[1] - start[1]) * east  # noqa: E731, B023
            self.wait_until(f"leg {north}, {east}", lambda: along() >= side_m, 60)  # noqa: B023
            flown = self.track[first:]
            fastest = max(math.hypot(*velocity[:2]) for _, _, velocity in flown)
            off = max(abs((p[0] - start[0]) * east - (p[1] - start[1]) * north) for _, p, _ in flown)
            legs.append((fastest, off))
            self.velocity = (0, 0, 0, yaw)
            self.wait_until("a stop", lambda: math.hypot(*self.true_velocity()[:2]) < 0.5, 60)
        self.set_mode("hold")
        self.velocity = None
        return legs
