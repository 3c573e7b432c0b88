"""MAVSDK 4.1 connects, arms, takes off, flies the first task with manual control, photographs a defect and lands."""

import math
import time

import pytest
from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.camera import Camera
from mavsdk.plugins.gimbal import Gimbal, GimbalMode, SendMode
from mavsdk.plugins.manual_control import ManualControl
from mavsdk.plugins.telemetry import Telemetry

import handpilot
from spandrel import wait_for

# MAVSDK requires at least 10 Hz; a typical ground station sends 25 Hz of wall time.
STICK_PERIOD_S = 0.02


class Client:
    """MAVSDK's plugins for one vehicle, and stick control."""

    def __init__(self, port):
        self.mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
        self.mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        system = self.mavsdk.first_autopilot(60.0)
        assert system is not None, "no vehicle discovered"
        self.action, self.telemetry = Action(system), Telemetry(system)
        self.origin = (0.0, 0.0, 0.0)
        self.manual, self.camera, self.gimbal = ManualControl(system), Camera(system), Gimbal(system)

    def here(self):
        """Returns the position in meters east, north and up of the job's origin, and the heading in radians."""
        p, (east, north, up) = self.telemetry.position_velocity_ned().position, self.origin
        return (east + p.east_m, north + p.north_m, up - p.down_m), math.radians(self.telemetry.attitude_euler().yaw_deg)

    def sticks(self, axes):
        """Sends one manual control input; MAVSDK's throttle ranges from 0 to 1."""
        forward, right, up, yaw = axes
        self.manual.set_manual_control_input(forward, right, 0.5 + 0.5 * up, yaw)

    def fly_to(self, target, look_yaw, seconds=None, cruise=handpilot.CRUISE_M_S):
        """Holds the sticks toward a target until it is reached, or for some wall seconds."""
        end = None if seconds is None else time.monotonic() + seconds

        def step():
            here, yaw = self.here()
            self.sticks(handpilot.sticks_towards(here, yaw, target, look_yaw(here), cruise))
            time.sleep(STICK_PERIOD_S)
            return time.monotonic() > end if end else handpilot.distance(here, target) < handpilot.REACHED_M

        wait_for(f"reaching {target}", step)


@pytest.mark.timeout(900)
def test_wire_mavsdk_flies_the_first_task_and_is_scored(flight, job):
    """Covers the entire flight, from discovery to the four scores."""
    client = Client(flight.client_port)
    wait_for("health_all_ok", client.telemetry.health_all_ok)
    assert client.telemetry.health().is_armable
    # On the pad, home is the local frame's origin; MAVSDK's own request for it times out at accelerated simulation
    # speed.
    home = wait_for("home", lambda: client.telemetry.health().is_home_position_ok and client.telemetry.home())
    client.origin = handpilot.local_origin("two-bridges", home.latitude_deg, home.longitude_deg, home.absolute_altitude_m)
    pad, _ = client.here()
    plan = handpilot.first_task_plan(job, pad)
    defect = plan["defect"]["position_enu_m"]

    def face(here):
        return handpilot.aim(here, defect)[0]

    client.action.arm()
    client.action.takeoff()
    wait_for("in the air", client.telemetry.in_air)
    wait_for("the end of the takeoff", lambda: client.here()[0][2] > pad[2] + 1.5)
    client.sticks((0, 0, 0, 0))
    client.manual.start_position_control()
    for target in plan["out"] + plan["path"] + [plan["stop"]]:
        client.fly_to(target, face)
    here, _ = client.here()
    elevation = math.degrees(handpilot.aim(here, defect)[1])
    gimbal = wait_for("gimbal", lambda: client.gimbal.gimbal_list().gimbals)[0]
    client.gimbal.set_angles(gimbal.gimbal_id, 0.0, elevation, 0.0, GimbalMode.YAW_FOLLOW, SendMode.ONCE)
    client.fly_to(plan["stop"], face, seconds=2.0, cruise=0.8)
    camera = wait_for("camera", lambda: client.camera.camera_list().cameras)[0]
    client.camera.take_photo(camera.component_id)
    for target in plan["back"]:
        client.fly_to(target, face)
    client.fly_to((pad[0], pad[1], pad[2] + 6.0), face)
    client.action.land()
    wait_for("disarmed", lambda: not client.telemetry.armed())

    result = flight.assessment()
    assert result["tasks"][0]["attempted"] is True
    assert result["snapshots"]["taken"] == 1
    assert result["snapshots"]["hits"] == 1
    assert result["end"]["reason"] == "landed"
