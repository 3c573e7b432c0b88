"""Scores of a recorded flight."""

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


_KINDS: dict[str, Callable[[str], object]] = {
    **dict.fromkeys(("frame", "light", "snapshot", "missing", "on_path", "interpolated"), int),
    "contact": str,
}
"""Columns of the frames that are no floats."""


def _number(text: str) -> float:
    """A cell as a float; NaN where the telemetry held no value."""
    return float(text) if text else math.nan


@dataclass(frozen=True)
class Assessment:
    """A scored flight. The tables need pandas."""

    data: dict[str, Any]
    """Everything, as `spandrel assess --json` writes it."""
    frames_csv: str
    """The scored frames, as `spandrel export --frames` writes them."""

    @property
    def scores(self) -> pandas.DataFrame:
        """One row for each score that applies (index `score`): `raw`, and `pct` from 0 to 100. `overall` is the sum of the pct."""
        import pandas

        scores = self.data["scores"]
        rows = {name: scores[name] for name in ("conformity", "efficiency", "safety", "accuracy") if scores[name]}
        rows["overall"] = {"raw": None, "pct": scores["overall"]}
        return pandas.DataFrame.from_dict(rows, orient="index", dtype=float).rename_axis("score")

    @property
    def tasks(self) -> pandas.DataFrame:
        """One row for each task (index `id`)."""
        import pandas

        return pandas.DataFrame(self.data["tasks"]).set_index("id")

    @property
    def snapshots(self) -> pandas.DataFrame:
        """One row for each picture: `frame`, `t_s` since lift-off, `hit`, the defects `found` first in it, and all `views`."""
        import pandas

        return pandas.DataFrame(self.data["snapshots"]["each"], columns=["frame", "t_s", "hit", "found", "views"])

    @property
    def frames(self) -> pandas.DataFrame:
        """One row for each scored frame (index `frame`): time, sticks, position, speed, battery, contact."""
        import pandas

        rows = list(csv.DictReader(io.StringIO(self.frames_csv)))
        # Read by Python, so that every number is the one that was written, to the last bit.
        columns = {name: [_KINDS.get(name, _number)(row[name]) for row in rows] for name in (rows[0] if rows else ())}
        return pandas.DataFrame(columns).set_index("frame")


def assess(
    tlog: str | os.PathLike[str], scenario: str | os.PathLike[str], vehicle: str | os.PathLike[str]
) -> Assessment:
    """Scores a telemetry log against the scenario and the vehicle that it was flown with: names of shipped ones, or files.

    Raises AssessmentError when there is nothing to score, or when the log is of another scenario.
    """
    text, frames = _assess(os.fspath(tlog), os.fspath(scenario), os.fspath(vehicle))
    return Assessment(json.loads(text), frames)
