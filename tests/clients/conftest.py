"""Fixtures: a flight per test, on ports of its own."""

import json

import pytest

import sdk
import spandrel

# What tests have measured, for whoever reads their output; no test fails by it.
MEASURED = []


@pytest.fixture
def measured():
    """Where a test tells what it has measured."""
    return MEASURED.append


def pytest_terminal_summary(terminalreporter):
    """Measured figures at the end of the output, also of tests that pass."""
    for line in MEASURED:
        terminalreporter.write_line(f"measured: {line}")


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
def vehicle(request, tmp_path):
    """MAVSDK's system for a simulated vehicle that would arm, in PX4's flavour unless the test says another, and its telemetry."""
    flavour = getattr(request, "param", "px4")
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port, "--flavour", flavour)
    mavsdk, system = sdk.connect(port)
    yield system, (sdk.asked if flavour == "ardupilot" else sdk.ready)(system)
    mavsdk.destroy()
    spandrel.end(process)


@pytest.fixture
def launch(tmp_path):
    """Starts a vehicle in a flavour and gives the port of its ground station; all end with the test."""
    started = []

    def start(flavour, *more, speed=spandrel.SPEED):
        port = spandrel.free_udp_port()
        started.append(spandrel.start_sim(tmp_path, port, "--flavour", flavour, *more, speed=speed))
        return port

    yield start
    for process in started:
        spandrel.end(process)
