"""How clients decode messages beyond the common set: ArduPilot's dialect with pymavlink, PX4's shell and
follow-me with MAVSDK."""

import pytest
from mavsdk.plugins.action import Action
from mavsdk.plugins.follow_me import FollowMe
from mavsdk.plugins.shell import Device, Shell
from mavsdk.plugins.telemetry import FlightMode, Telemetry
from pymavlink import mavutil

import asking
import sdk
import spandrel
from spandrel import wait_for

M = mavutil.mavlink
# Standard gravity, m/s^2, and tolerance for noise and tilt of a vehicle at rest.
GRAVITY, GRAVITY_TOLERANCE = 9.81, 0.3


@pytest.mark.timeout(300)
def test_regress_pymavlink_decodes_ardupilot_messages(launch):
    """pymavlink checks the CRC seed and layout of each message against its own definitions."""
    link = asking.connect(launch("ardupilot"))
    link.mav.request_data_stream_send(1, 1, M.MAV_DATA_STREAM_ALL, 10, 1)
    ekf = asking.receive(link, "EKF_STATUS_REPORT", lambda e: e.flags == 831)
    assert 0.0 <= ekf.pos_horiz_variance < 0.5 and ekf.compass_variance == 0.0
    assert asking.receive(link, "MEMINFO").freemem32 == 524288
    assert asking.receive(link, "POWER_STATUS").Vcc == 5000
    ahrs, wind = asking.receive(link, "AHRS"), asking.receive(link, "WIND")
    assert abs(ahrs.omegaIx) < 0.1 and wind.speed >= 0.0 and -180.0 <= wind.direction <= 180.0
    simulated, position = asking.receive(link, "SIMSTATE"), asking.receive(link, "GLOBAL_POSITION_INT")
    assert abs(simulated.zacc + GRAVITY) < GRAVITY_TOLERANCE
    # 10 m in 1e-7 degrees, more than the receiver's error.
    assert abs(simulated.lat - position.lat) < 900 and abs(simulated.lng - position.lon) < 900


@pytest.fixture(name="px4")
def fixture_px4(launch):
    """MAVSDK's view of a vehicle, which is released before the vehicle stops."""
    mavsdk, system = sdk.connect(launch("px4"))
    yield system
    mavsdk.destroy()


@pytest.mark.timeout(300)
def test_regress_mavsdk_uses_the_px4_shell(px4):
    """Sends a line to the shell and reads its output."""
    shell, heard = Shell(px4), []
    shell.subscribe_receive(lambda received, _: heard.append(received.data))
    # MAVSDK drops output that a plugin receives immediately after its creation.
    sdk.ready(px4)
    shell.send("ver all\n", Device.SHELL)
    wait_for("the version", lambda: "FW version" in "".join(heard))
    shell.send("param show MIS_TAKEOFF_ALT\n", Device.SHELL)
    wait_for("the parameter", lambda: "MIS_TAKEOFF_ALT : 2.5000" in "".join(heard))


@pytest.mark.timeout(300)
def test_regress_mavsdk_follow_me_works(px4):
    """MAVSDK's follow-me: configured, started, updated with a target, stopped."""
    telemetry, action = sdk.ready(px4), Action(px4)
    action.arm()
    action.takeoff()
    wait_for("takeoff", lambda: telemetry.flight_mode() == FlightMode.HOLD and telemetry.in_air())
    follow = FollowMe(px4)
    follow.start()
    wait_for("the mode", lambda: telemetry.flight_mode() == FlightMode.FOLLOW_ME)
    follow.stop()
    wait_for("hold", lambda: telemetry.flight_mode() == FlightMode.HOLD)
    assert isinstance(telemetry, Telemetry)
