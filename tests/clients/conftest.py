"""Fixtures: a flight per test, on ports of its own."""

import json

import pytest
from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.telemetry import Telemetry

import spandrel
from spandrel import wait_for


@pytest.fixture
def flight(request, tmp_path):
    """Simulator and monitor for one test, in PX4's flavour unless the test says another."""
    flight = spandrel.Flight(tmp_path, flavour=getattr(request, "param", "px4"))
    yield flight
    flight.close()
    print((tmp_path / "log.txt").read_text(encoding="utf-8")[-4000:])


@pytest.fixture
def job():
    """The job as exported: paths, defects, limits."""
    return json.loads(spandrel.run("export", "two-bridges", "--seed", "7", "--scenario", "-"))


@pytest.fixture
def vehicle(tmp_path):
    """MAVSDK's system for a simulated vehicle that would arm, and its telemetry."""
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port)
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
    system = mavsdk.first_autopilot(60.0)
    assert system is not None, "no vehicle discovered"
    telemetry = Telemetry(system)
    wait_for("health_all_ok", telemetry.health_all_ok)
    yield system, telemetry
    mavsdk.destroy()
    spandrel.end(process)
