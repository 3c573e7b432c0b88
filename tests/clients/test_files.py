"""Accesses the vehicle's folder with MAVSDK's FTP, and reads the flight log with PX4's own library."""

import base64
import json
import math
import pathlib
import signal
import struct
import subprocess
import time

import pytest
from mavsdk.plugins.ftp import Ftp, FtpResult
from mavsdk.plugins.log_files import LogFiles, LogFilesResult
from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader
from pyulog import ULog

import asking
import sdk
import spandrel
from spandrel import wait_for

# Tolerance between the log and telemetry at the default takeoff height, m.
HEIGHT_TOLERANCE_M = 0.3
# Vertical speed below which the vehicle hovers, m/s; the end of a climb at 1.5 m/s is faster.
STEADY_M_S = 0.1
# Tolerance of the log's unit quaternions, which are stored as 32-bit floats.
QUATERNION_TOLERANCE = 1e-5


@pytest.fixture
def vehicle(tmp_path):
    """A simulator with its own folder, and its port."""
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port, "--files", str(tmp_path / "files"))
    yield process, port, tmp_path / "files"
    spandrel.end(process)


def wait(start, *args):
    """Starts a call that reports progress, and waits until it is done."""
    results = []
    start(*args, lambda result, _progress, _data: results.append(FtpResult(result)))
    return wait_for("end of the transfer", lambda: next((r for r in results if r != FtpResult.NEXT), None))


@pytest.mark.timeout(600)
def test_wire_mavsdk_transfers_files(vehicle, tmp_path):
    """Uploads, lists, compares, renames, downloads (in both ways) and removes files."""
    _process, port, folder = vehicle
    mavsdk, system = sdk.connect(port)
    ftp = Ftp(system)
    local = tmp_path / "survey.bin"
    local.write_bytes(bytes(k * k % 251 for k in range(50_000)))
    ftp.create_directory("/jobs")
    assert wait(ftp.upload_async, str(local), "/jobs") == FtpResult.SUCCESS
    assert (folder / "jobs" / "survey.bin").read_bytes() == local.read_bytes()
    assert ftp.are_files_identical(str(local), "/jobs/survey.bin")
    ftp.rename("/jobs/survey.bin", "/jobs/flown.bin")
    listed = ftp.list_directory("/jobs").entries
    assert [entry.name for entry in listed] == ["flown.bin"]
    for burst in (False, True):
        down = tmp_path / f"down-{burst}"
        down.mkdir()
        assert wait(ftp.download_async, "/jobs/flown.bin", str(down), burst) == FtpResult.SUCCESS
        assert (down / "flown.bin").read_bytes() == local.read_bytes()
    ftp.remove_file("/jobs/flown.bin")
    ftp.remove_directory("/jobs")
    assert not (folder / "jobs").exists()
    mavsdk.destroy()


@pytest.mark.timeout(600)
def test_wire_checksum_of_a_huge_file_does_not_block_the_vehicle(tmp_path, measured):
    """CreateFile, TruncateFile to 256 MiB, CalcFileCRC32: heartbeats continue before the response, and a size above
    the quota is rejected."""
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port, "--files", str(tmp_path / "files"), speed=1)
    try:
        link = asking.connect(port)

        def ftp(sequence, opcode, offset, path):
            """Sends a request."""
            header = struct.pack("<HBBBBBBI", sequence, 0, opcode, len(path), 0, 0, 0, offset)
            link.mav.file_transfer_protocol_send(0, 1, 1, (header + path).ljust(251, b"\0"))

        def answer(sequence, opcode, offset, path):
            """Returns the response to a request: opcode and data."""
            fits = lambda m: bytes(m.payload[:2]) == struct.pack("<H", sequence + 1)  # noqa: E731
            payload = bytes(asking.ask(link, lambda: ftp(sequence, opcode, offset, path), "FILE_TRANSFER_PROTOCOL", fits).payload)
            return payload[3], payload[12 : 12 + payload[4]]

        create, truncate, checksum, ack, nak = 6, 12, 14, 128, 129
        assert answer(1, create, 0, b"/huge")[0] == ack
        assert answer(3, truncate, 256 * 1024 * 1024, b"/huge")[0] == ack
        ftp(5, checksum, 0, b"/huge")
        beats, begin = [time.monotonic()], time.monotonic()
        while True:
            message = link.recv_match(type=["HEARTBEAT", "FILE_TRANSFER_PROTOCOL"], blocking=True, timeout=asking.LIMIT_S)
            if message.get_type() == "FILE_TRANSFER_PROTOCOL":
                break
            if message.get_srcComponent() == 1:
                beats.append(time.monotonic())
        payload = bytes(message.payload)
        assert (payload[3], payload[12:16]) == (ack, bytes(4)), "the checksum of zeros must be zero"
        assert len(beats) > 1, "no heartbeat before the response"
        gaps = [later - sooner for sooner, later in zip(beats, [*beats[1:], time.monotonic()], strict=True)]
        measured(f"checksum of 256 MiB: {time.monotonic() - begin:.1f} s, longest time without a heartbeat {max(gaps):.1f} s")
        assert answer(7, truncate, 256 * 1024 * 1024 + 1, b"/huge")[0] == nak
        assert answer(9, create, 0, b"/log/mine.ulg")[0] == nak, "logs must be write-protected"
    finally:
        spandrel.end(process)


@pytest.mark.timeout(600)
def test_val_pyulog_reads_the_flight_log(vehicle):
    """The log contains takeoff and landing, and its height, modes and attitude agree with telemetry."""
    process, port, folder = vehicle
    mavsdk, system = sdk.connect(port)
    action, telemetry = sdk.take_off(system, 1.5)
    wait_for("a steady hover", lambda: abs(telemetry.position_velocity_ned().velocity.down_m_s) < STEADY_M_S)
    height = telemetry.position().relative_altitude_m
    action.land()
    wait_for("disarmed", lambda: not telemetry.armed())
    mavsdk.destroy()
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=60) == 0
    logs = sorted(folder.glob("log/*/*.ulg"))
    assert len(logs) == 1, logs
    log = ULog(str(logs[0]))
    topics = {dataset.name: dataset.data for dataset in log.data_list}
    position, status, attitude = topics["vehicle_local_position"], topics["vehicle_status"], topics["vehicle_attitude"]
    assert abs(-(position["z"] - position["z"][0]).min() - height) < HEIGHT_TOLERANCE_M
    assert {17, 18} <= set(status["nav_state"]) and set(status["arming_state"]) == {1, 2}
    norms = [math.sqrt(sum(attitude[f"q[{k}]"][row] ** 2 for k in range(4))) for row in range(len(attitude["timestamp"]))]
    assert max(abs(norm - 1) for norm in norms) < QUATERNION_TOLERANCE
    assert log.initial_parameters["MAV_SYS_ID"] == 1
    assert not log.dropouts and not log.file_corruption
    check_recording(logs[0].with_suffix(".mcap"), height)


def read_recording(path):
    """Returns the messages of an MCAP file by topic, using its index."""
    found = {}
    with path.open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            assert channel.message_encoding == "json" and schema.encoding == "jsonschema"
            found.setdefault((channel.topic, schema.name), []).append(json.loads(message.data))
    return found


def check_recording(path, height):
    """Checks with Foxglove's own library that the drone's frame reaches the height, the site is a glTF model, and texts
    are present."""
    found = read_recording(path)
    frames = found["/tf", "foxglove.FrameTransforms"]
    ups = [t["translation"]["z"] for f in frames for t in f["transforms"] if t["child_frame_id"] == "drone"]
    assert abs(max(ups) - ups[0] - height) < HEIGHT_TOLERANCE_M
    for turn in (t["rotation"] for t in frames[-1]["transforms"]):
        assert abs(math.sqrt(sum(turn[k] ** 2 for k in "xyzw")) - 1) < QUATERNION_TOLERANCE
    (site,) = found["/site", "foxglove.SceneUpdate"]
    assert base64.b64decode(site["entities"][0]["models"][0]["data"]).startswith(b"glTF")
    assert "Armed" in [log["message"] for log in found["/log", "foxglove.Log"]]
    assert {("/fix", "foxglove.LocationFix"), ("/camera", "foxglove.CameraCalibration"), ("/battery", "spandrel.Battery")} <= set(found)


@pytest.mark.timeout(600)
def test_val_recording_of_a_killed_simulator_is_recovered(vehicle, tmp_path):
    """After a kill in flight, the indexed reader fails, and `export --mcap` recovers all but the last second."""
    process, port, folder = vehicle
    mavsdk, system = sdk.connect(port)
    sdk.take_off(system, 2.0)
    mavsdk.destroy()
    process.kill()
    process.wait(timeout=60)
    (broken,) = folder.glob("log/*/*.mcap")
    with pytest.raises(McapError), broken.open("rb") as file:
        list(make_reader(file).iter_messages())
    whole = tmp_path / "whole.mcap"
    subprocess.run([spandrel.PROGRAM, "export", str(broken), "--mcap", str(whole)], check=True, timeout=60)
    with whole.open("rb") as file:
        assert len(list(StreamReader(file, validate_crcs=True).records)) > 0
    frames = read_recording(whole)["/tf", "foxglove.FrameTransforms"]
    ups = [t["translation"]["z"] for f in frames for t in f["transforms"] if t["child_frame_id"] == "drone"]
    # The vehicle was at a height of two meters and climbing at 1.5 m/s when the simulator was killed. At most one
    # second is lost.
    assert max(ups) - ups[0] > 0.4
    assert pathlib.Path(broken).stat().st_size > 0


@pytest.mark.timeout(600)
def test_wire_mavsdk_lists_downloads_and_erases_logs(vehicle, tmp_path):
    """The log of an earlier flight is listed with its time, downloaded completely and erased. Other files in the folder
    remain."""
    _process, port, folder = vehicle
    day = folder / "log" / "2026-11-20"
    day.mkdir(parents=True)
    content = bytes(k * k % 253 for k in range(61_234))
    (day / "15_08_00.ulg").write_bytes(content)
    (day / "notes.txt").write_text("not a log", encoding="utf-8")
    mavsdk, system = sdk.connect(port)
    logs = LogFiles(system)
    entries = logs.get_entries()
    assert [(e.id, e.date, e.size_bytes) for e in entries] == [(0, "2026-11-20T15:08:00Z", len(content))]
    results = []
    down = tmp_path / "down.ulg"
    logs.download_log_file_async(entries[0], str(down), lambda result, _progress, _data: results.append(LogFilesResult(result)))
    ended = wait_for("the download", lambda: next((r for r in results if r != LogFilesResult.NEXT), None))
    assert ended == LogFilesResult.SUCCESS and down.read_bytes() == content
    logs.erase_all_log_files()
    wait_for("the deletion", lambda: not (day / "15_08_00.ulg").exists())
    assert (day / "notes.txt").exists()
    mavsdk.destroy()
