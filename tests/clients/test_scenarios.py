"""Tests the requirements of MAVSDK's and PX4's own system tests: streams, information, commanded flights, missions in
MAVSDK's own format, sticks and loss of stick input, flight termination."""

import math
import time

import pytest
from mavsdk.plugins.action import Action, OrbitYawBehavior, RelayCommand
from mavsdk.plugins.info import Info, InfoError
from mavsdk.plugins.manual_control import ManualControl
from mavsdk.plugins.mission import Mission, MissionItem, MissionPlan
from mavsdk.plugins.mission_raw import MissionItem as RawItem
from mavsdk.plugins.mission_raw import MissionRaw
from mavsdk.plugins.telemetry import FlightMode, LandedState

import spandrel
from spandrel import wait_for

NAN = float("nan")
# Degrees of latitude per meter.
DEGREES_PER_METER = 360.0 / 40_000_000.0
# Tolerance between estimate and truth, m: GNSS errs by meters, the barometer by one.
TRUTH_M = 5.0
# Tolerance between commanded and reported values, m.
NEAR_M = 1.2


def take_off(action, telemetry, height_m):
    """Arms, takes off and waits for the hover at a height."""
    action.set_takeoff_altitude(height_m)
    assert action.get_takeoff_altitude() == height_m
    action.arm()
    action.takeoff()
    wait_for("the hover", lambda: telemetry.flight_mode() == FlightMode.HOLD)
    assert abs(telemetry.position().relative_altitude_m - height_m) < NEAR_M


def away_m(telemetry, latitude_deg, longitude_deg):
    """Returns the horizontal distance to a position in meters."""
    p = telemetry.position()
    north = (p.latitude_deg - latitude_deg) / DEGREES_PER_METER
    east = (p.longitude_deg - longitude_deg) / DEGREES_PER_METER * math.cos(math.radians(latitude_deg))
    return math.hypot(north, east)


@pytest.mark.timeout(600)
def test_wire_mavsdk_receives_all_streams_and_the_identification(vehicle):
    """All streams of a multirotor arrive with finite numbers; truth and estimate agree; the vehicle identifies
    itself."""
    system, telemetry = vehicle
    for name in ("position", "home", "velocity_ned", "gps_info", "battery", "odometry", "position_velocity_ned", "ground_truth", "imu",
                 "scaled_imu", "raw_imu", "distance_sensor", "altitude", "actuator_output_status"):
        getattr(telemetry, f"set_rate_{name}")(20.0)
    finite = {
        "position": lambda v: v.latitude_deg, "home": lambda v: v.latitude_deg, "attitude_quaternion": lambda v: v.w,
        "attitude_euler": lambda v: v.yaw_deg, "attitude_angular_velocity_body": lambda v: v.yaw_rad_s,
        "velocity_ned": lambda v: v.north_m_s, "gps_info": lambda v: v.num_satellites or NAN, "raw_gps": lambda v: v.hdop,
        "battery": lambda v: v.voltage_v, "odometry": lambda v: v.q.w, "position_velocity_ned": lambda v: v.position.north_m,
        "ground_truth": lambda v: v.latitude_deg, "imu": lambda v: v.acceleration_frd.down_m_s2,
        "scaled_imu": lambda v: v.acceleration_frd.down_m_s2, "raw_imu": lambda v: v.acceleration_frd.down_m_s2,
        "unix_epoch_time": lambda v: v or NAN, "distance_sensor": lambda v: v.current_distance_m,
        "scaled_pressure": lambda v: v.absolute_pressure_hpa, "heading": lambda v: v.heading_deg,
        "altitude": lambda v: v.altitude_relative_m, "actuator_output_status": lambda v: float(v.active) if v.active else NAN,
    }
    for name, number in finite.items():
        wait_for(name, lambda: math.isfinite(number(getattr(telemetry, name)())), limit_s=60)
    truth, told = telemetry.ground_truth(), telemetry.position()
    assert away_m(telemetry, truth.latitude_deg, truth.longitude_deg) < TRUTH_M
    assert abs(truth.absolute_altitude_m - told.absolute_altitude_m) < TRUTH_M
    assert telemetry.landed_state() == LandedState.ON_GROUND and not telemetry.in_air()
    assert abs(telemetry.imu().acceleration_frd.down_m_s2 + 9.8) < 0.5
    info = Info(system)
    version = info.get_version()
    assert (version.flight_sw_major, version.os_sw_major) >= (1, 0)
    assert info.get_identification().hardware_uid and info.get_product() is not None

    def speed():
        try:
            return info.get_speed_factor()
        except InfoError:
            return None

    assert abs(wait_for("the speed", lambda: (f := speed()) and math.isfinite(f) and f) - spandrel.SPEED) < 0.5 * spandrel.SPEED


@pytest.mark.timeout(600)
def test_wire_mavsdk_commands_a_flight_and_a_return(vehicle):
    """Takeoff height, go-to with a heading, a circle, a speed, hold, and return at the return height. The vehicle lands
    and disarms at home."""
    system, telemetry = vehicle
    action = Action(system)
    with pytest.raises(Exception):
        action.set_takeoff_altitude(-3.0)
    take_off(action, telemetry, 8.0)
    home = telemetry.home()
    north = home.latitude_deg + 25.0 * DEGREES_PER_METER
    action.set_current_speed(4.0)
    action.goto_location(north, home.longitude_deg, home.absolute_altitude_m + 10.0, 90.0)
    wait_for("the place", lambda: away_m(telemetry, north, home.longitude_deg) < NEAR_M)
    wait_for("the height", lambda: abs(telemetry.position().relative_altitude_m - 10.0) < NEAR_M)
    wait_for("the heading", lambda: abs(telemetry.heading().heading_deg - 90.0) < 5.0)
    action.do_orbit(10.0, 3.0, OrbitYawBehavior.HOLD_FRONT_TO_CIRCLE_CENTER, NAN, NAN, NAN)
    wait_for("the circle", lambda: abs(away_m(telemetry, north, home.longitude_deg) - 10.0) < NEAR_M)
    action.hold()
    wait_for("a hold", lambda: telemetry.flight_mode() == FlightMode.HOLD)
    action.set_relay(0, RelayCommand.ON)
    action.set_actuator(1, 1.0)
    with pytest.raises(Exception):
        action.set_relay(5, RelayCommand.ON)
    action.set_return_to_launch_altitude(15.0)
    assert action.get_return_to_launch_altitude() == 15.0
    action.return_to_launch()
    wait_for("the return's height", lambda: telemetry.position().relative_altitude_m > 14.0)
    wait_for("the landing", lambda: telemetry.landed_state() == LandedState.LANDING)
    wait_for("disarmed", lambda: not telemetry.armed())
    assert away_m(telemetry, home.latitude_deg, home.longitude_deg) < NEAR_M
    action.reboot()
    wait_for("ready again", telemetry.health_all_ok)


@pytest.mark.timeout(600)
def test_wire_mavsdk_flies_a_square_with_pictures_and_returns(vehicle):
    """A mission in MAVSDK's own format, with speeds, gimbal commands, pictures, delays, a jump to an item, and a final
    return."""
    system, telemetry = vehicle
    action, mission = Action(system), Mission(system)
    home = wait_for("home", lambda: (h := telemetry.home()) and math.isfinite(h.latitude_deg) and h)
    scale = math.cos(math.radians(home.latitude_deg))
    corners = [(10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.0)]
    picture = MissionItem.CameraAction.TAKE_PHOTO
    items = [
        MissionItem(
            home.latitude_deg + n * DEGREES_PER_METER, home.longitude_deg + e * DEGREES_PER_METER / scale, 8.0, speed_m_s=3.0 + k, is_fly_through=k % 2 == 0,
            gimbal_pitch_deg=-20.0 * k, camera_action=picture if k else None, loiter_time_s=1.0 if k % 2 else NAN, acceptance_radius_m=1.0,
            yaw_deg=NAN,
        )
        for k, (n, e) in enumerate(corners)
    ]
    mission.set_return_to_launch_after_mission(True)
    assert mission.get_return_to_launch_after_mission()
    mission.upload_mission(MissionPlan(items))
    back = mission.download_mission().mission_items
    assert [round(i.speed_m_s, 3) for i in back] == [3.0, 4.0, 5.0, 6.0]
    assert [i.camera_action for i in back] == [i.camera_action for i in items]
    action.arm()
    mission.start_mission()
    wait_for("the second corner", lambda: mission.mission_progress().current >= 2)
    mission.set_current_mission_item(3)
    wait_for("the last corner", lambda: mission.mission_progress().current >= 4)
    wait_for("disarmed at home", lambda: not telemetry.armed())
    assert away_m(telemetry, home.latitude_deg, home.longitude_deg) < NEAR_M
    mission.clear_mission()
    with pytest.raises(Exception):
        mission.start_mission()


@pytest.mark.timeout(600)
def test_wire_mavsdk_transfers_500_items(vehicle):
    """A plan of 500 items is uploaded and downloaded."""
    system, _telemetry = vehicle
    mission = MissionRaw(system)
    items = [
        RawItem(k, 6, 16, 1 if k == 0 else 0, 1, 0, 0, 0, NAN, 467_052_000 + 30 * k, 83_814_000, 5.0 + 0.01 * k, 0) for k in range(500)
    ]
    mission.upload_mission(items)
    assert [(i.x, round(i.z, 2)) for i in mission.download_mission()] == [(i.x, round(i.z, 2)) for i in items]


@pytest.mark.timeout(600)
def test_wire_mavsdk_flies_with_sticks_and_holds_when_they_are_lost(vehicle):
    """Climbs and flies forward. Released sticks stop the vehicle, lost stick input triggers the failsafe's hold, and
    new stick input takes over."""
    system, telemetry = vehicle
    action, manual = Action(system), ManualControl(system)
    take_off(action, telemetry, 5.0)

    def fly(what, reached, *stick):
        def step():
            manual.set_manual_control_input(*stick)
            time.sleep(0.02)
            return reached()
        wait_for(what, step)

    # MAVSDK requires an input before it requests the mode.
    manual.set_manual_control_input(0.0, 0.0, 0.5, 0.0)
    manual.start_position_control()
    fly("position mode", lambda: telemetry.flight_mode() == FlightMode.POSCTL, 0.0, 0.0, 0.5, 0.0)
    fly("8 m up", lambda: telemetry.position().relative_altitude_m > 8.0, 0.0, 0.0, 0.9, 0.0)
    before = telemetry.position_velocity_ned().position
    heading = math.radians(telemetry.heading().heading_deg)

    def ahead():
        p = telemetry.position_velocity_ned().position
        return (p.north_m - before.north_m) * math.cos(heading) + (p.east_m - before.east_m) * math.sin(heading)

    fly("10 m ahead", lambda: ahead() > 10.0, 0.6, 0.0, 0.5, 0.0)
    speed = lambda: math.hypot(telemetry.velocity_ned().north_m_s, telemetry.velocity_ned().east_m_s)
    fly("a stop", lambda: speed() < 0.3, 0.0, 0.0, 0.5, 0.0)
    wait_for("the failsafe's hold", lambda: telemetry.flight_mode() == FlightMode.HOLD)
    held = telemetry.position().relative_altitude_m
    fly("position mode again", lambda: telemetry.flight_mode() == FlightMode.POSCTL, 0.0, 0.0, 0.5, 0.0)
    fly("2 m higher by stick input", lambda: telemetry.position().relative_altitude_m > held + 2.0, 0.0, 0.0, 0.9, 0.0)
    # A landing away from home would be a crash in this job, followed by a respawn in the air.
    action.return_to_launch()
    wait_for("disarmed", lambda: not telemetry.armed())


@pytest.mark.timeout(600)
@pytest.mark.parametrize("how", ["kill", "terminate"])
def test_wire_mavsdk_stops_the_motors_in_flight(vehicle, how):
    """Disarming in flight is rejected. Kill and terminate are accepted, and the vehicle falls."""
    system, telemetry = vehicle
    action = Action(system)
    take_off(action, telemetry, 6.0)
    with pytest.raises(Exception):
        action.disarm()
    assert telemetry.armed()
    getattr(action, how)()
    wait_for("motors off", lambda: not telemetry.armed())
    wait_for("the ground", lambda: telemetry.position().relative_altitude_m < 1.0)
