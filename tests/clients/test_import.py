"""Bridges that trimesh writes are imported, checked, exported again and flown by the synthetic trainee.

trimesh is an independent writer and reader of glTF files: it builds the bridges, and it measures the parts that come out."""

import json
import math
import pathlib

import numpy
import pytest
import trimesh

import spandrel
from bridge_models import LENGTH_M, bridge_scene, i_girder, import_with_suggested_elements, rough_block, spandrel_import, write

# Relative tolerance for volumes: positions are 32-bit floats, and the thinnest plate is 2 cm.
VOLUME_TOLERANCE = 1e-3
# The least that an expert synthetic trainee reaches on the straight lines beside and below the bridge, as a share of the frames.
MIN_ON_PATH = 0.9
# The largest volume of the hulls that replace a scan, as a multiple of its volume (estimate).
MAX_HULL_VOLUME = 1.3


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    """The folder of an imported bridge, and the volumes of the parts of the model."""
    folder = tmp_path_factory.mktemp("import")
    scene, volumes = bridge_scene(tagged=False)
    model = write(scene, folder / "Slab Bridge.glb")
    done = import_with_suggested_elements(model, folder / "bridge", len(volumes))
    return folder / "bridge", volumes, done.stdout


def test_val_convex_parts_fill_the_volume_that_trimesh_measures(imported):
    folder, volumes, table = imported
    scene = trimesh.load(folder / "bridge.glb", force="scene")
    found = {}
    for name in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[name]
        part = scene.geometry[geometry].copy().apply_transform(transform)
        part.merge_vertices()
        assert part.is_watertight and part.is_convex, name
        owner = name.split("/")[0]
        found[owner] = found.get(owner, 0.0) + part.volume
    assert found.keys() == volumes.keys()
    for name, volume in volumes.items():
        assert math.isclose(found[name], volume, rel_tol=VOLUME_TOLERANCE), name
    # Girders are cut into two flanges and a web; everything else is convex.
    rows = {line.split()[0]: line.split() for line in table.splitlines()[1:8]}
    assert {name: int(row[7]) for name, row in rows.items()} == {name: 3 if "girder" in name else 1 for name in volumes}
    assert {row[8] for name, row in rows.items() if "girder" in name} == {"cut"}
    low, high = scene.bounds
    assert numpy.allclose(high - low, (LENGTH_M, 9.125, 8.0), atol=1e-4), "glTF axes: y up"
    assert numpy.allclose((low + high)[0], 0.0, atol=1e-4) and math.isclose(high[1], 0.0, abs_tol=1e-4), "origin on the deck"


def test_val_imported_job_passes_the_check_and_is_briefed(imported):
    folder, _, _ = imported
    checked = spandrel.run("check", str(folder / "scenario.toml"))
    assert "1 file valid" in checked, checked
    for element, amount in [("element 12, deck", "240.0 m2"), ("element 107, girder", "60.0 m"), ("element 205, column", "4 each")]:
        assert any(element in line and amount in line for line in checked.splitlines()), checked
    briefing = spandrel.run("brief", "--scenario", str(folder / "scenario.toml"))
    assert "Right side of the deck" in briefing and "Underside of the deck" in briefing, briefing
    exported = folder.parent / "site.glb"
    spandrel.run("export", str(folder / "scenario.toml"), "--glb", str(exported))
    names = trimesh.load(exported, force="scene").graph.nodes_geometry
    assert {"slab-bridge/deck", "slab-bridge/girder-1/01", "ground"} <= set(names)


def test_flight_synthetic_trainee_flies_the_imported_job(imported, tmp_path, measured):
    folder, _, _ = imported
    sessions = tmp_path / "sessions"
    scenario = str(folder / "scenario.toml")
    spandrel.run("demo", "--scenario", scenario, "--seed", "3", "--skill", "expert", "--speed", "max", "--sessions", str(sessions))
    (session,) = [path for path in sessions.iterdir() if path.is_dir()]
    # The session contains all files, so that it can be scored without the original ones.
    assert {"bridge.glb", "elements.toml", "scenario.toml"} <= {path.name for path in session.iterdir()}
    assessment = json.loads((session / "assessment.json").read_text(encoding="utf-8"))
    again = tmp_path / "again.json"
    spandrel.run("assess", str(session), "--json", str(again))
    assert json.loads(again.read_text(encoding="utf-8"))["scores"] == assessment["scores"]
    shares = [task["on_path"] for task in assessment["tasks"]]
    measured(f"on path at an imported bridge: {shares}")
    assert assessment["end"]["reason"] == "landed" and assessment["crashes"]["other"] == 0, assessment["end"]
    assert all(task["attempted"] for task in assessment["tasks"]) and min(shares) >= MIN_ON_PATH, assessment["tasks"]


def test_val_tags_of_trimesh_are_read(tmp_path):
    scene, volumes = bridge_scene(tagged=True)
    document, model = trimesh.exchange.gltf.export_gltf(scene), tmp_path / "tagged"
    model.mkdir()
    for name, content in document.items():
        (model / name).write_bytes(content)
    text = json.loads((model / "model.gltf").read_text(encoding="utf-8"))
    tags = {"deck": 12, "girder": 107, "column": 205}
    for node in text["nodes"]:
        if "mesh" in node:
            node["extras"] = {"element": tags[node["name"].split("-")[0]]}
    (model / "model.gltf").write_text(json.dumps(text), encoding="utf-8")
    done = spandrel_import(model / "model.gltf", "--out", tmp_path / "bridge", "--up", "z")
    assert done.returncode == 0, done.stderr
    rows = {line.split()[0]: int(line.split()[1]) for line in done.stdout.splitlines()[1 : 1 + len(volumes)]}
    assert rows == {name: tags[name.split("-")[0]] for name in volumes}
    refused = spandrel_import(model / "model.gltf", "--out", tmp_path / "bridge", "--up", "z")
    assert refused.returncode == 2 and "already exists" in refused.stderr, refused.stderr
    pathlib.Path(model / next(name for name in document if name.endswith(".bin"))).unlink()
    missing = spandrel_import(model / "model.gltf", "--out", tmp_path / "other", "--up", "z")
    assert missing.returncode == 2 and ".bin" in missing.stderr, missing.stderr


def test_val_obj_and_ply_files_of_trimesh_are_imported(tmp_path):
    scene, volumes = bridge_scene(tagged=False)
    model = tmp_path / "bridge.obj"
    model.write_text(scene.export(file_type="obj"), encoding="utf-8")
    done = spandrel_import(model, "--out", tmp_path / "obj", "--up", "z", "--element", 107)
    assert done.returncode == 0, done.stderr
    assert {line.split()[0] for line in done.stdout.splitlines()[1 : 1 + len(volumes)]} == set(volumes)
    for name, encoding in (("binary", "binary"), ("text", "ascii")):
        scan = tmp_path / f"{name}.ply"
        scan.write_bytes(i_girder().export(file_type="ply", encoding=encoding))
        done = spandrel_import(scan, "--out", tmp_path / name, "--up", "z", "--element", 107)
        assert done.returncode == 0, done.stderr
        assert "1 parts with 44 triangles became 3 shapes" in done.stdout, done.stdout


def import_scan(folder, mesh, *options):
    """Imports a mesh as a PLY file; returns the row of the table and the parts."""
    folder.mkdir()
    (folder / "scan.ply").write_bytes(mesh.export(file_type="ply"))
    done = spandrel_import(folder / "scan.ply", "--out", folder / "scan", "--up", "z", "--element", 144, *options)
    assert done.returncode == 0, done.stderr
    parts = trimesh.load(folder / "scan" / "bridge.glb", force="scene")
    return done.stdout.splitlines()[1].split(), [parts.geometry[parts.graph[name][1]] for name in parts.graph.nodes_geometry]


def test_val_a_rough_surface_keeps_its_triangles_or_becomes_hulls_near_it(tmp_path, measured):
    block = rough_block()
    row, [part] = import_scan(tmp_path / "mesh", block)
    assert row[7:10] == ["1", "mesh", "0.0"], row
    part.merge_vertices()
    assert part.is_watertight and len(part.faces) == len(block.faces)
    assert math.isclose(part.volume, block.volume, rel_tol=VOLUME_TOLERANCE)
    row, parts = import_scan(tmp_path / "hulls", block, "--voxels", 128)
    assert row[8] == "voxels" and int(row[7]) > 1, row
    volume = sum(part.volume for part in parts)
    measured(f"scan of {block.volume:.1f} m3: {row[7]} convex parts with {volume:.1f} m3, deviation {row[9]} mm")
    # The hulls of the groups overlap at their borders, and fill hollows.
    assert 0.95 < volume / block.volume < MAX_HULL_VOLUME, volume / block.volume


def test_val_an_open_scan_keeps_its_opening_and_passes_the_check(tmp_path):
    """A curved vault, open below and at both ends: no hull may close it."""
    vault = trimesh.creation.annulus(r_min=5.0, r_max=6.0, height=20.0, sections=600)
    vault.apply_transform(trimesh.transformations.rotation_matrix(math.pi / 2, (0, 1, 0)))
    vault = trimesh.intersections.slice_mesh_plane(vault, (0, 0, 1), (0, 0, 0))
    row, [part] = import_scan(tmp_path / "vault", vault)
    assert row[8] == "mesh" and int(row[5]) > 0, row
    # Without its feet, the vault is open; a point in the opening is outside of every triangle's hull.
    part.merge_vertices()
    assert not part.is_watertight and math.isclose(part.area, vault.area, rel_tol=VOLUME_TOLERANCE)
    checked = spandrel.run("check", str(tmp_path / "vault" / "scan" / "scenario.toml"))
    assert "1 file valid" in checked, checked


def test_val_a_scan_keeps_the_colors_of_its_vertices(tmp_path):
    """PLY files have colors for screens, which become shares of the light; glTF files have shares of the light."""
    block = rough_block()
    gray, red = (188, 188, 188, 255), (255, 0, 0, 255)
    block.visual.vertex_colors = [gray if x < 0.0 else red for x in block.vertices[:, 0]]
    _, [part] = import_scan(tmp_path / "ply", block)
    left = part.vertices[:, 0] < 0.0
    assert left.any() and not left.all()
    colors = part.visual.vertex_attributes["color"][:, :3]
    assert (colors[left] == 128).all() and (colors[~left] == (255, 0, 0)).all()
    assert (part.visual.material.baseColorFactor == 255).all(), "viewers multiply the two"
    model = tmp_path / "scan.glb"
    model.write_bytes(trimesh.Scene(block).export(file_type="glb"))
    done = spandrel_import(model, "--out", tmp_path / "glb", "--up", "z", "--element", 144)
    assert done.returncode == 0, done.stderr
    [part] = trimesh.load(tmp_path / "glb" / "bridge.glb", force="scene").geometry.values()
    assert (part.visual.vertex_attributes["color"][part.vertices[:, 0] < 0.0][:, :3] == 188).all()
