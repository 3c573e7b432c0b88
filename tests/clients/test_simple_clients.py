"""Clients that treat every heartbeat from the vehicle as the autopilot's: a short pymavlink script, DroneKit,
mavpilot."""

import asyncio
import collections
import collections.abc
import math
import os

os.environ["MAVLINK20"] = "1"

import pytest
from pymavlink import mavutil

from spandrel import wait_for

# DroneKit 2.9.2 uses names that Python 3.10 removed.
for _name in ("MutableMapping", "Mapping", "Iterable"):
    if not hasattr(collections, _name):
        setattr(collections, _name, getattr(collections.abc, _name))

import dronekit  # noqa: E402
from mavpilot import DroneController  # noqa: E402

M = mavutil.mavlink
# Distance within which a position counts as reached, m.
NEAR_M = 1.5
# Number of clients that connect at different times; each must receive the autopilot's heartbeat first.
LOOKS = 12


def distance_m(a, b):
    """Returns the distance between two nearby positions in meters."""
    north = (a.lat - b.lat) * 111_319.5
    east = (a.lon - b.lon) * 111_319.5 * math.cos(math.radians(a.lat))
    return math.hypot(north, east)


@pytest.mark.timeout(300)
def test_regress_new_clients_receive_the_autopilot_heartbeat_first(launch):
    """Scripts that start at any time and use the first heartbeat, while the camera component is also active."""
    port, first = launch("px4"), []
    for _ in range(LOOKS):
        link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", dialect="all")
        beat = link.wait_heartbeat(timeout=60)
        first.append((beat.get_srcComponent(), beat.autopilot))
        link.close()
    assert first == [(1, M.MAV_AUTOPILOT_PX4)] * LOOKS


@pytest.mark.timeout(300)
def test_regress_naive_script_flies(launch):
    """Reads mode, arming and takeoff from any heartbeat, as many tutorials do."""
    port = launch("ardupilot", "--camera", "off", speed=2)
    link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}")
    link.wait_heartbeat()
    link.mav.request_data_stream_send(link.target_system, link.target_component, M.MAV_DATA_STREAM_ALL, 10, 1)
    guided = link.mode_mapping()["GUIDED"]

    def wait_for_change(send, holds):
        """Sends until the next heartbeat shows the change."""
        for _ in range(120):
            send()
            beat = link.recv_match(type="HEARTBEAT", blocking=True, timeout=5)
            if beat is not None and holds(beat):
                return
        raise AssertionError("no heartbeat shows the change")

    wait_for_change(lambda: link.set_mode(guided), lambda beat: beat.custom_mode == guided)
    wait_for_change(link.arducopter_arm, lambda beat: beat.base_mode & M.MAV_MODE_FLAG_SAFETY_ARMED)
    link.mav.command_long_send(link.target_system, link.target_component, M.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 0, 5)
    # From now on, every heartbeat must be the vehicle's: armed, in GUIDED.
    for _ in range(10):
        beat = link.recv_match(type="HEARTBEAT", blocking=True, timeout=60)
        assert beat.custom_mode == guided and beat.base_mode & M.MAV_MODE_FLAG_SAFETY_ARMED, beat
    while link.recv_match(type="GLOBAL_POSITION_INT", blocking=True, timeout=60).relative_alt < 4_000:
        pass


@pytest.mark.timeout(600)
def test_regress_dronekit_takes_off_and_flies_to_a_target(launch):
    """Uses DroneKit 2.9.2 as in its own example, then for a mission, which it uploads only through the older
    request."""
    port = launch("ardupilot", "--camera", "off", speed=2)
    vehicle = None
    try:
        vehicle = dronekit.connect(f"udpin:127.0.0.1:{port}", wait_ready=True, heartbeat_timeout=60, timeout=120)
        wait_for("a fix", lambda: vehicle.gps_0.fix_type == 3 and vehicle.location.global_frame.lat)

        def set_to(what, change, holds):
            """Requests a change in a loop, as tutorials do, because DroneKit sends each request only once."""
            tries = iter(range(600))

            def step():
                if next(tries) % 100 == 0:
                    change()
                return holds()

            wait_for(what, step)

        set_to("GUIDED", lambda: setattr(vehicle, "mode", dronekit.VehicleMode("GUIDED")), lambda: vehicle.mode.name == "GUIDED")
        set_to("armed", lambda: setattr(vehicle, "armed", True), lambda: vehicle.armed)
        vehicle.simple_takeoff(6)
        wait_for("6 m", lambda: vehicle.location.global_relative_frame.alt > 0.95 * 6)
        here = vehicle.location.global_relative_frame
        there = dronekit.LocationGlobalRelative(here.lat + 10 / 111_319.5, here.lon, 6)
        vehicle.simple_goto(there)
        wait_for("10 m north", lambda: distance_m(vehicle.location.global_relative_frame, there) < NEAR_M)
        commands = vehicle.commands
        commands.clear()
        for north in (0, 5, 10):
            commands.add(dronekit.Command(
                0, 0, 0, M.MAV_FRAME_GLOBAL_RELATIVE_ALT, M.MAV_CMD_NAV_WAYPOINT, 0, 0, 0, 0, 0, 0, here.lat + north / 111_319.5, here.lon, 8,
            ))
        commands.upload(timeout=60)
        commands.next = 1
        set_to("AUTO", lambda: setattr(vehicle, "mode", dronekit.VehicleMode("AUTO")), lambda: vehicle.mode.name == "AUTO")
        wait_for("8 m", lambda: vehicle.location.global_relative_frame.alt > 7.5)
        assert vehicle.armed
    finally:
        if vehicle is not None:
            vehicle.close()


@pytest.mark.timeout(600)
def test_regress_mavpilot_takes_off_flies_and_lands(launch):
    """mavpilot 0.3, which flies PX4 with setpoints in the local frame."""
    port = launch("px4", "--camera", "off", speed=1)

    async def mission():
        async with DroneController(connection_string=f"udpin:127.0.0.1:{port}", enable_viz=False) as drone:
            await drone.wait_until_ready()
            assert await drone.takeoff(altitude_m=5.0)
            assert await drone.goto(x=6.0, y=0.0, z=-5.0)
            assert await drone.goto(x=6.0, y=4.0, z=-5.0, yaw_deg=90)
            assert await drone.land()

    asyncio.run(mission())
