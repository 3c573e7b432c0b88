"""Results of the TASBID paper's pilot study: Li, Karim and Qin, "A Virtual Reality-based Training and Assessment System for Bridge Inspectors with an
Assistant Drone" (arXiv:2109.02705). The paper's charts print no numbers; all values are from its text and its table of t tests.
"""

PEOPLE = 22
REPEATING = 8
SCORES = ["conformity", "efficiency", "safety", "accuracy"]
PLACES = ["slab side", "arch bottom", "interlayer", "pier", "outside"]

# First sessions: means of the scores.
MEANS = {"conformity": 78.32, "efficiency": 91.68, "safety": 68.86, "accuracy": 77.73, "overall": 316.59}
OVERALL_ENDS = (220, 370)
EFFICIENCY_RANGE = 38
SAFETY_RANGE = 97
# Participant 10.
SHORTEST_MIN = 13.75
# Efficiency falls by 5 points per minute above 15 minutes, and the shortest flight has 100 points, so a range of 38 points is 7.6 minutes. The 24
# minutes that the paper also mentions therefore belong to a later session: participant 18 skipped a task in the second one because time ran out.
LONGEST_MIN = 15 + EFFICIENCY_RANGE / 5

# First sessions: crashes.
CRASHES = 203
CRASHES_BY_PLACE = {"arch bottom": 63, "pier": 15}
# Participants 3 and 7.
FEWEST_CRASHES, PEOPLE_WITH_FEWEST = 1, 2
# Participant 8, whose safety score was 28.
MOST_CRASHES, SAFETY_OF_MOST = 24, 28
# Participants 4, 17 and 19: the same number of crashes, at different places.
EQUAL_CRASHES, PEOPLE_WITH_EQUAL = 13, 3
# Follows from the mean of the safety score: 203 crashes alone would leave 72.3 points.
TRAFFIC_CRASHES = 1

# Share of the task's time that participant 2 stayed on the path of the interlayer.
LOW_INTERLAYER_SHARE = 0.30
# Participant 13; the paper doesn't give the session.
HIGH_CONFORMITY = 97

# Participants who agreed or strongly agreed after the first session.
AGREED = {
    "time_pressure": 15, "frustration": 10, "feedback": 20, "task_2.physical_demand": 13, "task_3.mental_demand": 9, "task_3.performance": 11,
}  # fmt: skip

# Paired t tests of the later minus the earlier session: t, p, and the tail of p.
TESTS = {
    ("conformity", 1, 2): (2.609, 0.018, "upper"), ("conformity", 1, 3): (2.969, 0.010, "upper"), ("conformity", 2, 3): (1.090, 0.312, "two"),
    ("efficiency", 1, 2): (-0.175, 0.866, "two"), ("efficiency", 1, 3): (-0.938, 0.380, "two"), ("efficiency", 2, 3): (-0.661, 0.530, "two"),
    ("safety", 1, 2): (3.340, 0.006, "upper"), ("safety", 1, 3): (3.498, 0.005, "upper"), ("safety", 2, 3): (0.475, 0.649, "two"),
    ("accuracy", 1, 2): (1.930, 0.048, "upper"), ("accuracy", 1, 3): (-0.662, 0.529, "two"), ("accuracy", 2, 3): (-7.638, 0.000, "lower"),
}  # fmt: skip
T = {pair: t for pair, (t, _, _) in TESTS.items()}
# Level of the chi-squared tests of homogeneity, none of which was significant.
HOMOGENEITY_LEVEL = 0.05

# The three sessions of participant 18; None if the paper gives no number.
PERSON = 18
PERSON_SCORES = {"accuracy": (40, 70, 60), "conformity": (72, None, 80)}
PERSON_MINUTES = "22.5 to 24"
PERSON_BRIDGE_CRASHES = (12, 0, 0)
