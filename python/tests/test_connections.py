"""Tests of pymavlink connections (lockstep) and MAVSDK connections (real time)."""

import time

import pytest
from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.telemetry import Telemetry

import spandrel

# Wall-clock timeout, s, which prevents a failing test from hanging.
DISCOVERY_TIMEOUT_S = 60.0
# Speed of simulation time relative to wall time; MAVSDK uses wall time.
SPEED = 4.0


def test_wire_pymavlink_waits_in_simulation_time():
    with spandrel.Vehicle(seed=7) as vehicle:
        connection = vehicle.connect()
        assert connection.recv_match(type="HEARTBEAT", blocking=True, timeout=2).autopilot == 12
        before = vehicle.time_s
        assert connection.recv_match(type="SCALED_PRESSURE3", blocking=True, timeout=1.5) is None
        assert vehicle.time_s - before == pytest.approx(1.5, abs=0.021)


def test_wire_pymavlink_loses_no_messages_during_computation():
    with spandrel.Vehicle(seed=7) as vehicle:
        connection = vehicle.connect()
        connection.wait_heartbeat(timeout=5)
        vehicle.run_for(60.0)
        times = []
        while (message := connection.recv_match(type="ATTITUDE")) is not None:
            times.append(message.time_boot_ms)
        assert times[-1] - times[0] > 59_000
        # 50 Hz, with timestamps in whole milliseconds.
        assert {later - earlier for earlier, later in zip(times, times[1:])} <= {19, 20, 21}


def test_wire_two_pymavlink_connections_run_in_lockstep():
    with spandrel.Vehicle(seed=7) as vehicle:
        first, second = vehicle.connect(), vehicle.connect()
        vehicle.run_for(2.0)
        assert first.recv_match(type="ATTITUDE") is not None
        assert second.recv_match(type="ATTITUDE") is not None


def test_exact_closed_connection_raises_an_error():
    vehicle = spandrel.Vehicle(seed=7)
    vehicle.connect().close()
    with pytest.raises(spandrel.SpandrelError, match="does not reply"):
        vehicle.run_for(1.0)


@pytest.mark.timeout(300)
def test_wire_mavsdk_arms_and_takes_off():
    vehicle = spandrel.Vehicle(seed=7)
    with vehicle.serve(speed=SPEED) as address:
        mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
        try:
            mavsdk.add_any_connection(address)
            system = mavsdk.first_autopilot(DISCOVERY_TIMEOUT_S)
            assert system is not None, "no vehicle discovered"
            telemetry, action = Telemetry(system), Action(system)
            end = time.monotonic() + DISCOVERY_TIMEOUT_S
            while not telemetry.health_all_ok() and time.monotonic() < end:
                vehicle.run_for(0.1)
            action.arm()
            action.takeoff()
            assert vehicle.run_until(lambda state: state.height_m > 1.5, sim_s=60).armed
        finally:
            mavsdk.destroy()
    with pytest.raises(spandrel.LateError):
        vehicle.run_until(lambda state: state.height_m > 100.0, sim_s=1)


def test_exact_serve_and_connect_are_mutually_exclusive():
    vehicle = spandrel.Vehicle()
    with vehicle.serve():
        with pytest.raises(spandrel.SpandrelError, match="served in real time"):
            vehicle.connect()
    vehicle.connect()
    with pytest.raises(spandrel.SpandrelError, match="already connected"), vehicle.serve():
        pass
    vehicle.close()
    with pytest.raises(ValueError, match="speed is 0"), vehicle.serve(speed=0):
        pass
