"""Flies with stick inputs only: a proportional controller for position and heading, shared by all client libraries.

Positions are east, north, up in meters from the scenario origin; sticks are forward, right, up, clockwise in [-1, 1].
"""

import math
import tomllib

import spandrel

# Maximum commanded speed, m/s; well below the 10 mph limit.
CRUISE_M_S = 3.0
# The default aircraft's speed at full stick (vehicle-params/phantom2.toml), m/s.
FULL_STICK_M_S = 13.4
FULL_CLIMB_M_S = 6.0
FULL_DESCENT_M_S = 2.0
FULL_YAW_RAD_S = 1.75
POSITION_GAIN = 0.7
YAW_GAIN = 1.2
REACHED_M = 1.2
# Height above the path for transits across the bridge, clear of railings and trucks, m.
OVER_M = 14.0


def wrap_angle(angle):
    """Returns an angle in (-pi, pi]."""
    return math.atan2(math.sin(angle), math.cos(angle))


def sticks_towards(here, yaw, target, look_yaw, cruise=CRUISE_M_S):
    """Returns the stick inputs for flying from `here` to `target` while turning to `look_yaw`."""
    east, north, up = (t - h for t, h in zip(target, here))
    ve, vn, vu = (POSITION_GAIN * c for c in (east, north, up))
    scale = min(1.0, cruise / max(math.sqrt(ve * ve + vn * vn + vu * vu), 1e-6))
    ve, vn, vu = ve * scale, vn * scale, vu * scale
    forward = vn * math.cos(yaw) + ve * math.sin(yaw)
    right = ve * math.cos(yaw) - vn * math.sin(yaw)
    climb = vu / (FULL_CLIMB_M_S if vu > 0 else FULL_DESCENT_M_S)
    turn = YAW_GAIN * wrap_angle(look_yaw - yaw) / FULL_YAW_RAD_S
    return tuple(deflection(fraction) for fraction in (forward / FULL_STICK_M_S, right / FULL_STICK_M_S, climb, turn))


def deflection(fraction):
    """Returns the stick deflection for a fraction of the full speed, with the stick curve of position mode (60% cubic)."""
    low, high = 0.0, 1.0
    for _ in range(30):
        middle = (low + high) / 2
        low, high = (middle, high) if 0.4 * middle + 0.6 * middle**3 < abs(fraction) else (low, middle)
    return math.copysign(low, fraction)


def distance(a, b):
    """Returns the distance between two points in meters."""
    return math.dist(a, b)


def simplify(path, step_m=4.0):
    """Returns the path with points at least `step_m` apart, including its ends."""
    kept = [path[0]]
    for point in path[1:-1]:
        if distance(kept[-1], point) >= step_m:
            kept.append(point)
    return kept + [path[-1]]


def incidence_cosine(defect, point):
    """Returns the cosine between the defect's normal and the line of sight from a point."""
    line = [p - d for p, d in zip(point, defect["position_enu_m"])]
    length = math.sqrt(sum(c * c for c in line))
    return sum(c * n for c, n in zip(line, defect["normal_enu"])) / max(length, 1e-9)


def defect_to_photograph(job, path):
    """Returns the defect that is most visible from a task's path, and the path point to view it from: near,
    perpendicular, large."""

    def visibility(item):
        defect, point = item
        return max(0.0, incidence_cosine(defect, point)) * defect["size_m"] / distance(defect["position_enu_m"], point)

    return max(((d, p) for d in job["defects"] for p in path), key=visibility)


def aim(here, target):
    """Returns the heading and elevation from one point to another in radians."""
    east, north, up = (t - h for t, h in zip(target, here))
    return math.atan2(east, north), math.atan2(up, math.hypot(east, north))


def first_task_plan(job, pad):
    """Returns the waypoints of the flight: up from the pad, over the bridge, along task 1 with the photo stop, and
    back over the bridge."""
    path = job["tasks"][0]["path_enu_m"]
    if distance(pad, path[-1]) < distance(pad, path[0]):
        path = path[::-1]
    defect, stop = defect_to_photograph(job, path)
    over = max(point[2] for point in path) + OVER_M

    def above(point):
        return (point[0], point[1], over)

    return {
        "out": [above(pad), above(path[0])],
        "path": simplify(path),
        "back": [above(stop), above(pad)],
        "stop": stop,
        "defect": defect,
    }


WGS84_A_M, WGS84_E2 = 6_378_137.0, 6.694_379_990_14e-3  # semi-major axis, eccentricity squared


def local_origin(scenario, latitude_deg, longitude_deg, altitude_m):
    """Returns the origin of the vehicle's local frame (GPS_GLOBAL_ORIGIN) in meters east, north and up of the job's
    origin."""
    site = tomllib.loads((spandrel.ROOT / "scenarios" / f"{scenario}.toml").read_text(encoding="utf-8"))["origin"]
    latitude = math.radians(site["latitude_deg"])
    flat = 1.0 - WGS84_E2 * math.sin(latitude) ** 2
    prime = WGS84_A_M / math.sqrt(flat)
    north = math.radians(latitude_deg - site["latitude_deg"]) * prime * (1.0 - WGS84_E2) / flat
    east = math.radians(longitude_deg - site["longitude_deg"]) * prime * math.cos(latitude)
    return east, north, altitude_m - site["altitude_m"]
