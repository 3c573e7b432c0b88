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
# Start, eight bits, stop.
BYTES_S = BAUD / 10


def test_wire_a_radio_on_a_serial_port_gets_no_more_than_it_carries(tmp_path):
    """Over a pseudo-terminal: parameters come whole, the byte rate stays within the baud rate, a command is answered."""
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
        mav.param_request_list_send(1, 1)
        mav.command_long_send(1, 1, mavutil.mavlink.MAV_CMD_REQUEST_MESSAGE, 0, 148, 0, 0, 0, 0, 0, 0)
        while time.monotonic() < end and (count is None or len(names) < count or not acknowledged):
            ready, _, _ = select.select([ours], [], [], 1)
            data = os.read(ours, 4096) if ready else b""
            received += len(data)
            for message in mav.parse_buffer(data) or []:
                if message.get_type() == "SYSTEM_TIME":
                    begin = begin if begin is not None else (message.time_boot_ms, received)
                    seconds = (message.time_boot_ms - begin[0]) / 1000
                if message.get_type() == "PARAM_VALUE" and message.param_index != 65535:
                    names.add(message.param_id)
                    count = message.param_count
                acknowledged |= message.get_type() == "COMMAND_ACK"
        assert count and len(names) == count and acknowledged, (len(names), count, acknowledged)
        # Over the whole of it, by the vehicle's own clock; half a second's worth may lie in buffers.
        assert received - begin[1] <= BYTES_S * (seconds + 1.5), (received, seconds)
    finally:
        spandrel.end(sim)
        os.close(ours)
        os.close(theirs)


def test_wire_three_vehicles_in_one_process_are_flown_apart(tmp_path):
    """Systems 1 to 3 call the same ground station; arming the second leaves the others on the ground."""
    port = spandrel.free_udp_port()
    sim = spandrel.start_sim(tmp_path, port, "--instances", "3")
    try:
        connection = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=255, source_component=190, dialect="all")
        for system in (1, 2, 3):
            asking.hear(connection, "HEARTBEAT", lambda beat, system=system: beat.get_srcSystem() == system)
        prearm = mavutil.mavlink.MAV_SYS_STATUS_PREARM_CHECK
        asking.hear(
            connection, "SYS_STATUS", lambda m: m.get_srcSystem() == 2 and m.onboard_control_sensors_health & prearm,
        )
        # pymavlink sends to everybody who has called; only the one that is meant acts.
        assert asking.command(connection, mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1, system=2) == 0
        armed = mavutil.mavlink.MAV_MODE_FLAG_SAFETY_ARMED
        asking.hear(connection, "HEARTBEAT", lambda beat: beat.get_srcSystem() == 2 and beat.base_mode & armed)
        for system in (1, 3):
            beat = asking.hear(
                connection, "HEARTBEAT", lambda beat, system=system: beat.get_srcSystem() == system and beat.get_srcComponent() == 1,
            )
            assert not beat.base_mode & armed
    finally:
        spandrel.end(sim)


def test_wire_tcp_clients_come_and_go_and_the_vehicle_flies_on(tmp_path):
    """Two clients over TCP; the first breaks off in the middle of a frame."""
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
        asking.hear(connection, "HEARTBEAT")
        send = lambda: connection.mav.param_request_read_send(1, 1, b"MIS_TAKEOFF_ALT", -1)  # noqa: E731
        asking.ask(connection, send, "PARAM_VALUE", lambda value: value.param_id == "MIS_TAKEOFF_ALT")
        assert sim.poll() is None
    finally:
        sim.send_signal(signal.SIGINT)
        sim.wait(timeout=LIMIT_S)
    assert sim.returncode == 0
