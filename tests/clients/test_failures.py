"""MAVSDK's failure plugin, as used by instructors: failures and their effects."""

import pytest
from mavsdk.plugins.failure import Failure, FailureType, FailureUnit

import sdk
import spandrel
from spandrel import wait_for

# Pulse width of a stopped motor, us.
STANDING_US = 1000.0
# Tilt limits, deg: a vehicle hovering in the drill's wind stays below the first; an upside-down vehicle exceeds the
# second.
LEVEL_DEG, UPSIDE_DEG = 20.0, 90.0


@pytest.fixture
def failing(tmp_path):
    """A vehicle ready to fly with failure injection enabled, and MAVSDK's plugin."""
    file = tmp_path / "drone.params"
    file.write_text("1\t1\tSYS_FAILURE_EN\t1\t6\n", encoding="utf-8")
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port, "--params", str(file), "--after-crash", "respawn")
    mavsdk, system = sdk.connect(port)
    yield system, sdk.ready(system), Failure(system)
    mavsdk.destroy()
    spandrel.end(process)


@pytest.mark.timeout(300)
def test_wire_mavsdk_injects_and_clears_a_gnss_failure(failing):
    """The vehicle's health shows the failure and the recovery. An unsupported failure is reported as unsupported."""
    _system, telemetry, failure = failing
    failure.inject(FailureUnit.SENSOR_GPS, FailureType.OFF, 0)
    wait_for("no satellites", lambda: telemetry.gps_info().num_satellites == 0)
    wait_for("the position loss", lambda: not telemetry.health().is_global_position_ok)
    failure.inject(FailureUnit.SENSOR_GPS, FailureType.OK, 0)
    wait_for("satellites again", lambda: telemetry.gps_info().num_satellites > 5)
    wait_for("the position again", telemetry.health_all_ok)
    with pytest.raises(Exception, match="UNSUPPORTED"):
        failure.inject(FailureUnit.SYSTEM_SERVO, FailureType.OFF, 0)


@pytest.mark.timeout(300)
def test_wire_failure_injection_requires_its_parameter(vehicle):
    """MAVSDK checks the parameter itself, and the vehicle rejects requests from clients that do not."""
    system, telemetry = vehicle
    with pytest.raises(Exception, match="DISABLED|DENIED"):
        Failure(system).inject(FailureUnit.SENSOR_GPS, FailureType.OFF, 0)
    assert telemetry.gps_info().num_satellites > 5


@pytest.mark.timeout(300)
def test_wire_mavsdk_motor_failure_makes_the_vehicle_fall(failing):
    """Only the failed motor stops. The vehicle falls, ends up upside down and reports it. After repair, it hovers at
    the respawn position."""
    system, telemetry, failure = failing
    telemetry.set_rate_actuator_output_status(20.0)
    texts = []
    telemetry.subscribe_status_text(lambda text, *_: texts.append(text.text.rstrip()))
    with pytest.raises(Exception, match="UNSUPPORTED"):
        failure.inject(FailureUnit.SYSTEM_MOTOR, FailureType.OFF, 9)
    action, _telemetry = sdk.take_off(system, 2.0)

    def motors():
        return telemetry.actuator_output_status().actuator[:4]

    wait_for("four turning motors", lambda: len(motors()) == 4 and min(motors()) > STANDING_US)
    failure.inject(FailureUnit.SYSTEM_MOTOR, FailureType.OFF, 1)
    wait_for("a stopped motor", lambda: motors()[0] == STANDING_US and max(motors()[1:]) > STANDING_US)
    wait_for("the fall", lambda: telemetry.position().relative_altitude_m < 0.5)
    wait_for("an inverted attitude", lambda: abs(telemetry.attitude_euler().roll_deg) > UPSIDE_DEG)
    wait_for("the message about the attitude", lambda: "Attitude control lost: motor/propeller failure?" in texts)
    wait_for("the status text", lambda: "Crash detected" in texts)
    failure.inject(FailureUnit.SYSTEM_MOTOR, FailureType.OK, 1)
    told = len(texts)
    wait_for("the respawn", lambda: any(text.startswith("Respawned at") for text in texts[told:]))

    def hovers():
        euler = telemetry.attitude_euler()
        level = max(abs(euler.roll_deg), abs(euler.pitch_deg)) < LEVEL_DEG
        return level and telemetry.position().relative_altitude_m > 1.5 and min(motors()) > STANDING_US

    wait_for("a hover", hovers)
    action.land()
    wait_for("the ground", lambda: "Disarmed by landing" in texts)


@pytest.mark.timeout(300)
def test_wire_mavsdk_injects_battery_and_compass_failures(failing):
    """An empty battery appears in telemetry values and status texts, and prevents arming."""
    system, telemetry, failure = failing
    texts = []
    telemetry.subscribe_status_text(lambda text, *_: texts.append(text.text.rstrip()))
    failure.inject(FailureUnit.SENSOR_MAG, FailureType.OFF, 0)
    health = telemetry.health
    wait_for("no compass", lambda: not (health().is_magnetometer_calibration_ok or health().is_armable), limit_s=60)
    wait_for("the status text", lambda: "Compass lost: no readings" in texts)
    with pytest.raises(Exception, match="DENIED"):
        sdk.Action(system).arm()
    failure.inject(FailureUnit.SENSOR_MAG, FailureType.OK, 0)
    wait_for("the compass again", telemetry.health_all_ok)
    before = telemetry.battery().remaining_percent
    failure.inject(FailureUnit.SYSTEM_BATTERY, FailureType.OFF, 0)
    wait_for("an empty battery", lambda: telemetry.battery().remaining_percent < before - 20.0)
    wait_for("the status text", lambda: any(text.startswith("Critical battery") for text in texts))
    wait_for("not armable", lambda: not telemetry.health().is_armable)
    with pytest.raises(Exception, match="DENIED"):
        sdk.Action(system).arm()
    failure.inject(FailureUnit.SYSTEM_BATTERY, FailureType.OK, 0)
    wait_for("a full battery", telemetry.health_all_ok)
