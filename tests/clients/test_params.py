"""Parameters as ground stations use them: the whole list, ranges, what they mean, and a file that outlives the run."""

import json
import struct

import pytest
from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.component_metadata import ComponentMetadata, MetadataType
from mavsdk.plugins.param import Param
from pymavlink import mavutil

import spandrel
from spandrel import wait_for

INT32, REAL32 = mavutil.mavlink.MAV_PARAM_TYPE_INT32, mavutil.mavlink.MAV_PARAM_TYPE_REAL32
# Wall seconds for an answer of a simulator on a busy machine, ten times over.
LIMIT_S = 60


def connect(port):
    """pymavlink, after the first heartbeat."""
    connection = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=255, source_component=190)
    assert connection.wait_heartbeat(timeout=LIMIT_S) is not None
    return connection


def answer(connection, *kinds):
    """The next message of these kinds."""
    message = connection.recv_match(type=list(kinds), blocking=True, timeout=LIMIT_S)
    assert message is not None, kinds
    return message


def put(connection, name, value, kind):
    """PARAM_SET, byte-wise for whole numbers as PX4 asks."""
    wire = struct.unpack("<f", struct.pack("<i", value))[0] if kind == INT32 else value
    connection.mav.param_set_send(1, 1, name.encode(), wire, kind)


def test_wire_the_list_is_whole_by_index_and_by_name_and_ranges_hold(tmp_path):
    """Every parameter once; what is out of range is named, and the old value told."""
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port)
    try:
        connection = connect(port)
        connection.mav.param_request_list_send(1, 1)
        values, count = {}, None
        while count is None or len(values) < count:
            message = answer(connection, "PARAM_VALUE")
            if message.param_index != 65535:
                values[message.param_id], count = message.param_index, message.param_count
        assert sorted(values.values()) == list(range(count))
        for name in ("GF_ACTION", "MPC_XY_CRUISE"):
            connection.mav.param_request_read_send(1, 1, name.encode(), -1)
            assert answer(connection, "PARAM_VALUE").param_index == values[name]
        put(connection, "MPC_XY_CRUISE", 7.5, REAL32)
        assert answer(connection, "PARAM_VALUE").param_value == 7.5
        put(connection, "MPC_XY_CRUISE", 900.0, REAL32)
        refusal, old = answer(connection, "PARAM_ERROR"), answer(connection, "PARAM_VALUE")
        assert refusal.error == mavutil.mavlink.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE
        assert (old.param_id, old.param_value) == ("MPC_XY_CRUISE", 7.5)
    finally:
        spandrel.end(process)


@pytest.mark.timeout(300)
def test_wire_parameters_outlive_the_run_in_their_file(tmp_path):
    """Set, stopped, started again; reset to the defaults; a wrong file is refused with its line."""
    file = tmp_path / "drone.params"
    for expected, then in ((2.5, 6.5), (6.5, None)):
        port = spandrel.free_udp_port()
        process = spandrel.start_sim(tmp_path, port, "--params", str(file))
        try:
            connection = connect(port)
            connection.mav.param_request_read_send(1, 1, b"MIS_TAKEOFF_ALT", -1)
            assert answer(connection, "PARAM_VALUE").param_value == expected
            if then is not None:
                put(connection, "MIS_TAKEOFF_ALT", then, REAL32)
                assert answer(connection, "PARAM_VALUE").param_value == then
                continue
            storage = mavutil.mavlink.MAV_CMD_PREFLIGHT_STORAGE
            connection.mav.command_long_send(1, 1, storage, 0, 2, -1, 0, 0, 0, 0, 0)
            assert answer(connection, "COMMAND_ACK").result == 0
            reset = lambda: answer(connection, "PARAM_VALUE")  # noqa: E731
            wait_for("the default again", lambda: (v := reset()).param_id == "MIS_TAKEOFF_ALT" and v.param_value == 2.5, LIMIT_S)
        finally:
            spandrel.end(process)
    assert "\tMIS_TAKEOFF_ALT\t2.5\t9" in file.read_text(encoding="utf-8")
    file.write_text("1\t1\tMIS_TAKEOFF_ALT\t900\t9\n", encoding="utf-8")
    process = spandrel.start_sim(tmp_path, spandrel.free_udp_port(), "--params", str(file))
    assert process.wait(timeout=LIMIT_S) == 2
    log = (tmp_path / "sim.txt").read_text(encoding="utf-8")
    assert "drone.params:1: MIS_TAKEOFF_ALT = 900 is out of range (allowed: 0.5 to 80)" in log


@pytest.mark.timeout(300)
def test_wire_mavsdk_reads_what_the_parameters_mean(tmp_path):
    """The description over MAVLink FTP, unpacked and checked by MAVSDK, names every parameter that the vehicle lists."""
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port)
    try:
        mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
        mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        system = mavsdk.first_autopilot(60.0)
        metadata, found = ComponentMetadata(system), []
        metadata.subscribe_metadata_available(lambda update, _: found.append(update))
        metadata.request_autopilot_component()
        wait_for("the metadata", lambda: any(u.type == MetadataType.PARAMETER for u in found), LIMIT_S)
        text = next(u.json_metadata for u in found if u.type == MetadataType.PARAMETER)
        described = {p["name"]: p for p in json.loads(text)["parameters"]}
        listed = Param(system).get_all_params()
        names = {p.name for p in listed.int_params} | {p.name for p in listed.float_params}
        assert names == set(described)
        assert described["GF_ACTION"]["max"] == 5 and described["MPC_XY_CRUISE"]["units"] == "m/s"
    finally:
        spandrel.end(process)


def test_wire_what_one_station_sets_the_other_hears(tmp_path):
    """Two ground stations on links of their own: a change by one is told to both."""
    ports = [spandrel.free_udp_port(), spandrel.free_udp_port()]
    process = spandrel.start_sim(tmp_path, ports[0], "--gcs", f"127.0.0.1:{ports[1]}")
    try:
        one, other = (connect(port) for port in ports)
        put(one, "MPC_XY_CRUISE", 6.25, REAL32)
        for connection in (one, other):
            told = answer(connection, "PARAM_VALUE")
            assert (told.param_id, told.param_value) == ("MPC_XY_CRUISE", 6.25)
    finally:
        spandrel.end(process)
