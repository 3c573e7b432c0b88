"""MAVSDK uploads and flies a mission, sets valid and invalid parameters, flies with external setpoints, and points
the gimbal."""

import json
import math

import pytest
from mavsdk.plugins.action import Action
from mavsdk.plugins.geofence import Circle, FenceType, Geofence, GeofenceData, Point
from mavsdk.plugins.gimbal import ControlMode, Gimbal, GimbalMode, SendMode
from mavsdk.plugins.mission_raw import MissionItem, MissionRaw
from mavsdk.plugins.offboard import AttitudeRate, Offboard, PositionNedYaw, VelocityBodyYawspeed
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import FlightMode

import spandrel
from spandrel import wait_for

NAN = float("nan")
# Ground speed below which the vehicle counts as stopped after flying at 2 m/s, m/s.
STANDSTILL_M_S = 0.3
# MAVLink frames: height relative to home, and MISSION.
OVER_HOME, ANY = 6, 2
# 1e-7 degrees of latitude per meter.
E7_PER_METER = 1e7 * 360.0 / 40_000_000.0
# Tolerances between the commanded values and the vehicle's own estimate, m and m/s.
NEAR_M, NEAR_M_S = 0.7, 0.4


def place(telemetry):
    """Returns the position north, east and down in meters."""
    p = telemetry.position_velocity_ned().position
    return p.north_m, p.east_m, p.down_m


@pytest.mark.timeout(600)
def test_wire_mavsdk_flies_a_mission_to_its_end(vehicle):
    """Takeoff, a waypoint, a picture, and a landing at the start position."""
    system, telemetry = vehicle
    mission, action = MissionRaw(system), Action(system)
    here = wait_for("a position", lambda: (p := telemetry.position()) and p.latitude_deg != 0.0 and p)
    lat, lon = round(here.latitude_deg * 1e7), round(here.longitude_deg * 1e7)
    north = lat + round(12.0 * E7_PER_METER)
    items = [
        MissionItem(0, OVER_HOME, 22, 1, 1, 0, 0, 0, NAN, lat, lon, 5.0, 0),
        MissionItem(1, OVER_HOME, 16, 0, 1, 0, 0, 0, NAN, north, lon, 6.0, 0),
        MissionItem(2, ANY, 2000, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0),
        MissionItem(3, OVER_HOME, 21, 0, 1, 0, 0, 0, NAN, lat, lon, 0, 0),
    ]
    mission.upload_mission(items)
    assert [(i.command, i.x, i.z) for i in mission.download_mission()] == [(i.command, i.x, i.z) for i in items]
    start = place(telemetry)
    action.arm()
    mission.start_mission()
    wait_for("the waypoint", lambda: place(telemetry)[0] - start[0] > 9.0)
    wait_for("the landing", lambda: not telemetry.armed())
    assert math.hypot(place(telemetry)[0] - start[0], place(telemetry)[1] - start[1]) < NEAR_M
    with pytest.raises(Exception, match="INVALID_ARGUMENT"):
        mission.upload_mission([MissionItem(0, OVER_HOME, 16, 1, 1, 0, 0, 0, NAN, 910_000_000, lon, 5.0, 0)])


@pytest.mark.timeout(600)
def test_wire_mavsdk_flies_with_setpoints_and_points_the_gimbal(vehicle):
    """Sends a position, a body velocity and a yaw rate, moves the gimbal up and down, and sets valid and invalid
    parameters."""
    system, telemetry = vehicle
    action, offboard, gimbal, param = Action(system), Offboard(system), Gimbal(system), Param(system)
    param.set_param_float("MIS_TAKEOFF_ALT", 4.0)
    assert param.get_param_float("MIS_TAKEOFF_ALT") == 4.0
    for name, value, why in (("NOPE", 1.0, "DOES_NOT_EXIST"), ("MIS_TAKEOFF_ALT", 1e9, "VALUE_OUT_OF_RANGE")):
        with pytest.raises(Exception, match=why):
            param.set_param_float(name, value)
    action.arm()
    action.takeoff()
    wait_for("a height of 3.5 m", lambda: telemetry.position().relative_altitude_m > 3.5)
    n, e, d = place(telemetry)
    with pytest.raises(Exception, match="NO_SETPOINT_SET"):
        offboard.start()
    target = (n + 5.0, e + 2.0, d - 2.0)
    offboard.set_position_ned(PositionNedYaw(*target, 90.0))
    offboard.start()
    wait_for("the position", lambda: math.dist(place(telemetry), target) < NEAR_M)
    wait_for("offboard mode", lambda: telemetry.flight_mode() == FlightMode.OFFBOARD)
    wait_for("the heading", lambda: abs(telemetry.attitude_euler().yaw_deg - 90.0) < 5.0)
    # The vehicle is facing east, so forward is east.
    offboard.set_velocity_body(VelocityBodyYawspeed(2.0, 0.0, 0.0, 0.0))
    wait_for("2 m/s east", lambda: abs(telemetry.velocity_ned().east_m_s - 2.0) < NEAR_M_S)
    assert abs(telemetry.velocity_ned().north_m_s) < NEAR_M_S
    offboard.set_velocity_body(VelocityBodyYawspeed(0.0, 0.0, 0.0, 0.0))
    wait_for("a stop", lambda: abs(telemetry.velocity_ned().east_m_s) < NEAR_M_S)
    offboard.set_attitude_rate(AttitudeRate(0.0, 0.0, 40.0, 0.5))
    wait_for("a spin", lambda: abs(math.degrees(telemetry.attitude_angular_velocity_body().yaw_rad_s) - 40.0) < 10.0)
    offboard.set_velocity_body(VelocityBodyYawspeed(0.0, 0.0, 0.0, 0.0))
    offboard.stop()
    known = wait_for("a gimbal", lambda: gimbal.gimbal_list().gimbals)[0].gimbal_id
    gimbal.take_control(known, ControlMode.PRIMARY)
    for pitch, mode in ((-90.0, SendMode.ONCE), (90.0, SendMode.ONCE), (30.0, SendMode.STREAM)):
        gimbal.set_angles(known, 0.0, pitch, 0.0, GimbalMode.YAW_FOLLOW, mode)
        wait_for(f"pitch {pitch}", lambda: abs(gimbal.get_attitude(known).euler_angle_forward.pitch_deg - pitch) < 1.0)
    action.land()
    wait_for("landing mode", lambda: telemetry.flight_mode() == FlightMode.LAND)


@pytest.mark.timeout(600)
def test_wire_mavsdk_flies_pauses_and_resumes_the_exported_plan(vehicle):
    """Flies a drill's plan in QGroundControl's format, pauses on the way, and completes it."""
    system, telemetry = vehicle
    mission, action = MissionRaw(system), Action(system)
    text = spandrel.run("export", "drill-hover", "--seed", "7", "--plan", "-")
    imported = mission.import_qgroundcontrol_mission_from_string(text)
    written = json.loads(text)["mission"]["items"]
    assert [i.command for i in imported.mission_items] == [i["command"] for i in written]
    mission.upload_mission(imported.mission_items)
    assert len(mission.download_mission()) == len(written)
    action.arm()
    mission.start_mission()
    wait_for("the first waypoints", lambda: mission.mission_progress().current >= 3)
    mission.pause_mission()
    wait_for("a pause", lambda: telemetry.flight_mode() == FlightMode.HOLD)
    held = mission.mission_progress().current
    mission.start_mission()
    wait_for("more of the plan", lambda: mission.mission_progress().current > held)
    wait_for("the landing", lambda: not telemetry.armed())


@pytest.mark.timeout(600)
@pytest.mark.parametrize("vehicle", ["px4", "ardupilot"], indirect=True)
def test_wire_mavsdk_fence_holds_the_vehicle(vehicle):
    """Uploads and downloads a fence and breaches it with setpoints. The vehicle must hold, even when it emulates
    ArduPilot."""
    system, telemetry = vehicle
    fence, action, offboard = Geofence(system), Action(system), Offboard(system)
    here = wait_for("a position", lambda: (p := telemetry.position()) and p.latitude_deg != 0.0 and p)
    circle = Circle(Point(here.latitude_deg, here.longitude_deg), 12.0, FenceType.INCLUSION)
    fence.upload_geofence(GeofenceData([], [circle]))
    assert [round(c.radius, 3) for c in fence.download_geofence().circles] == [12.0]
    action.arm()
    action.takeoff()
    wait_for("the hover", lambda: telemetry.flight_mode() in (FlightMode.HOLD, FlightMode.OFFBOARD) and place(telemetry)[2] < -1.5)
    offboard.set_velocity_body(VelocityBodyYawspeed(2.0, 0.0, 0.0, 0.0))
    offboard.start()
    wait_for("offboard flight", lambda: telemetry.flight_mode() == FlightMode.OFFBOARD)
    wait_for("the hold at the fence", lambda: telemetry.flight_mode() == FlightMode.HOLD)
    wait_for("a standstill", lambda: (v := telemetry.position_velocity_ned().velocity) and math.hypot(v.north_m_s, v.east_m_s) < STANDSTILL_M_S)
    away = math.hypot(place(telemetry)[0], place(telemetry)[1])
    assert 10.0 < away < 18.0, away
    fence.clear_geofence()
