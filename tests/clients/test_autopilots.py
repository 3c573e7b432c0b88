"""External autopilots as processes, with small programs in place of PX4 and ArduPilot: start, misbehavior, restarts, several vehicles.
Real PX4 and ArduPilot are in test_real_autopilots.py."""

import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys

import pytest
from pymavlink import mavutil

import fake_px4
import spandrel
from spandrel import wait_for

HERE = pathlib.Path(__file__).parent
NAMES = {"px4": "PX4", "ardupilot": "ArduPilot"}
BOTH = pytest.mark.parametrize("kind", NAMES)
# Height that counts as flying, m.
HEIGHT_M = 2.0
# Timeouts of the simulator for an autopilot that does not answer, s: short if it never does, so that the tests end soon; for one that starts first, long
# enough to start on a busy computer.
TIMEOUT_S, START_TIMEOUT_S, FLIGHT_TIMEOUT_S = 2, 8, 60


def build(folder, behavior="fly", kind="px4"):
    """Creates a folder that looks like the autopilot's build folder, with the small autopilot as its program."""
    folder = pathlib.Path(folder) / kind
    program = folder / {"px4": "bin/px4", "ardupilot": "build/sitl/bin/arducopter"}[kind]
    program.parent.mkdir(parents=True)
    if kind == "px4":
        (folder / "etc" / "init.d-posix").mkdir(parents=True)
        (folder / "etc" / "init.d-posix" / "rcS").write_text("", encoding="utf-8")
    set_behavior(folder, behavior)
    text = f"#!{sys.executable}\nimport sys\nsys.path.insert(0, {str(HERE)!r})\nimport fake_{kind}\nfake_{kind}.main()\n"
    program.write_text(text, encoding="utf-8")
    program.chmod(0o755)
    return folder


def set_behavior(folder, behavior):
    """Sets how the small autopilot behaves after its next start."""
    place = folder if folder.name == "px4" else folder / "build/sitl/bin"
    (place / "behavior").write_text(behavior, encoding="utf-8")


def arguments(autopilot, *more, scenario="drill-hover", timeout_s=TIMEOUT_S, command=("sim", "--ports", "ephemeral")):
    """Returns the command line of a simulator with that autopilot: a build folder, or a tuple of options in place of --px4."""
    own = ("px4", *autopilot) if isinstance(autopilot, tuple) else (autopilot.name, f"--{autopilot.name}", str(autopilot))
    return [
        spandrel.PROGRAM, *command, "--scenario", scenario, "--seed", "7", "--autopilot", *own, "--autopilot-timeout", str(timeout_s), *more,
    ]


class Vehicle:
    """A simulator with an external autopilot, and a ground station."""

    def __init__(self, folder, autopilot, *more, stdin=subprocess.DEVNULL, timeout_s=FLIGHT_TIMEOUT_S):
        self.autopilot = autopilot
        self.folder = pathlib.Path(folder)
        self.port = spandrel.free_udp_port()
        self.station = mavutil.mavlink_connection(f"udpin:127.0.0.1:{self.port}", source_system=255, source_component=190)
        self.log = open(self.folder / "sim.txt", "w", encoding="utf-8")
        command = arguments(autopilot, "--gcs", f"127.0.0.1:{self.port}", "--autopilot-dir", str(self.folder / "work"), "--announce", *more, timeout_s=timeout_s)
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

    def started(self):
        """Returns the numbers of the processes that were started."""
        return [int(number) for number in re.findall(r"started \w+ \(process (\d+)\)", self.output())]

    def record(self):
        """Returns the record of the autopilot."""
        return json.loads((self.folder / "work" / "autopilot.json").read_text(encoding="utf-8"))

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
def start(tmp_path):
    """Returns a function that starts a simulator with the small autopilot."""
    started = []

    def one(*more, behavior="fly", kind="px4", **options):
        started.append(Vehicle(tmp_path, build(tmp_path, behavior, kind), *more, **options))
        return started[-1]

    yield one
    for vehicle in started:
        vehicle.close()


@pytest.fixture
def vehicle(start):
    """A simulator with the small autopilot in place of PX4."""
    return start()


@pytest.mark.parametrize(("kind", "behavior"), [("px4", "fly"), ("px4", "garbage"), ("ardupilot", "fly"), ("ardupilot", "garbage"), ("ardupilot", "resend")])
def test_takes_off_and_records_the_autopilot(start, kind, behavior):
    vehicle = start(behavior=behavior, kind=kind)
    vehicle.take_off()
    spandrel.end(vehicle.process)
    record = vehicle.record()
    assert record["autopilot"] == NAMES[kind] and record["reproducible"] is False
    set_at_start = {"px4": ("CA_ROTOR_COUNT", 4), "ardupilot": ("FRAME_CLASS", 1)}[kind]
    assert float(record["parameters_set_at_start"][set_at_start[0]]) == set_at_start[1]
    assert record["version"]["number"] == {"px4": "1.16.0", "ardupilot": "4.6.3"}[kind]
    assert record["parameters"].keys() == {name.decode() for name in fake_px4.PARAMETERS}
    assert (vehicle.folder / "work" / "output.log").exists()
    assert "has been flown with" not in vehicle.output()


@BOTH
def test_other_version_is_named_in_a_warning(start, kind):
    vehicle = start(behavior="version", kind=kind)
    vehicle.take_off()
    assert re.search(rf"WARN Spandrel has been flown with {NAMES[kind]} [\d.]+ to [\d.]+ only", vehicle.output()), vehicle.output()


@pytest.mark.parametrize(
    ("kind", "behavior", "code", "words"),
    [
        ("px4", "absent", 3, "has not connected to the simulator"),
        ("px4", "mute", 3, "has not sent motor commands"),
        ("px4", "babble", 3, "has not sent motor commands"),
        ("px4", "silent", 4, "has not answered"),
        ("px4", "chatter", 4, "has not answered"),
        ("px4", "close", 5, "closed its connection"),
        # The connection closes slightly before the process exits; both messages are correct then.
        ("px4", "exit", 5, "exited|closed its connection"),
        ("ardupilot", "absent", 3, "has not connected to the simulator"),
        ("ardupilot", "blind", 4, "has not answered"),
        ("ardupilot", "silent", 4, "has not answered"),
        ("ardupilot", "exit", 5, "exited"),
    ],
)
def test_misbehavior_ends_with_its_own_message_and_exit_code(tmp_path, kind, behavior, code, words):
    timeout_s = {3: TIMEOUT_S, 4: START_TIMEOUT_S, 5: FLIGHT_TIMEOUT_S}[code]
    command = arguments(build(tmp_path, behavior, kind), "--autopilot-dir", str(tmp_path / "work"), "--speed", "max", timeout_s=timeout_s)
    done = subprocess.run(command, capture_output=True, text=True, timeout=spandrel.FLIGHT_LIMIT_S, check=False)
    assert done.returncode == code, done.stderr
    assert re.search(f"spandrel: {NAMES[kind]} .*({words})", done.stderr) and "output.log" in done.stderr, done.stderr
    assert ("lift-off" in done.stderr) == (behavior in ("close", "exit")), done.stderr
    # What was known of the autopilot is recorded even if the flight ends so.
    record = json.loads((tmp_path / "work" / "autopilot.json").read_text(encoding="utf-8"))
    assert (record["version"] is None) == (behavior in ("absent", "blind")), record["version"]


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


@BOTH
def test_reboot_command_restarts_the_autopilot(start, kind):
    """PX4 gets a new process. ArduPilot restarts in its process, and counts its packets from 0 again."""
    vehicle = start(kind=kind)
    starts = lambda: vehicle.discard() or vehicle.output().count("the autopilot is ready")  # noqa: E731
    wait_for("the start", starts)
    reboot = mavutil.mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN
    assert vehicle.command(1, reboot, 1) == mavutil.mavlink.MAV_RESULT_ACCEPTED
    processes = {"px4": 2, "ardupilot": 1}[kind]
    wait_for("the processes", lambda: len(vehicle.started()) == processes)
    wait_for("a second start", lambda: starts() == 2)
    vehicle.take_off()
    assert len(set(vehicle.started())) == processes


def test_record_survives_a_process_that_does_not_become_ready(start):
    vehicle = start(timeout_s=START_TIMEOUT_S)
    wait_for("the record", lambda: vehicle.discard() or (vehicle.folder / "work" / "autopilot.json").exists())
    set_behavior(vehicle.autopilot, "mute")
    vehicle.command(1, mavutil.mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1)
    vehicle.process.wait(timeout=spandrel.FLIGHT_LIMIT_S)
    assert vehicle.process.returncode == 3, vehicle.output()
    assert vehicle.record()["version"]["number"] == "1.16.0"


def test_ardupilot_keeps_its_parameters_after_a_crash(start):
    """Only the first start deletes those that an earlier session saved."""
    vehicle = start("--after-crash", "respawn", kind="ardupilot")
    given = lambda: (vehicle.folder / "work" / "arguments.txt").read_text(encoding="utf-8").split()  # noqa: E731
    vehicle.take_off()
    assert given()[-1] == "-w"
    motor = mavutil.mavlink.FAILURE_UNIT_SYSTEM_MOTOR
    assert vehicle.command(1, mavutil.mavlink.MAV_CMD_INJECT_FAILURE, motor, mavutil.mavlink.FAILURE_TYPE_OFF, 1) == mavutil.mavlink.MAV_RESULT_ACCEPTED
    wait_for("a second process", lambda: vehicle.discard() or len(vehicle.started()) == 2)
    # The file is empty while the second process writes it.
    wait_for("its arguments", lambda: given()[-1:] not in ([], ["-w"]))


@pytest.mark.parametrize("kill", [signal.SIGTERM, signal.SIGKILL])
@BOTH
def test_autopilot_ends_with_the_simulator(start, kind, kill):
    vehicle = start(kind=kind)
    vehicle.hear("HIL_STATE_QUATERNION")
    process, = vehicle.started()
    assert pathlib.Path(f"/proc/{process}").exists()
    vehicle.process.send_signal(kill)
    vehicle.process.wait(timeout=spandrel.FLIGHT_LIMIT_S)
    wait_for("the end of the autopilot", lambda: has_ended(process))


def has_ended(process):
    """Returns whether a process has ended. Nobody may collect the exit status of an orphan in a container."""
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0] == "Z"
    except FileNotFoundError:
        return True


@BOTH
def test_user_can_start_the_autopilot(tmp_path, kind):
    vehicle = Vehicle(tmp_path, build(tmp_path, kind=kind), "--wait")
    command = wait_for("the command", lambda: re.search(r"^\(cd .*\)$", vehicle.output(), re.MULTILINE))[0]
    with open(tmp_path / "autopilot.txt", "w", encoding="utf-8") as log:
        autopilot = subprocess.Popen(["sh", "-c", command], stdout=log, stderr=log, stdin=subprocess.DEVNULL, start_new_session=True)
        try:
            vehicle.take_off()
        finally:
            vehicle.close()
            # PX4 ends by itself when the simulator closes the connection. ArduPilot waits for another simulator.
            if kind == "ardupilot":
                os.killpg(autopilot.pid, signal.SIGTERM)
            autopilot.wait(timeout=spandrel.FLIGHT_LIMIT_S)


@BOTH
def test_four_vehicles_have_four_autopilots(tmp_path, kind):
    vehicle = Vehicle(tmp_path, build(tmp_path, kind=kind), "--instances", "4")
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
