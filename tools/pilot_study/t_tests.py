"""Paired t tests."""

import math
from statistics import fmean, stdev


def two_tailed_p(t, freedom):
    """Returns the two-tailed p value of Student's t, by Simpson's rule."""
    factor = math.exp(math.lgamma((freedom + 1) / 2) - math.lgamma(freedom / 2)) / math.sqrt(freedom * math.pi)
    steps = 2000
    width = abs(t) / steps
    weights = [1 if k in (0, steps) else 4 if k % 2 else 2 for k in range(steps + 1)]
    inside = sum(w * (1 + (k * width) ** 2 / freedom) ** (-(freedom + 1) / 2) for k, w in enumerate(weights))
    return max(0.0, 1 - 2 * factor * inside * width / 3)


def tail_p(t, freedom, tail):
    """Returns the p value of one tail ("upper" or "lower") or of both ("two")."""
    two = two_tailed_p(t, freedom)
    if tail == "two":
        return two
    return two / 2 if (t > 0) == (tail == "upper") else 1 - two / 2


def paired(changes):
    """Returns the mean, t and d_z of changes; t and d_z are None if all changes are equal."""
    mean, spread = fmean(changes), stdev(changes)
    if spread == 0.0:
        return mean, None, None
    return mean, mean / spread * math.sqrt(len(changes)), mean / spread


def without_one(changes):
    """Returns t and d_z without each of the people in turn."""
    return [paired(changes[:k] + changes[k + 1 :])[1:] for k in range(len(changes))]
