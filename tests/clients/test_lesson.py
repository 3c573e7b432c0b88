"""A ground station does the lesson `first-flight` with sticks and commands, step by step as the monitor announces them."""

import json
import math

import pytest

import handpilot
import spandrel
from stick_client import CAMERA, Client, M

# Places of scenarios/first-flight.toml, m east, north, up.
RING = (0.0, 8.0, 5.0)
SQUARE = [(-6.0, 8.0, 5.0), (6.0, 8.0, 5.0), (6.0, 20.0, 5.0), (-6.0, 20.0, 5.0), (-6.0, 8.0, 5.0), (6.0, 8.0, 5.0)]
PIER = (0.0, 34.0, 5.0)
DEFECT = (1.6, 38.5, 4.2)
ABOVE_PAD = (0.0, 0.0, 5.0)
NAN = float("nan")
# Largest error of a place that follows from the way to it, m: whole meters and degrees, and the flight between two messages.
ROUNDING_M = 1.5


def lesson_texts(client):
    """Returns the monitor's texts about the lesson."""
    return [text for component, text in client.texts if component == 191 and text.startswith("Lesson: ")]


def place_of_step(client):
    """Returns the place of the lesson's step, as NAV_CONTROLLER_OUTPUT shows the way to it."""
    client.way = None
    way = client.wait("the way to the next place", lambda: client.way)
    (east, north, up), _ = client.here()
    bearing = math.radians(way.target_bearing)
    return (east + way.wp_dist * math.sin(bearing), north + way.wp_dist * math.cos(bearing), up + way.alt_error)


@pytest.mark.timeout(300)
def test_wire_a_ground_station_does_the_lesson(tmp_path):
    """Every step waits until it is done; a picture without a defect and a ring left too early are remarked."""
    flight = spandrel.Flight(tmp_path, scenario="first-flight")
    try:
        client = Client(flight.client_port, scenario="first-flight")
        said = lambda words: client.wait(words, lambda: any(words in text for text in lesson_texts(client)))  # noqa: E731
        north = lambda _: 0.0  # noqa: E731
        at_defect = lambda here: handpilot.aim(here, DEFECT)[0]  # noqa: E731

        def hold(place, look, words):
            """Holds a position until a text arrives."""
            client.fly_to(place, look, done=lambda _: any(words in text for text in lesson_texts(client)), cruise=1.0)

        def tilt(degrees):
            assert client.command(M.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, degrees, NAN, NAN, NAN) == M.MAV_RESULT_ACCEPTED

        def photograph():
            assert client.command(M.MAV_CMD_IMAGE_START_CAPTURE, 0, 0, 1, component=CAMERA) == M.MAV_RESULT_ACCEPTED

        client.ready()
        said("1/11 arm the motors")
        assert client.command(M.MAV_CMD_COMPONENT_ARM_DISARM, 1) == M.MAV_RESULT_ACCEPTED
        said("2/11 take off to 2 m")
        hold((0.0, 0.0, 5.0), north, "3/11 hover in the ring for 10 s")
        ring = place_of_step(client)
        assert handpilot.distance(ring, RING) < ROUNDING_M, ring
        said(" m, ahead")
        client.fly_to(ring, north)
        # Leaves the ring too early.
        client.fly_to(ring, north, done=lambda _, since=client.state["ATTITUDE"].time_boot_ms: client.state["ATTITUDE"].time_boot_ms > since + 3000)
        client.fly_to((0.0, 13.0, 5.0), north)
        said("you left the ring: stay 10 s")
        hold(ring, north, "4/11 turn by 90 deg")
        hold(RING, lambda _: math.pi, "5/11 fly along the path")
        for corner in SQUARE:
            client.fly_to(corner, north, cruise=2.0)
        said("6/11 stop in the ring for 3 s")
        stop = place_of_step(client)
        assert handpilot.distance(stop, PIER) < ROUNDING_M, stop
        hold(stop, at_defect, "7/11 tilt the camera up 20 deg")
        tilt(30.0)
        hold(PIER, at_defect, "8/11 turn the lamp on")
        assert client.command(M.MAV_CMD_DO_SET_RELAY, 0, 1) == M.MAV_RESULT_ACCEPTED
        hold(PIER, at_defect, "9/11 photograph a defect")
        tilt(80.0)
        client.fly_to(PIER, at_defect, done=lambda _, since=client.state["ATTITUDE"].time_boot_ms: client.state["ATTITUDE"].time_boot_ms > since + 4000)
        photograph()
        said("no defect in the picture")
        here, _ = client.here()
        tilt(math.degrees(handpilot.aim(here, DEFECT)[1]))
        client.fly_to(PIER, at_defect, done=lambda _, since=client.state["ATTITUDE"].time_boot_ms: client.state["ATTITUDE"].time_boot_ms > since + 5000)
        photograph()
        hold(PIER, at_defect, "10/11 fly back to the pad")
        assert handpilot.distance(place_of_step(client)[:2] + (0.0,), (0.0, 0.0, 0.0)) < ROUNDING_M
        client.fly_to(ABOVE_PAD, north)
        said("11/11 land on the pad")
        assert client.command(M.MAV_CMD_NAV_LAND, 0, 0, 0, NAN, NAN, NAN, 0) == M.MAV_RESULT_ACCEPTED
        said("all steps done")
        assert flight.assessment()["end"]["reason"] == "landed"
        lines = (flight.session() / "events.jsonl").read_text(encoding="utf-8").splitlines()
        steps = [event["done"] for event in map(json.loads, lines) if event.get("event") == "lesson_step"]
        assert steps == list(range(1, 12)), steps
    finally:
        flight.close()
