"""Flies a 5 m square above the pad and checks every corner."""

import math


def test_square(spandrel_vehicle):
    vehicle = spandrel_vehicle
    vehicle.arm()
    vehicle.take_off(5)
    east, north, up = vehicle.run_until(lambda state: state.height_m > 4.7, sim_s=20).position_enu_m
    for corner in [(east + 5, north, up), (east + 5, north + 5, up), (east, north + 5, up), (east, north, up)]:
        vehicle.go_to(*corner)
        vehicle.run_until(lambda state: math.dist(state.position_enu_m, corner) < 1.0, sim_s=30)
    vehicle.land()
    assert vehicle.run_until(lambda state: not state.armed, sim_s=30).hits == 0
