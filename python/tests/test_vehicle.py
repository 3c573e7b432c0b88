"""Tests of the in-process vehicle: stepping, commands, errors, links and reproducibility."""

import math
import threading

import pytest

import spandrel


def flying_vehicle(seed):
    """Returns a vehicle that has taken off."""
    vehicle = spandrel.Vehicle(seed=seed)
    vehicle.arm()
    vehicle.take_off(5)
    vehicle.run_until(lambda state: state.height_m > 4.7, sim_s=20)
    return vehicle


def test_exact_step_is_one_millisecond():
    vehicle = spandrel.Vehicle()
    assert vehicle.step().time_s == 0.001
    assert vehicle.step(499).time_s == 0.5
    assert vehicle.run_for(0.25).time_s == 0.75
    assert vehicle.step(0).time_s == vehicle.time_s == 0.75


def test_flight_arm_take_off_go_to_and_land():
    vehicle = flying_vehicle(7)
    assert vehicle.state.armed
    vehicle.go_to(8.0, 6.0, 7.0)
    state = vehicle.run_until(lambda s: math.dist(s.position_enu_m, (8.0, 6.0, 7.0)) < 1.0, sim_s=30)
    assert state.battery_pct < 100.0
    vehicle.go_to(0.0, 0.0, 5.0)
    vehicle.run_until(lambda s: math.dist(s.position_enu_m, (0.0, 0.0, 5.0)) < 1.0, sim_s=30)
    vehicle.land()
    state = vehicle.run_until(lambda s: not s.armed, sim_s=30)
    assert state.hits == 0 and state.ended is None
    assert "armed" in repr(state)


def test_flight_ardupilot_takes_off_in_guided():
    vehicle = spandrel.Vehicle(flavor="ardupilot")
    vehicle.arm()
    vehicle.take_off(5)
    assert vehicle.run_until(lambda state: state.height_m > 4.5, sim_s=30).armed


def test_flight_sticks_make_the_vehicle_climb():
    vehicle = flying_vehicle(7)
    start = vehicle.state.height_m
    for _ in range(10):
        vehicle.sticks(0.0, 0.0, 1.0, 0.0)
        vehicle.run_for(0.2)
    assert vehicle.state.height_m > start + 1.0


def test_exact_only_equal_seeds_are_bit_identical():
    digests = [flying_vehicle(seed).digest for seed in (7, 7, 8)]
    assert digests[0] == digests[1] != digests[2]
    assert len(digests[0]) == 64


def test_exact_concurrent_flights_are_bit_identical():
    alone = flying_vehicle(7).digest
    found = []
    threads = [threading.Thread(target=lambda: found.append(flying_vehicle(7).digest)) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [alone, alone]


def test_stepping_lets_other_python_threads_run():
    vehicle = spandrel.Vehicle()
    thread = threading.Thread(target=vehicle.run_for, args=(120.0,))
    turns = 0
    thread.start()
    while thread.is_alive():
        turns += 1
    assert vehicle.time_s == 120.0
    # If the other thread held the lock, only a few turns would remain.
    assert turns > 1_000


def test_exact_unmet_condition_raises_late_error():
    vehicle = spandrel.Vehicle()
    with pytest.raises(spandrel.LateError, match="was not met within 2 s of simulation time"):
        vehicle.run_until(lambda state: state.armed, sim_s=2)
    assert vehicle.time_s == 2.0


@pytest.mark.parametrize(
    "arguments, words",
    [
        ({"scenario": "three-bridges"}, "three-bridges: no such scenario; .*two-bridges"),
        ({"vehicle": "phantom9"}, "phantom9: no such vehicle; .*phantom2"),
        ({"scenario": "missing.toml"}, "missing.toml: "),
        ({"flavor": "betaflight"}, "unknown flavor betaflight; allowed: px4, ardupilot, generic"),
        ({"after_crash": "cry"}, "unknown crash rule cry; allowed: scenario, continue, respawn, end"),
    ],
)
def test_exact_invalid_jobs_raise_descriptive_errors(arguments, words):
    with pytest.raises(spandrel.JobError, match=words):
        spandrel.Vehicle(**arguments)


def test_exact_every_problem_of_a_file_is_listed(tmp_path):
    file = tmp_path / "job.toml"
    file.write_text('format = 1\nname = "Job!"\nwrong = 2\n', encoding="utf-8")
    with pytest.raises(spandrel.JobError) as raised:
        spandrel.Vehicle(file)
    assert "wrong" in str(raised.value) and "job.toml:" in str(raised.value)


def test_exact_rejected_command_raises_an_error_with_the_result():
    with pytest.raises(spandrel.RefusedError, match="MAV_CMD_DO_PARACHUTE returned MAV_RESULT_UNSUPPORTED"):
        spandrel.Vehicle().command(208)
    with pytest.raises(ValueError, match="unknown MAV_CMD 65000"):
        spandrel.Vehicle().command(65000)


def test_exact_invalid_arguments_raise_value_errors():
    vehicle = spandrel.Vehicle()
    for wrong in (lambda: vehicle.step(-1), lambda: vehicle.run_for(-1.0), lambda: vehicle.run_for(math.nan)):
        with pytest.raises(ValueError, match="allowed: 0 or more"):
            wrong()
    with pytest.raises(ValueError, match="unknown link kind"):
        vehicle.open_link("carrier pigeon")


def test_wire_socketless_link_carries_frames_in_both_directions():
    vehicle = spandrel.Vehicle()
    link = vehicle.open_link("gcs")
    vehicle.run_for(1.0)
    datagrams = link.receive()
    assert datagrams and all(datagram[0] == 0xFD for datagram in datagrams)
    assert link.receive() == []
    link.close()
    with pytest.raises(spandrel.SpandrelError, match="is closed"):
        link.send(b"")


def test_shipped_files_are_listed():
    assert "two-bridges" in spandrel.scenarios()
    assert "phantom2" in spandrel.vehicles()
