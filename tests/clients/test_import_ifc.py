"""A bridge that ifcopenshell writes as IFC is imported, checked and flown. ifcopenshell, an independent library, also measures its parts."""

import json
import math

import numpy
import pytest

import ifc_models
import spandrel
from bridge_models import convex_parts, spandrel_import

# Relative tolerance for volumes: Spandrel's circles have 36 corners, and ifcopenshell's many. The rest is plane.
CIRCLE_TOLERANCE, VOLUME_TOLERANCE = 6e-3, 1e-4
# Tolerance for extents, m: the sides of the 36 corners on a circle of 0.5 m lie up to 1.9 mm inside it; the rest is plane.
CIRCLE_M, EXTENT_M = 2e-3, 1e-4
# The least that an expert synthetic trainee reaches on the straight lines beside and below the bridge, as a share of the frames.
MIN_ON_PATH = 0.9


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    """The folder of an imported bridge, its table, and ifcopenshell's measures of its parts."""
    folder = tmp_path_factory.mktemp("ifc")
    model = folder / "Slab Bridge.ifc"
    measures = ifc_models.measures(ifc_models.write_bridge(model))
    done = spandrel_import(model, "--out", folder / "bridge", "--turn", -ifc_models.TURN_DEG)
    assert done.returncode == 0, done.stderr
    return folder / "bridge", done.stdout, measures


def test_val_parts_have_the_volumes_and_extents_that_ifcopenshell_measures(imported):
    folder, table, measures = imported
    found = convex_parts(folder / "bridge.glb")
    assert found.keys() == measures.keys()
    # The origin is on the deck, and glTF's y axis points up.
    top = measures["deck"][2][2]
    for name, (volume, low, high) in measures.items():
        is_round = name.startswith("column")
        own = sum(part.volume for part in found[name])
        assert math.isclose(own, volume, rel_tol=CIRCLE_TOLERANCE if is_round else VOLUME_TOLERANCE), (name, own, volume)
        corners = numpy.concatenate([part.vertices for part in found[name]])[:, [0, 2, 1]] * (1, -1, 1) + (0, 0, top)
        tolerance = CIRCLE_M if is_round else EXTENT_M
        assert numpy.allclose(corners.min(axis=0), low, atol=tolerance), (name, corners.min(axis=0), low)
        assert numpy.allclose(corners.max(axis=0), high, atol=tolerance), (name, corners.max(axis=0), high)
    east, north, up = ifc_models.MAP_M
    assert f"--origin {east:.3f},{north:.3f},{up + top:.3f}" in table, table
    assert "note: no part of a bridge: 1 IfcReinforcingBar\n" in table, table


def test_val_elements_are_those_of_properties_classes_and_materials(imported):
    folder, table, measures = imported
    rows = {line.split()[0]: int(line.split()[1]) for line in table.splitlines()[1 : 1 + len(measures)]}
    assert rows == {name: ifc_models.ELEMENTS[name.split("-")[0]] for name in measures}
    checked = spandrel.run("check", str(folder / "scenario.toml"))
    assert "1 file valid" in checked, checked
    for element, amount in [("element 12, deck", "240.0 m2"), ("element 107, girder", "60.0 m"), ("element 310, elastomeric", "4 each")]:
        assert any(element in line and amount in line for line in checked.splitlines()), checked


def test_flight_synthetic_trainee_flies_the_imported_job(imported, tmp_path, measured):
    folder, _, _ = imported
    sessions = tmp_path / "sessions"
    scenario = str(folder / "scenario.toml")
    spandrel.run("demo", "--scenario", scenario, "--seed", "3", "--skill", "expert", "--speed", "max", "--sessions", str(sessions))
    (session,) = [path for path in sessions.iterdir() if path.is_dir()]
    assessment = json.loads((session / "assessment.json").read_text(encoding="utf-8"))
    shares = [task["on_path"] for task in assessment["tasks"]]
    measured(f"on path at a bridge imported from IFC: {shares}")
    assert assessment["end"]["reason"] == "landed" and assessment["crashes"]["other"] == 0, assessment["end"]
    assert all(task["attempted"] for task in assessment["tasks"]) and min(shares) >= MIN_ON_PATH, assessment["tasks"]


def test_val_a_product_that_cannot_be_read_is_named(tmp_path):
    model = tmp_path / "bridge.ifc"
    ifc_models.write_bridge(model)
    text = model.read_text(encoding="utf-8")
    assert text.count("IFCISHAPEPROFILEDEF") == 1
    model.write_text(text.replace("IFCISHAPEPROFILEDEF", "IFCNOPROFILEDEF"), encoding="utf-8")
    done = spandrel_import(model, "--out", tmp_path / "bridge")
    assert done.returncode == 0, done.stderr
    notes = [line for line in done.stdout.splitlines() if "IfcBeam girder-" in line]
    assert len(notes) == 2 and all("left out: " in note for note in notes), done.stdout
    model.write_text(text[: len(text) // 2], encoding="utf-8")
    refused = spandrel_import(model, "--out", tmp_path / "other")
    assert refused.returncode == 2 and "bridge.ifc: truncated: " in refused.stderr, refused.stderr
