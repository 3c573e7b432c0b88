"""Assessment of a recorded flight."""

from __future__ import annotations

import csv
import io
import json
import math
import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ._spandrel import assess as _assess

if TYPE_CHECKING:
    import pandas


_COLUMN_TYPES: dict[str, Callable[[str], object]] = {
    **dict.fromkeys(("frame", "light", "snapshot", "missing", "on_path", "interpolated"), int),
    "contact": str,
}
"""Types of the frame columns that are not floats."""


def _parse_float(text: str) -> float:
    """Parses a cell as a float; NaN if the telemetry has no value."""
    return float(text) if text else math.nan


@dataclass(frozen=True)
class Assessment:
    """A scored flight. The table properties require pandas."""

    data: dict[str, Any]
    """The full assessment, as written by `spandrel assess --json`."""
    frames_csv: str
    """The scored frames, as written by `spandrel export --frames`."""

    @property
    def completion(self) -> dict[str, Any]:
        """How much of the job was done: whether it is `complete`, `tasks_done` of `tasks`, and the `path_share` from 0 to 1."""
        return dict(self.data["completion"])

    @property
    def overall(self) -> float | None:
        """Sum of the applicable scores; None if the flight is incomplete, because the scores then cover only a part of the job."""
        return float(self.data["scores"]["overall"]) if self.data["completion"]["complete"] else None

    @property
    def scores(self) -> pandas.DataFrame:
        """One row per applicable score (index `score`): `raw`, and `pct` from 0 to 100. `overall` is the sum of the `pct` values;
        its `pct` is NaN if the flight is incomplete, because the scores then cover only a part of the job."""
        import pandas

        scores = self.data["scores"]
        rows = {name: scores[name] for name in ("conformity", "efficiency", "safety", "accuracy") if scores[name]}
        rows["overall"] = {"raw": None, "pct": self.overall}
        return pandas.DataFrame.from_dict(rows, orient="index", dtype=float).rename_axis("score")

    @property
    def tasks(self) -> pandas.DataFrame:
        """One row per task (index `id`)."""
        import pandas

        return pandas.DataFrame(self.data["tasks"]).set_index("id")

    @property
    def certified(self) -> bool:
        """Whether the flight meets every requirement of the certification profile."""
        return bool(self.data["certification"]["passed"])

    @property
    def requirements(self) -> pandas.DataFrame:
        """One row per certification requirement (index `id`): `limit`, the value `reached`, whether it is `met`."""
        import pandas

        return pandas.DataFrame(self.data["certification"]["requirements"]).set_index("id")

    @property
    def snapshots(self) -> pandas.DataFrame:
        """One row per photo: `frame`, `t_s` since lift-off, `hit`, the defects first `found` in it, and all `views`."""
        import pandas

        return pandas.DataFrame(self.data["snapshots"]["each"], columns=["frame", "t_s", "hit", "found", "views"])

    @property
    def frames(self) -> pandas.DataFrame:
        """One row per scored frame (index `frame`): time, sticks, position, speed, battery, contact."""
        import pandas

        rows = list(csv.DictReader(io.StringIO(self.frames_csv)))
        # Parsed by Python instead of pandas, so that every number round-trips exactly.
        columns = {name: [_COLUMN_TYPES.get(name, _parse_float)(row[name]) for row in rows] for name in (rows[0] if rows else ())}
        return pandas.DataFrame(columns).set_index("frame")


def assess(
    tlog: str | os.PathLike[str], scenario: str | os.PathLike[str], vehicle: str | os.PathLike[str]
) -> Assessment:
    """Scores a telemetry log. `scenario` and `vehicle` must be the ones used in the flight, given by shipped name or file path.
    If the scenario has forms or difficulty levels, the flown one is found in the log; `pilot-study@B` accepts only form B.

    Raises AssessmentError if the log contains no session or belongs to a different scenario.
    """
    text, frames = _assess(os.fspath(tlog), os.fspath(scenario), os.fspath(vehicle))
    return Assessment(json.loads(text), frames)
