"""Links other than UDP, and several vehicles in one process."""

import os
import pty
import select
import signal
import socket
import subprocess
import time
import tty

import pytest
from pymavlink import mavutil

import asking
import spandrel

LIMIT_S = asking.LIMIT_S
BAUD = 57600
# One start bit, eight data bits, one stop bit.
BYTES_S = BAUD / 10


def test_wire_serial_radio_stays_within_its_baud_rate(tmp_path):
    """Over a pseudo-terminal: parameters arrive completely, the byte rate stays within the baud rate, and a command
    is answered."""
    try:
        ours, theirs = pty.openpty()
    except OSError as error:
        pytest.skip(f"this machine has no pseudo-terminals: {error}")
    tty.setraw(ours)
    tty.setraw(theirs)
    sim = spandrel.start_sim(
        tmp_path, spandrel.free_udp_port(), "--serial", f"{os.ttyname(theirs)}:{BAUD}", speed=1,
    )
    try:
        mav = mavutil.mavlink.MAVLink(os.fdopen(ours, "wb", buffering=0, closefd=False), srcSystem=255, srcComponent=190)
        mav.robust_parsing = True
        names, count, received, seconds, acknowledged = set(), None, 0, None, False
        begin = None
        end = time.monotonic() + LIMIT_S
        # Streams, and with them the vehicle's clock, start with a heartbeat.
        mav.heartbeat_send(mavutil.mavlink.MAV_TYPE_GCS, mavutil.mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0)
        mav.param_request_list_send(1, 1)
        mav.command_long_send(1, 1, mavutil.mavlink.MAV_CMD_REQUEST_MESSAGE, 0, 148, 0, 0, 0, 0, 0, 0)
        while time.monotonic() < end and (count is None or len(names) < count or not acknowledged):
            ready, _, _ = select.select([ours], [], [], 1)
            data = os.read(ours, 4096) if ready else b""
            received += len(data)
            for message in mav.parse_buffer(data) or []:
                if hasattr(message, "time_boot_ms"):
                    begin = begin if begin is not None else (message.time_boot_ms, received)
                    seconds = (message.time_boot_ms - begin[0]) / 1000
                if message.get_type() == "PARAM_VALUE" and message.param_index != 65535:
                    names.add(message.param_id)
                    count = message.param_count
                acknowledged |= message.get_type() == "COMMAND_ACK"
        assert count and len(names) == count and acknowledged, (len(names), count, acknowledged)
        # Measured over the entire time on the vehicle's own clock; half a second of data may still be in buffers.
        assert received - begin[1] <= BYTES_S * (seconds + 1.5), (received, seconds)
    finally:
        spandrel.end(sim)
        os.close(ours)
        os.close(theirs)


def test_wire_three_vehicles_in_one_process_are_independent(tmp_path):
    """Systems 1 to 3 connect to the same ground station; arming the second leaves the others on the ground."""
    port = spandrel.free_udp_port()
    sim = spandrel.start_sim(tmp_path, port, "--instances", "3")
    try:
        connection = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=255, source_component=190, dialect="all")
        for system in (1, 2, 3):
            asking.receive(connection, "HEARTBEAT", lambda beat, system=system: beat.get_srcSystem() == system)
        prearm = mavutil.mavlink.MAV_SYS_STATUS_PREARM_CHECK
        asking.receive(
            connection, "SYS_STATUS", lambda m: m.get_srcSystem() == 2 and m.onboard_control_sensors_health & prearm,
        )
        # pymavlink sends to all connected vehicles; only the addressed one must respond.
        assert asking.command(connection, mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1, system=2) == 0
        armed = mavutil.mavlink.MAV_MODE_FLAG_SAFETY_ARMED
        asking.receive(connection, "HEARTBEAT", lambda beat: beat.get_srcSystem() == 2 and beat.base_mode & armed)
        for system in (1, 3):
            beat = asking.receive(
                connection, "HEARTBEAT", lambda beat, system=system: beat.get_srcSystem() == system and beat.get_srcComponent() == 1,
            )
            assert not beat.base_mode & armed
    finally:
        spandrel.end(sim)


def test_wire_tcp_clients_may_disconnect_in_flight(tmp_path):
    """Connects two clients over TCP; the first disconnects in the middle of a frame."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    log = open(tmp_path / "sim.txt", "w", encoding="utf-8")
    sim = subprocess.Popen(
        [spandrel.PROGRAM, "sim", "--scenario", "drill-hover", "--seed", "7", "--ports", "ephemeral", "--tcp-port", str(port)],
        stdout=log, stderr=log, stdin=subprocess.DEVNULL,
    )
    try:
        end = time.monotonic() + LIMIT_S
        rude = None
        while rude is None and time.monotonic() < end:
            try:
                rude = socket.create_connection(("127.0.0.1", port), timeout=LIMIT_S)
            except ConnectionRefusedError:
                time.sleep(0.05)
        assert rude.recv(1) == b"\xfd"
        rude.sendall(b"\xfd\xff\x00")
        rude.close()
        connection = mavutil.mavlink_connection(f"tcp:127.0.0.1:{port}", source_system=255, source_component=190, dialect="all")
        asking.receive(connection, "HEARTBEAT")
        send = lambda: connection.mav.param_request_read_send(1, 1, b"MIS_TAKEOFF_ALT", -1)  # noqa: E731
        asking.ask(connection, send, "PARAM_VALUE", lambda value: value.param_id == "MIS_TAKEOFF_ALT")
        assert sim.poll() is None
    finally:
        sim.send_signal(signal.SIGINT)
        sim.wait(timeout=LIMIT_S)
    assert sim.returncode == 0


def bytes_received_by(stranger, limit_s):
    """Returns the number of bytes received on a socket until none arrive for a while."""
    stranger.settimeout(limit_s)
    count = 0
    try:
        while count < 1_000_000:
            count += len(stranger.recv(65_536))
    except TimeoutError:
        pass
    return count


def test_wire_unknown_peers_get_no_streams_and_do_not_block_a_sidecar(tmp_path):
    """One byte triggers no traffic; 70 invalid datagrams do not block a sidecar; a sidecar's heartbeat starts all of
    its streams."""
    payload = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port := spandrel.free_udp_port(), speed=1, payload_port=payload)
    strangers = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(70)]
    try:
        asking.connect(port)
        for stranger in strangers:
            stranger.sendto(b"\xfd", ("127.0.0.1", payload))
        # A peer would receive its streams within one second.
        assert bytes_received_by(strangers[0], 1.0) == 0
        sidecar = mavutil.mavlink_connection(f"udpout:127.0.0.1:{payload}", source_system=1, source_component=192, dialect="all")
        hello = asking.Repeater(lambda: sidecar.mav.heartbeat_send(18, 8, 0, 0, 4))
        end, truth = time.monotonic() + LIMIT_S, None
        while truth is None and time.monotonic() < end:
            hello.if_due()
            truth = sidecar.recv_match(type="HIL_STATE_QUATERNION", blocking=True, timeout=0.1)
        assert truth is not None, "the sidecar must not be blocked"
    finally:
        for stranger in strangers:
            stranger.close()
        spandrel.end(process)


@pytest.mark.timeout(300)
def test_wire_monitor_ignores_unknown_senders(tmp_path):
    """The monitor must select the vehicle despite datagrams from a stranger and heartbeats from a ground station before
    and during the vehicle's telemetry."""
    sessions, port = tmp_path / "sessions", spandrel.free_udp_port()
    with (tmp_path / "monitor.txt").open("w", encoding="utf-8") as log:
        monitor = subprocess.Popen(
            [spandrel.PROGRAM, "monitor", "--scenario", "drill-hover", "--sessions", str(sessions), "--port", str(port)],
            stdout=log, stderr=log, stdin=subprocess.DEVNULL,
        )
    stranger = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    station = mavutil.mavlink.MAVLink(None, srcSystem=255, srcComponent=190)
    process = None
    try:
        spandrel.wait_for("the session folder", lambda: sessions.exists() and any(sessions.iterdir()), LIMIT_S)
        end = time.monotonic() + LIMIT_S

        def taken():
            """Returns whether the vehicle's truth is in the session; the stranger keeps sending."""
            for datagram in (b"\xfd", station.heartbeat_encode(6, 8, 0, 0, 4).pack(station)):
                stranger.sendto(datagram, ("127.0.0.1", port))
            # Message 115, HIL_STATE_QUATERNION, of system 1 and component 1.
            return any(b"\x01\x01\x73\x00\x00" in path.read_bytes() for path in sessions.glob("*/telemetry.tlog"))

        assert not taken()
        with (tmp_path / "sim.txt").open("w", encoding="utf-8") as log:
            process = subprocess.Popen(
                [spandrel.PROGRAM, "sim", "--scenario", "drill-hover", "--ports", "ephemeral", "--monitor-port", str(port)],
                stdout=log, stderr=log, stdin=subprocess.DEVNULL,
            )
        spandrel.wait_for("the vehicle's telemetry", taken, end - time.monotonic())
    finally:
        stranger.close()
        spandrel.end(monitor)
        if process is not None:
            spandrel.end(process)
