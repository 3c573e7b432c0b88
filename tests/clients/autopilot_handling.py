"""Flies the shipped aircraft with the built-in autopilot, PX4 and ArduPilot, and prints how they handle, as a table. Everything is measured on ground
truth. SPANDREL_PX4 and SPANDREL_ARDUPILOT specify the programs; without one, its columns are left out.

A flight above the flat ground of drill-hover, with one seed: hold for 60 s in each wind, then in still air a forward stick of 30% and of 100%, a full stick
to the left, full climb and descent, and a full yaw stick, each held until the motion is steady and then released."""

import argparse
import math
import os
import pathlib
import re
import statistics
import tempfile

from real_autopilot import VARIABLES, Vehicle

VEHICLES = ("phantom2", "f450", "m30", "elios3")
HEIGHT_M, HOLD_S = 15.0, 60.0
# Mean wind speeds, m/s. The slowest of the aircraft flies 7 m/s.
WINDS_M_S = (0.0, 3.0, 6.0)
WIND_SETTLES_S = 15.0
# Time for which a stick is held, and in which the aircraft must then stop, s.
HELD_S, STOPS_S = 12.0, 8.0
CLIMB_S, YAW_S = 6.0, 6.0
# A released aircraft has stopped at this fraction of its speed or rate.
STOPPED = 0.05
CENTERED, FULL = (0, 0, 500, 0), 1000


class Flight:
    """One aircraft in the air, with its sticks."""

    def __init__(self, vehicle):
        self.vehicle, self.heading = vehicle, vehicle.heading()

    def wind(self, speed_m_s):
        """Sets the mean wind and lets it settle."""
        self.vehicle.set_param("SIM_WIND_SPD", speed_m_s)
        self.vehicle.pass_time(WIND_SETTLES_S)

    def hold(self, seconds, sticks=CENTERED):
        """Holds the sticks; returns times, positions, velocities and headings since then. Headings, rad, do not wrap."""
        vehicle, rows = self.vehicle, []
        vehicle.sticks = sticks
        end = vehicle.now + seconds
        while vehicle.now < end:
            vehicle.step()
            self.heading += math.remainder(vehicle.heading() - self.heading, math.tau)
            rows.append((vehicle.now, vehicle.position(), vehicle.true_velocity(), self.heading))
        return rows

    def scatter(self):
        """Returns the standard deviations north, east and down while holding, m."""
        places = [place for _, place, _, _ in self.hold(HOLD_S)]
        return [statistics.pstdev(axis) for axis in zip(*places)]

    def stick(self, sticks):
        """Holds a horizontal stick and releases it. Returns speed, time from 10 to 90% of it, time to stop and distance to stop."""
        held = self.hold(HELD_S, sticks)
        speeds = [math.hypot(*velocity[:2]) for _, _, velocity, _ in held]
        speed = statistics.median(speeds[-50:])
        first = {share: next(row[0] for row, v in zip(held, speeds) if v >= share * speed) for share in (0.1, 0.9)}
        start_s, start = held[-1][0], held[-1][1]
        for now, place, velocity, _ in self.hold(STOPS_S):
            if math.hypot(*velocity[:2]) <= STOPPED * speed:
                return speed, first[0.9] - first[0.1], now - start_s, math.dist(place[:2], start[:2])
        return speed, first[0.9] - first[0.1], math.nan, math.nan

    def vertical(self, throttle):
        """Returns the steady vertical speed with this stick, m/s."""
        velocities = [velocity[2] for _, _, velocity, _ in self.hold(CLIMB_S, (0, 0, throttle, 0))]
        self.hold(STOPS_S / 2)
        return abs(statistics.median(velocities[-75:]))

    def yaw(self):
        """Returns the steady yaw rate, deg/s, and after its release the further turn and the swing back, deg."""
        held = self.hold(YAW_S, (0, 0, 500, FULL))
        rate = (held[-1][3] - held[-100][3]) / (held[-1][0] - held[-100][0])
        released = [heading for _, _, _, heading in self.hold(STOPS_S / 2)]
        return tuple(map(math.degrees, (rate, max(released) - held[-1][3], max(released) - released[-1])))


def fly(folder, autopilot, name):
    """Flies one aircraft and returns its row of the table, by title."""
    options = {"flavor": "px4"} if autopilot == "built-in" else {}
    vehicle = Vehicle(folder, "px4" if autopilot == "built-in" else autopilot, vehicle=name, **options)
    try:
        vehicle.get_ready()
        found = re.search(r"ready after ([\d.]+) s on its clock", vehicle.output())
        ready_s = float(found[1]) if found else vehicle.now
        vehicle.take_off(HEIGHT_M)
        vehicle.set_mode("sticks")
        flight, row = Flight(vehicle), {"ready after, s on its clock": f"{ready_s:.0f}"}
        for wind in reversed(WINDS_M_S):
            flight.wind(wind)
            row[f"hold in wind of {wind:.0f} m/s, standard deviation north/east/down, m"] = "/".join(f"{s:.2f}" for s in flight.scatter())
        for title, sticks in (("30% forward stick", (300, 0, 500, 0)), ("full forward stick", (FULL, 0, 500, 0)), ("full stick to the left", (0, -FULL, 500, 0))):
            speed, rise_s, stop_s, stop_m = flight.stick(sticks)
            row[f"{title}: speed, m/s; 10 to 90% of it, s; stop, s and m"] = f"{speed:.1f}; {rise_s:.1f}; {stop_s:.1f}, {stop_m:.1f}"
        row["full climb/descent, m/s"] = f"{flight.vertical(FULL):.1f}/{flight.vertical(0):.1f}"
        rate, further, back = flight.yaw()
        row["full yaw stick: rate, deg/s; after its release, further turn and swing back, deg"] = f"{rate:.0f}; {further:.0f}, {back:.1f}"
        vehicle.land()
        return row
    finally:
        vehicle.close()


def print_table(autopilot, rows):
    """Prints the rows of one autopilot, with the aircraft as columns."""
    print(f"\n| {autopilot} | {' | '.join(rows)} |\n|---|{'---|' * len(rows)}")
    for title in next(iter(rows.values())):
        print(f"| {title} | {' | '.join(row[title] for row in rows.values())} |", flush=True)


def main():
    """Flies everything and prints the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--autopilot", action="append", choices=["built-in", *VARIABLES])
    parser.add_argument("--vehicle", action="append", choices=VEHICLES)
    args = parser.parse_args()
    present = ["built-in"] + [name for name, variable in VARIABLES.items() if variable in os.environ]
    folder = pathlib.Path(tempfile.mkdtemp())
    for autopilot in args.autopilot or present:
        print_table(autopilot, {name: fly(folder / autopilot / name, autopilot, name) for name in args.vehicle or VEHICLES})


if __name__ == "__main__":
    main()
