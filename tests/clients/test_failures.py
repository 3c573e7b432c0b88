"""MAVSDK's failure plugin, as instructors use it."""

import pytest
from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.failure import Failure, FailureType, FailureUnit
from mavsdk.plugins.telemetry import Telemetry

import spandrel
from spandrel import wait_for


def connect(port):
    """MAVSDK, and the vehicle that it found, ready to fly."""
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
    system = mavsdk.first_autopilot(60.0)
    assert system is not None, "no vehicle discovered"
    telemetry = Telemetry(system)
    wait_for("health", telemetry.health_all_ok)
    return mavsdk, system, telemetry


def failing(folder):
    """A simulator whose parameter allows failures, and its port."""
    file = folder / "drone.params"
    file.write_text("1\t1\tSYS_FAILURE_EN\t1\t6\n", encoding="utf-8")
    port = spandrel.free_udp_port()
    return spandrel.start_sim(folder, port, "--params", str(file)), port


@pytest.mark.timeout(300)
def test_wire_mavsdk_takes_the_gnss_away_and_gives_it_back(tmp_path):
    """The vehicle's health tells both; a failure that there is not is told as such."""
    process, port = failing(tmp_path)
    try:
        _mavsdk, system, telemetry = connect(port)
        failure = Failure(system)
        failure.inject(FailureUnit.SENSOR_GPS, FailureType.OFF, 0)
        wait_for("no satellites", lambda: telemetry.gps_info().num_satellites == 0)
        failure.inject(FailureUnit.SENSOR_GPS, FailureType.OK, 0)
        wait_for("satellites again", lambda: telemetry.gps_info().num_satellites > 5)
        with pytest.raises(Exception, match="UNSUPPORTED"):
            failure.inject(FailureUnit.SYSTEM_SERVO, FailureType.OFF, 0)
    finally:
        spandrel.end(process)


@pytest.mark.timeout(300)
def test_wire_failures_are_off_unless_a_parameter_allows_them(tmp_path):
    """MAVSDK looks at the parameter itself, and the vehicle refuses whoever does not."""
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port)
    try:
        _mavsdk, system, _telemetry = connect(port)
        with pytest.raises(Exception, match="DISABLED|DENIED"):
            Failure(system).inject(FailureUnit.SENSOR_GPS, FailureType.OFF, 0)
    finally:
        spandrel.end(process)


@pytest.mark.timeout(300)
def test_wire_mavsdk_breaks_the_compass_a_motor_and_the_battery(tmp_path):
    """Each is taken and can be taken back, an empty battery is told; a motor that there is not is no motor."""
    process, port = failing(tmp_path)
    try:
        _mavsdk, system, telemetry = connect(port)
        failure = Failure(system)
        failure.inject(FailureUnit.SENSOR_MAG, FailureType.OFF, 0)
        failure.inject(FailureUnit.SENSOR_MAG, FailureType.OK, 0)
        with pytest.raises(Exception, match="UNSUPPORTED"):
            failure.inject(FailureUnit.SYSTEM_MOTOR, FailureType.OFF, 9)
        failure.inject(FailureUnit.SYSTEM_MOTOR, FailureType.OFF, 1)
        failure.inject(FailureUnit.SYSTEM_MOTOR, FailureType.OK, 1)
        before = telemetry.battery().remaining_percent
        failure.inject(FailureUnit.SYSTEM_BATTERY, FailureType.OFF, 0)
        wait_for("an empty battery", lambda: telemetry.battery().remaining_percent < before - 20.0)
    finally:
        spandrel.end(process)
