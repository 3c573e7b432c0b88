"""The same vehicle emulates other autopilots and is used with ArduCopter scripts, MAVProxy commands as entered by
users, MAVSDK, and the generic standard."""

import pytest
from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.mission_raw import MissionItem, MissionRaw
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import FlightMode, Telemetry
from pymavlink import mavutil

import asking
import spandrel
from spandrel import wait_for
from test_mavproxy import LAT, LON, Console, plan

M = mavutil.mavlink
LIMIT_S = asking.LIMIT_S
# Distance within which a height counts as reached, m.
NEAR_M = 0.8
NAN = float("nan")
# Two meters in 1e-7 degrees of latitude.
PLACE = 180


class Script:
    """Functions of typical pymavlink scripts, for any autopilot."""

    def __init__(self, port):
        self.link = asking.connect(port)

    def wait(self, kind, condition=lambda message: True):
        """Returns the next message of a kind that meets a condition."""
        return asking.receive(self.link, kind, condition)

    def command(self, number, *params):
        """Returns the result of a command."""
        return asking.command(self.link, number, *params)

    def ready(self):
        """Requests all streams at 10 Hz, as scripts do, and waits until the vehicle is ready to arm."""
        self.link.mav.request_data_stream_send(1, 1, M.MAV_DATA_STREAM_ALL, 10, 1)
        self.wait("SYS_STATUS", lambda s: s.onboard_control_sensors_health & M.MAV_SYS_STATUS_PREARM_CHECK)

    def height(self):
        """Returns the height above home in meters."""
        return self.wait("GLOBAL_POSITION_INT").relative_alt / 1000

    def landed(self):
        """Waits until the motors have stopped."""
        self.wait("HEARTBEAT", lambda b: b.get_srcComponent() == 1 and not b.base_mode & M.MAV_MODE_FLAG_SAFETY_ARMED)


@pytest.mark.timeout(600)
def test_wire_arducopter_script_flies(launch):
    """pymavlink's own helpers for ArduPilot: mode by name, arming, takeoff to a height above home, a target, parameters
    encoded as floats, return."""
    script = Script(launch("ardupilot"))
    link = script.link
    assert link.mode_mapping()["GUIDED"] == 4
    script.ready()
    values = {name: value.param_value for name, value in asking.parameters(link).items()}
    assert (values["FRAME_CLASS"], values["RTL_ALT"]) == (1.0, 3000.0)
    set_to = asking.ask(link, lambda: link.param_set_send("RTL_ALT", 1200), "PARAM_VALUE", lambda v: v.param_id == "RTL_ALT")
    assert set_to.param_value == 1200.0
    link.set_mode("GUIDED")
    script.wait("HEARTBEAT", lambda b: b.get_srcComponent() == 1 and b.custom_mode == 4)
    assert link.flightmode == "GUIDED"
    link.arducopter_arm()
    link.motors_armed_wait()
    assert script.command(M.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 6) == M.MAV_RESULT_ACCEPTED
    wait_for("takeoff", lambda: script.height() > 6 - NEAR_M, LIMIT_S)
    here = script.wait("GLOBAL_POSITION_INT")
    # Send only a position, and only once, as scripts for GUIDED do.
    link.mav.set_position_target_global_int_send(
        0, 1, 1, M.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, 0x0DF8, here.lat + 1500, here.lon, 8, 0, 0, 0, 0, 0, 0, 0, 0,
    )
    script.wait("GLOBAL_POSITION_INT", lambda p: p.lat > here.lat + 1400 and abs(p.relative_alt / 1000 - 8) < NEAR_M)
    link.set_mode("RTL")
    script.wait("HEARTBEAT", lambda b: b.get_srcComponent() == 1 and b.custom_mode == 6)
    script.landed()
    end = script.wait("GLOBAL_POSITION_INT")
    assert abs(end.lat - here.lat) < 200 and abs(end.lon - here.lon) < 200


@pytest.mark.timeout(600)
def test_wire_standard_mavlink_script_flies(launch):
    """Uses only common messages and standard modes: available modes, takeoff, position hold, return."""
    script = Script(launch("generic"))
    script.ready()
    standard = {1: "position hold", 5: "safe recovery", 7: "land", 8: "take-off"}
    modes, total = {}, 1
    while len(modes) < total:
        wanted = len(modes) + 1
        mode = asking.message(script.link, 435, "AVAILABLE_MODES", lambda m: m.mode_index == wanted, wanted)
        modes[mode.mode_index], total = mode, mode.number_modes
    offered = {mode.standard_mode for mode in modes.values() if not mode.properties & M.MAV_MODE_PROPERTY_NOT_USER_SELECTABLE}
    assert set(standard) <= offered and 0 not in offered
    assert script.command(M.MAV_CMD_COMPONENT_ARM_DISARM, 1) == M.MAV_RESULT_ACCEPTED
    assert script.command(M.MAV_CMD_DO_SET_STANDARD_MODE, 8) == M.MAV_RESULT_ACCEPTED
    wait_for("takeoff", lambda: script.height() > 2.5 - NEAR_M, LIMIT_S)
    assert script.command(M.MAV_CMD_DO_SET_STANDARD_MODE, 7) == M.MAV_RESULT_ACCEPTED
    wait_for("mode", lambda: script.wait("CURRENT_MODE").standard_mode == 7, LIMIT_S)
    script.landed()


@pytest.fixture
def copter(tmp_path, launch):
    """An emulated ArduCopter, and a MAVProxy that has fetched its parameters."""
    console = Console(launch("ardupilot", speed=2), tmp_path)
    console.wait("parameters to")
    yield console, tmp_path
    console.close()


@pytest.mark.timeout(600)
def test_wire_mavproxy_flies_arducopter(copter):
    """Parameters as a file, modes by name, arming rejected and accepted, GUIDED takeoff, channels, relay, return."""
    typed, _folder = copter
    fetched = "\n".join(typed.heard)
    assert "fallback" not in fetched.lower() and "param.pck" not in fetched, "parameters must come over FTP at the first attempt"
    typed.enter_command("param show RTL_ALT", "RTL_ALT          3000")
    typed.enter_command("param set RTL_ALT 1500", None)
    typed.repeat_until("param fetch RTL_ALT", "RTL_ALT = 1500")
    modes = typed.enter_command("mode", "Available modes")
    assert "GUIDED" in modes and "POSHOLD" in modes
    typed.enter_command("arm list", "all")
    typed.enter_command("arm prearms", "RUN_PREARM_CHECKS: ACCEPTED")
    typed.repeat_until("mode rtl", "Mode RTL")
    typed.repeat_until("arm throttle", "Arm: RTL mode not armable")
    typed.repeat_until("mode loiter", "Mode LOITER")
    typed.enter_command("rc 3 1900", None)
    typed.repeat_until("arm throttle", "Arm: Throttle too high")
    typed.enter_command("rc 3 1000", None)
    typed.repeat_until("mode guided", "Mode GUIDED")
    typed.repeat_until("arm throttle", "ARMED")
    typed.enter_command("takeoff 5", "NAV_TAKEOFF: ACCEPTED")
    typed.wait("Takeoff detected")
    typed.repeat_until("status VFR_HUD", "climb : 0.0")
    typed.enter_command("rc all 1500", None)
    typed.repeat_until("mode loiter", "Mode LOITER")
    typed.enter_command("relay set 0 1", "DO_SET_RELAY: ACCEPTED")
    typed.enter_command("rc 2 1300", None)
    typed.repeat_until("status VFR_HUD", "groundspeed : 2.")
    typed.enter_command("rc 2 1500", None)
    typed.repeat_until("mode rtl", "Mode RTL")
    typed.wait("DISARMED")


@pytest.mark.timeout(600)
def test_wire_mavproxy_transfers_copter_plans(copter):
    """Item 0 of a mission is home, so it is included in a downloaded mission, but not in the fence or rally points."""
    typed, folder = copter
    nothing = (0.0, 0.0, 0.0, 0.0)
    home = (0, 16, nothing, 0, 1630)
    mission = plan(folder, "mission.txt", [home, (3, 22, nothing, 0, 5), (3, 16, nothing, 10, 6), (3, 21, nothing, 0, 0)])
    typed.enter_command(f"wp load {mission}", "Loaded 4 waypoints")
    typed.wait("Got MISSION_ACK: TYPE_MISSION: ACCEPTED")
    typed.enter_command("wp list", "Requesting 4 waypoints")
    saved = folder / "back.txt"
    typed.wait("Saved 4 waypoints")
    typed.enter_command(f"wp save {saved}", str(saved))
    rows = [line.split("\t") for line in saved.read_text(encoding="utf-8").splitlines()[1:]]
    assert [row[3] for row in rows] == ["16", "22", "16", "21"]
    assert abs(float(rows[0][8]) - LAT) < 1e-3 and abs(float(rows[0][9]) - LON) < 1e-3, "home must be at the vehicle's position"
    typed.enter_command("wp set 2", None)
    typed.repeat_until("status MISSION_CURRENT", "seq : 2")
    typed.enter_command(f"fence load {plan(folder, 'fence.txt', [(0, 5003, (80.0, 0.0, 0.0, 0.0), 0, 0)])}", "Got MISSION_ACK: TYPE_FENCE: ACCEPTED")
    typed.enter_command("fence list", "Requesting 1 fence")
    typed.enter_command(f"rally load {plan(folder, 'rally.txt', [(3, 5100, nothing, 20, 5)])}", "Got MISSION_ACK: TYPE_RALLY: ACCEPTED")
    typed.enter_command("rally list", "Requesting 1 rally")


@pytest.mark.timeout(600)
def test_wire_mavsdk_detects_ardupilot(launch):
    """Takeoff, hold, parameters, a mission that starts with home, return: MAVSDK must choose ArduPilot's variants
    automatically."""
    port = launch("ardupilot")
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
    system = mavsdk.first_autopilot(60.0)
    assert system is not None, "no vehicle discovered"
    action, telemetry, param, mission = Action(system), Telemetry(system), Param(system), MissionRaw(system)
    telemetry.set_rate_position(10.0)
    telemetry.set_rate_in_air(5.0)
    wait_for("position", lambda: telemetry.position().latitude_deg > 1, LIMIT_S)
    param.set_param_float("WPNAV_SPEED", 400.0)
    assert param.get_param_float("WPNAV_SPEED") == 400.0 and param.get_param_int("FRAME_CLASS") == 1
    lat, lon = int(LAT * 1e7), int(LON * 1e7)
    items = [
        MissionItem(0, 0, 16, 1, 1, 0, 0, 0, 0, lat, lon, 1630.0, 0),
        MissionItem(1, 3, 22, 0, 1, 0, 0, 0, 0, lat, lon, 6.0, 0),
        MissionItem(2, 3, 16, 0, 1, 0, 0, 0, 0, lat + 1000, lon, 6.0, 0),
    ]
    mission.upload_mission(items)
    back = mission.download_mission()
    assert [item.command for item in back] == [16, 22, 16] and back[2].x == items[2].x
    action.arm()
    mission.start_mission()
    wait_for("the last position", lambda: telemetry.position().latitude_deg * 1e7 > items[2].x - PLACE, LIMIT_S)
    wait_for("the end of the mission", lambda: mission.mission_progress().current == mission.mission_progress().total, LIMIT_S)
    action.return_to_launch()
    wait_for("home again", lambda: not telemetry.armed(), LIMIT_S)
    action.set_takeoff_altitude(4.0)
    action.arm()
    action.takeoff()
    wait_for("takeoff", lambda: telemetry.position().relative_altitude_m > 4.0 - NEAR_M, LIMIT_S)
    action.hold()
    wait_for("hold", lambda: telemetry.flight_mode() == FlightMode.HOLD, LIMIT_S)
    action.return_to_launch()
    wait_for("return", lambda: telemetry.flight_mode() == FlightMode.RETURN_TO_LAUNCH, LIMIT_S)
    wait_for("disarmed", lambda: not telemetry.armed(), LIMIT_S)
