"""Recomputes the certification of a session from its exports alone: the frames, the scenario, the vehicle file and the
pictures' measurements in `assessment.json`. Written from docs/src/reference/assessment.md, not from the program."""

import math

# Constants of docs/src/reference/assessment.md, "Certification".
VISIT_GAP_S, CONTACT_GAP_S = 10.0, 1.0
COVERED_STEP_M = 5.0
FRAMING_FREE_DEG, FRAMING_ZERO_DEG = 45.0, 67.5
CONTACT_POINTS, CONTACT_SPEED_M_S, CONTACT_MOST = 3.0, 2.0, 30.0
EXPOSURE_PER_S, EXPOSURE_MOST = 0.1, 50.0
SEVERITY = ["none", "other", "water", "terrain", "bridge", "vehicle", "person"]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def length(a):
    return math.sqrt(dot(a, a))


def angle_deg(a, b):
    cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    return math.degrees(math.atan2(length(cross), dot(a, b)))


class Path:
    """A task's reference path, with the paper's nearest-point rule."""

    def __init__(self, task):
        self.points, self.closed = task["path_enu_m"], task["closed"]
        self.threshold = task["threshold_m"]
        self.low = [min(p[k] for p in self.points) for k in range(3)]
        self.high = [max(p[k] for p in self.points) for k in range(3)]

    def segment(self, k):
        if k + 1 < len(self.points):
            return self.points[k], self.points[k + 1]
        return (self.points[k], self.points[0]) if self.closed else None

    def far(self, p):
        return any(p[k] < self.low[k] - self.threshold - 1 or p[k] > self.high[k] + self.threshold + 1 for k in range(3))

    def nearest(self, p):
        point = min(range(len(self.points)), key=lambda k: sum((x - y) ** 2 for x, y in zip(p, self.points[k])))
        distances = [length(minus(p, self.points[point]))]
        before = point - 1 if point else (len(self.points) - 1 if self.closed else None)
        for k in (before, point):
            segment = None if k is None else self.segment(k)
            if segment:
                a, b = segment
                along = minus(b, a)
                share = min(1.0, max(0.0, dot(minus(p, a), along) / dot(along, along))) if dot(along, along) else 0.0
                distances.append(length(minus(p, [x + share * y for x, y in zip(a, along)])))
        return point, min(distances)

    def weights(self):
        """The length that each point represents."""
        out = [0.0] * len(self.points)
        for k in range(len(self.points)):
            segment = self.segment(k)
            if segment:
                half = 0.5 * length(minus(segment[1], segment[0]))
                out[k] += half
                out[(k + 1) % len(self.points)] += half
        return out


def on_path(frames, paths):
    """The task and the nearest point of every frame; None off all paths."""
    current, out = None, []
    for frame in frames:
        within = []
        for k, path in enumerate(paths):
            if not path.far(frame["at"]):
                point, distance = path.nearest(frame["at"])
                if distance <= path.threshold:
                    within.append((distance / path.threshold, k != current, k, point))
        best = min(within, default=None)
        out.append(best and (best[2], best[3]))
        current = best[2] if best else current
    return out


def coverage(path, on, task):
    along = [0.0]
    for a, b in zip(path.points, path.points[1:]):
        along.append(along[-1] + length(minus(b, a)))
    covered, before = set(), None
    for one in on:
        point = one[1] if one and one[0] == task else None
        if point is not None:
            start = before if before is not None and abs(along[before] - along[point]) <= COVERED_STEP_M else point
            covered.update(range(min(start, point), max(start, point) + 1))
        before = point
    weights = path.weights()
    total = sum(weights)
    if total <= path.threshold or len(covered) == len(path.points):
        return total, 1.0 if covered else 0.0
    return total, sum(weights[k] for k in covered) / total


def visits(on, task, rate):
    out = []
    for i, one in enumerate(on):
        if one and one[0] == task:
            if out and i - out[-1][1] < VISIT_GAP_S * rate:
                out[-1][1] = i
            else:
                out.append([i, i])
    return out


def read(rows):
    """The frames export as numbers."""
    def number(text):
        return float(text) if text != "" else None

    frames = []
    for row in rows:
        yaw, pitch = number(row["yaw_deg"]), number(row["gimbal_pitch_deg"])
        axis = None
        if yaw is not None:
            yaw, pitch = math.radians(yaw), math.radians(pitch or 0.0)
            axis = [math.cos(pitch) * math.sin(yaw), math.cos(pitch) * math.cos(yaw), math.sin(pitch)]
        frames.append({
            "at": [number(row[key]) for key in ("east_m", "north_m", "up_m")], "speed": number(row["speed_m_s"]), "axis": axis,
            "clearance": number(row["clearance_m"]), "missing": row["missing"] == "1", "contact": row["contact"],
            "battery": number(row["battery_pct"]),
        })
    return frames


def contacts(frames, rate):
    """Merged contacts as (worst object, speed)."""
    onsets, before = [], "none"
    for i, frame in enumerate(frames):
        now = frame["contact"]
        worse = now in ("person", "vehicle") and now != before
        if now != "none" and (before == "none" or worse):
            speed = max(one["speed"] for one in frames[max(0, i - 2):i + 1])
            onsets.append([i, i, now, speed])
        elif now != "none":
            onsets[-1][1] = i
        before = now
    merged = []
    for first, last, with_, speed in onsets:
        if merged and first - merged[-1][1] < CONTACT_GAP_S * rate:
            _, _, worst, fastest = merged[-1]
            merged[-1][1:] = [last, max(worst, with_, key=SEVERITY.index), max(fastest, speed)]
        else:
            merged.append([first, last, with_, speed])
    return len(onsets), [(with_, speed) for _, _, with_, speed in merged]


def precision(frames, task, path, ranges, limit, home):
    """Sums over a task's visits: frames, squared distance, squared speeding, squared framing, framed frames, close frames."""
    sums = [0, 0.0, 0.0, 0.0, 0, 0]
    for first, last in ranges:
        for frame in frames[first:last + 1]:
            if frame["missing"]:
                continue
            point, distance = path.nearest(frame["at"])
            sums[0] += 1
            sums[1] += (distance / path.threshold) ** 2
            sums[2] += max(0.0, frame["speed"] / limit - 1.0) ** 2
            if task["viewing_directions_enu"] and frame["axis"]:
                error = max(0.0, angle_deg(frame["axis"], task["viewing_directions_enu"][point]) - FRAMING_FREE_DEG)
                sums[3] += error ** 2
                sums[4] += 1
            sums[5] += close(frame, task["clearance_m"], home)
    return sums


def close(frame, limit_m, home):
    (pad, radius), at = home, frame["at"]
    away = math.hypot(at[0] - pad[0], at[1] - pad[1]) > radius
    return frame["clearance"] is not None and frame["clearance"] < limit_m and away and not frame["missing"]


def measures(sums):
    count, distance, speeding, framing, framed, near = sums
    return None if not count else {
        "frames": count, "rms_distance_ratio": math.sqrt(distance / count), "rms_speeding_ratio": math.sqrt(speeding / count),
        "rms_framing_deg": math.sqrt(framing / framed) if framed else None, "low_clearance_share": near / count,
    }


def precision_score(of):
    framing = (of["rms_framing_deg"] or 0.0) / FRAMING_ZERO_DEG
    score = 100.0
    for error in (of["rms_distance_ratio"], of["rms_speeding_ratio"], framing, of["low_clearance_share"]):
        score *= max(0.0, 1.0 - error)
    return score


def accuracy(pictures, scenario, camera):
    """Counts and score from the pictures' measured distance, incidence, illuminance, speed and rotation."""
    limits = scenario["certification"]
    focal = 0.5 * camera["width_px"] / math.tan(0.5 * math.radians(camera["hfov_deg"]))
    nearest = min([limits["clearance_m"], *(task["clearance_m"] for task in scenario["tasks"])])
    best = 1000.0 * nearest / (focal * camera.get("zoom_max", 1.0))
    allowed = {}
    for defect in scenario["defects"]:
        width = limits["gsd_per_line_width"] * defect["width_m"] * 1000.0 if defect["line"] else math.inf
        allowed[defect["id"]] = min(limits["max_gsd_mm"], width)
    found, taken, hits = set(), 0, 0
    for picture in pictures:
        new, too_fine = set(), False
        for view in (view for view in picture["views"] if view["shown"]):
            of, quality = view["defect"], view["quality"]
            if best > allowed[of]:
                too_fine = True
                continue
            exposure = camera["exposure_max_s"] * min(1.0, quality["required_illuminance_lux"] / quality["illuminance_lux"])
            gsd_mm = quality["gsd_mm"]
            focal_now = quality["distance_m"] * 1000.0 / gsd_mm
            smear = exposure * (quality["speed_across_m_s"] * 1000.0 / gsd_mm + quality["rotation_rad_s"] * focal_now)
            assert math.isclose(smear, quality["smear_px"], rel_tol=1e-9), (smear, quality)
            sharp = smear <= limits["max_smear_px"] and gsd_mm <= allowed[of]
            if sharp and quality["incidence_deg"] <= limits["max_incidence_deg"] and of not in found:
                new.add(of)
        found |= new
        hits += bool(new)
        taken += bool(new) or not too_fine
    placed = sum(best <= limit for limit in allowed.values())
    if not placed:
        return taken, hits, 0, 0, None
    right, recall = (hits / taken if taken else 0.0), len(found) / placed
    beta2 = 1.0 if scenario["beta"] == 1.0 else scenario["beta"] ** 2
    score = 100.0 * (1 + beta2) * right * recall / (beta2 * right + recall) if hits else 0.0
    return taken, hits, len(found), placed, score


def certify(rows, scenario, camera, assessment):
    """Returns the scores, the measures and the decision."""
    frames, limits, rate = read(rows), scenario["certification"], scenario["frame_rate_hz"]
    home = (limits["home_enu_m"], limits["home_radius_m"])
    paths = [Path(task) for task in scenario["tasks"]]
    on = on_path(frames, paths)
    count, limit = len(paths), scenario["speed_limit_m_s"]
    path_m, done, shares, speeding, sums, entered = 0.0, 0, 0.0, 0.0, [0, 0.0, 0.0, 0.0, 0, 0], False
    covered_shares = []
    for k, (task, path) in enumerate(zip(scenario["tasks"], paths)):
        ranges = visits(on, k, rate)
        total, covered = coverage(path, on, k)
        inside = [i for first, last in ranges for i in range(first, last + 1)]
        entered |= bool(inside)
        covered_shares.append(covered)
        path_m += total
        done += bool(inside) and covered >= limits["task_done_share"]
        if inside:
            share = sum(one is not None and one[0] == k for one in on) / len(inside)
            if covered >= limits["min_inspected_share"]:
                shares += covered * share
            speeding += sum(frames[i]["speed"] / limit for i in inside if frames[i]["speed"] > limit) / len(inside)
        of_task = precision(frames, task, path, ranges, limit, home)
        sums = [a + b for a, b in zip(sums, of_task)]
    conformity = min(100.0, max(0.0, 100.0 * (shares - speeding * limit / scenario["max_speed_m_s"]) / count)) if entered else None
    of = measures(sums)
    onsets, merged = contacts(frames, rate)
    exposure, current = 0, None
    for frame, one in zip(frames, on):
        current = one[0] if one else current
        exposure += close(frame, limits["clearance_m"] if current is None else scenario["tasks"][current]["clearance_m"], home)
    exposure /= rate
    lost = sum(min(CONTACT_MOST, CONTACT_POINTS * (1 + (v / CONTACT_SPEED_M_S) ** 2)) for _, v in merged)
    traffic = any(with_ in ("person", "vehicle") for with_, _ in merged)
    safety = 0.0 if traffic else min(100.0, max(0.0, 100.0 - lost - min(EXPOSURE_MOST, EXPOSURE_PER_S * exposure)))
    shown = {view["defect"] for picture in assessment["snapshots"]["each"] for view in picture["views"] if view["shown"]}
    needed = path_m / limits["inspection_speed_m_s"] + limits["transit_time_s"] + limits["time_per_defect_s"] * len(shown)
    landed = assessment["end"]["reason"] == "landed"
    complete = landed and done == count
    most = limits["max_time_ratio"]
    efficiency = min(100.0, max(0.0, 100.0 * (most - len(frames) / rate / needed) / (most - 1))) if complete else 0.0
    taken, hits, found, placed, accurate = accuracy(assessment["snapshots"]["each"], scenario, camera)
    exact = of and precision_score(of)
    passed = all([
        complete, not traffic, frames[-1]["battery"] >= limits["min_battery_pct"], len(merged) <= limits["max_contacts"],
        all(v <= limits["max_contact_speed_m_s"] for _, v in merged), conformity is not None and conformity >= limits["min_conformity"],
        exact is not None and exact >= limits["min_precision"], safety >= limits["min_safety"],
        accurate is None or accurate >= limits["min_accuracy"], not any(assessment["practice_aids"].values()),
    ])
    scores = {"conformity": conformity, "precision": exact, "safety": safety, "accuracy": accurate, "efficiency": efficiency}
    scores["sum"] = sum(value for value in scores.values() if value is not None)
    return {
        "passed": passed, "scores": scores, "precision": of, "coverage": covered_shares, "onsets": onsets, "contacts": len(merged),
        "exposure_s": exposure, "needed_s": needed, "pictures": (taken, hits, found, placed),
    }
