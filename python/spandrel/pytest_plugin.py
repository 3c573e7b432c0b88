"""pytest plugin: the `spandrel_vehicle` fixture and the `spandrel` marker, which configures it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from .vehicle import Vehicle


def pytest_configure(config: pytest.Config) -> None:
    """Registers the marker."""
    config.addinivalue_line(
        "markers", "spandrel(scenario, vehicle, seed, flavor, after_crash): arguments that spandrel_vehicle passes to spandrel.Vehicle"
    )


@pytest.fixture
def spandrel_vehicle(request: pytest.FixtureRequest) -> Iterator[Vehicle]:
    """Provides a new vehicle for each test, on free ports, with the `spandrel` marker's arguments. The default seed is
    7."""
    arguments = {"seed": 7}
    for marker in reversed(list(request.node.iter_markers("spandrel"))):
        arguments.update(marker.kwargs)
    with Vehicle(**arguments) as vehicle:  # type: ignore[arg-type]
        yield vehicle
