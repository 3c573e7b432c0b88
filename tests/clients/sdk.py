"""Connects MAVSDK to a vehicle and performs a short flight."""

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.telemetry import Telemetry

from spandrel import wait_for

# Time limit for finding a vehicle on a busy machine, wall seconds (ten times the usual time).
DISCOVERY_LIMIT_S = 60.0


def connect(port):
    """Returns MAVSDK and the vehicle that it has found."""
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
    system = mavsdk.first_autopilot(DISCOVERY_LIMIT_S)
    assert system is not None, "no vehicle discovered"
    return mavsdk, system


def ready(system):
    """Returns the telemetry of a vehicle that is ready to arm."""
    telemetry = Telemetry(system)
    wait_for("health_all_ok", telemetry.health_all_ok)
    return telemetry


def request_telemetry(system):
    """Requests telemetry from a vehicle that, like ArduPilot, sends none without a request, and waits until its home is
    known."""
    telemetry = Telemetry(system)
    telemetry.set_rate_position(10.0)
    telemetry.set_rate_position_velocity_ned(10.0)
    wait_for("the home position", lambda: telemetry.health().is_home_position_ok and telemetry.position().latitude_deg > 1)
    return telemetry


def take_off(system, height_m):
    """Arms, takes off and waits for a height. Returns the action and telemetry plugins."""
    action, telemetry = Action(system), ready(system)
    action.arm()
    action.takeoff()
    wait_for("the height", lambda: telemetry.position().relative_altitude_m > height_m)
    return action, telemetry
