"""A vehicle emulating ArduCopter, flown with pymavlink as in ArduPilot's autotest. All times are vehicle time; the
vehicle runs in lockstep with this client."""

import math
import os

os.environ["MAVLINK20"] = "1"

from pymavlink import mavutil

import spandrel

M = mavutil.mavlink
MODES = {
    "STABILIZE": 0, "ACRO": 1, "ALT_HOLD": 2, "AUTO": 3, "GUIDED": 4, "LOITER": 5, "RTL": 6, "CIRCLE": 7, "LAND": 9, "POSHOLD": 16, "BRAKE": 17,
    "SMART_RTL": 21, "FOLLOW": 23,
}
# Channels 1 to 9 of a transmitter: sticks centered except the throttle, and switches.
CHANNELS = {1: 1500, 2: 1500, 3: 1000, 4: 1500, 5: 1500, 6: 1500, 7: 1500, 8: 1500, 9: 1500}
# Meters per degree of latitude (WGS 84, accurate to 0.5%).
DEGREE_M = 111_320.0
# Wall seconds without messages before a test gives up; the vehicle responds to every request immediately.
STUCK_S = 60.0
# Rate of streams and stick inputs, Hz in vehicle time.
RATE_HZ = 10
STICK_RATE_HZ = 25
# The vehicle in these flights can reach the speeds that the autotest requires.
VEHICLE = "m30"
POSITION_ONLY_MASK, IGNORE_ALL_BUT_VELOCITY = 0x0DF8, 0x0DC7


class Copter:
    """A simulator in lockstep with this client: 20 ms of its time pass with each response."""

    def __init__(self, folder, scenario="drill-hover"):
        folder.mkdir(parents=True, exist_ok=True)
        port = spandrel.free_udp_port()
        here = f"127.0.0.1:{port}"
        self.link = mavutil.mavlink_connection(f"udpin:{here}", source_system=255, source_component=190, dialect="ardupilotmega")
        more = ["--flavor", "ardupilot", "--vehicle", VEHICLE, "--lockstep", here, "--camera", "off"]
        self.process = spandrel.start_sim(folder, port, *more, speed="max", scenario=scenario)
        self.now = 0.0
        self.last = {}
        self.texts = []
        self.channels = dict(CHANNELS)
        self.transmits = True
        self.watches = []
        self.stick_due = self.beat_due = 0.0
        self.step()
        self.link.mav.request_data_stream_send(1, 1, M.MAV_DATA_STREAM_ALL, RATE_HZ, 1)
        self.wait_until("armable", lambda: self.has_received("SYS_STATUS") and self.last["SYS_STATUS"].onboard_control_sensors_health & M.MAV_SYS_STATUS_PREARM_CHECK, 60)

    def close(self):
        """Stops everything that was started."""
        self.link.close()
        spandrel.end(self.process)

    # Time control

    def step(self):
        """Advances by 20 ms."""
        while True:
            message = self.link.recv_match(blocking=True, timeout=STUCK_S)
            assert message is not None, f"no message at {self.now:.2f} s; {self.texts[-5:]}"
            kind = message.get_type()
            if message.get_srcSystem() != 1 or kind == "BAD_DATA":
                continue
            if kind == "TIMESYNC" and message.tc1 == 0:
                self.now = message.ts1 / 1e9
                self.send_inputs()
                self.link.mav.timesync_send(1, message.ts1)
                return
            self.last[kind] = message
            if kind == "STATUSTEXT":
                self.texts.append(message.text)

    def send_inputs(self):
        """Sends sticks and heartbeats at their rates."""
        if self.now >= self.beat_due:
            self.beat_due = self.now + 1.0
            self.link.mav.heartbeat_send(M.MAV_TYPE_GCS, M.MAV_AUTOPILOT_INVALID, 0, 0, 0)
        if self.transmits and self.now >= self.stick_due:
            self.stick_due = self.now + 1 / STICK_RATE_HZ
            self.link.mav.rc_channels_override_send(1, 1, *[self.channels[channel] for channel in range(1, 9)], self.channels[9])

    def wait_until(self, what, predicate, limit_s):
        """Waits until the predicate is true, for at most `limit_s` seconds of vehicle time, and returns the time that
        it took."""
        start = self.now
        while not predicate():
            assert self.now - start <= limit_s, f"not within {limit_s} s: {what}; {self.texts[-5:]}"
            self.step()
            for watched, wrong in self.watches:
                assert not wrong(), f"{watched} while waiting for {what}"
        return self.now - start

    def pass_time(self, seconds):
        """Lets some vehicle time pass."""
        end = self.now + seconds
        self.wait_until(f"{seconds} s", lambda: self.now >= end, seconds + 1)

    def check_stays_true(self, what, predicate, seconds):
        """Checks that the predicate stays true."""
        end = self.now + seconds
        while self.now < end:
            assert predicate(), f"{what} at {self.now:.1f} s"
            self.step()

    def wait_until_settled(self, what, predicate, seconds, limit_s):
        """Waits until the predicate has been true for `seconds` without interruption."""
        since = None

        def held():
            nonlocal since
            since = (since if since is not None else self.now) if predicate() else None
            return since is not None and self.now - since >= seconds

        self.wait_until(what, held, limit_s)

    # Telemetry

    def has_received(self, kind):
        """Returns whether a message of this kind has arrived."""
        return kind in self.last

    @property
    def height(self):
        """Returns the height above home in meters."""
        return self.last["GLOBAL_POSITION_INT"].relative_alt / 1000

    @property
    def speed(self):
        """Returns the ground speed in m/s."""
        return self.last["VFR_HUD"].groundspeed

    @property
    def climb_rate(self):
        """Returns the climb rate in m/s."""
        return -self.last["GLOBAL_POSITION_INT"].vz / 100

    @property
    def heading(self):
        """Returns the heading in degrees."""
        return self.last["GLOBAL_POSITION_INT"].hdg / 100

    @property
    def position_m(self):
        """Returns the position north and east of the first home, in meters."""
        here = self.last["GLOBAL_POSITION_INT"]
        return self.offset_m(here.lat / 1e7, here.lon / 1e7)

    @property
    def current_item(self):
        """Returns the current mission item."""
        return self.last["MISSION_CURRENT"].seq

    @property
    def armed(self):
        """Returns whether the motors are armed."""
        return bool(self.last["HEARTBEAT"].base_mode & M.MAV_MODE_FLAG_SAFETY_ARMED)

    def is_in_mode(self, mode):
        """Returns whether the heartbeat reports this mode."""
        return self.last["HEARTBEAT"].custom_mode == MODES[mode]

    def home(self):
        """Returns the latitude and longitude of home in degrees."""
        if "HOME_POSITION" not in self.last:
            self.request_message(242)
            self.wait_until("home", lambda: self.has_received("HOME_POSITION"), 5)
        home = self.last["HOME_POSITION"]
        return home.latitude / 1e7, home.longitude / 1e7

    def offset_m(self, latitude, longitude):
        """Converts a geographic position to meters north and east of home."""
        north, east = (latitude - self.home()[0]) * DEGREE_M, (longitude - self.home()[1]) * DEGREE_M
        return north, east * math.cos(math.radians(latitude))

    def degrees(self, north_m, east_m):
        """Converts meters from home to latitude and longitude in 1e-7 degrees."""
        latitude, longitude = self.home()
        east = east_m / DEGREE_M / math.cos(math.radians(latitude))
        return round((latitude + north_m / DEGREE_M) * 1e7), round((longitude + east) * 1e7)

    def distance_from_m(self, position_m=(0.0, 0.0)):
        """Returns the distance from a position in meters."""
        return math.dist(self.position_m, position_m)

    def heading_error_deg(self, heading):
        """Returns the difference between the vehicle's heading and a given heading in degrees."""
        return abs((self.heading - heading + 180) % 360 - 180)

    # Commands

    def command(self, command, *values):
        """Sends a command and returns the name of its result."""
        self.last.pop("COMMAND_ACK", None)
        self.link.mav.command_long_send(1, 1, command, 0, *values, *[0] * (7 - len(values)))
        self.wait_until(f"the response to {command}", lambda: self.has_received("COMMAND_ACK") and self.last["COMMAND_ACK"].command == command, 5)
        return M.enums["MAV_RESULT"][self.last["COMMAND_ACK"].result].name.removeprefix("MAV_RESULT_")

    def command_accepted(self, command, *values):
        """Sends a command that must be accepted."""
        assert self.command(command, *values) == "ACCEPTED", (command, values, self.texts[-3:])

    def request_message(self, message):
        """Requests a message."""
        self.command_accepted(M.MAV_CMD_REQUEST_MESSAGE, message)

    def set(self, **parameters):
        """Sets parameters and waits for confirmation."""
        for name, value in parameters.items():
            self.last.pop("PARAM_VALUE", None)
            self.link.mav.param_set_send(1, 1, name.encode(), value, M.MAV_PARAM_TYPE_REAL32)
            self.wait_until(name, lambda name=name: self.has_received("PARAM_VALUE") and self.last["PARAM_VALUE"].param_id == name, 5)
            assert math.isclose(self.last["PARAM_VALUE"].param_value, value, rel_tol=1e-5), name

    def set_sticks(self, **channels):
        """Moves sticks (roll, pitch, throttle, yaw) and switches (channels c5 to c9)."""
        names = {"roll": 1, "pitch": 2, "throttle": 3, "yaw": 4}
        for name, pulse in channels.items():
            self.channels[names.get(name) or int(name[1:])] = pulse

    def set_mode(self, mode):
        """Changes the mode with a command."""
        self.command_accepted(M.MAV_CMD_DO_SET_MODE, M.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, MODES[mode])
        self.wait_until(mode, lambda: self.is_in_mode(mode), 5)

    def arm(self):
        """Arms the motors."""
        self.command_accepted(M.MAV_CMD_COMPONENT_ARM_DISARM, 1)
        self.wait_until("armed", lambda: self.armed, 5)

    def take_off(self, height_m, mode="GUIDED"):
        """Takes off to a height: with a command in GUIDED mode, with the throttle in manual modes."""
        self.set_mode(mode)
        self.arm()
        if mode == "GUIDED":
            self.command_accepted(M.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, height_m)
        else:
            self.set_sticks(throttle=1700)
        self.wait_until(f"{height_m} m", lambda: self.height > height_m - 1, 60)
        self.set_sticks(throttle=1500)

    def until_disarmed(self, limit_s=180):
        """Waits until the vehicle has landed and disarmed."""
        self.wait_until("disarmed", lambda: not self.armed, limit_s)

    def return_and_land(self):
        """Returns home, lands and disarms."""
        self.set_sticks(**{"roll": 1500, "pitch": 1500, "throttle": 1500, "yaw": 1500})
        self.set_mode("RTL")
        self.until_disarmed()

    def upload(self, items, kind=0):
        """Uploads a plan: (command, north m, east m, height m, *parameters). In a mission, home becomes item 0."""
        whole = [(M.MAV_CMD_NAV_WAYPOINT, 0, 0, 0), *items] if kind == 0 else items
        self.last.pop("MISSION_ACK", None)
        self.last.pop("MISSION_REQUEST", None)
        self.link.mav.mission_count_send(1, 1, len(whole), kind)
        for seq, (command, north, east, height, *values) in enumerate(whole):
            wants = lambda seq=seq: self.has_received("MISSION_REQUEST") and self.last["MISSION_REQUEST"].seq == seq
            self.wait_until(f"a request for item {seq}", wants, 5)
            x, y = self.degrees(north, east) if command < M.MAV_CMD_NAV_DELAY and command != M.MAV_CMD_NAV_RETURN_TO_LAUNCH or kind else (0, 0)
            values = [*values, *[0] * (4 - len(values))]
            frame = M.MAV_FRAME_GLOBAL_RELATIVE_ALT
            self.link.mav.mission_item_int_send(1, 1, seq, frame, command, 0, 1, *values, x, y, height, kind)
        self.wait_until("the end of the upload", lambda: self.has_received("MISSION_ACK"), 5)
        assert self.last["MISSION_ACK"].type == M.MAV_MISSION_ACCEPTED, self.last["MISSION_ACK"]

    def start_auto(self):
        """Arms in AUTO, which takes off immediately."""
        self.set(AUTO_OPTIONS=3)
        self.set_mode("AUTO")
        self.arm()

    def send_setpoint(self, north=0.0, east=0.0, up=0.0, velocity=None):
        """Sends a setpoint in the local frame: a position or a velocity."""
        mask = IGNORE_ALL_BUT_VELOCITY if velocity else POSITION_ONLY_MASK
        vx, vy, vz = velocity or (0, 0, 0)
        self.link.mav.set_position_target_local_ned_send(0, 1, 1, M.MAV_FRAME_LOCAL_NED, mask, north, east, -up, vx, vy, vz, 0, 0, 0, 0, 0)
