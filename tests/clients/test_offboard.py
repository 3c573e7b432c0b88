"""MAVSDK's offboard example, and MAVSDK as a lockstep peer."""

import pytest
from mavsdk.plugins.action import Action
from mavsdk.plugins.offboard import Offboard, PositionNedYaw, VelocityBodyYawspeed, VelocityNedYaw

import sdk
import spandrel
from spandrel import wait_for

# Distance within which a position counts as reached in MAVSDK's telemetry, m.
NEAR_M = 0.6
# Maximum distance of the estimate from the pad, where the estimator was initialized, m (GNSS drifts within a minute).
PAD_M = 1.0


def start(folder, port, *more, speed=spandrel.SPEED):
    """Starts the shipped job's vehicle, which connects to one client."""
    log = open(folder / "sim.txt", "w", encoding="utf-8")
    arguments = [
        "sim", "--scenario", "two-bridges", "--seed", "7", "--speed", str(speed), "--gcs", f"127.0.0.1:{port}", "--sdk", "none",
        "--gcs-port", "0", "--payload-port", "none", "--tcp-port", "none", "--monitor-port", "none", *more,
    ]
    return spandrel.subprocess.Popen([spandrel.PROGRAM, *arguments], stdout=log, stderr=log, stdin=spandrel.subprocess.DEVNULL)


@pytest.mark.timeout(600)
def test_regress_mavsdk_offboard_example_flies(tmp_path, measured):
    """Flies like MAVSDK's offboard examples: setpoint at 0, 0, 0 on the pad, up 5 m, 5 m north, back, then velocities,
    then down."""
    port = spandrel.free_udp_port()
    process = start(tmp_path, port)
    mavsdk, system = sdk.connect(port)
    try:
        telemetry, action, offboard = sdk.ready(system), Action(system), Offboard(system)
        place = lambda: telemetry.position_velocity_ned().position  # noqa: E731
        wait_for("a local position", lambda: place().north_m == place().north_m)
        pad = place()
        measured(f"local position on the pad: {pad.north_m:.2f}, {pad.east_m:.2f}, {pad.down_m:.2f} m")
        assert max(abs(pad.north_m), abs(pad.east_m), abs(pad.down_m)) < PAD_M, pad
        action.arm()
        offboard.set_position_ned(PositionNedYaw(0.0, 0.0, 0.0, 0.0))
        offboard.start()

        def fly_to(north, east, down, yaw):
            offboard.set_position_ned(PositionNedYaw(north, east, down, yaw))
            off = lambda p: ((p.north_m - north) ** 2 + (p.east_m - east) ** 2 + (p.down_m - down) ** 2) ** 0.5  # noqa: E731
            wait_for(f"{north}, {east}, {down}", lambda: off(place()) < NEAR_M)

        fly_to(0.0, 0.0, -5.0, 0.0)
        fly_to(5.0, 0.0, -5.0, 90.0)
        fly_to(5.0, 5.0, -5.0, 90.0)
        fly_to(0.0, 0.0, -5.0, 270.0)
        offboard.set_velocity_ned(VelocityNedYaw(2.0, 0.0, 0.0, 0.0))
        wait_for("flying north", lambda: place().north_m > 4.0)
        offboard.set_velocity_body(VelocityBodyYawspeed(0.0, 0.0, -1.0, 0.0))
        wait_for("climbing", lambda: place().down_m < -7.0)
        fly_to(0.0, 0.0, -3.0, 0.0)
        offboard.stop()
        action.land()
        wait_for("disarmed", lambda: not telemetry.armed())
    finally:
        mavsdk.destroy()
        spandrel.end(process)


@pytest.mark.parametrize("answers", [True, False])
@pytest.mark.timeout(600)
def test_regress_mavsdk_flies_as_a_lockstep_peer(tmp_path, answers):
    """Uses MAVSDK as the only peer. MAVSDK answers TIMESYNC only after it has found the vehicle and is configured to do
    so."""
    port = spandrel.free_udp_port()
    process = start(tmp_path, port, "--lockstep", f"127.0.0.1:{port}")
    mavsdk, system = sdk.connect(port)
    try:
        if answers:
            system.enable_timesync()
        action, telemetry = sdk.take_off(system, 1.5)
        action.land()
        wait_for("disarmed", lambda: not telemetry.armed())
    finally:
        mavsdk.destroy()
        spandrel.end(process)
    in_real_time = "serving it in real time" in (tmp_path / "sim.txt").read_text(encoding="utf-8")
    assert in_real_time != answers, "in step from its first answer on, and in real time without one"
