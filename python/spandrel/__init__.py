"""A simulated inspection drone in your process: step it, fly it over MAVLink, train agents with it, and score its flights."""

from ._spandrel import (
    AssessmentError,
    JobError,
    LateError,
    RefusedError,
    SpandrelError,
    State,
    __version__,
    scenarios,
    vehicles,
)
from .assessment import Assessment, assess
from .vehicle import Link, Vehicle

__all__ = [
    "Assessment",
    "AssessmentError",
    "JobError",
    "LateError",
    "Link",
    "RefusedError",
    "SpandrelError",
    "State",
    "Vehicle",
    "__version__",
    "assess",
    "scenarios",
    "vehicles",
]
