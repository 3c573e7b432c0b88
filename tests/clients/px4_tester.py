"""A vehicle flown with MAVSDK as in PX4's integration tests (PX4-Autopilot, test/mavsdk_tests): the same steps and
limits, with time measured by the vehicle's clock."""

import contextlib
import math
import threading
import time

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action, ActionError
from mavsdk.plugins.failure import Failure, FailureError
from mavsdk.plugins.follow_me import FollowMe
from mavsdk.plugins.manual_control import ManualControl
from mavsdk.plugins.mission import Mission, MissionError, MissionItem, MissionPlan
from mavsdk.plugins.mission_raw import MissionRaw
from mavsdk.plugins.offboard import Attitude, Offboard, OffboardError, VelocityNedYaw
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import LandedState, Telemetry

import spandrel

# Meters per degree of latitude (WGS 84 at 47 degrees north, accurate to 0.1%; legs are about ten meters long).
DEGREE_M = 111_170.0
# Speed of vehicle time relative to wall time.
SPEED = 5
# With a real PX4. MAVSDK's timers use wall time, and a busy computer is slower than five times real time.
REAL_SPEED = 2
# Polling interval, wall seconds.
LOOK_S = 0.01
# Wall seconds without progress on the vehicle's clock before a test gives up.
STUCK_S = 120.0
# Rate of stick inputs and setpoints, Hz in vehicle time.
STICK_RATE_HZ = 50


class Tester:
    """A simulator and MAVSDK's plugins for it."""

    def __init__(self, folder, scenario, instance=None):
        """With an instance number, a real PX4 flies, otherwise the built-in autopilot."""
        folder.mkdir(parents=True, exist_ok=True)
        port = spandrel.free_udp_port()
        real = [] if instance is None else ["--autopilot", "px4", "--autopilot-dir", str(folder / "work"), "--instance", str(instance)]
        self.process = spandrel.start_sim(folder, port, *real, scenario=scenario, speed=SPEED if instance is None else REAL_SPEED)
        self.mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
        self.mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        system = self.mavsdk.first_autopilot(30.0)
        assert system is not None, "no vehicle discovered"
        self.system = system
        self.action, self.telemetry, self.param = Action(system), Telemetry(system), Param(system)
        self.mission, self.mission_raw, self.offboard = Mission(system), MissionRaw(system), Offboard(system)
        self.failure, self.manual = Failure(system), ManualControl(system)
        self.home = None
        # With a real PX4, sticks that are sent while the stick flows wait until it can arm: without sticks, it loses its readiness in a stick mode, and
        # Spandrel's receiver makes its height check fail for moments, after which it does not become ready again. PX4's own tests send none here.
        self.real, self.waiting_sticks = instance is not None, None
        self.wrong = []
        self.watches = []

    def follow_me(self):
        """Returns the follow-me plugin."""
        return FollowMe(self.system)

    def close(self):
        """Stops everything that was started. The test fails if a watch has found a problem."""
        for stop, thread in self.watches:
            stop.set()
            thread.join()
        self.mavsdk.destroy()
        spandrel.end(self.process)
        assert not self.wrong, self.wrong[:5]

    # Time control

    def now_s(self):
        """Returns the time on the vehicle's clock in seconds."""
        return self.telemetry.attitude_quaternion().timestamp_us / 1e6

    def wait(self, what, predicate, limit_s):
        """Waits until the predicate is true, for at most `limit_s` seconds of vehicle time."""
        start, last, moved = self.now_s(), self.now_s(), time.monotonic()
        while True:
            value = predicate()
            if value:
                return value
            now = self.now_s()
            if now != last:
                last, moved = now, time.monotonic()
            assert now - start <= limit_s, f"not within {limit_s} s: {what}"
            assert time.monotonic() - moved < STUCK_S, f"the vehicle's clock stopped at {now}: {what}"
            if self.waiting_sticks:
                self.waiting_sticks()
            time.sleep(LOOK_S)

    def pass_time(self, seconds, meanwhile=None):
        """Lets some vehicle time pass; calls `meanwhile` at the stick rate."""
        end = self.now_s() + seconds
        due = self.now_s()
        while self.now_s() < end:
            if meanwhile and self.now_s() >= due:
                meanwhile()
                due += 1 / STICK_RATE_HZ
            time.sleep(LOOK_S / 5)

    def watch(self, what, look):
        """Calls `look`, which returns a problem or None, repeatedly until the end."""
        stop = threading.Event()

        def watching():
            while not stop.is_set():
                wrong = look()
                if wrong:
                    self.wrong.append(f"{what}: {wrong}")
                time.sleep(LOOK_S)

        thread = threading.Thread(target=watching)
        thread.start()
        self.watches.append((stop, thread))

    # Steps from PX4's tester

    def wait_until_ready(self):
        """Waits until the vehicle is healthy (30 s), then armable (45 s)."""
        self.wait("telemetry", lambda: self.now_s() > 0, math.inf)
        self.wait("healthy", self.telemetry.health_all_ok, 30)
        self.wait("armable", lambda: self.telemetry.health().is_armable, 45)

    def store_home(self):
        """Stores the current position from ground truth."""
        self.telemetry.set_rate_ground_truth(15)
        self.home = self.wait("ground truth", self.ground_truth, 10)

    def ground_truth(self):
        """Returns latitude and longitude in degrees, or None while unknown."""
        truth = self.telemetry.ground_truth()
        return (truth.latitude_deg, truth.longitude_deg) if math.isfinite(truth.latitude_deg) else None

    def distance_from_home_m(self):
        """Returns the horizontal distance from the stored home in meters."""
        latitude, longitude = self.ground_truth()
        east = (longitude - self.home[1]) * math.cos(math.radians(self.home[0]))
        return math.hypot(latitude - self.home[0], east) * DEGREE_M

    def arm(self):
        """Arms as soon as the vehicle allows it, within 30 s."""

        def armed():
            try:
                self.action.arm()
            except ActionError:
                return False
            return True

        self.wait("arming", armed, 30)

    def take_off(self, height_m=None):
        """Takes off to a height."""
        if height_m is not None:
            self.action.set_takeoff_altitude(height_m)
            assert abs(self.action.get_takeoff_altitude() - height_m) < 0.01
        self.action.takeoff()

    def wait_until_hovering(self):
        """Waits until the vehicle is in the air, at most 45 s."""
        self.wait("in the air", lambda: self.telemetry.landed_state() == LandedState.IN_AIR, 45)

    def wait_until_disarmed(self, limit_s):
        """Waits until the vehicle has disarmed."""
        self.wait("disarmed", lambda: not self.telemetry.armed(), limit_s)

    def position_ned(self):
        """Returns the position north, east and down in meters."""
        position = self.telemetry.position_velocity_ned().position
        return position.north_m, position.east_m, position.down_m

    def global_position_at(self, north_m, east_m):
        """Returns latitude and longitude of a position given in meters from home."""
        home = self.telemetry.home()
        latitude = home.latitude_deg + north_m / DEGREE_M
        return latitude, home.longitude_deg + east_m / (DEGREE_M * math.cos(math.radians(home.latitude_deg)))

    def upload(self, places, height_m=10.0, fly_through=False, return_at_end=False):
        """Uploads a mission with these positions in meters north and east of home."""
        items = []
        for north, east in places:
            latitude, longitude = self.global_position_at(north, east)
            items.append(MissionItem(latitude_deg=latitude, longitude_deg=longitude, relative_altitude_m=height_m, is_fly_through=fly_through))
        self.mission.set_return_to_launch_after_mission(return_at_end)
        self.mission.upload_mission(MissionPlan(items))
        return places

    def check_tracks(self, places, height_m, corridor_m):
        """Checks from now on that the vehicle stays within a distance of its current leg."""
        points = [(north, east, -height_m) for north, east in places]

        def off():
            current = self.mission.mission_progress().current
            if not 0 < current < len(points):
                return None
            away = distance_to_line(self.position_ned(), points[current - 1], points[current])
            return f"{away:.1f} m off leg {current}" if away > corridor_m else None

        self.watch("track", off)

    def start_mission(self):
        """Starts the mission, within 3 s."""

        def started():
            try:
                self.mission.start_mission()
            except MissionError:
                return False
            return True

        self.wait("the start of the mission", started, 3)

    def fly_mission(self, limit_s=500):
        """Flies the mission to its end."""
        self.start_mission()
        self.wait("the end of the mission", self.mission.is_mission_finished, limit_s)

    def inject(self, kind, *units):
        """Makes sensors fail after the first item has been reached."""
        self.param.set_param_int("SYS_FAILURE_EN", 1)
        self.start_mission()
        self.wait("item 1", lambda: self.mission.mission_progress().current >= 1, 60)
        # MAVSDK 4.1 reads the parameter only when the plugin is created.
        failure = Failure(self.system)
        for unit in units:
            failure.inject(unit, kind, 0)

    def rejected_failure_result(self, unit, kind):
        """Requests a failure that is not enabled and returns the name of the response."""
        try:
            self.failure.inject(unit, kind, 1)
        except FailureError as error:
            return str(error)
        return "accepted"

    def start_offboard(self, send):
        """Sends a setpoint until Offboard mode has started."""
        for _ in range(10):
            send()
            with contextlib.suppress(OffboardError):
                self.offboard.start()
                return
            time.sleep(0.02)
        raise AssertionError("Offboard did not start")

    def offboard_to(self, target, within_m, limit_s):
        """Flies to a local position and waits until the estimate is near it."""
        self.start_offboard(lambda: self.offboard.set_position_ned(target))
        place = (target.north_m, target.east_m, target.down_m)
        self.wait(f"{place}", lambda: math.dist(self.position_ned(), place) < within_m, limit_s)

    def offboard_land(self):
        """Descends at 1 m/s."""
        self.offboard.set_velocity_ned(VelocityNedYaw(0.0, 0.0, 1.0, 0.0))

    def sticks(self, forward, right, throttle, yaw):
        """Returns a function that holds the sticks in a position."""
        return lambda: self.manual.set_manual_control_input(forward, right, throttle, yaw)

    def fly_forward_by_sticks(self, begin):
        """Climbs for 5 s, flies forward for 10 s, and descends until landed."""
        centered = self.sticks(0, 0, 0.5, 0)
        self.pass_time(1, centered)
        begin()
        self.pass_time(1, centered)
        self.store_home()
        self.pass_time(1, centered)
        self.waiting_sticks = centered if self.real else None
        self.wait_until_ready()
        self.pass_time(1, centered)
        self.arm()
        self.waiting_sticks = None
        self.pass_time(5, self.sticks(0, 0, 1, 0))
        self.pass_time(10, self.sticks(0.5, 0, 0.5, 0))
        end = self.now_s() + 60
        while self.telemetry.in_air() and self.now_s() < end:
            self.pass_time(0.1, self.sticks(0, 0, 0, 0))

    def hold_attitude(self, attitude, seconds):
        """Sends an attitude setpoint at the stick rate."""
        self.pass_time(seconds, lambda: self.offboard.set_attitude(attitude))


def attitude(pitch_deg=0.0, thrust=0.0):
    """Returns an attitude setpoint."""
    return Attitude(0.0, pitch_deg, 0.0, thrust)


def distance_to_line(point, a, b):
    """Returns the distance of a point from the straight line through two other points, in the points' unit."""
    along = [q - p for p, q in zip(a, b)]
    length = math.dist(a, b)
    if length == 0:
        return math.dist(point, a)
    share = sum((p - q) * u for p, q, u in zip(point, a, along)) / length**2
    foot = [q + min(max(share, 0), 1) * u for q, u in zip(a, along)]
    return math.dist(point, foot)
