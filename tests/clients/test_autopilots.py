"""External autopilots as processes, with a small program in place of PX4: start, misbehavior, restarts, several vehicles.
Real PX4 and ArduPilot are in test_real_autopilots.py."""

import json
import pathlib
import re
import socket
import subprocess
import sys

import pytest
from pymavlink import mavutil

import spandrel
from spandrel import wait_for

FAKE = pathlib.Path(__file__).with_name("fake_px4.py")
# Height that counts as flying, m.
HEIGHT_M = 2.0
# Timeout of the simulator for an autopilot that does not answer, s: short, so that the tests of failures end soon.
TIMEOUT_S = 2


def build(folder, behavior="fly"):
    """Creates a folder that looks like PX4's build folder, with the small autopilot as its program."""
    folder = pathlib.Path(folder) / "px4"
    (folder / "bin").mkdir(parents=True)
    (folder / "etc" / "init.d-posix").mkdir(parents=True)
    (folder / "etc" / "init.d-posix" / "rcS").write_text("", encoding="utf-8")
    (folder / "behavior").write_text(behavior, encoding="utf-8")
    program = folder / "bin" / "px4"
    text = f"#!{sys.executable}\nimport sys\nsys.path.insert(0, {str(FAKE.parent)!r})\nimport fake_px4\nfake_px4.main()\n"
    program.write_text(text, encoding="utf-8")
    program.chmod(0o755)
    return folder


def arguments(px4, *more, scenario="drill-hover", timeout_s=TIMEOUT_S):
    """Returns the command line of a simulator with that autopilot: a build folder, or a tuple of options in place of --px4."""
    own = px4 if isinstance(px4, tuple) else ("--px4", str(px4))
    return [
        spandrel.PROGRAM, "sim", "--scenario", scenario, "--seed", "7", "--ports", "ephemeral", "--autopilot", "px4", *own,
        "--autopilot-timeout", str(timeout_s), *more,
    ]


class Vehicle:
    """A simulator with an external autopilot, and a ground station."""

    def __init__(self, folder, px4, *more, stdin=subprocess.DEVNULL, timeout_s=TIMEOUT_S):
        self.folder = pathlib.Path(folder)
        self.port = spandrel.free_udp_port()
        self.station = mavutil.mavlink_connection(f"udpin:127.0.0.1:{self.port}", source_system=255, source_component=190)
        self.log = open(self.folder / "sim.txt", "w", encoding="utf-8")
        command = arguments(px4, "--gcs", f"127.0.0.1:{self.port}", "--autopilot-dir", str(self.folder / "work"), "--announce", *more, timeout_s=timeout_s)
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=self.log, stdin=stdin, text=True)
        self.bound = json.loads(self.process.stdout.readline())

    def output(self):
        """Returns the log so far."""
        return (self.folder / "sim.txt").read_text(encoding="utf-8")

    def hear(self, kind, predicate=lambda _: True):
        """Returns the next message of this kind for which the predicate is true."""
        def next_one():
            message = self.station.recv_match(type=kind, blocking=True, timeout=0.1)
            assert message is not None or self.process.poll() is None, f"the simulator has exited: {self.output()[-1000:]}"
            return message if message is not None and predicate(message) else None
        return wait_for(kind, next_one)

    def discard(self):
        """Discards the messages that have arrived so far. Otherwise, they fill the socket's buffer, which then loses the next ones."""
        while self.station.recv_match(blocking=False) is not None:
            pass

    def command(self, component, command, *params):
        """Sends a command and returns its acknowledgment."""
        values = list(params) + [0.0] * (7 - len(params))
        self.station.mav.command_long_send(1, component, command, 0, *values)
        return self.hear("COMMAND_ACK", lambda ack: ack.command == command).result

    def take_off(self):
        """Arms and climbs."""
        mav = mavutil.mavlink
        self.hear("SYS_STATUS", lambda status: status.onboard_control_sensors_health & mav.MAV_SYS_STATUS_PREARM_CHECK)
        assert self.command(1, mav.MAV_CMD_COMPONENT_ARM_DISARM, 1) == mav.MAV_RESULT_ACCEPTED
        start = self.hear("HIL_STATE_QUATERNION").alt

        def climbed():
            self.station.mav.manual_control_send(1, 0, 0, 1000, 0, 0)
            return self.hear("HIL_STATE_QUATERNION").alt > start + 1000 * HEIGHT_M
        wait_for("the takeoff", climbed)

    def close(self):
        """Ends the simulator."""
        spandrel.end(self.process)
        self.process.stdout.close()
        self.station.close()
        self.log.close()
        print(self.output()[-3000:])


@pytest.fixture
def vehicle(request, tmp_path):
    """A simulator with the small autopilot."""
    vehicle = Vehicle(tmp_path, build(tmp_path, getattr(request, "param", "fly")))
    yield vehicle
    vehicle.close()


@pytest.mark.parametrize("vehicle", ["fly", "garbage"], indirect=True)
def test_takes_off_and_records_the_autopilot(vehicle):
    vehicle.take_off()
    spandrel.end(vehicle.process)
    record = json.loads((vehicle.folder / "work" / "autopilot.json").read_text(encoding="utf-8"))
    assert record["autopilot"] == "PX4" and record["reproducible"] is False
    assert float(record["parameters_set_at_start"]["CA_ROTOR_COUNT"]) == 4
    assert (vehicle.folder / "work" / "output.log").exists()


@pytest.mark.parametrize(
    ("behavior", "code", "words"),
    [
        ("absent", 3, "has not connected to the simulator"),
        ("mute", 3, "has not sent motor commands"),
        ("silent", 4, "has not answered"),
        ("close", 5, "closed its connection"),
        ("exit", 5, "exited"),
    ],
)
def test_misbehavior_ends_with_its_own_message_and_exit_code(tmp_path, behavior, code, words):
    command = arguments(build(tmp_path, behavior), "--autopilot-dir", str(tmp_path / "work"), "--speed", "max")
    done = subprocess.run(command, capture_output=True, text=True, timeout=spandrel.FLIGHT_LIMIT_S, check=False)
    accepted = {code} if behavior != "exit" else {5}
    assert done.returncode in accepted, done.stderr
    # The connection closes slightly before the process exits; both messages are correct then.
    words = f"{words}|closed its connection" if behavior == "exit" else words
    assert re.search(words, done.stderr) and "output.log" in done.stderr, done.stderr


def test_demo_keeps_the_exit_code(tmp_path):
    px4 = build(tmp_path, "absent")
    command = [
        spandrel.PROGRAM, "demo", "--scenario", "drill-hover", "--autopilot", "px4", "--px4", str(px4), "--autopilot-timeout", "1",
        "--sessions", str(tmp_path / "sessions"),
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=spandrel.FLIGHT_LIMIT_S, check=False)
    assert done.returncode == 3, done.stderr


def test_missing_program_and_wrong_options_are_explained(tmp_path):
    def told(*more):
        done = subprocess.run([spandrel.PROGRAM, "sim", *more], capture_output=True, text=True, timeout=60, check=False,
                              env={"PATH": str(tmp_path)})
        assert done.returncode == 2, (done.returncode, done.stderr)
        return done.stderr
    free = ("--ports", "ephemeral")
    assert "make px4_sitl_default" in told("--autopilot", "px4", *free)
    assert "waf configure --board sitl" in told("--autopilot", "ardupilot", *free)
    assert "250, 500, 1000" in told("--autopilot", "px4", "--px4", str(build(tmp_path)), "--autopilot-rate", "333", *free)
    assert "--wait" in told("--wait", *free)
    assert "--params" in told("--autopilot", "px4", "--params", str(tmp_path / "x.params"), *free)


def test_occupied_port_is_named(tmp_path):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        command = arguments(build(tmp_path), "--autopilot-port", str(port))
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 1 and str(port) in done.stderr and "--autopilot-port" in done.stderr, done.stderr


def test_second_connection_is_rejected_and_the_flight_goes_on(vehicle):
    vehicle.hear("HIL_STATE_QUATERNION")
    with socket.create_connection(("127.0.0.1", vehicle.bound["autopilot_port"])) as second:
        second.settimeout(spandrel.FLIGHT_LIMIT_S)
        assert second.recv(1) == b"", "the simulator closes it"
    vehicle.take_off()
    assert "rejected a second connection" in vehicle.output()


def test_reboot_command_restarts_the_process(vehicle):
    vehicle.hear("HIL_STATE_QUATERNION")
    started = lambda: re.findall(r"started PX4 \(process (\d+)\)", vehicle.output())  # noqa: E731
    reboot = mavutil.mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN
    assert vehicle.command(1, reboot, 1) == mavutil.mavlink.MAV_RESULT_ACCEPTED
    wait_for("a second process", lambda: len(started()) == 2)
    vehicle.take_off()
    assert len(set(started())) == 2


def test_autopilot_ends_with_the_simulator(vehicle):
    vehicle.hear("HIL_STATE_QUATERNION")
    process = int(re.search(r"started PX4 \(process (\d+)\)", vehicle.output())[1])
    assert pathlib.Path(f"/proc/{process}").exists()
    spandrel.end(vehicle.process)
    assert not pathlib.Path(f"/proc/{process}").exists()


def test_user_can_start_the_autopilot(tmp_path):
    vehicle = Vehicle(tmp_path, build(tmp_path), "--wait")
    command = wait_for("the command", lambda: re.search(r"^\(cd .*\)$", vehicle.output(), re.MULTILINE))[0]
    with open(tmp_path / "autopilot.txt", "w", encoding="utf-8") as log:
        autopilot = subprocess.Popen(["sh", "-c", command], stdout=log, stderr=log, stdin=subprocess.DEVNULL)
        try:
            vehicle.take_off()
        finally:
            vehicle.close()
            # The autopilot ends by itself when the simulator closes the connection.
            autopilot.wait(timeout=spandrel.FLIGHT_LIMIT_S)


def test_four_vehicles_have_four_autopilots(tmp_path):
    vehicle = Vehicle(tmp_path, build(tmp_path), "--instances", "4")
    ready = set()

    def all_ready():
        status = vehicle.hear("SYS_STATUS")
        if status.onboard_control_sensors_health & mavutil.mavlink.MAV_SYS_STATUS_PREARM_CHECK:
            ready.add(status.get_srcSystem())
        return ready == {1, 2, 3, 4}
    try:
        wait_for("four autopilots", all_ready)
        assert sorted(folder.name for folder in (tmp_path / "work").iterdir()) == ["1", "2", "3", "4"]
    finally:
        vehicle.close()


def test_pause_keeps_the_vehicle_connected(tmp_path):
    vehicle = Vehicle(tmp_path, build(tmp_path), "--leash", stdin=subprocess.PIPE)

    def say(line):
        vehicle.process.stdin.write(line + "\n")
        vehicle.process.stdin.flush()
    try:
        vehicle.hear("HIL_STATE_QUATERNION", lambda state: state.time_usec > 0)
        say("pause")
        vehicle.hear("STATUSTEXT", lambda text: text.text == "Simulation paused")
        # The autopilot's clock is stopped, so these are the simulator's repetitions.
        beats = [vehicle.hear("HEARTBEAT", lambda beat: beat.get_srcComponent() == 1) for _ in range(3)]
        assert {beat.autopilot for beat in beats} == {mavutil.mavlink.MAV_AUTOPILOT_PX4}
        say("resume")
        first = vehicle.hear("HIL_STATE_QUATERNION").time_usec
        vehicle.hear("HIL_STATE_QUATERNION", lambda state: state.time_usec > first)
    finally:
        vehicle.process.stdin.close()
        vehicle.close()
