"""Hardware in the loop: a small flight controller on a pseudo-terminal, in real time. No test requires hardware."""

import os
import re
import subprocess
import sys

import pytest
from pymavlink import mavutil

import spandrel
from spandrel import wait_for

if sys.platform == "win32":
    pytest.skip("needs pseudo-terminals", allow_module_level=True)

import fake_flight_controller
from test_autopilots import Vehicle, arguments

BAUD = 921_600
# Rate of the readings at this baud rate, and accepted deviation: the test machine is busy with other tests.
RATE_HZ, RATE_TOLERANCE_HZ = 250.0, 25.0
# Accepted error of the measured clock offset, s: half of the longest round trip that counts.
CLOCK_TOLERANCE_S = 0.1
# Timeout of the simulator, s: longer than a reboot on a busy machine, which is no failure in these tests.
PATIENCE_S = 60
REBOOT = mavutil.mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN


@pytest.fixture
def controller(request):
    """A small flight controller."""
    controller = fake_flight_controller.FlightController(getattr(request, "param", "fly"))
    yield controller
    controller.unplug()


def serial(controller, baud=BAUD):
    """Returns the options for the flight controller's port."""
    return ("--serial", f"{controller.path}:{baud}")


def wait_for_restart(vehicle, controller):
    """Waits until the flight controller has rebooted and started. Commands that are sent meanwhile are lost."""
    wait_for("the reboot", lambda: vehicle.discard() or controller.reboots == 1)
    wait_for("the start", lambda: vehicle.discard() or starts(vehicle) == 2)
    vehicle.discard()


def starts(vehicle):
    """Returns how many times the flight controller has started."""
    return vehicle.output().count("the autopilot is ready")


@pytest.fixture
def vehicle(tmp_path, controller):
    """A simulator with the small flight controller."""
    vehicle = Vehicle(tmp_path, serial(controller), timeout_s=PATIENCE_S)
    yield vehicle
    vehicle.close()


def test_takes_off_in_real_time(vehicle, controller):
    vehicle.take_off()
    assert abs(controller.rate_hz() - RATE_HZ) < RATE_TOLERANCE_HZ
    assert controller.kinds["HIL_GPS"] > 0 and controller.kinds["DISTANCE_SENSOR"] > 0
    assert "HIL_STATE_QUATERNION" not in controller.kinds, "the ground truth is not for the flight controller"
    found = wait_for("the clock", lambda: re.search(r"clock is ([-+][0-9.]+) s", vehicle.output()))
    # Both clocks are monotonic, but start at different times: only the small flight controller's offset is known, and the
    # simulator's clock starts with the program.
    started = float(found[1]) - fake_flight_controller.CLOCK_OFFSET_S
    assert 0.0 < started < float(open("/proc/uptime", encoding="utf-8").read().split()[0]) + CLOCK_TOLERANCE_S
    assert (vehicle.folder / "work" / "flight-controller.params").read_text(encoding="utf-8").count("HIL_ACT_FUNC") == 4


def test_reboot_command_reboots_the_flight_controller(vehicle, controller):
    vehicle.hear("HIL_STATE_QUATERNION")
    wait_for("the first start", lambda: vehicle.discard() or starts(vehicle) == 1)
    assert vehicle.command(1, REBOOT, 1) == mavutil.mavlink.MAV_RESULT_ACCEPTED
    wait_for_restart(vehicle, controller)
    vehicle.take_off()
    assert "refuses" not in vehicle.output()


@pytest.mark.parametrize("controller", ["quick"], indirect=True)
def test_quick_reboot_is_recognized_by_the_clock(vehicle, controller):
    vehicle.hear("HIL_STATE_QUATERNION")
    wait_for("the first start", lambda: vehicle.discard() or starts(vehicle) == 1)
    wait_for("the clock", lambda: vehicle.discard() or "clock is" in vehicle.output())
    assert vehicle.command(1, REBOOT, 1) == mavutil.mavlink.MAV_RESULT_ACCEPTED
    wait_for_restart(vehicle, controller)
    vehicle.take_off()


@pytest.mark.parametrize("controller", ["stubborn"], indirect=True)
def test_refused_reboot_waits_for_the_user(vehicle, controller):
    vehicle.hear("HIL_STATE_QUATERNION")
    wait_for("the first start", lambda: vehicle.discard() or starts(vehicle) == 1)
    assert vehicle.command(1, REBOOT, 1) == mavutil.mavlink.MAV_RESULT_ACCEPTED
    wait_for("the explanation", lambda: vehicle.discard() or "disconnect its power" in vehicle.output())
    controller.power_cycle.set()
    wait_for_restart(vehicle, controller)
    vehicle.take_off()


@pytest.mark.parametrize(
    ("controller", "code", "words"),
    [("mute", 3, "has not sent motor commands within"), ("silent", 4, "has not sent motor commands for")],
    indirect=["controller"],
)
def test_silence_has_its_own_message_and_exit_code(tmp_path, controller, code, words):
    command = arguments(serial(controller))
    done = subprocess.run(command, capture_output=True, text=True, timeout=spandrel.FLIGHT_LIMIT_S, check=False)
    assert done.returncode == code and words in done.stderr, done.stderr
    assert ("the motors stop" in done.stderr) == (code == 4), done.stderr


def test_disconnected_port_ends_the_simulation(vehicle, controller):
    vehicle.take_off()
    controller.unplug()
    assert vehicle.process.wait(timeout=spandrel.FLIGHT_LIMIT_S) == 5
    assert f"the flight controller on {controller.path}:{BAUD} has disconnected" in vehicle.output()


def test_wrong_options_are_explained(tmp_path, controller):
    def told(*more, subcommand="sim", options=None):
        command = [spandrel.PROGRAM, subcommand, "--autopilot", "px4", *(options or serial(controller)), *more]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, env={**os.environ, "HOME": str(tmp_path)})
        assert done.returncode == 2, (done.returncode, done.stderr)
        return done.stderr
    free = ("--ports", "ephemeral")
    for option in (("--wait",), ("--px4", str(tmp_path)), ("--autopilot-rate", "250"), ("--autopilot-port", "0"), ("--speed", "2"),
                   ("--speed", "max"), ("--instances", "2"), serial(controller)):
        assert option[0] in told(*option, *free)
    assert "--lockstep" in told("--gcs", "127.0.0.1:9", "--lockstep", "127.0.0.1:9", *free)
    assert "at least" in told(*free, options=serial(controller, 57_600))
    assert "run sim, monitor and view" in told(subcommand="train")
