"""Measures how fast PX4 and ArduPilot run on Spandrel's physics, next to their own simulators. An aircraft stands on the ground with its
motors stopped; a client reads the autopilot's clock. The settings alternate, so that the machine's load affects all of them equally.
SPANDREL_PX4 and SPANDREL_ARDUPILOT specify the programs.

PX4's own simulator (SIH) has one inertial sensor, so that one estimator runs. "one estimator" is PX4 on Spandrel's physics with
SENS_IMU_MODE 1 and EKF2_MULTI_IMU 0, so that PX4 uses only one of Spandrel's three inertial sensors."""

import argparse
import contextlib
import os
import pathlib
import shutil
import statistics
import subprocess
import tempfile
import time

os.environ["MAVLINK20"] = "1"

from pymavlink import mavutil

import px4
import spandrel
from real_autopilot import INSTANCE, M

# Wall time until an autopilot must have started.
START_LIMIT_S = 180
# Time on the autopilot's clock before a measurement: the start is over.
START_S = 20
SPEED_LIMIT = "1000"
# Interval between the autopilot's messages with its time, on its clock.
TIME_INTERVAL_US = 20_000
# The start script sets parameters from these variables.
ONE_ESTIMATOR = "PX4_PARAM_SENS_IMU_MODE=1 PX4_PARAM_EKF2_MULTI_IMU=0"


def ardupilot_binary():
    """Returns the path of the program, which SPANDREL_ARDUPILOT or its folder contains."""
    path = pathlib.Path(os.environ["SPANDREL_ARDUPILOT"])
    return path if path.is_file() else path / "build/sitl/bin/arducopter"


def px4_with_one_estimator(folder):
    """Makes a program that starts PX4 with the parameters above. Returns its path."""
    build, program = pathlib.Path(px4.BUILD).resolve(), folder / "bin/px4"
    program.parent.mkdir()
    (folder / "etc").symlink_to(build / "etc")
    for tool in (build / "bin").iterdir():
        if tool.name != "px4":
            (folder / "bin" / tool.name).symlink_to(tool)
    program.write_text(f'#!/bin/sh\n{ONE_ESTIMATOR} exec "{build / "bin/px4"}" "$@"\n', encoding="utf-8")
    program.chmod(0o755)
    return program


class OnSpandrel:
    """An autopilot on Spandrel's physics."""

    def __init__(self, autopilot, rate_hz, one_estimator=False):
        self.autopilot, self.rate_hz, self.one_estimator = autopilot, rate_hz, one_estimator
        self.title = f"{autopilot} on Spandrel's physics" + (", one estimator" if one_estimator else "")

    def start(self, folder):
        """Starts the simulator. Returns its process and a connection to it."""
        port = spandrel.free_udp_port()
        link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=255, dialect="all")
        command = [
            spandrel.PROGRAM, "sim", "--scenario", "drill-hover", "--speed", "max", "--ports", "ephemeral", "--gcs", f"127.0.0.1:{port}",
            "--autopilot", self.autopilot, "--autopilot-rate", str(self.rate_hz), "--instance", str(INSTANCE),
        ]
        if self.one_estimator:
            command += ["--px4", str(px4_with_one_estimator(folder))]
        with open(folder / "sim.txt", "w", encoding="utf-8") as log:
            return subprocess.Popen(command, stdout=log, stderr=log, stdin=subprocess.DEVNULL), link


class Sih:
    """PX4 with its own simulator."""

    title, autopilot, rate_hz = "px4 with its own simulator", "px4", 250

    def start(self, folder):
        """Starts PX4. Returns its process and a connection to it."""
        port = spandrel.free_udp_port()
        link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=255, dialect="all")
        (folder / "files").mkdir()
        return px4.start(folder, folder / "files", port, speed=int(SPEED_LIMIT)), link


class OwnQuadrotor:
    """ArduPilot with its own simulator."""

    autopilot = "ardupilot"

    def __init__(self, rate_hz):
        self.rate_hz = rate_hz
        self.title = "ardupilot with its own simulator"

    def start(self, folder):
        """Starts ArduPilot. Returns its process and a connection to it."""
        port = spandrel.free_udp_port()
        link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=255, dialect="all")
        command = [
            ardupilot_binary(), "--model", "quad", "--speedup", SPEED_LIMIT, "--rate", str(self.rate_hz), "-I", str(INSTANCE), "--wipe",
            "--serial0", f"udpclient:127.0.0.1:{port}", "--sim-address", "127.0.0.1",
        ]
        with open(folder / "sim.txt", "w", encoding="utf-8") as log:
            return subprocess.Popen(command, cwd=folder, stdout=log, stderr=log, stdin=subprocess.DEVNULL), link


def clock_s(link, limit_s):
    """Returns the autopilot's time of its next message that contains it."""
    give_up = time.monotonic() + limit_s
    while time.monotonic() < give_up:
        link.mav.heartbeat_send(M.MAV_TYPE_GCS, M.MAV_AUTOPILOT_INVALID, 0, 0, 0)
        message = link.recv_match(type="SYSTEM_TIME", blocking=True, timeout=0.5)
        if message is None:
            link.mav.command_long_send(
                link.target_system, 1, M.MAV_CMD_SET_MESSAGE_INTERVAL, 0, M.MAVLINK_MSG_ID_SYSTEM_TIME, TIME_INTERVAL_US, 0, 0, 0, 0, 0
            )
        elif message.get_srcComponent() == M.MAV_COMP_ID_AUTOPILOT1:
            return message.time_boot_ms / 1000
    raise TimeoutError("no time from the autopilot")


def latest_clock_s(link):
    """Returns the autopilot's current time: discards what is queued first, without decoding it, because at full speed messages arrive faster than they
    are decoded."""
    with contextlib.suppress(BlockingIOError):
        while True:
            link.port.recv(65536)
    return clock_s(link, START_LIMIT_S)


def measure(setting, wall_s):
    """Returns the number of simulated seconds per second of wall time."""
    folder = pathlib.Path(tempfile.mkdtemp())
    process, link = setting.start(folder)
    try:
        clock_s(link, START_LIMIT_S)
        give_up = time.monotonic() + START_LIMIT_S
        while latest_clock_s(link) < START_S:
            if time.monotonic() > give_up:
                raise TimeoutError(f"{setting.title}: did not start")
        began_s, began_wall = latest_clock_s(link), time.monotonic()
        while time.monotonic() - began_wall < wall_s:
            link.recv_match(blocking=True, timeout=0.1)
        return (latest_clock_s(link) - began_s) / (time.monotonic() - began_wall)
    finally:
        spandrel.end(process)
        link.close()
        shutil.rmtree(folder, ignore_errors=True)


def settings(autopilots):
    """Returns the settings, each group starting with its reference."""
    groups = []
    if "px4" in autopilots:
        groups.append([Sih(), OnSpandrel("px4", 250), OnSpandrel("px4", 250, one_estimator=True), OnSpandrel("px4", 500)])
    if "ardupilot" in autopilots:
        groups.append([OwnQuadrotor(1000), OnSpandrel("ardupilot", 1000), OnSpandrel("ardupilot", 500)])
    return groups


def main():
    """Measures everything and prints the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=10, help="wall time of each measurement")
    parser.add_argument("--autopilot", action="append", choices=["px4", "ardupilot"])
    args = parser.parse_args()
    print("| | rate | times real time | ratio |\n|---|---|---|---|")
    for group in settings(args.autopilot or ["px4", "ardupilot"]):
        factors = {setting: [] for setting in group}
        for _ in range(args.runs):
            for setting in group:
                factors[setting].append(measure(setting, args.seconds))
        reference = statistics.median(factors[group[0]])
        for setting in group:
            factor = statistics.median(factors[setting])
            print(f"| {setting.title} | {setting.rate_hz} Hz | {factor:.1f} | {factor / reference:.2f} |", flush=True)


if __name__ == "__main__":
    main()
