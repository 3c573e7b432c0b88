"""Elevation models and photographs that GDAL writes become the ground of a job.

rasterio (GDAL) writes the files, pyproj (PROJ) says where they are, and trimesh reads the ground that Spandrel exports."""

import pathlib
import subprocess
import sys

import numpy
import pyproj
import pytest
import rasterio
import trimesh
from rasterio.transform import from_origin

import spandrel

ROOT = pathlib.Path(__file__).resolve().parents[2]
SITE = ROOT / "examples/site"
# The origin of the job.
LATITUDE_DEG, LONGITUDE_DEG, ALTITUDE_M = 40.4259, -86.9081, 155.0
# Tolerance for heights, m: rounding to 1 mm, 32-bit floats at 500 m, and the curvature of the earth between linear steps.
HEIGHT_TOLERANCE_M = 0.005
# The largest distance from the origin at which a plane replaces the ellipsoid, m, and the earth's radius: heights then differ by 5 mm.
NEAR_M, EARTH_M = 250.0, 6_371_000.0
# Range of heights around the bridge, the pad and the roads that earthworks may change, m.
EARTHWORKS_M = 60.0
SIZE_M = 700.0


def spandrel_program(*arguments, **more):
    """Runs the program and returns what it wrote."""
    return subprocess.run([spandrel.PROGRAM, *arguments], capture_output=True, text=True, check=False, timeout=120, **more)


def job(folder, terrain):
    """Writes the example's job with another terrain."""
    text = (SITE / "scenario.toml").read_text(encoding="utf-8")
    start, end = text.index("[terrain]"), text.index("[ground_team]")
    path = folder / "scenario.toml"
    path.write_text(f"{text[:start]}[terrain]\nsize_m = {SIZE_M}\nspacing_m = 10.0\n{terrain}\n\n{text[end:]}", encoding="utf-8")
    return path


def ground(folder, terrain):
    """Returns the vertices of the exported ground: east, north and up in meters."""
    path = folder / "site.glb"
    done = spandrel_program("export", "--glb", str(path), str(job(folder, terrain)))
    assert done.returncode == 0, done.stderr
    scene = trimesh.load(path)
    name = next(node for node in scene.graph.nodes_geometry if node == "ground")
    transform, geometry = scene.graph[name]
    vertices = trimesh.transform_points(scene.geometry[geometry].vertices, transform)
    # glTF has y up and z to the south.
    return vertices[:, [0, 2, 1]] * [1.0, -1.0, 1.0]


def surface(east, north):
    """Height of the ground at map coordinates relative to the origin, in map units: a tilted plane, on which interpolation is exact."""
    return ALTITUDE_M + 12.0 + 0.02 * east - 0.013 * north


@pytest.mark.parametrize(
    ("system", "step", "unit_m", "form"),
    [
        ("EPSG:32616", 10.0, 1.0, {"dtype": "float32", "compress": "deflate", "predictor": 3, "tiled": True, "blockxsize": 64, "blockysize": 64}),
        ("EPSG:32616", 10.0, 1.0, {"dtype": "float64", "compress": "lzw"}),
        # U.S. survey feet: Indiana West.
        ("EPSG:2966", 30.0, 1200 / 3937, {"dtype": "float32"}),
        ("EPSG:4326", 1e-4, None, {"dtype": "float32", "compress": "deflate"}),
    ],
    ids=["utm-tiles", "utm-doubles", "state-plane-feet", "degrees"],
)
def test_val_heights_are_those_of_gdal_and_proj(tmp_path, system, step, unit_m, form):
    """Checks the exported ground against the heights at the positions that PROJ computes."""
    to_map = pyproj.Transformer.from_crs("EPSG:4326", system, always_xy=True)
    middle = to_map.transform(LONGITUDE_DEG, LATITUDE_DEG)
    pixels = 120
    corner = (middle[0] - pixels * step / 2, middle[1] + pixels * step / 2)
    at = (numpy.arange(pixels) + 0.5) * step
    east, south = numpy.meshgrid(corner[0] + at - middle[0], at)
    # In degrees, the plane is tilted per meter of latitude.
    scale = 111_000.0 if unit_m is None else unit_m
    heights = surface(scale * east, scale * (corner[1] - south - middle[1]))
    with rasterio.open(
        tmp_path / "dem.tif", "w", driver="GTiff", crs=system, transform=from_origin(*corner, step, step), height=pixels, width=pixels, count=1, **form
    ) as file:
        file.write(heights.astype(form["dtype"]), 1)
    vertices = ground(tmp_path, 'source = "geotiff"\nfile = "dem.tif"\nwater_level_m = -100.0')
    near = vertices[numpy.hypot(vertices[:, 0], vertices[:, 1]) < NEAR_M]
    # Away from the bridge with its roads, which run east and west, and from the pad.
    free = near[numpy.abs(near[:, 1]) > EARTHWORKS_M]
    free = free[numpy.hypot(free[:, 0] + 84.0, free[:, 1] + 46.0) > EARTHWORKS_M]
    assert len(free) > 500
    local = pyproj.Transformer.from_pipeline(
        f"+proj=pipeline +step +inv +proj=topocentric +ellps=WGS84 +lon_0={LONGITUDE_DEG} +lat_0={LATITUDE_DEG} +h_0={ALTITUDE_M} "
        "+step +inv +proj=cart +ellps=WGS84 +step +proj=unitconvert +xy_in=rad +xy_out=deg"
    )
    longitude, latitude, _ = local.transform(free[:, 0], free[:, 1], numpy.zeros(len(free)))
    x, y = to_map.transform(longitude, latitude)
    expected = surface(scale * (x - middle[0]), scale * (y - middle[1])) - ALTITUDE_M
    drop = (free[:, 0] ** 2 + free[:, 1] ** 2) / (2 * EARTH_M)
    assert numpy.abs(free[:, 2] + drop - expected).max() < HEIGHT_TOLERANCE_M


def test_val_example_is_what_its_program_writes_and_is_flown(tmp_path):
    """Checks the committed files, and that an expert flies the whole job on this ground."""
    done = subprocess.run([sys.executable, str(SITE / "make.py"), str(tmp_path)], capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    for name, tolerance in (("elevation.tif", 1e-3), ("photo.tif", 4)):
        with rasterio.open(SITE / name) as committed, rasterio.open(tmp_path / name) as made:
            assert committed.crs == made.crs and committed.transform == made.transform
            assert numpy.abs(committed.read().astype(float) - made.read().astype(float)).mean() < tolerance
    checked = spandrel_program("check", str(SITE / "scenario.toml"))
    assert checked.returncode == 0, checked.stdout + checked.stderr
    flown = spandrel_program(
        "study", "--scenario", str(SITE / "scenario.toml"), "--skill", "expert", "--seeds", "3-3", "--flight", "1", "--out", str(tmp_path)
    )
    assert flown.returncode == 0, flown.stderr
    assert '"complete":true' in flown.stdout.replace(" ", ""), flown.stdout


def test_wire_problems_name_file_line_key_and_what_is_allowed(tmp_path):
    """Checks the messages for an elevation model that is too small, and for a file that is no GeoTIFF."""
    with rasterio.open(SITE / "elevation.tif") as file:
        profile, heights = file.profile, file.read(1)
    profile.update(height=40, width=40)
    with rasterio.open(tmp_path / "small.tif", "w", **profile) as file:
        file.write(heights[:40, :40], 1)
    (tmp_path / "text.tif").write_text("no picture", encoding="utf-8")
    for name, problem in (("small.tif", "no height"), ("text.tif", "not a TIFF file"), ("none.tif", "none.tif")):
        done = spandrel_program("check", str(job(tmp_path, f'source = "geotiff"\nfile = "{name}"')))
        assert done.returncode != 0
        assert "scenario.toml:" in done.stdout and "terrain.file" in done.stdout and name in done.stdout and problem in done.stdout, done.stdout
        assert "a GeoTIFF file with heights for the whole terrain" in done.stdout, done.stdout
