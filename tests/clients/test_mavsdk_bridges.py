"""MAVSDK flies in offboard mode at bridges: a shipped steel girder bridge, and one that trimesh builds."""

import json
import tomllib

import pytest
import trimesh
from mavsdk.plugins.action import Action
from mavsdk.plugins.offboard import Offboard, PositionNedYaw

import bridge_models
import handpilot
import sdk
import spandrel
from spandrel import wait_for

# Length of the path that is flown, m.
PIECE_M = 15.0
# Height above the pad at which offboard mode begins, m.
START_UP_M = 2.0


def imported_bridge(folder):
    """Returns the job at a slab bridge on girders with a rough arch between them, which collides as a triangle mesh."""
    scene, volumes = bridge_models.bridge_scene(tagged=False)
    below_deck = trimesh.transformations.translation_matrix((0.0, 0.0, 7.3))
    scene.add_geometry(bridge_models.rough_block(), node_name="arch", geom_name="arch", transform=below_deck)
    model = bridge_models.write(scene, folder / "ribbed.glb")
    done = bridge_models.import_with_suggested_elements(model, folder / "ribbed", len(volumes) + 1)
    [arch] = [line.split() for line in done.stdout.splitlines() if line.startswith("arch ")]
    assert arch[8] == "mesh", arch
    return folder / "ribbed" / "scenario.toml"


def piece(path):
    """Returns the first part of a path."""
    points, length = [path[0]], 0.0
    for point in path[1:]:
        length += handpilot.distance(points[-1], point)
        points.append(point)
        if length >= PIECE_M:
            break
    return handpilot.simplify(points)


class Pilot:
    """Flies by position setpoints in the site's frame. The vehicle stands on the pad, whose position is known; this removes the constant
    error of the receiver."""

    def __init__(self, system, pad_m):
        self.action, self.telemetry, self.offboard = Action(system), sdk.ready(system), Offboard(system)
        p = wait_for("a local position", self.local_position)
        self.origin = (pad_m[0] - p.east_m, pad_m[1] - p.north_m, pad_m[2] + p.down_m)

    def local_position(self):
        """Returns the position in the vehicle's local frame; `None` until there is one."""
        p = self.telemetry.position_velocity_ned().position
        return p if p.north_m == p.north_m else None

    def here(self):
        """Returns the position in meters east, north and up of the job's origin."""
        p, (east, north, up) = self.local_position(), self.origin
        return east + p.east_m, north + p.north_m, up - p.down_m

    def aim_at(self, target):
        east, north, up = (t - o for t, o in zip(target, self.origin))
        self.offboard.set_position_ned(PositionNedYaw(north, east, -up, 0.0))

    def fly_to(self, target):
        self.aim_at(target)
        wait_for(f"reaching {target}", lambda: handpilot.distance(self.here(), target) < handpilot.REACHED_M)


@pytest.mark.parametrize("bridge", ["shipped", "imported"])
@pytest.mark.timeout(900)
def test_flight_mavsdk_inspects_a_bridge_in_offboard_mode(tmp_path, measured, bridge):
    """Takes off, flies to the start of the first task and along a piece of its path, returns and lands; the session is scored."""
    scenario = spandrel.ROOT / "scenarios" / "girder.toml" if bridge == "shipped" else imported_bridge(tmp_path)
    pad = tomllib.loads(scenario.read_text(encoding="utf-8"))["ground_team"]["pad_m"]
    job = json.loads(spandrel.run("export", str(scenario), "--seed", "7", "--scenario", "-"))
    path = piece(job["tasks"][0]["path_enu_m"])
    over_m = max(point[2] for point in job["tasks"][0]["path_enu_m"]) + handpilot.OVER_M
    flight = spandrel.Flight(tmp_path, scenario=str(scenario))
    mavsdk, system = sdk.connect(flight.client_port)
    try:
        pilot = Pilot(system, pad)
        pilot.action.arm()
        pilot.action.takeoff()
        wait_for("the height", lambda: pilot.here()[2] > pad[2] + START_UP_M)
        above = [(point[0], point[1], over_m) for point in (pad, path[0], path[-1])]
        pilot.aim_at(above[0])
        pilot.offboard.start()
        for target in [above[0], above[1], *path, above[2], above[0]]:
            pilot.fly_to(target)
        pilot.offboard.stop()
        pilot.action.land()
        wait_for("disarmed", lambda: not pilot.telemetry.armed())
        result = flight.assessment()
    finally:
        mavsdk.destroy()
        flight.close()
        print((tmp_path / "log.txt").read_text(encoding="utf-8")[-4000:])
    first = result["tasks"][0]
    measured(f"MAVSDK at the {bridge} bridge: first task {first['state']}, on path {first['on_path']}")
    assert first["attempted"] is True and first["on_path"] > 0.0, first
    assert result["end"]["reason"] == "landed" and result["crashes"]["other"] == 0, result["end"]
    report = (flight.session() / "report.html").read_text(encoding="utf-8")
    assert job["tasks"][0]["name"] in report
