"""Tests of the pytest plugin, loaded as in a user's test run."""

import pathlib

EXAMPLE = pathlib.Path(__file__).parents[1] / "examples" / "test_square.py"

FLIGHT = """
    import pytest

    @pytest.mark.spandrel(seed=11, vehicle="m30")
    def test_by_pymavlink(spandrel_vehicle):
        connection = spandrel_vehicle.connect()
        assert connection.wait_heartbeat(timeout=5) is not None
        spandrel_vehicle.arm()
        connection.mav.command_long_send(1, 1, 520, 0, 1, 0, 0, 0, 0, 0, 0)
        assert connection.recv_match(type="COMMAND_ACK", blocking=True, timeout=5) is not None
        spandrel_vehicle.take_off(4)
        spandrel_vehicle.run_until(lambda state: state.height_m > 3.5, sim_s=20)
        print("digest", spandrel_vehicle.digest)
"""


def digest(pytester):
    """Runs the flight and returns the digest that it prints."""
    result = pytester.runpytest_subprocess("-s", "-p", "no:cacheprovider")
    result.assert_outcomes(passed=1)
    (line,) = [line for line in result.outlines if "digest" in line]
    return line.split()[-1]


def test_exact_two_runs_of_a_test_are_bit_identical(pytester):
    pytester.makepyfile(FLIGHT)
    first, second = digest(pytester), digest(pytester)
    assert len(first) == 64
    assert first == second


def test_exact_marker_seed_changes_the_flight(pytester):
    pytester.makepyfile(FLIGHT)
    first = digest(pytester)
    pytester.makepyfile(FLIGHT.replace("seed=11", "seed=12"))
    assert digest(pytester) != first


def test_documentation_example_is_short_and_passes(pytester):
    text = EXAMPLE.read_text(encoding="utf-8")
    assert sum(1 for line in text.splitlines() if line.strip()) <= 15
    pytester.makepyfile(test_square=text)
    pytester.runpytest_subprocess("--strict-markers").assert_outcomes(passed=1)


def test_documentation_example_fails_with_a_wrong_corner(pytester):
    text = EXAMPLE.read_text(encoding="utf-8").replace("vehicle.go_to(*corner)", "vehicle.go_to(east + 40, north, up)")
    pytester.makepyfile(test_square=text)
    result = pytester.runpytest_subprocess()
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*LateError: the condition was not met within 30 s of simulation time*"])
