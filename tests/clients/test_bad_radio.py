"""Stock clients over a radio that loses a tenth of all round trips and is late: the vehicle's own bad radio, from its seed."""

import pytest
from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.ftp import Ftp, FtpResult
from mavsdk.plugins.mission_raw import MissionItem, MissionRaw
from mavsdk.plugins.param import Param

import spandrel
from spandrel import wait_for

NAN = float("nan")
# Each way: of a question and its answer one in ten is lost.
LOSS_PCT, DELAY_MS = 5.0, 40


@pytest.mark.timeout(600)
def test_wire_mavsdk_moves_plans_parameters_and_files_over_a_bad_radio(tmp_path):
    """A mission up and down, all parameters, a file: MAVSDK's own repetitions and the vehicle's answers suffice."""
    file, files = tmp_path / "drone.params", tmp_path / "files"
    file.write_text(f"1\t1\tSIM_LINK_LOSS\t{LOSS_PCT}\t9\n1\t1\tSIM_LINK_DELAY\t{DELAY_MS}\t6\n", encoding="utf-8")
    files.mkdir()
    content = bytes(k * k % 251 for k in range(6_000))
    (files / "survey.bin").write_bytes(content)
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port, "--params", str(file), "--files", str(files), speed=1)
    try:
        mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
        mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        system = mavsdk.first_autopilot(60.0)
        assert system is not None, "no vehicle discovered"
        mission, param, ftp = MissionRaw(system), Param(system), Ftp(system)
        items = [
            MissionItem(k, 6, 16, 1 if k == 0 else 0, 1, 0, 0, 0, NAN, 467_052_000 + 300 * k, 83_814_000, 8.0, 0) for k in range(12)
        ]
        mission.upload_mission(items)
        assert [(i.x, i.z) for i in mission.download_mission()] == [(i.x, i.z) for i in items]
        param.set_param_float("MPC_XY_CRUISE", 4.5)
        assert param.get_param_float("MPC_XY_CRUISE") == 4.5
        assert abs(param.get_param_float("SIM_LINK_LOSS") - LOSS_PCT) < 1e-6
        results = []
        ftp.download_async("/survey.bin", str(tmp_path), False, lambda result, _progress, _data: results.append(FtpResult(result)))
        ended = wait_for("the download", lambda: next((r for r in results if r != FtpResult.NEXT), None))
        assert ended == FtpResult.SUCCESS and (tmp_path / "survey.bin").read_bytes() == content
    finally:
        spandrel.end(process)
