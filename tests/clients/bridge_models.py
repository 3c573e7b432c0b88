"""Bridges that trimesh builds, and their import."""

import subprocess

import numpy
import trimesh

import spandrel

LENGTH_M = 30.0


def i_girder(depth_m=1.2, flange_m=0.4, plate_m=0.02):
    """Returns a welded girder as one mesh, along x."""
    half, top = flange_m / 2, depth_m / 2
    outline = [
        (-half, -top), (half, -top), (half, plate_m - top), (plate_m / 2, plate_m - top), (plate_m / 2, top - plate_m), (half, top - plate_m),
        (half, top), (-half, top), (-half, top - plate_m), (-plate_m / 2, top - plate_m), (-plate_m / 2, plate_m - top), (-half, plate_m - top),
    ]
    # Caps of the concave outline: two flanges and the web.
    faces = [(0, 1, 2), (0, 2, 3), (0, 3, 10), (0, 10, 11), (3, 4, 9), (3, 9, 10), (4, 5, 6), (4, 6, 7), (4, 7, 8), (4, 8, 9)]
    count = len(outline)
    vertices = [(LENGTH_M / 2, y, z) for y, z in outline] + [(-LENGTH_M / 2, y, z) for y, z in outline]
    triangles = list(faces) + [(count + a, count + c, count + b) for a, b, c in faces]
    for k in range(count):
        after = (k + 1) % count
        triangles += [(after, k, count + k), (after, count + k, count + after)]
    mesh = trimesh.Trimesh(vertices, triangles, process=False)
    assert mesh.is_watertight and mesh.volume > 0.0
    return mesh


def bridge_scene(tagged):
    """Returns a slab bridge on two girders and four columns, with z up, and the volume of each part."""
    scene, volumes = trimesh.Scene(), {}

    def add(name, mesh, place, element):
        volumes[name] = mesh.volume
        metadata = {"element": element} if tagged else None
        scene.add_geometry(mesh, node_name=name, geom_name=name, transform=trimesh.transformations.translation_matrix(place), metadata=metadata)

    add("deck", trimesh.creation.box((LENGTH_M, 8.0, 0.25)), (0, 0, 9.0), 12)
    for k, y in enumerate((-2.0, 2.0)):
        add(f"girder-{k + 1}", i_girder(), (0, y, 8.2), 107)
        for end, x in enumerate((-12.0, 12.0)):
            column = trimesh.creation.cylinder(radius=0.5, height=7.6, sections=24)
            add(f"column-{2 * k + end + 1}", column, (x, y, 3.8), 205)
    return scene, volumes


def write(scene, target):
    """Writes a scene with z up, as trimesh does: it does not turn the axes."""
    target.write_bytes(scene.export(file_type="glb"))
    return target


def spandrel_import(*args):
    return subprocess.run([spandrel.PROGRAM, "import", *map(str, args)], capture_output=True, text=True, timeout=300, check=False)


def convex_parts(model):
    """Returns the parts of an imported bridge by the names of their members. Asserts that each is closed and convex."""
    scene = trimesh.load(model, force="scene")
    found = {}
    for name in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[name]
        part = scene.geometry[geometry].copy().apply_transform(transform)
        part.merge_vertices()
        assert part.is_watertight and part.is_convex, name
        found.setdefault(name.split("/")[0], []).append(part)
    return found


def import_with_suggested_elements(model, out, parts):
    """Imports a model without elements: first without success, then with the elements file that this prints."""
    refused = spandrel_import(model, "--out", out, "--up", "z")
    assert refused.returncode == 2 and f"{parts} parts have no element: " in refused.stderr, refused.stderr
    assert not out.exists()
    elements = out.with_suffix(".toml")
    elements.write_text(refused.stdout, encoding="utf-8")
    done = spandrel_import(model, "--out", out, "--up", "z", "--elements", elements)
    assert done.returncode == 0, done.stderr
    return done


def rough_block():
    """A curved, rough block, as a scan of a rib, which cannot be cut exactly."""
    block = trimesh.creation.box((12.0, 1.5, 2.0)).subdivide_to_size(0.25)
    vertices = block.vertices.copy()
    vertices[:, 2] -= 0.02 * vertices[:, 0] ** 2
    block.vertices = vertices + 0.01 * numpy.sin(7.0 * vertices[:, [1, 2, 0]])
    return block
