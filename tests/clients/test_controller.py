"""`spandrel rc` flies a vehicle with controller input, played back from a recording instead of a real device."""

import json
import subprocess

import pytest
from pymavlink import mavutil

import asking
import spandrel

DEVICE, IDENTITY = "Test transmitter", "0483:5710"
# Raw axis numbers of a transmitter on Linux: roll, pitch (reversed), throttle, yaw.
ROLL, PITCH, THROTTLE, YAW = 196608, 196609, 196610, 196613
PROFILE = f"""
format = 1
device = "{DEVICE}"
id = "{IDENTITY}"
stick_mode = 2
[left_vertical]
axis = {THROTTLE}
low = -0.9
centre = 0.0
high = 0.9
[left_horizontal]
axis = {YAW}
low = -1.0
centre = 0.0
high = 1.0
[right_vertical]
axis = {PITCH}
low = 1.0
centre = 0.0
high = -1.0
[right_horizontal]
axis = {ROLL}
low = -1.0
centre = 0.0
high = 1.0
[buttons]
arm = [1]
lamp = [2]
snapshot = [3]
"""


def events():
    """Returns input events: arm, climb, fly forward, switch the lamp, take a photo, and unplug the device in flight."""
    for at, button in ((4.0, 1), (9.0, 2), (9.5, 3)):
        yield {"t_s": at, "button": button, "pressed": True}
        yield {"t_s": at + 0.1, "button": button, "pressed": False}
    for at, axis, value in ((0.0, PITCH, 0.0), (0.0, ROLL, 0.0), (0.0, THROTTLE, 0.0), (0.0, YAW, 0.0),
                            (4.5, THROTTLE, 0.9), (7.0, THROTTLE, 0.0), (7.0, PITCH, -1.0), (9.0, PITCH, 0.0)):
        yield {"t_s": at, "axis": axis, "value": value}
    yield {"t_s": 10.5, "lost": True}
    yield {"t_s": 14.0, "found": True}


@pytest.mark.timeout(300)
def test_wire_transmitter_flies_the_vehicle_and_its_loss_triggers_the_failsafe(tmp_path):
    """Sticks follow the calibration, and buttons send commands. Losing the device centers the sticks and then stops the
    input, which triggers the failsafe."""
    profiles = tmp_path / "profiles"
    profiles.mkdir()
    (profiles / "test-transmitter-0483-5710.toml").write_text(PROFILE, encoding="utf-8")
    record = tmp_path / "flight.jsonl"
    head = {"format": 1, "device": DEVICE, "id": IDENTITY}
    record.write_text("\n".join(json.dumps(line) for line in [head, *sorted(events(), key=lambda e: e["t_s"])]), encoding="utf-8")
    watcher, dial = spandrel.free_udp_port(), spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, watcher, speed=1, gcs_port=dial)
    try:
        link = asking.connect(watcher)
        assert asking.command(link, mavutil.mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 376, 200_000) == 0
        flown = subprocess.Popen(
            [spandrel.PROGRAM, "rc", "--replay", str(record), "--profiles", str(profiles), "--connect", f"127.0.0.1:{dial}"],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )
        seen = {"up": 0.0, "speed": 0.0, "lamp": 0, "pictures": 0, "texts": [], "sticks": set()}

        def take(m):
            kind = m.get_type()
            if kind == "LOCAL_POSITION_NED":
                seen["up"], seen["speed"] = max(seen["up"], -m.z), max(seen["speed"], (m.vx**2 + m.vy**2) ** 0.5)
            elif kind == "RELAY_STATUS":
                seen["lamp"] = max(seen["lamp"], m.on & 1)
            elif kind == "CAMERA_IMAGE_CAPTURED":
                seen["pictures"] += 1
            elif kind == "RC_CHANNELS":
                seen["sticks"].add(m.chan3_raw)
            elif kind == "STATUSTEXT":
                seen["texts"].append(m.text)
            return "manual control lost" in (seen["texts"] or [""])[-1]

        kinds = ["LOCAL_POSITION_NED", "RELAY_STATUS", "CAMERA_IMAGE_CAPTURED", "RC_CHANNELS", "STATUSTEXT"]
        asking.receive(link, kinds, take)
        assert seen["up"] > 3.0 and seen["speed"] > 1.0 and seen["lamp"] == 1 and seen["pictures"] == 1, seen
        assert {1500, 2000} <= seen["sticks"], "calibrated end and center positions"
        _, told = flown.communicate(timeout=60)
        assert flown.returncode == 0 and "disconnected: stick input centered, then stopped" in told, told
        beat = asking.receive(link, "HEARTBEAT", lambda b: b.get_srcComponent() == 1)
        assert beat.base_mode & mavutil.mavlink.MAV_MODE_FLAG_SAFETY_ARMED, "the vehicle must hold its position"
    finally:
        spandrel.end(process)


def test_wire_uncalibrated_device_and_invalid_file_are_reported(tmp_path):
    """Each error contains the file and the allowed values, with the usual exit code."""
    record = tmp_path / "flight.jsonl"
    record.write_text('{"format": 1, "device": "Pad", "id": "1:2"}\n', encoding="utf-8")

    def rc(*args):
        return subprocess.run(
            [spandrel.PROGRAM, "rc", "--profiles", str(tmp_path), *args], capture_output=True, text=True, timeout=60, check=False,
        )

    refused = rc("--replay", str(record))
    assert refused.returncode == 1 and "'Pad' is not calibrated: run `spandrel rc --calibrate`" in refused.stderr
    (tmp_path / "pad-1-2.toml").write_text(PROFILE.replace("high = 0.9", "high = 9"), encoding="utf-8")
    refused = rc("--replay", str(record))
    assert refused.returncode == 2 and "left_vertical.high = 9: out of range (allowed: -1 to 1)" in refused.stderr, refused.stderr
    record.write_text("sticks\n", encoding="utf-8")
    refused = rc("--replay", str(record))
    assert refused.returncode == 2 and "flight.jsonl:1: 'sticks' is not a JSON object" in refused.stderr
    refused = rc("--keyboard")
    assert refused.returncode == 1 and "--keyboard needs a terminal" in refused.stderr
    refused = rc("--list")
    assert refused.returncode in (0, 1) and (refused.returncode == 0 or "gamepad" in refused.stderr)


def test_wire_waiting_for_a_vehicle_is_reported(tmp_path):
    """A wrong address or a simulator that has not started yet must be reported."""
    (tmp_path / "pad-1-2.toml").write_text(PROFILE, encoding="utf-8")
    record = tmp_path / "flight.jsonl"
    record.write_text('{"format": 1, "device": "Pad", "id": "1:2"}\n{"t_s": 600, "lost": true}\n', encoding="utf-8")
    dial = spandrel.free_udp_port()
    waits = subprocess.Popen(
        [spandrel.PROGRAM, "rc", "--replay", str(record), "--profiles", str(tmp_path), "--connect", f"127.0.0.1:{dial}"],
        stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
    )
    said = (line.strip() for line in waits.stderr)
    told = []
    try:
        told.append(next(line for line in said if "vehicle" in line))
        sim = spandrel.start_sim(tmp_path, spandrel.free_udp_port(), speed=1, gcs_port=dial)
        told.append(next(line for line in said if "vehicle" in line))
        spandrel.end(sim)
    finally:
        spandrel.end(waits)
    assert told == [f"waiting for a vehicle at 127.0.0.1:{dial}", f"connected to the vehicle at 127.0.0.1:{dial}"]
    assert waits.returncode == 0
