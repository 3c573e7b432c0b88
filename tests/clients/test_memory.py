"""Tests the memory needed to score a session of typical length and to write its report."""

import math
import struct
import subprocess
import sys

import pytest
from pymavlink.dialects.v20 import common as mavlink

import spandrel

# Length of the flight, s; the TASBID job takes 15 to 20 minutes.
FLIGHT_S = 1200
# Start of the recording, 2026-08-01 00:00 UTC, us.
STARTED_US = 1_785_542_400_000_000
# Telemetry rates in a session, Hz: truth and sticks, clearance, contacts, everything else.
TRUTH_HZ, CLEARANCE_HZ, CONTACT_HZ, SLOW_HZ = 50, 25, 10, 1
# Memory limits, MB, between the debug build's consumption (44 and 62) and its consumption when samples were stored at
# full width and the report stored a flight twice (66 and 100). The monitor writes the report in its own process, which
# must stay below 100 MB.
ASSESS_MB = 55
REPORT_MB = 80
# Degrees of latitude per meter (40,000 km circumference).
DEGREES_PER_METER = 360.0 / 40_000_000.0


class Recorder:
    """Stores frames from pymavlink as records of a telemetry log."""

    def __init__(self, path):
        self.file = open(path, "wb")
        self.now_us = STARTED_US

    def write(self, frame):
        """Writes a frame with its time."""
        self.file.write(struct.pack(">Q", self.now_us) + bytes(frame))


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    """A hover drill session with telemetry from a flight of typical length: circles at the shipped job's site."""
    sessions = tmp_path_factory.mktemp("memory") / "sessions"
    spandrel.run("demo", "--scenario", "drill-hover", "--seed", "7", "--speed", "max", "--sessions", str(sessions))
    (session,) = sessions.iterdir()
    scenario = (spandrel.ROOT / "scenarios" / "two-bridges.toml").read_text(encoding="utf-8")
    (session / "scenario.toml").write_text(scenario, encoding="utf-8")
    job = {key: float(line.split("=")[1].split("#")[0]) for line in scenario.splitlines() for key in ["latitude_deg", "longitude_deg", "altitude_m"]
           if line.strip().startswith(key)}
    record = Recorder(session / "telemetry.tlog")
    mav = mavlink.MAVLink(record, srcSystem=1, srcComponent=1)
    for k in range(FLIGHT_S * TRUTH_HZ):
        t_s = k / TRUTH_HZ
        record.now_us = STARTED_US + int(t_s * 1e6)
        boot_ms = int(t_s * 1000)
        up_m = min(t_s, 60.0)
        north_m, east_m = 20.0 * math.sin(t_s / 10.0), 20.0 * math.cos(t_s / 10.0)
        if k % (TRUTH_HZ // SLOW_HZ) == 0:
            mav.heartbeat_send(2, 12, 0x80, 3 << 16, 4)
            mav.named_value_int_send(boot_ms, b"seed", 7)
            mav.battery_status_send(0, 0, 3, 0, [0] * 10, -1, -1, -1, 80)
        mav.hil_state_quaternion_send(
            int(t_s * 1e6), [1.0, 0.0, 0.0, 0.0], 0.0, 0.0, 0.0, int((job["latitude_deg"] + north_m * DEGREES_PER_METER) * 1e7),
            int((job["longitude_deg"] + east_m * DEGREES_PER_METER / math.cos(math.radians(job["latitude_deg"]))) * 1e7),
            int((job["altitude_m"] + up_m) * 1000), 0, 0, 0, 0, 0, 0, 0, 0,
        )
        mav.rc_channels_send(boot_ms, 4, *[1500 + k % 100] * 4, *[65535] * 14, 255)
        if k % (TRUTH_HZ // CLEARANCE_HZ) == 0:
            mav.named_value_float_send(boot_ms, b"clearance", 5.0)
        if k % (TRUTH_HZ // CONTACT_HZ) == 0:
            mav.named_value_int_send(boot_ms, b"contact", 0)
            mav.named_value_int_send(boot_ms, b"hits", 0)
    record.file.close()
    return session


# Runs in a small intermediate process, because a child inherits the memory of its parent until it executes another
# program.
LAUNCHER = """
import os, sys
child = os.spawnv(os.P_NOWAIT, sys.argv[1], sys.argv[1:])
_, status, usage = os.wait4(child, 0)
print(usage.ru_maxrss)
sys.exit(os.waitstatus_to_exitcode(status))
"""


def peak_mb(*args):
    """Runs the program to its end and returns its peak memory in MB."""
    run = subprocess.run([sys.executable, "-c", LAUNCHER, spandrel.PROGRAM, *args], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True)
    return int(run.stdout.split()[-1]) / 1000


@pytest.mark.timeout(600)
def test_regress_scoring_stays_within_its_memory_limit(session, tmp_path, measured):
    """Each telemetry sample must be stored only once, as compactly as transmitted."""
    assess, report = peak_mb("assess", str(session), "--json", str(tmp_path / "scores.json")), peak_mb("report", str(session))
    measured(f"{FLIGHT_S / 60:.0f} minutes, {(session / 'telemetry.tlog').stat().st_size / 1e6:.0f} MB: assess {assess:.0f} MB, report {report:.0f} MB")
    assert assess < ASSESS_MB and report < REPORT_MB
