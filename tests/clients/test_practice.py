"""A script freezes and rewinds a practice flight with MAVLink commands; the session records both, and an assessment refuses them."""

import json
import math

import pytest
from pymavlink import mavutil

import spandrel
from stick_client import Client, M

FREEZE, REWIND, MOVE = M.MAV_CMD_USER_1, M.MAV_CMD_USER_2, M.MAV_CMD_USER_3
NAN = float("nan")


def heard(client, words):
    """Waits until a text of the vehicle contains these words."""
    client.wait(words, lambda: any(component == 1 and words in text for component, text in client.texts))


def now_ms(client):
    return client.state["ATTITUDE"].time_boot_ms


def beats(client, count):
    """Waits for heartbeats, which arrive once per second of wall time while the flight is frozen."""
    for _ in range(count):
        last = client.state.get("HEARTBEAT")
        client.wait("heartbeat", lambda: client.state.get("HEARTBEAT") is not last)


def records(tlog):
    """Returns the log's timestamps and its named integers."""
    log, stamps, named = mavutil.mavlink_connection(str(tlog)), [], []
    while (message := log.recv_match()) is not None:
        stamps.append(message._timestamp)
        if message.get_type() == "NAMED_VALUE_INT":
            named.append((message.name, message.value))
    return stamps, named


@pytest.mark.timeout(300)
def test_wire_a_script_freezes_and_rewinds_a_flight(tmp_path):
    flight = spandrel.Flight(tmp_path, scenario="drill-hover", speed=1)
    try:
        client = Client(flight.client_port, scenario="drill-hover")
        client.ready()
        assert client.command(REWIND, 10) == M.MAV_RESULT_DENIED
        heard(client, "Rejected: not flown yet")
        assert client.command(M.MAV_CMD_COMPONENT_ARM_DISARM, 1) == M.MAV_RESULT_ACCEPTED
        place = (0.0, 0.0, 5.0)
        client.fly_to(place, lambda _: 0.0)
        since = now_ms(client)
        client.fly_to(place, lambda _: 0.0, done=lambda _: now_ms(client) > since + 3000)
        # Frozen: heartbeats arrive, time and position stay, parameters are answered.
        assert client.command(FREEZE, 1) == M.MAV_RESULT_ACCEPTED
        heard(client, "Frozen")
        beats(client, 1)
        at, here = now_ms(client), client.here()
        client.link.mav.param_request_read_send(client.link.target_system, 1, b"MPC_XY_VEL_MAX", -1)
        client.wait("parameter", lambda: "PARAM_VALUE" in client.state)
        beats(client, 3)
        assert (now_ms(client), client.here()) == (at, here)
        assert client.command(FREEZE, 0) == M.MAV_RESULT_ACCEPTED
        client.wait("time goes on", lambda: now_ms(client) > at + 500)
        # Rewound: time goes on, the drone is back near the earlier place, and a stick continues the flight.
        client.fly_to((0.0, 6.0, 5.0), lambda _: 0.0)
        before = now_ms(client)
        assert client.command(REWIND, 10) == M.MAV_RESULT_ACCEPTED
        heard(client, "Frozen: move a stick to continue")
        (east, north, up), _ = client.here()
        assert now_ms(client) >= before and north < 4.0, (now_ms(client), before, north)
        at = now_ms(client)
        client.sticks((0, 0, 0, 0))
        beats(client, 1)
        assert now_ms(client) == at
        client.fly_to(place, lambda _: 0.0)
        assert now_ms(client) > at
        (east, north, up), _ = client.here()
        assert math.dist((east, north, up), place) < 2.0
        # Moved to the start of the task, which is the drill's only one.
        assert client.command(MOVE, 2) == M.MAV_RESULT_DENIED
        heard(client, "No task 2 (allowed: 1 to 1)")
        client.texts.clear()
        assert client.command(MOVE, 1) == M.MAV_RESULT_ACCEPTED
        heard(client, "Frozen: move a stick to continue")
        client.sticks((0, 0, 0, 0))
        beats(client, 1)
        client.fly_to(place, lambda _: 0.0)
        assert client.command(M.MAV_CMD_NAV_LAND, 0, 0, 0, NAN, NAN, NAN, 0) == M.MAV_RESULT_ACCEPTED
        assessment = flight.assessment()
    finally:
        flight.close()
    assert assessment["practice_aids"] == {"freezes": 1, "rewinds": 2}
    certification = assessment["certification"]
    assert not certification["passed"] and certification["unmet"][0] == "rewound twice and frozen once, so it was practice"
    lines = (flight.session() / "events.jsonl").read_text(encoding="utf-8").splitlines()
    events = [json.loads(line) for line in lines]
    assert [(one["event"], one["count"]) for one in events if one["event"] in ("freeze", "rewind")] == [("freeze", 1), ("rewind", 1), ("rewind", 2)]
    stamps, named = records(flight.session() / "telemetry.tlog")
    assert stamps == sorted(stamps)
    assert {("freezes", 1), ("rewinds", 2), ("frozen", 1), ("frozen", 0)} <= set(named)


@pytest.mark.timeout(120)
@pytest.mark.parametrize("flavor", ["px4", "ardupilot"])
def test_wire_an_assessment_refuses_freeze_and_rewind(launch, flavor):
    client = Client(launch(flavor, "--practice-controls", "off"))
    for number, param in ((FREEZE, 1), (FREEZE, 0), (REWIND, 10)):
        assert client.command(number, param) == M.MAV_RESULT_DENIED
    heard(client, "No freeze or rewind in an assessment")
