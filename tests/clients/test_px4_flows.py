"""The multicopter cases from PX4's own integration tests, with their limits, in the shipped job and above flat ground.
Omitted because the built-in autopilot lacks the feature: optical flow, terrain estimate without GNSS, several instances
of sensors or estimators (EKF and GNSS selectors), control allocation of more than four motors, VTOL and fixed wing,
gravity of the SIH simulator, "Follow target - RC Adjustment". Parameters by FTP are tested in test_transfers.py, home and geofence in test_plans.py.

With SPANDREL_PX4, a real PX4 also flies the cases on the simulated aircraft.
"""

import concurrent.futures
import math
import os

import pytest
from mavsdk.plugins.failure import FailureType, FailureUnit
from mavsdk.plugins.follow_me import Config, TargetLocation
from mavsdk.plugins.mission_raw import MissionItem as RawItem
from mavsdk.plugins.offboard import PositionNedYaw

import real_autopilot
from px4_tester import Tester, attitude

# Number of parallel flights; each one needs little processor time.
AT_ONCE = 6
# The shipped job is on a slope above a lake; the drill is above level ground.
SCENARIOS = ["two-bridges", "drill-hover"]
LEG_M, HEIGHT_M = 20.0, 10.0
SQUARE = [(LEG_M, 0.0), (LEG_M, LEG_M), (0.0, LEG_M)]
# Eastward, where there are no obstacles for 80 m; the arch of the shipped job is 68 m north of its pad.
STRAIGHT = [(0.0, k * LEG_M) for k in range(5)]
NEAR_M = 0.3
# A real PX4 uses most of a core at two times real time. Its instances must differ from those of other tests that may run.
REAL_AT_ONCE = 2
FIRST_REAL_INSTANCE = 80


def takeoff_and_hold(t):
    """After settling for 5 s, the vehicle must be within 0.2 m of its height. PX4's test requires 0.1 m at 10 m after
    15 s. Unlike PX4's simulated GNSS, this one drifts, and the height above home drifts with it."""
    t.wait_until_ready()
    t.store_home()
    t.arm()
    t.take_off(10.0)
    t.wait_until_hovering()
    t.wait("10 m", lambda: abs(10.0 + t.position_ned()[2]) <= 0.35, 30)
    t.pass_time(5)
    held = t.position_ned()[2]
    t.watch("height", lambda: f"{t.position_ned()[2] - held:.2f} m" if abs(t.position_ned()[2] - held) > 0.2 else None)
    t.pass_time(15)


def takeoff_and_land(t):
    t.wait_until_ready()
    t.arm()
    t.take_off()
    t.wait_until_hovering()
    t.action.land()
    t.wait_until_disarmed(180)


def square_mission_with_return(t):
    t.wait_until_ready()
    t.upload(SQUARE, return_at_end=True)
    t.arm()
    t.fly_mission()
    t.wait_until_disarmed(180)


def square_mission_then_return(t):
    t.wait_until_ready()
    t.check_tracks(t.upload(SQUARE), HEIGHT_M, 5.0)
    t.arm()
    t.fly_mission()
    t.wait_until_hovering()
    t.action.return_to_launch()
    t.wait_until_disarmed(180)


def straight_mission(t):
    """Must be faster than 4 m/s during the whole third leg, between waypoints that are flown through."""
    t.wait_until_ready()
    t.check_tracks(t.upload(STRAIGHT, fly_through=True), HEIGHT_M, 5.0)
    t.telemetry.set_rate_velocity_ned(10)

    def slow():
        before = t.mission.mission_progress().current
        velocity = t.telemetry.velocity_ned()
        speed = math.hypot(velocity.north_m_s, velocity.east_m_s)
        on_leg = before == t.mission.mission_progress().current == 2
        return f"{speed:.2f} m/s" if on_leg and speed <= 4.0 else None

    t.watch("speed", slow)
    t.arm()
    t.fly_mission()
    t.wait_until_hovering()
    t.action.return_to_launch()
    t.wait_until_disarmed(180)


def offboard_takeoff_and_land(t):
    t.wait_until_ready()
    t.store_home()
    t.param.set_param_int("COM_RCL_EXCEPT", 4)
    t.arm()
    t.offboard_to(PositionNedYaw(0.0, 0.0, -2.0, 0.0), NEAR_M, 90)
    t.offboard_land()
    t.wait_until_disarmed(120)
    assert t.distance_from_home_m() < 2.0


def offboard_positions(t):
    t.wait_until_ready()
    t.store_home()
    t.param.set_param_int("COM_RCL_EXCEPT", 4)
    t.arm()
    above = PositionNedYaw(0.0, 0.0, -2.0, 0.0)
    for target in [above, PositionNedYaw(0.0, 5.0, -2.0, 180.0), PositionNedYaw(5.0, 5.0, -4.0, 180.0), PositionNedYaw(5.0, 0.0, -4.0, 90.0), above]:
        t.offboard_to(target, NEAR_M, 10)
    t.offboard_land()
    t.wait_until_disarmed(120)
    assert t.distance_from_home_m() < 2.0


def offboard_attitude(t):
    """Climbs with thrust only, leans forward for 3 s, descends."""
    t.param.set_param_int("COM_RCL_EXCEPT", 4)

    def level():
        angles = t.telemetry.attitude_euler()
        return t.telemetry.raw_gps().altitude_ellipsoid_m > 0 and abs(angles.roll_deg) < 5 and abs(angles.pitch_deg) < 5

    t.wait("level and with a height above the ellipsoid", level, 20)
    start_m = t.telemetry.raw_gps().altitude_ellipsoid_m
    t.start_offboard(lambda: t.offboard.set_attitude(attitude()))
    t.wait("armable", lambda: t.telemetry.health().is_armable, 20)
    t.arm()
    end = t.now_s() + 60
    while t.telemetry.raw_gps().altitude_ellipsoid_m - start_m < 10.0:
        t.hold_attitude(attitude(thrust=0.8), 0.1)
        assert t.now_s() < end, "no climb"
    t.hold_attitude(attitude(-20.0, 0.8), 3.0)
    angles = t.telemetry.attitude_euler()
    assert abs(angles.roll_deg) < 5 and abs(angles.pitch_deg + 20) < 5, angles
    t.hold_attitude(attitude(thrust=0.4), 6.0)
    t.offboard.set_attitude(attitude())
    t.wait_until_disarmed(120)


def forward_in_position_control(t):
    t.fly_forward_by_sticks(t.manual.start_position_control)
    t.wait_until_disarmed(180)
    assert t.distance_from_home_m() > 5.0


def forward_in_altitude_control(t):
    t.fly_forward_by_sticks(t.manual.start_altitude_control)
    t.wait_until_disarmed(180)
    assert t.distance_from_home_m() > 5.0


def land_without_gnss(height_source):
    def flow(t):
        t.param.set_param_int("EKF2_HGT_REF", height_source)
        # PX4's default; the simulated aircraft could continue on its inertial sensors for a minute.
        t.param.set_param_int("EKF2_NOAID_TOUT", 5_000_000)
        t.wait_until_ready()
        t.upload(SQUARE, return_at_end=True)
        t.arm()
        # PX4's simulated aircraft has no other position source; this one has optical flow.
        t.inject(FailureType.OFF, FailureUnit.SENSOR_OPTICAL_FLOW, FailureUnit.SENSOR_GPS)
        t.wait_until_disarmed(30)

    return flow


def continue_without_sensor(unit, kind, height_source=None, finish_s=90, disarm_s=90):
    """The mission must continue to its end when a sensor fails."""

    def flow(t):
        if height_source is not None:
            t.param.set_param_int("EKF2_HGT_REF", height_source)
        t.wait_until_ready()
        t.upload(SQUARE, return_at_end=True)
        t.arm()
        t.inject(kind, unit)
        t.wait("the end of the mission", t.mission.is_mission_finished, finish_s)
        t.wait_until_disarmed(disarm_s)

    return flow


def no_failure_injection_in_the_air_unless_enabled(t):
    t.wait_until_ready()
    t.arm()
    t.take_off()
    t.wait_until_hovering()
    assert "DISABLED" in t.rejected_failure_result(FailureUnit.SYSTEM_MOTOR, FailureType.OFF).upper()
    t.action.return_to_launch()
    t.wait_until_disarmed(180)


def no_failure_injection_on_the_ground_unless_enabled(t):
    t.wait_until_ready()
    assert "DISABLED" in t.rejected_failure_result(FailureUnit.SYSTEM_MOTOR, FailureType.OFF).upper()


def set_current_item_to_jump(t):
    """MISSION_SET_CURRENT to a DO_JUMP: the jump is resolved and the mission ends on the ground."""
    t.wait_until_ready()

    def item(seq, command, north, east, z, params=(0.0, 0.0), frame=6):
        latitude, longitude = t.global_position_at(north, east)
        x, y = (round(latitude * 1e7), round(longitude * 1e7)) if frame == 6 else (0, 0)
        return RawItem(seq, frame, command, int(seq == 0), 1, params[0], params[1], 0.0, 0.0, x, y, z, 0)

    leg, height = 100.0, 15.0
    t.mission_raw.upload_mission([
        item(0, 22, 0, 0, height), item(1, 16, leg, 0, height), item(2, 16, leg, leg, height), item(3, 177, 0, 0, 0.0, (1.0, 1.0), frame=2),
        item(4, 16, 0, leg, height), item(5, 21, 0, 0, 0.0),
    ])
    t.arm()
    t.start_mission()
    t.wait("item 2", lambda: t.mission_raw.mission_progress().current >= 2, 120)
    # Sent once, as an operator does; MAVSDK would repeat it until this number is current, which a jump never becomes.
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        pool.submit(lambda: t.mission_raw.set_current_mission_item(3))
    t.wait_until_disarmed(240)


def follow(stream_velocity):
    """A target moves north at 2 m/s; the vehicle follows it from behind, from the front and from both sides."""

    def flow(t):
        t.wait_until_ready()
        t.store_home()
        t.arm()
        t.take_off(10.0)
        t.wait_until_hovering()
        me, start = t.follow_me(), t.position_ned()
        config = Config(10.0, 8.0, 0.1, Config.FollowAltitudeMode.CONSTANT, 15.0, 0.0)
        t.pass_time(1)
        me.start()
        t.pass_time(1)
        north, tolerance_m = start[0], 11.0
        angles = {5: 180.0, 20: 0.0, 35: 45.0, 55: -45.0}
        checked = set(range(15, 20)) | set(range(30, 35)) | set(range(45, 55)) | set(range(65, 75))
        altitude_m = t.telemetry.home().absolute_altitude_m
        for k in range(75):
            if k in angles:
                config.follow_angle_deg = angles[k]
                me.set_config(config)
            if k > 5:
                north += 2.0
            if k in checked:
                here = t.position_ned()
                assert abs(t.telemetry.position().relative_altitude_m - 10.0) <= 1.5, (k, here)
                away = math.dist(here, (north, start[1], start[2]))
                assert abs(away - 8.0) <= tolerance_m, (k, away)
                angle = math.radians(config.follow_angle_deg)
                assert abs(here[0] - north - 8.0 * math.cos(angle)) < tolerance_m, (k, here, north)
                assert abs(here[1] - start[1] - 8.0 * math.sin(angle)) < tolerance_m, (k, here)
            latitude, longitude = t.global_position_at(north, start[1])
            velocity = (2.0 if k > 5 else 0.0, 0.0, 0.0) if stream_velocity else (math.nan,) * 3
            me.set_target_location(TargetLocation(latitude, longitude, altitude_m, *velocity))
            t.pass_time(1)
        me.stop()
        t.action.land()
        t.wait_until_disarmed(300)

    return flow


def follow_velocity_only(t):
    """A target without a position must not move the vehicle."""
    t.wait_until_ready()
    t.store_home()
    t.arm()
    t.take_off(10.0)
    t.wait_until_hovering()
    me = t.follow_me()
    me.set_config(Config(8.0, 8.0, 0.1, Config.FollowAltitudeMode.CONSTANT, 5.0, 180.0))
    t.pass_time(1)
    me.start()
    t.pass_time(1)
    before = t.position_ned()
    for _ in range(15):
        me.set_target_location(TargetLocation(math.nan, math.nan, math.nan, 2.0, 1.0, 0.5))
        t.pass_time(1)
    assert math.dist(before, t.position_ned()) < 4.0
    t.action.land()
    t.wait_until_disarmed(300)
    assert t.distance_from_home_m() < 1.0


BARO, GNSS = 0, 1
FLOWS = {
    "take off and hold position": takeoff_and_hold,
    "take off and land": takeoff_and_land,
    "square mission with return": square_mission_with_return,
    "square mission, then return": square_mission_then_return,
    "straight mission": straight_mission,
    "Offboard takeoff and landing": offboard_takeoff_and_land,
    "Offboard positions": offboard_positions,
    "Offboard attitude": offboard_attitude,
    "forward in position control": forward_in_position_control,
    "forward in altitude control": forward_in_altitude_control,
    "land without GNSS, height by barometer": land_without_gnss(BARO),
    "land without GNSS, height by GNSS": land_without_gnss(GNSS),
    "continue without compass": continue_without_sensor(FailureUnit.SENSOR_MAG, FailureType.OFF, disarm_s=120),
    "continue with a stuck compass": continue_without_sensor(FailureUnit.SENSOR_MAG, FailureType.STUCK, finish_s=120),
    "continue without barometer, height by barometer": continue_without_sensor(FailureUnit.SENSOR_BARO, FailureType.OFF, BARO),
    "continue without barometer, height by GNSS": continue_without_sensor(FailureUnit.SENSOR_BARO, FailureType.OFF, GNSS),
    "continue with a stuck barometer, height by barometer": continue_without_sensor(FailureUnit.SENSOR_BARO, FailureType.STUCK, BARO),
    "continue with a stuck barometer, height by GNSS": continue_without_sensor(FailureUnit.SENSOR_BARO, FailureType.STUCK, GNSS),
    "no failure injection in the air unless enabled": no_failure_injection_in_the_air_unless_enabled,
    "no failure injection on the ground unless enabled": no_failure_injection_on_the_ground_unless_enabled,
    "set current item to a jump": set_current_item_to_jump,
    "follow by position": follow(False),
    "follow by position and velocity": follow(True),
    "follow by velocity only": follow_velocity_only,
}


def fly(flow, folder, scenario, instance=None):
    tester = Tester(folder, scenario, instance)
    try:
        flow(tester)
    finally:
        tester.close()


# The target moves 140 m north, through the arch of the shipped job.
ONLY_OVER_LEVEL_GROUND = {"follow by position", "follow by position and velocity"}
FLIGHTS = [(name, scenario) for name in FLOWS for scenario in SCENARIOS if scenario != "two-bridges" or name not in ONLY_OVER_LEVEL_GROUND]


def begin(at_once, flights):
    """Starts flights, some in parallel, from the arguments of `fly` by flight; yields their futures."""
    with concurrent.futures.ThreadPoolExecutor(at_once) as pool:
        begun = {flight: pool.submit(fly, *arguments) for flight, arguments in flights.items()}
        yield begun
        for flight in begun.values():
            flight.cancel()


@pytest.fixture(scope="module", name="flights")
def fixture_flights(tmp_path_factory):
    """Starts all flights; the tests below check their results."""
    folder = tmp_path_factory.mktemp("px4")
    yield from begin(AT_ONCE, {flight: (FLOWS[flight[0]], folder / f"{k}-{flight[1]}", flight[1]) for k, flight in enumerate(FLIGHTS)})


@pytest.mark.timeout(1800)
@pytest.mark.parametrize(("name", "scenario"), FLIGHTS)
def test_wire_px4_flow_passes(flights, name, scenario):
    """Checks that the flight passed, as on PX4."""
    flights[name, scenario].result()


# These also fail on PX4 with its own simulator: MAVSDK reports that a failure that PX4 ignores was accepted, the mission with the jump does not end, and
# MAVSDK reports that Follow Me is not active.
NOT_ON_REAL_PX4 = {
    "no failure injection in the air unless enabled", "no failure injection on the ground unless enabled", "set current item to a jump",
    "follow by position", "follow by position and velocity", "follow by velocity only",
}
REAL_FLOWS = [name for name in FLOWS if name not in NOT_ON_REAL_PX4]


@pytest.fixture(scope="module", name="real_flights")
def fixture_real_flights(tmp_path_factory):
    """Starts all flights with a real PX4; each has an instance number of its own."""
    folder = tmp_path_factory.mktemp("real-px4")
    yield from begin(REAL_AT_ONCE, {name: (FLOWS[name], folder / str(k), "drill-hover", FIRST_REAL_INSTANCE + k) for k, name in enumerate(REAL_FLOWS)})


@pytest.mark.timeout(1800)
@pytest.mark.skipif(not os.environ.get(real_autopilot.VARIABLES["px4"]), reason="SPANDREL_PX4 is not set")
@pytest.mark.parametrize("name", REAL_FLOWS)
def test_wire_real_px4_flow_passes(real_flights, name):
    """Checks that a real PX4 passes the flow on the simulated aircraft."""
    real_flights[name].result()
