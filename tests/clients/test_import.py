"""Bridges that trimesh writes are imported, checked, exported again and flown by the synthetic trainee.

trimesh is an independent writer and reader of glTF files: it builds the bridges, and it measures the parts that come out. laspy is an
independent writer of point clouds."""

import json
import math
import pathlib
import subprocess

import laspy
import numpy
import pytest
import trimesh

import spandrel
from bridge_models import (
    LENGTH_M, bridge_scene, convex_parts, i_girder, import_with_suggested_elements, rough_block, spandrel_import, write,
)

# Relative tolerance for volumes: positions are 32-bit floats, and the thinnest plate is 2 cm.
VOLUME_TOLERANCE = 1e-3
# The least that an expert synthetic trainee reaches on the straight lines beside and below the bridge, as a share of the frames.
MIN_ON_PATH = 0.9
# The largest volume of the hulls that replace a scan, as a multiple of its volume (estimate).
MAX_HULL_VOLUME = 1.3
# Points of a scanned bridge, and the size of its voxels in m: about four points in each voxel.
SCAN_POINTS, VOXEL_M = 60_000, 0.25


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
    found = convex_parts(folder / "bridge.glb")
    assert found.keys() == volumes.keys()
    for name, volume in volumes.items():
        assert math.isclose(sum(part.volume for part in found[name]), volume, rel_tol=VOLUME_TOLERANCE), name
    # Girders are cut into two flanges and a web; everything else is convex.
    rows = {line.split()[0]: line.split() for line in table.splitlines()[1:8]}
    assert {name: int(row[7]) for name, row in rows.items()} == {name: 3 if "girder" in name else 1 for name in volumes}
    assert {row[8] for name, row in rows.items() if "girder" in name} == {"cut"}
    low, high = trimesh.load(folder / "bridge.glb", force="scene").bounds
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


def gltf_json(file):
    """Returns the description in a binary glTF file."""
    content = file.read_bytes()
    return content[20 : 20 + int.from_bytes(content[12:16], "little")]


def test_val_boxes_divide_a_scan_into_parts_with_its_whole_surface(tmp_path):
    """One block of 12 m, whose ends are piers and whose middle is a deck; the rest of it is what the default says."""
    block = rough_block()
    elements = tmp_path / "elements.toml"
    row = '[[elements]]\nelement = {}\nbox_m = [[{}, -2, -9], [{}, 2, 9]]\nname = "{}"\n'
    rows = [(205, -7, -4, "left"), (12, -5, 3, "deck"), (210, 20, 30, "away")]
    elements.write_text("format = 1\n" + "".join(row.format(*values) for values in rows), encoding="utf-8")
    whole, _ = import_scan(tmp_path / "whole", block)
    first, parts = import_scan(tmp_path / "parts", block, "--elements", elements)
    assert first[:2] == ["left", "205"] and first[8] == "mesh", first
    assert len(parts) == 3 and math.isclose(sum(part.area for part in parts), block.area, rel_tol=VOLUME_TOLERANCE)
    scene = trimesh.load(tmp_path / "parts" / "scan" / "bridge.glb", force="scene")
    document = json.loads(gltf_json(tmp_path / "parts" / "scan" / "bridge.glb"))
    tags = {node["name"]: node["extras"]["element"] for node in document["nodes"] if "mesh" in node}
    assert tags == {"left": 205, "deck": 12, "mesh": 144}
    # Triangles are at most 0.25 m long, and one of them can reach over the border on each side.
    ends = {name: scene.geometry[scene.graph[name][1]].bounds[:, 0] for name in tags}
    assert abs(ends["left"][1] + 4.0) < 0.3 and abs(ends["deck"][0] + 4.0) < 0.3 and abs(ends["deck"][1] - 3.0) < 0.3, ends
    checked = spandrel.run("check", str(tmp_path / "parts" / "scan" / "scenario.toml"))
    assert "1 file valid" in checked and whole[7] == "1", checked
    # A job whose elements file has boxes would leave them without effect.
    job = tmp_path / "parts" / "scan" / "elements.toml"
    job.write_text(elements.read_text(encoding="utf-8"), encoding="utf-8")
    command = [spandrel.PROGRAM, "check", str(tmp_path / "parts" / "scan" / "scenario.toml")]
    refused = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    problems = refused.stdout + refused.stderr
    assert refused.returncode == 2 and "elements[].box_m" in problems and "spandrel import --elements" in problems, problems


def test_val_empty_boxes_are_noted(tmp_path):
    elements = tmp_path / "elements.toml"
    elements.write_text("format = 1\n[[elements]]\nelement = 12\nbox_m = [[20, -2, -9], [30, 2, 9]]\n", encoding="utf-8")
    (tmp_path / "scan.ply").write_bytes(rough_block().export(file_type="ply"))
    options = ("--up", "z", "--element", 144, "--elements", elements)
    done = spandrel_import(tmp_path / "scan.ply", "--out", tmp_path / "out", *options)
    assert done.returncode == 0, done.stderr
    assert "note: elements file, row 1: no triangle has its middle in box_m = [[20.0, -2.0, -9.0], [30.0, 2.0, 9.0]]" in done.stdout


def test_val_a_point_cloud_becomes_a_solid_that_contains_its_points(tmp_path, measured):
    """A scan of a slab bridge in coordinates of a map, with 100 points far away from it and 100 on the ground."""
    scene, _ = bridge_scene(tagged=False)
    surface = scene.to_geometry()
    points, _ = trimesh.sample.sample_surface(surface, SCAN_POINTS, seed=1)
    stray = numpy.random.default_rng(1).uniform((-40, -40, 20), (40, 40, 60), (100, 3))
    ground = numpy.array([(x, 0.0, -1.0) for x in numpy.linspace(-20, 20, 100)])
    everything = numpy.concatenate([points, stray, ground]) + (504_000.0, 4_475_000.0, 180.0)
    header = laspy.LasHeader(point_format=2, version="1.2")
    header.offsets, header.scales = (504_000.0, 4_475_000.0, 180.0), (0.001, 0.001, 0.001)
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = everything.T
    cloud.red = numpy.full(len(everything), 65535)
    cloud.green = cloud.blue = numpy.zeros(len(everything))
    cloud.classification = [1] * (SCAN_POINTS + 100) + [2] * 100
    imports = {}
    for name in ("scan.las", "scan.laz"):
        cloud.write(str(tmp_path / name))
        out = tmp_path / name.replace(".", "-")
        done = spandrel_import(tmp_path / name, "--out", out, "--element", 12, "--voxel-size", VOXEL_M, "--name", "scan")
        assert done.returncode == 0, done.stderr
        imports[name] = (out / "bridge.glb").read_bytes()
    assert imports["scan.las"] == imports["scan.laz"]
    assert f"{SCAN_POINTS} of {SCAN_POINTS + 200} points" in done.stdout and "100 outliers and 100 ground" in done.stdout, done.stdout
    loaded = trimesh.load(out / "bridge.glb", force="scene")
    [part] = loaded.geometry.values()
    assert (part.visual.vertex_attributes["color"][:, :3] == (255, 0, 0)).all()
    part.merge_vertices()
    assert part.is_watertight and part.is_winding_consistent
    voxels = part.volume / VOXEL_M**3
    measured(f"cloud of {SCAN_POINTS} points: {len(part.faces)} triangles around {voxels:.0f} voxels")
    assert math.isclose(voxels, round(voxels), abs_tol=0.01 * voxels / 100), voxels
    # The corners of the voxels are near the surface that was scanned, and the extent is that of the scan.
    size = numpy.ptp(points, axis=0)[[0, 2, 1]]
    assert ((part.extents - size > -1e-3) & (part.extents - size < 2 * VOXEL_M)).all(), (part.extents, size)
    checked = spandrel.run("check", str(out / "scenario.toml"))
    assert "1 file valid" in checked, checked
    coarse = spandrel_import(tmp_path / "scan.laz", "--out", tmp_path / "none", "--element", 12, "--voxel-size", 2)
    assert coarse.returncode == 2 and "allowed: 0.02 to 1" in coarse.stderr, coarse.stderr
