"""Fixtures: one flight per test, with its own ports."""

import json

import pytest

import sdk
import spandrel
import webserver

# Test measurements for the summary; they do not affect the result.
MEASURED = []


# Files whose tests take longest (`--durations=0`). They begin first, so that no process is left alone with one of them at the end. Windows are beside
# clients that mostly wait; browsers and renderings come after them.
LONG_FILES = (
    "test_flow", "test_pymavlink", "test_lesson_gamepad", "test_bad_radio", "test_mavsdk", "test_simple_clients", "test_practice", "test_school",
    "test_px4_flows", "test_mavsdk_bridges", "test_flavors", "test_lesson", "test_settings", "test_stations", "test_speech", "test_live_camera", "test_view",
    "test_stream", "test_lesson_keys", "test_faults", "test_report", "test_web", "test_certification", "test_dataset", "test_training", "test_study",
    "test_web_editor", "test_web_instructor", "test_video", "test_web_pictures", "test_web_attacks",
)


def pytest_collection_modifyitems(items):
    """Sorts the tests by file: the long files first, the others in the order of their names."""
    rank = {name: k for k, name in enumerate(LONG_FILES)}
    items.sort(key=lambda item: rank.get(item.path.stem, len(rank)))


@pytest.fixture
def measured():
    """Returns a function that records a measurement for the summary."""
    return MEASURED.append


def pytest_sessionfinish(session):
    """Hands a worker process's measurements to the main process."""
    if hasattr(session.config, "workeroutput"):
        session.config.workeroutput["measured"] = MEASURED


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node):
    """Takes the measurements of a worker process, unless it crashed."""
    MEASURED.extend(getattr(node, "workeroutput", {}).get("measured", []))


def pytest_terminal_summary(terminalreporter):
    """Prints the measurements at the end of the output, even if all tests pass."""
    for line in MEASURED:
        terminalreporter.write_line(f"measured: {line}")


@pytest.fixture(scope="module")
def server(sessions):
    """A web server that the tests of one file share. The file's fixture `sessions` returns the folder."""
    server = webserver.Server(sessions)
    yield server
    server.close()


@pytest.fixture
def flight(request, tmp_path):
    """Simulator and monitor for one test. Emulates PX4 unless the test specifies another autopilot."""
    flight = spandrel.Flight(tmp_path, flavor=getattr(request, "param", "px4"))
    yield flight
    flight.close()
    print((tmp_path / "log.txt").read_text(encoding="utf-8")[-4000:])


@pytest.fixture
def job():
    """Returns the exported job: paths, defects, limits."""
    return json.loads(spandrel.run("export", "two-bridges", "--seed", "7", "--scenario", "-"))


@pytest.fixture
def vehicle(request, tmp_path):
    """MAVSDK's system for a simulated vehicle that is ready to arm, and its telemetry. Emulates PX4 unless the test
    specifies another autopilot."""
    flavor = getattr(request, "param", "px4")
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port, "--flavor", flavor)
    mavsdk, system = sdk.connect(port)
    yield system, (sdk.request_telemetry if flavor == "ardupilot" else sdk.ready)(system)
    mavsdk.destroy()
    spandrel.end(process)


@pytest.fixture
def launch(tmp_path):
    """Returns a function that starts a vehicle and returns its ground station port. All vehicles stop at the end of the
    test."""
    started = []

    def start(flavor, *more, speed=spandrel.SPEED):
        port = spandrel.free_udp_port()
        started.append(spandrel.start_sim(tmp_path, port, "--flavor", flavor, *more, speed=speed))
        return port

    yield start
    for process in started:
        spandrel.end(process)
