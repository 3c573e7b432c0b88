"""Parameters as used by ground stations: the complete list, ranges, descriptions, and a file that persists."""

import json
import struct

import pytest
from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.component_metadata import ComponentMetadata, MetadataType
from mavsdk.plugins.param import Param
from pymavlink import mavutil

import asking
import spandrel
from spandrel import wait_for

INT32, REAL32 = mavutil.mavlink.MAV_PARAM_TYPE_INT32, mavutil.mavlink.MAV_PARAM_TYPE_REAL32
LIMIT_S = asking.LIMIT_S


def set_parameter(connection, name, value, kind, answers="PARAM_VALUE", fits=None):
    """Sets a parameter and returns the response; integers use bytewise encoding, as PX4 requires."""
    wire = struct.unpack("<f", struct.pack("<i", value))[0] if kind == INT32 else value
    send = lambda: connection.mav.param_set_send(1, 1, name.encode(), wire, kind)  # noqa: E731
    return asking.ask(connection, send, answers, fits or (lambda message: message.param_id == name))


def read(connection, name):
    """Reads a parameter and returns the response."""
    send = lambda: connection.mav.param_request_read_send(1, 1, name.encode(), -1)  # noqa: E731
    return asking.ask(connection, send, "PARAM_VALUE", lambda message: message.param_id == name)


def test_wire_parameter_list_is_complete_and_ranges_are_enforced(tmp_path):
    """The list contains every parameter once; an out-of-range value is rejected with a reason and the old value."""
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port)
    try:
        connection = asking.connect(port)
        values = asking.parameters(connection)
        assert sorted(v.param_index for v in values.values()) == list(range(len(values)))
        for name in ("GF_ACTION", "MPC_XY_CRUISE"):
            assert read(connection, name).param_index == values[name].param_index
        assert set_parameter(connection, "MPC_XY_CRUISE", 7.5, REAL32).param_value == 7.5
        refusal = set_parameter(connection, "MPC_XY_CRUISE", 900.0, REAL32, "PARAM_ERROR")
        assert refusal.error == mavutil.mavlink.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE
        assert set_parameter(connection, "MPC_XY_CRUISE", 900.0, REAL32).param_value == 7.5, "the old value must be reported too"
    finally:
        spandrel.end(process)


@pytest.mark.timeout(300)
def test_wire_parameters_persist_in_their_file(tmp_path):
    """Sets parameters, restarts the vehicle, and resets them to their defaults. An invalid file is rejected with the
    line number."""
    file = tmp_path / "drone.params"
    for expected, then in ((2.5, 6.5), (6.5, None)):
        port = spandrel.free_udp_port()
        process = spandrel.start_sim(tmp_path, port, "--params", str(file))
        try:
            connection = asking.connect(port)
            assert read(connection, "MIS_TAKEOFF_ALT").param_value == expected
            if then is not None:
                assert set_parameter(connection, "MIS_TAKEOFF_ALT", then, REAL32).param_value == then
                continue
            assert asking.command(connection, mavutil.mavlink.MAV_CMD_PREFLIGHT_STORAGE, 2, -1) == 0
            assert read(connection, "MIS_TAKEOFF_ALT").param_value == 2.5
        finally:
            spandrel.end(process)
    assert "\tMIS_TAKEOFF_ALT\t2.5\t9" in file.read_text(encoding="utf-8")
    file.write_text("1\t1\tMIS_TAKEOFF_ALT\t900\t9\n", encoding="utf-8")
    process = spandrel.start_sim(tmp_path, spandrel.free_udp_port(), "--params", str(file))
    assert process.wait(timeout=LIMIT_S) == 2
    log = (tmp_path / "sim.txt").read_text(encoding="utf-8")
    assert "drone.params:1: MIS_TAKEOFF_ALT = 900 is out of range (allowed: 0.5 to 500)" in log


@pytest.mark.timeout(300)
def test_wire_mavsdk_reads_the_parameter_metadata(tmp_path):
    """The metadata, which MAVSDK downloads over MAVLink FTP, unpacks and checks, describes every parameter that the
    vehicle lists."""
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


def test_wire_parameter_changes_reach_all_stations(tmp_path):
    """Two ground stations on separate links both receive a change by one of them."""
    ports = [spandrel.free_udp_port(), spandrel.free_udp_port()]
    process = spandrel.start_sim(tmp_path, ports[0], "--gcs", f"127.0.0.1:{ports[1]}")
    try:
        one, other = (asking.connect(port) for port in ports)
        assert set_parameter(one, "MPC_XY_CRUISE", 6.25, REAL32).param_value == 6.25
        told = asking.receive(other, "PARAM_VALUE")
        assert (told.param_id, told.param_value) == ("MPC_XY_CRUISE", 6.25)
    finally:
        spandrel.end(process)
