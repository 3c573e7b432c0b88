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
    c.stick(pitch=1100)
    c.until("50 m", lambda: c.away() > 50, 60)
    c.stick(pitch=1500)
    c.until("slow", lambda: c.speed < 2, 30)
    here, height = c.place, c.height
    c.holds("within 5 m", lambda: math.dist(c.place, here) < 5 and abs(c.height - height) < 5, 10)
    c.go_home()


def alt_hold_keeps_height_with_full_sticks(c):
    c.take_off(10, "ALT_HOLD")
    c.settles("10 m", lambda: 9 <= c.height <= 11, 5, 30)
    c.stick(roll=1000, pitch=1000)
    c.holds("9 to 11 m", lambda: 9 <= c.height <= 11, 5)
    c.go_home()


def brake_ignores_the_sticks(c):
    c.take_off(10, "LOITER")
    c.stick(pitch=1000)
    c.until("fast", lambda: c.speed > 5, 30)
    c.change("BRAKE")
    # It overshoots the braking target and returns before it stops.
    c.settles("at rest", lambda: c.speed < 0.5, 2, 20)
    here = c.place
    c.holds("within 3 m", lambda: math.dist(c.place, here) < 3, 8)
    c.go_home()


def circle_holds_radius(c):
    c.set(CIRCLE_RADIUS=3000, CIRCLE_RATE=20)
    c.take_off(10)
    c.change("LOITER")
    centre = (c.place[0] + 30 * math.cos(math.radians(c.heading)), c.place[1] + 30 * math.sin(math.radians(c.heading)))
    c.change("CIRCLE")
    c.pass_time(10)
    c.holds("30 m from the center", lambda: abs(math.dist(c.place, centre) - 30) < 5 and abs(c.height - 10) < 3, 20)
    c.go_home()


def guided_yaw_rate_is_limited(c):
    c.take_off(20)
    c.settles("at rest", lambda: abs(c.climb) < 0.1, 3, 20)
    c.watches.append(("turns faster than 10 deg/s", lambda: abs(math.degrees(c.last["ATTITUDE"].yawspeed)) > 10))
    for turn, direction in ((60, 1), (-60, -1)):
        goal = (c.heading + turn) % 360
        c.must(M.MAV_CMD_CONDITION_YAW, goal, 2, direction, 0)
        took_s = c.until(f"{turn} degrees", lambda goal=goal: c.off(goal) < 5, 60)
        assert took_s > 20, "60 degrees at 2 deg/s must take half a minute"
        c.pass_time(5)
    c.watches.clear()
    c.go_home()


def guided_speed_command(c):
    c.take_off(20)
    latitude, longitude = c.degrees(2000, 0)
    c.link.mav.command_int_send(1, 1, M.MAV_FRAME_GLOBAL_RELATIVE_ALT, M.MAV_CMD_DO_REPOSITION, 0, 0, -1, 0, 0, math.nan, latitude, longitude, 20)
    for speed in (2, 10, 4):
        c.must(M.MAV_CMD_DO_CHANGE_SPEED, 1, speed, -1)
        c.settles(f"{speed} m/s", lambda speed=speed: abs(c.speed - speed) < 0.2, 10, 40)
    c.must(M.MAV_CMD_COMPONENT_ARM_DISARM, 0, 21196)


def guided_heading_follows_course(c):
    c.set(WP_YAW_BEHAVIOR=1)
    c.take_off(5)
    c.target(100, 100, 20)
    for _ in range(12):
        c.pass_time(2)
        c.target(100, 100, 20)
    c.until("the target", lambda: c.away((100, 100)) < 3, 40)
    assert c.off(45) < 5, c.heading
    c.change("RTL")
    c.settles("the heading toward home", lambda: c.off(225) < 5, 4, 30)
    c.until_disarmed()


def mission_starts_by_command(c):
    c.upload([(M.MAV_CMD_NAV_TAKEOFF, 0, 0, 40), (M.MAV_CMD_NAV_RETURN_TO_LAUNCH, 0, 0, 0)])
    c.change("LOITER")
    c.arm()
    c.change("AUTO")
    assert c.command(M.MAV_CMD_MISSION_START, 1) == "DENIED"
    c.must(M.MAV_CMD_MISSION_START)
    c.until("20 m", lambda: c.height > 20, 60)
    c.go_home()


def mission_repeats_in_auto(c):
    c.upload([(M.MAV_CMD_NAV_TAKEOFF, 0, 0, 20), (M.MAV_CMD_NAV_WAYPOINT, 20, 0, 20), (M.MAV_CMD_NAV_RETURN_TO_LAUNCH, 0, 0, 0)])
    c.set(AUTO_OPTIONS=3)
    c.change("AUTO")
    for _ in range(2):
        c.arm()
        c.until("20 m", lambda: c.height > 18, 60)
        c.until("the last item", lambda: c.item == 3, 120)
        c.until_disarmed()
        c.pass_time(20)
        assert c.flies("AUTO")


def mission_delay_of_one_minute(c):
    c.upload([
        (M.MAV_CMD_NAV_TAKEOFF, 0, 0, 20), (M.MAV_CMD_NAV_WAYPOINT, 10, 10, 20), (M.MAV_CMD_NAV_DELAY, 0, 0, 0, 60),
        (M.MAV_CMD_NAV_RETURN_TO_LAUNCH, 0, 0, 0),
    ])
    c.start_auto()
    c.until("the delay", lambda: c.item == 3, 120)
    assert 59 <= c.until("the end of the delay", lambda: c.item == 4, 80) <= 62
    c.until_disarmed()


def mission_takeoff_at_time_of_day(c):
    c.until("the clock", lambda: c.shows("SYSTEM_TIME"), 5)
    due = datetime.datetime.fromtimestamp(c.last["SYSTEM_TIME"].time_unix_usec / 1e6, datetime.timezone.utc) + datetime.timedelta(seconds=77)
    begun = c.now
    c.upload([(M.MAV_CMD_NAV_DELAY, 0, 0, 0, 0, due.hour, due.minute, due.second), (M.MAV_CMD_NAV_TAKEOFF, 0, 0, 20), (M.MAV_CMD_NAV_RETURN_TO_LAUNCH, 0, 0, 0)])
    c.start_auto()
    c.until("the takeoff", lambda: c.item > 1, 90)
    assert abs(c.now - begun - 77) <= 2
    c.until_disarmed()


def mission_pause_and_resume(c):
    c.upload([(M.MAV_CMD_NAV_TAKEOFF, 0, 0, 20), *[(M.MAV_CMD_NAV_WAYPOINT, 0, 100 * k, 20) for k in range(1, 4)], (M.MAV_CMD_NAV_RETURN_TO_LAUNCH, 0, 0, 0)])
    c.start_auto()
    c.until("flying", lambda: c.item == 3 and c.speed > 3, 120)
    c.must(M.MAV_CMD_DO_PAUSE_CONTINUE, 0)
    c.settles("hovering in place", lambda: c.speed < 1, 5, 30)
    c.must(M.MAV_CMD_DO_PAUSE_CONTINUE, 1)
    c.until("the next item", lambda: c.item == 4, 120)
    c.until_disarmed(300)


def smart_rtl_lands_at_home(c):
    c.take_off(10)
    for north, east in ((0, 20), (20, 20)):
        latitude, longitude = c.degrees(north, east)
        c.link.mav.command_int_send(1, 1, M.MAV_FRAME_GLOBAL_RELATIVE_ALT, M.MAV_CMD_DO_REPOSITION, 0, 0, -1, 0, 0, math.nan, latitude, longitude, 10)
        c.until("the target", lambda north=north, east=east: c.away((north, east)) < 2, 40)
    c.change("SMART_RTL")
    c.until("the corner", lambda: c.away((0, 20)) < 5, 60)
    c.until_disarmed()
    assert c.away() < 2


def rtl_speed_and_final_height(c):
    c.set(RTL_SPEED=300, RTL_ALT_FINAL=500, RTL_LOIT_TIME=1000)
    c.take_off(20)
    latitude, longitude = c.degrees(90, 0)
    c.link.mav.command_int_send(1, 1, M.MAV_FRAME_GLOBAL_RELATIVE_ALT, M.MAV_CMD_DO_REPOSITION, 0, 0, -1, 0, 0, math.nan, latitude, longitude, 20)
    c.until("90 m", lambda: c.away() > 88, 60)
    c.change("RTL")
    c.settles("3 m/s", lambda: abs(c.speed - 3) < 1, 10, 60)
    c.settles("5 m over home", lambda: abs(c.height - 5) < 1 and c.away() < 2, 10, 120)
    c.change("LAND")
    c.until_disarmed()


def rtl_to_rally_point(c):
    c.upload([(M.MAV_CMD_NAV_RALLY_POINT, 50, -25, 37)], kind=M.MAV_MISSION_TYPE_RALLY)
    c.set(RALLY_INCL_HOME=0, RTL_LOIT_TIME=5000)
    c.take_off(10)
    c.change("RTL")
    c.until("the rally point", lambda: c.away((50, -25)) < 1, 120)
    assert abs(c.height - 37) < 1, c.height
    c.until("descending", lambda: c.height < 25, 60)
    c.until_disarmed()
    assert c.away((50, -25)) < 2


def fence_ceiling_triggers_rtl(c):
    c.set(FENCE_TYPE=1, FENCE_ALT_MAX=20, FENCE_ACTION=1, FENCE_ENABLE=1)
    c.take_off(10, "LOITER")
    c.stick(throttle=1900)
    c.until("RTL", lambda: c.flies("RTL"), 60)
    assert 19 < c.height < 25
    c.stick(throttle=1500)
    c.until_disarmed()


def fence_floor_allows_landing(c):
    c.set(FENCE_TYPE=15, FENCE_ALT_MIN=20, FENCE_ALT_MAX=40, FENCE_RADIUS=150, FENCE_ACTION=1, FENCE_ENABLE=1)
    c.take_off(30)
    c.change("LOITER")
    c.stick(throttle=1200)
    c.until("RTL", lambda: c.flies("RTL"), 60)
    c.stick(throttle=1500)
    c.until("below the floor", lambda: c.height < 15, 120)
    c.change("LOITER")
    c.stick(throttle=1300)
    c.until("the ground", lambda: c.height < 2, 60)
    c.stick(throttle=1000)
    c.until_disarmed()
    assert c.flies("LOITER")


def switches_select_mode(c):
    c.set(FLTMODE1=7, FLTMODE6=5, RC8_OPTION=55, RC9_OPTION=18)
    c.stick(c5=1000, c8=1000, c9=1000)
    c.until("CIRCLE", lambda: c.flies("CIRCLE"), 5)
    c.stick(c9=1900)
    c.until("LAND", lambda: c.flies("LAND"), 5)
    c.stick(c8=1900)
    c.until("GUIDED", lambda: c.flies("GUIDED"), 5)
    c.stick(c8=1000)
    c.until("the mode switch's", lambda: c.flies("CIRCLE"), 5)
    c.stick(c5=1900)
    c.until("LOITER", lambda: c.flies("LOITER"), 5)


def arming_switch_acts_on_change(c):
    c.set(RC8_OPTION=153)
    c.change("LOITER")
    c.stick(c8=1000)
    c.pass_time(1)
    c.stick(c8=2000)
    c.until("armed", lambda: c.armed, 5)
    c.must(M.MAV_CMD_COMPONENT_ARM_DISARM, 0)
    c.until_disarmed(5)
    c.must(M.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1)
    c.link.mav.request_data_stream_send(1, 1, M.MAV_DATA_STREAM_ALL, 10, 1)
    c.holds("disarmed after a restart", lambda: not c.armed, 60)


def overrides_time_out(c):
    c.take_off(10, "LOITER")
    c.stick(pitch=1000)
    c.until("fast", lambda: c.speed > 5, 30)
    c.transmits = False
    c.until("hovering in place", lambda: c.speed < 1, 20)
    c.until("another mode", lambda: not c.flies("LOITER"), 20)
    c.transmits = True
    c.go_home()


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
def test_wire_copter_flow(flights, flow):
    """Checks that the flight passed, as on ArduCopter."""
    flights[flow].result()
