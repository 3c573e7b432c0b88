"""Stock clients over a radio that loses a tenth of all round trips and delays datagrams: the vehicle's own link
impairment, reproducibly from its seed."""

import time

import pytest
from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.ftp import Ftp, FtpResult
from mavsdk.plugins.mission_raw import MissionItem, MissionRaw, MissionRawError
from mavsdk.plugins.param import Param
from pymavlink import mavutil

import asking
import spandrel
import test_mavproxy as mavproxy
from spandrel import wait_for

NAN = float("nan")
# In each direction, so that one in ten round trips is lost.
LOSS_PCT, DELAY_MS = 5.0, 40
# Wall seconds before a client repeats a request.
AGAIN_S = 0.5
# Wall seconds before a user enters a command again.
PATIENCE_S = 10
# Uploads of a mission before a user gives up: losing the last acknowledgment of all of them has a probability of 3e-7.
UPLOADS = 5


def bad_radio(folder, *more):
    """Starts a vehicle behind the radio; returns its process and port."""
    file = folder / "drone.params"
    file.write_text(f"1\t1\tSIM_LINK_LOSS\t{LOSS_PCT}\t9\n1\t1\tSIM_LINK_DELAY\t{DELAY_MS}\t6\n", encoding="utf-8")
    port = spandrel.free_udp_port()
    return spandrel.start_sim(folder, port, "--params", str(file), *more, speed=1), port


@pytest.mark.timeout(600)
def test_wire_pymavlink_transfers_plan_and_parameters_over_a_bad_radio(tmp_path):
    """Every item arrives once and in order, and every parameter is read, although some requests must be repeated
    because of real losses."""
    process, port = bad_radio(tmp_path)
    try:
        link, mav = asking.connect(port), mavutil.mavlink
        count = 60

        def item(seq):
            link.mav.mission_item_int_send(1, 1, seq, 6, 16, 0, 1, 0, 0, 0, NAN, 467_052_000 + 300 * seq, 83_814_000, 8.0, 0)

        def ask(send, kind, fits=lambda _m: True):
            return asking.ask(link, send, kind, fits, AGAIN_S)

        requests = ["MISSION_REQUEST_INT", "MISSION_REQUEST"]
        asked = ask(lambda: link.mav.mission_count_send(1, 1, count, 0), requests, lambda m: m.seq == 0)
        while asked.get_type() != "MISSION_ACK":
            # The vehicle answers a repeated item by requesting the next item, or the same item again.
            asked = ask(lambda: item(asked.seq), requests + ["MISSION_ACK"])
        assert asked.type == mav.MAV_MISSION_ACCEPTED
        assert ask(lambda: link.mav.mission_request_list_send(1, 1, 0), "MISSION_COUNT").count == count
        for k in range(count):
            back = ask(lambda: link.mav.mission_request_int_send(1, 1, k, 0), "MISSION_ITEM_INT", lambda m: m.seq == k)
            assert back.x == 467_052_000 + 300 * k
        link.mav.mission_ack_send(1, 1, 0, 0)
        values = asking.parameters(link)
        assert sorted(v.param_index for v in values.values()) == list(range(len(values)))
        fits = lambda m: m.param_id == "MPC_XY_CRUISE" and m.param_value == 4.5  # noqa: E731
        ask(lambda: link.mav.param_set_send(1, 1, b"MPC_XY_CRUISE", 4.5, mav.MAV_PARAM_TYPE_REAL32), "PARAM_VALUE", fits)
        assert link.packet_loss() > LOSS_PCT / 4, "the radio must lose datagrams"
    finally:
        spandrel.end(process)


@pytest.mark.timeout(600)
def test_wire_mavproxy_transfers_plan_and_parameters_over_a_bad_radio(tmp_path):
    """User commands succeed, through MAVProxy's own retries or by entering them again."""
    process, port = bad_radio(tmp_path)
    typed = mavproxy.Console(port, tmp_path)
    try:
        typed.wait("parameters to")
        typed.repeat_until("param set MPC_XY_CRUISE 4\nparam fetch MPC_XY_CRUISE", "MPC_XY_CRUISE = 4.0", PATIENCE_S)
        nothing = (0.0, 0.0, 0.0, 0.0)
        rows = [(3, 22, nothing, 0, 5)] + [(3, 16, nothing, k, 6) for k in range(1, 20)] + [(3, 21, nothing, 0, 0)]
        mission = mavproxy.plan(tmp_path, "mission.txt", rows)
        typed.repeat_until(f"wp load {mission}", "Got MISSION_ACK: TYPE_MISSION: ACCEPTED", 3 * PATIENCE_S)
        typed.repeat_until("wp list", "Saved 21 waypoints", 3 * PATIENCE_S)
        typed.repeat_until("arm throttle", "ARMED")
    finally:
        typed.close()
        spandrel.end(process)


def upload(mission, items):
    """Uploads a mission as a user does who presses the button again. MAVSDK repeats nothing after the last item: if the radio loses the vehicle's
    final acknowledgment, one datagram of 20, it gives up although the vehicle has the mission."""
    for _ in range(UPLOADS):
        try:
            mission.upload_mission(items)
            return
        except MissionRawError as error:
            assert "TIMEOUT" in str(error)
    raise AssertionError(f"{UPLOADS} uploads without an acknowledgment")


@pytest.mark.timeout(600)
def test_wire_mavsdk_transfers_plan_parameters_and_file_over_a_bad_radio(tmp_path):
    """Uploads and downloads a mission, all parameters and a file; MAVSDK's own retries and the vehicle's responses
    must suffice."""
    files = tmp_path / "files"
    files.mkdir()
    content = bytes(k * k % 251 for k in range(6_000))
    (files / "survey.bin").write_bytes(content)
    process, port = bad_radio(tmp_path, "--files", str(files))
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    try:
        mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        system = mavsdk.first_autopilot(60.0)
        assert system is not None, "no vehicle discovered"
        mission, param, ftp = MissionRaw(system), Param(system), Ftp(system)
        items = [
            MissionItem(k, 6, 16, 1 if k == 0 else 0, 1, 0, 0, 0, NAN, 467_052_000 + 300 * k, 83_814_000, 8.0, 0) for k in range(12)
        ]
        upload(mission, items)
        assert [(i.x, i.z) for i in mission.download_mission()] == [(i.x, i.z) for i in items]
        param.set_param_float("MPC_XY_CRUISE", 4.5)
        assert param.get_param_float("MPC_XY_CRUISE") == 4.5
        assert abs(param.get_param_float("SIM_LINK_LOSS") - LOSS_PCT) < 1e-6
        results = []
        ftp.download_async("/survey.bin", str(tmp_path), False, lambda result, _progress, _data: results.append(FtpResult(result)))
        ended = wait_for("the download", lambda: next((r for r in results if r != FtpResult.NEXT), None))
        assert ended == FtpResult.SUCCESS and (tmp_path / "survey.bin").read_bytes() == content
    finally:
        # Otherwise, MAVSDK's threads abort the tests when Python collects it.
        mavsdk.destroy()
        spandrel.end(process)
