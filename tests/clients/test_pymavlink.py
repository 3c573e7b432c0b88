"""pymavlink flies the first task with MANUAL_CONTROL, photographs a defect and lands; the monitor scores the flight."""

import math

import pytest

import handpilot
from stick_client import CAMERA, Client, M


@pytest.mark.parametrize("flight", ["px4", "ardupilot"], indirect=True)
@pytest.mark.timeout(900)
def test_wire_pymavlink_flies_the_first_task_and_is_scored(flight, job):
    """Covers the entire flight, from the connection to the four scores."""
    client = Client(flight.client_port)
    client.ready()
    pad, _ = client.here()
    plan = handpilot.first_task_plan(job, pad)
    defect = plan["defect"]["position_enu_m"]

    def face(here):
        return handpilot.aim(here, defect)[0]

    assert client.command(M.MAV_CMD_COMPONENT_ARM_DISARM, 1) == M.MAV_RESULT_ACCEPTED
    for target in plan["out"] + plan["path"]:
        client.fly_to(target, face)
    client.fly_to(plan["stop"], face)
    here, _ = client.here()
    elevation = math.degrees(handpilot.aim(here, defect)[1])
    nan = float("nan")
    assert client.command(M.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, elevation, nan, nan, nan) == M.MAV_RESULT_ACCEPTED
    start = client.state["ATTITUDE"].time_boot_ms
    client.fly_to(plan["stop"], face, done=lambda _: client.state["ATTITUDE"].time_boot_ms > start + 4000, cruise=0.8)
    assert client.command(M.MAV_CMD_IMAGE_START_CAPTURE, 0, 0, 1, component=CAMERA) == M.MAV_RESULT_ACCEPTED
    client.wait("picture", lambda: "CAMERA_IMAGE_CAPTURED" in client.state)
    for target in plan["back"]:
        client.fly_to(target, face)
    client.fly_to((pad[0], pad[1], pad[2] + 6.0), face)
    assert client.command(M.MAV_CMD_NAV_LAND, 0, 0, 0, nan, nan, nan, 0) == M.MAV_RESULT_ACCEPTED
    client.wait("disarmed", lambda: not client.link.motors_armed())

    result = flight.assessment()
    assert result["tasks"][0]["attempted"] is True
    assert result["tasks"][0]["on_path"] > 0.5
    assert result["snapshots"]["taken"] == 1
    assert result["snapshots"]["hits"] == 1
    assert result["end"]["reason"] == "landed"
    assert result["crashes"] == {**result["crashes"], "other": 0, "person": 0, "vehicle": 0}
    assert any(component == 191 for component, _ in client.texts), "the monitor's texts must reach the ground station"
