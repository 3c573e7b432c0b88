"""The ArduPilot copter autotest cases that are most significant for ArduCopter's behavior, with their limits,
reimplemented here; docs/src/measured/autotest.md lists all of its cases and which of them pass."""

import concurrent.futures
import datetime
import math

import pytest

from copter_tester import M, Copter

# Number of parallel flights. The simulator waits for its client, so more flights would only share the processor.
AT_ONCE = 3


def loiter_holds_position(c):
    c.take_off(10, "LOITER")
    c.set_sticks(pitch=1100)
    c.wait_until("50 m", lambda: c.distance_from_m() > 50, 60)
    c.set_sticks(pitch=1500)
    c.wait_until("slow", lambda: c.speed < 2, 30)
    here, height = c.position_m, c.height
    c.check_stays_true("within 5 m", lambda: math.dist(c.position_m, here) < 5 and abs(c.height - height) < 5, 10)
    c.return_and_land()


def alt_hold_keeps_height_with_full_sticks(c):
    c.take_off(10, "ALT_HOLD")
    c.wait_until_settled("10 m", lambda: 9 <= c.height <= 11, 5, 30)
    c.set_sticks(roll=1000, pitch=1000)
    c.check_stays_true("9 to 11 m", lambda: 9 <= c.height <= 11, 5)
    c.return_and_land()


def brake_ignores_the_sticks(c):
    c.take_off(10, "LOITER")
    c.set_sticks(pitch=1000)
    c.wait_until("fast", lambda: c.speed > 5, 30)
    c.set_mode("BRAKE")
    # It overshoots the braking target and returns before it stops.
    c.wait_until_settled("at rest", lambda: c.speed < 0.5, 2, 20)
    here = c.position_m
    c.check_stays_true("within 3 m", lambda: math.dist(c.position_m, here) < 3, 8)
    c.return_and_land()


def circle_holds_radius(c):
    c.set(CIRCLE_RADIUS=3000, CIRCLE_RATE=20)
    c.take_off(10)
    c.set_mode("LOITER")
    centre = (c.position_m[0] + 30 * math.cos(math.radians(c.heading)), c.position_m[1] + 30 * math.sin(math.radians(c.heading)))
    c.set_mode("CIRCLE")
    c.pass_time(10)
    c.check_stays_true("30 m from the center", lambda: abs(math.dist(c.position_m, centre) - 30) < 5 and abs(c.height - 10) < 3, 20)
    c.return_and_land()


def guided_yaw_rate_is_limited(c):
    c.take_off(20)
    c.wait_until_settled("at rest", lambda: abs(c.climb_rate) < 0.1, 3, 20)
    c.watches.append(("turns faster than 10 deg/s", lambda: abs(math.degrees(c.last["ATTITUDE"].yawspeed)) > 10))
    for turn, direction in ((60, 1), (-60, -1)):
        goal = (c.heading + turn) % 360
        c.command_accepted(M.MAV_CMD_CONDITION_YAW, goal, 2, direction, 0)
        took_s = c.wait_until(f"{turn} degrees", lambda goal=goal: c.heading_error_deg(goal) < 5, 60)
        assert took_s > 20, "60 degrees at 2 deg/s must take half a minute"
        c.pass_time(5)
    c.watches.clear()
    c.return_and_land()


def guided_speed_command(c):
    c.take_off(20)
    latitude, longitude = c.degrees(2000, 0)
    c.link.mav.command_int_send(1, 1, M.MAV_FRAME_GLOBAL_RELATIVE_ALT, M.MAV_CMD_DO_REPOSITION, 0, 0, -1, 0, 0, math.nan, latitude, longitude, 20)
    for speed in (2, 10, 4):
        c.command_accepted(M.MAV_CMD_DO_CHANGE_SPEED, 1, speed, -1)
        c.wait_until_settled(f"{speed} m/s", lambda speed=speed: abs(c.speed - speed) < 0.2, 10, 40)
    c.command_accepted(M.MAV_CMD_COMPONENT_ARM_DISARM, 0, 21196)


def guided_heading_follows_course(c):
    c.set(WP_YAW_BEHAVIOR=1)
    c.take_off(5)
    c.send_setpoint(100, 100, 20)
    for _ in range(12):
        c.pass_time(2)
        c.send_setpoint(100, 100, 20)
    c.wait_until("the target", lambda: c.distance_from_m((100, 100)) < 3, 40)
    assert c.heading_error_deg(45) < 5, c.heading
    c.set_mode("RTL")
    c.wait_until_settled("the heading toward home", lambda: c.heading_error_deg(225) < 5, 4, 30)
    c.until_disarmed()


def mission_starts_by_command(c):
    c.upload([(M.MAV_CMD_NAV_TAKEOFF, 0, 0, 40), (M.MAV_CMD_NAV_RETURN_TO_LAUNCH, 0, 0, 0)])
    c.set_mode("LOITER")
    c.arm()
    c.set_mode("AUTO")
    assert c.command(M.MAV_CMD_MISSION_START, 1) == "DENIED"
    c.command_accepted(M.MAV_CMD_MISSION_START)
    c.wait_until("20 m", lambda: c.height > 20, 60)
    c.return_and_land()


def mission_repeats_in_auto(c):
    c.upload([(M.MAV_CMD_NAV_TAKEOFF, 0, 0, 20), (M.MAV_CMD_NAV_WAYPOINT, 20, 0, 20), (M.MAV_CMD_NAV_RETURN_TO_LAUNCH, 0, 0, 0)])
    c.set(AUTO_OPTIONS=3)
    c.set_mode("AUTO")
    for _ in range(2):
        c.arm()
        c.wait_until("20 m", lambda: c.height > 18, 60)
        c.wait_until("the last item", lambda: c.current_item == 3, 120)
        c.until_disarmed()
        c.pass_time(20)
        assert c.is_in_mode("AUTO")


def mission_delay_of_one_minute(c):
    c.upload([
        (M.MAV_CMD_NAV_TAKEOFF, 0, 0, 20), (M.MAV_CMD_NAV_WAYPOINT, 10, 10, 20), (M.MAV_CMD_NAV_DELAY, 0, 0, 0, 60),
        (M.MAV_CMD_NAV_RETURN_TO_LAUNCH, 0, 0, 0),
    ])
    c.start_auto()
    c.wait_until("the delay", lambda: c.current_item == 3, 120)
    assert 59 <= c.wait_until("the end of the delay", lambda: c.current_item == 4, 80) <= 62
    c.until_disarmed()


def mission_takeoff_at_time_of_day(c):
    c.wait_until("the clock", lambda: c.has_received("SYSTEM_TIME"), 5)
    due = datetime.datetime.fromtimestamp(c.last["SYSTEM_TIME"].time_unix_usec / 1e6, datetime.timezone.utc) + datetime.timedelta(seconds=77)
    begun = c.now
    c.upload([(M.MAV_CMD_NAV_DELAY, 0, 0, 0, 0, due.hour, due.minute, due.second), (M.MAV_CMD_NAV_TAKEOFF, 0, 0, 20), (M.MAV_CMD_NAV_RETURN_TO_LAUNCH, 0, 0, 0)])
    c.start_auto()
    c.wait_until("the takeoff", lambda: c.current_item > 1, 90)
    assert abs(c.now - begun - 77) <= 2
    c.until_disarmed()


def mission_pause_and_resume(c):
    c.upload([(M.MAV_CMD_NAV_TAKEOFF, 0, 0, 20), *[(M.MAV_CMD_NAV_WAYPOINT, 0, 100 * k, 20) for k in range(1, 4)], (M.MAV_CMD_NAV_RETURN_TO_LAUNCH, 0, 0, 0)])
    c.start_auto()
    c.wait_until("flying", lambda: c.current_item == 3 and c.speed > 3, 120)
    c.command_accepted(M.MAV_CMD_DO_PAUSE_CONTINUE, 0)
    c.wait_until_settled("hovering in place", lambda: c.speed < 1, 5, 30)
    c.command_accepted(M.MAV_CMD_DO_PAUSE_CONTINUE, 1)
    c.wait_until("the next item", lambda: c.current_item == 4, 120)
    c.until_disarmed(300)


def smart_rtl_lands_at_home(c):
    c.take_off(10)
    for north, east in ((0, 20), (20, 20)):
        latitude, longitude = c.degrees(north, east)
        c.link.mav.command_int_send(1, 1, M.MAV_FRAME_GLOBAL_RELATIVE_ALT, M.MAV_CMD_DO_REPOSITION, 0, 0, -1, 0, 0, math.nan, latitude, longitude, 10)
        c.wait_until("the target", lambda north=north, east=east: c.distance_from_m((north, east)) < 2, 40)
    c.set_mode("SMART_RTL")
    c.wait_until("the corner", lambda: c.distance_from_m((0, 20)) < 5, 60)
    c.until_disarmed()
    assert c.distance_from_m() < 2


def rtl_speed_and_final_height(c):
    c.set(RTL_SPEED=300, RTL_ALT_FINAL=500, RTL_LOIT_TIME=1000)
    c.take_off(20)
    latitude, longitude = c.degrees(90, 0)
    c.link.mav.command_int_send(1, 1, M.MAV_FRAME_GLOBAL_RELATIVE_ALT, M.MAV_CMD_DO_REPOSITION, 0, 0, -1, 0, 0, math.nan, latitude, longitude, 20)
    c.wait_until("90 m", lambda: c.distance_from_m() > 88, 60)
    c.set_mode("RTL")
    c.wait_until_settled("3 m/s", lambda: abs(c.speed - 3) < 1, 10, 60)
    c.wait_until_settled("5 m over home", lambda: abs(c.height - 5) < 1 and c.distance_from_m() < 2, 10, 120)
    c.set_mode("LAND")
    c.until_disarmed()


def rtl_to_rally_point(c):
    c.upload([(M.MAV_CMD_NAV_RALLY_POINT, 50, -25, 37)], kind=M.MAV_MISSION_TYPE_RALLY)
    c.set(RALLY_INCL_HOME=0, RTL_LOIT_TIME=5000)
    c.take_off(10)
    c.set_mode("RTL")
    c.wait_until("the rally point", lambda: c.distance_from_m((50, -25)) < 1, 120)
    assert abs(c.height - 37) < 1, c.height
    c.wait_until("descending", lambda: c.height < 25, 60)
    c.until_disarmed()
    assert c.distance_from_m((50, -25)) < 2


def fence_ceiling_triggers_rtl(c):
    c.set(FENCE_TYPE=1, FENCE_ALT_MAX=20, FENCE_ACTION=1, FENCE_ENABLE=1)
    c.take_off(10, "LOITER")
    c.set_sticks(throttle=1900)
    c.wait_until("RTL", lambda: c.is_in_mode("RTL"), 60)
    assert 19 < c.height < 25
    c.set_sticks(throttle=1500)
    c.until_disarmed()


def fence_floor_allows_landing(c):
    c.set(FENCE_TYPE=15, FENCE_ALT_MIN=20, FENCE_ALT_MAX=40, FENCE_RADIUS=150, FENCE_ACTION=1, FENCE_ENABLE=1)
    c.take_off(30)
    c.set_mode("LOITER")
    c.set_sticks(throttle=1200)
    c.wait_until("RTL", lambda: c.is_in_mode("RTL"), 60)
    c.set_sticks(throttle=1500)
    c.wait_until("below the floor", lambda: c.height < 15, 120)
    c.set_mode("LOITER")
    c.set_sticks(throttle=1300)
    c.wait_until("the ground", lambda: c.height < 2, 60)
    c.set_sticks(throttle=1000)
    c.until_disarmed()
    assert c.is_in_mode("LOITER")


def switches_select_mode(c):
    c.set(FLTMODE1=7, FLTMODE6=5, RC8_OPTION=55, RC9_OPTION=18)
    c.set_sticks(c5=1000, c8=1000, c9=1000)
    c.wait_until("CIRCLE", lambda: c.is_in_mode("CIRCLE"), 5)
    c.set_sticks(c9=1900)
    c.wait_until("LAND", lambda: c.is_in_mode("LAND"), 5)
    c.set_sticks(c8=1900)
    c.wait_until("GUIDED", lambda: c.is_in_mode("GUIDED"), 5)
    c.set_sticks(c8=1000)
    c.wait_until("the mode switch's", lambda: c.is_in_mode("CIRCLE"), 5)
    c.set_sticks(c5=1900)
    c.wait_until("LOITER", lambda: c.is_in_mode("LOITER"), 5)


def arming_switch_acts_on_change(c):
    c.set(RC8_OPTION=153)
    c.set_mode("LOITER")
    c.set_sticks(c8=1000)
    c.pass_time(1)
    c.set_sticks(c8=2000)
    c.wait_until("armed", lambda: c.armed, 5)
    c.command_accepted(M.MAV_CMD_COMPONENT_ARM_DISARM, 0)
    c.until_disarmed(5)
    c.command_accepted(M.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1)
    c.link.mav.request_data_stream_send(1, 1, M.MAV_DATA_STREAM_ALL, 10, 1)
    c.check_stays_true("disarmed after a restart", lambda: not c.armed, 60)


def overrides_time_out(c):
    c.take_off(10, "LOITER")
    c.set_sticks(pitch=1000)
    c.wait_until("fast", lambda: c.speed > 5, 30)
    c.transmits = False
    c.wait_until("hovering in place", lambda: c.speed < 1, 20)
    c.wait_until("another mode", lambda: not c.is_in_mode("LOITER"), 20)
    c.transmits = True
    c.return_and_land()


FLOWS = [
    loiter_holds_position,
    alt_hold_keeps_height_with_full_sticks,
    brake_ignores_the_sticks,
    circle_holds_radius,
    guided_yaw_rate_is_limited,
    guided_speed_command,
    guided_heading_follows_course,
    mission_starts_by_command,
    mission_repeats_in_auto,
    mission_delay_of_one_minute,
    mission_takeoff_at_time_of_day,
    mission_pause_and_resume,
    smart_rtl_lands_at_home,
    rtl_speed_and_final_height,
    rtl_to_rally_point,
    fence_ceiling_triggers_rtl,
    fence_floor_allows_landing,
    switches_select_mode,
    arming_switch_acts_on_change,
    overrides_time_out,
]


def fly(flow, folder):
    copter = Copter(folder)
    try:
        copter.set(COM_RC_OVERRIDE=0, WPNAV_SPEED=1000, RTL_ALT=1500)
        flow(copter)
    finally:
        copter.close()


@pytest.fixture(scope="module", name="flights")
def fixture_flights(tmp_path_factory):
    """Starts all flights, some in parallel; the tests below check their results."""
    folder = tmp_path_factory.mktemp("copter")
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
        begun = {flow: pool.submit(fly, flow, folder / flow.__name__) for flow in FLOWS}
        yield begun
        for flight in begun.values():
            flight.cancel()


@pytest.mark.timeout(900)
@pytest.mark.parametrize("flow", FLOWS, ids=lambda flow: flow.__name__)
def test_wire_copter_flow_passes(flights, flow):
    """Checks that the flight passed, as on ArduCopter."""
    flights[flow].result()
