"""Data sets for detectors, read by the reference tools for COCO files and by the rules of YOLO's text format."""

import csv
import filecmp
import json
import math
import pathlib
import subprocess

import numpy
import pytest
from PIL import Image
from pycocotools import mask as coco_mask
from pycocotools.coco import COCO

import display
import spandrel

COUNT = 12
SIZE = (480, 360)
SPLITS = ("train", "val")
# Rounding of the coordinates in the text files and in the table, px and mm/px.
ROUNDING_PX, ROUNDING_MM = 1e-6, 1e-3


def render(folder, *options, count=COUNT, seed=3, scenario="girder"):
    """Renders a data set and returns its folder."""
    size = f"{SIZE[0]}x{SIZE[1]}"
    spandrel.run(
        "render", scenario, "--dataset", str(count), "--seed", str(seed), "--size", size, "--quality", "low", "--out", str(folder), *options,
        program=spandrel.COCKPIT,
    )
    return folder


@pytest.fixture(scope="module")
def dataset(tmp_path_factory):
    """A small data set with label masks."""
    assert display.DRIVERS, "Mesa's software Vulkan is missing: apt-get install mesa-vulkan-drivers"
    return render(tmp_path_factory.mktemp("datasets") / "set", "--masks")


def poses(folder):
    """Returns the table of pictures by file name."""
    with open(folder / "poses.csv", encoding="utf-8", newline="") as file:
        return {row["file"]: row for row in csv.DictReader(file)}


def pictures(folder):
    """Yields split, image entry, annotations and COCO file of each picture."""
    for split in SPLITS:
        coco = COCO(folder / "annotations" / f"instances_{split}.json")
        for image in coco.loadImgs(coco.getImgIds()):
            yield split, image, coco.loadAnns(coco.getAnnIds(image["id"])), coco


@pytest.mark.timeout(900)
def test_val_coco_tools_restore_the_label_masks(dataset):
    """Checks that pycocotools derives the pixels, areas and boxes of the label masks from the annotations."""
    total = 0
    for split, image, found, coco in pictures(dataset):
        picture = Image.open(dataset / "images" / split / image["file_name"])
        assert picture.size == SIZE == (image["width"], image["height"])
        stem = pathlib.Path(image["file_name"]).stem
        labels = numpy.asarray(Image.open(dataset / "annotations" / f"{stem}.defects.png"))
        restored = numpy.zeros_like(labels)
        for entry in found:
            pixels = coco.annToMask(entry).astype(bool)
            assert not restored[pixels].any(), "no pixel has two defects"
            restored[pixels] = entry["defect"]
            run_lengths = coco.annToRLE(entry)
            assert coco_mask.area(run_lengths) == entry["area"] == pixels.sum()
            assert coco_mask.toBbox(run_lengths).tolist() == entry["bbox"]
            assert entry["category_id"] in coco.cats and entry["condition_state"] in (2, 3, 4)
        assert (restored == labels).all()
        total += len(found)
    assert total >= COUNT / 3, "many pictures must show defects"


@pytest.mark.timeout(900)
def test_val_yolo_boxes_equal_the_coco_boxes(dataset):
    """Checks that each picture has a text file with the same boxes and classes, and that data.yaml lists folders and classes."""
    lines = (dataset / "data.yaml").read_text(encoding="utf-8").splitlines()
    assert lines[:3] == ["train: images/train", "val: images/val", "names:"]
    names = dict(line.strip().split(": ", 1) for line in lines[3:])
    files = 0
    for split, image, found, coco in pictures(dataset):
        text = (dataset / "labels" / split / image["file_name"].replace(".jpg", ".txt")).read_text(encoding="utf-8")
        rows = [[float(number) for number in line.split()] for line in text.splitlines()]
        assert len(rows) == len(found)
        for (number, x, y, w, h), entry in zip(rows, found):
            assert names[str(int(number))] == coco.cats[entry["category_id"]]["name"]
            box = [(x - w / 2) * SIZE[0], (y - h / 2) * SIZE[1], w * SIZE[0], h * SIZE[1]]
            assert box == pytest.approx(entry["bbox"], abs=ROUNDING_PX)
        files += 1
    assert files == COUNT == sum(1 for _ in (dataset / "images").rglob("*.jpg")) == sum(1 for _ in (dataset / "labels").rglob("*.txt"))


@pytest.mark.timeout(900)
def test_val_table_has_pose_distance_and_weather_of_each_picture(dataset):
    """Checks the ground sampling distance against distance and field of view, the split against the scenes, and the variety."""
    table = poses(dataset)
    assert len(table) == COUNT
    for split, image, _, _ in pictures(dataset):
        row = table[f"images/{split}/{image['file_name']}"]
        wide_m = 2 * float(row["distance_m"]) * math.tan(math.radians(float(row["hfov_deg"])) / 2)
        assert float(row["gsd_mm_px"]) == pytest.approx(1000 * wide_m / SIZE[0], abs=ROUNDING_MM)
        assert image["gsd_mm_px"] == pytest.approx(float(row["gsd_mm_px"]), abs=ROUNDING_MM)
        assert bool(row["task"]) != bool(row["defect"]), "a picture aims at a surface or at a defect"
        assert float(row["sun_elevation_deg"]) > 0 and 0 <= float(row["cloud_cover"]) <= 1
    splits = {}
    for row in table.values():
        splits.setdefault(row["scene_seed"], set()).add(row["split"])
    assert all(len(found) == 1 for found in splits.values()), "no scene is in both splits"
    assert {found for group in splits.values() for found in group} == set(SPLITS)
    for column in ("distance_m", "yaw_deg", "pitch_deg", "utc", "up_m"):
        assert len({row[column] for row in table.values()}) > COUNT / 2, column


@pytest.mark.timeout(900)
def test_regress_same_seed_yields_the_same_bits(dataset, tmp_path):
    """Checks that a second run yields the same files, and another seed other pictures."""
    again = render(tmp_path / "again", "--masks")
    names = sorted(path.relative_to(dataset) for path in dataset.rglob("*") if path.is_file())
    assert names == sorted(path.relative_to(again) for path in again.rglob("*") if path.is_file())
    assert filecmp.cmpfiles(dataset, again, [str(name) for name in names], shallow=False)[1:] == ([], [])
    other = render(tmp_path / "other", seed=4, count=2)
    first = sorted((other / "images").rglob("*.jpg"))
    assert len(first) == 2 and not filecmp.cmp(first[0], next((dataset / "images").rglob("000001.jpg")), shallow=False)
    assert len(json.loads((other / "annotations/instances_val.json").read_text(encoding="utf-8"))["images"]) == 1


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["girder", "--dataset", "0"], "0 is not in 1..=100000"),
        (["girder", "--dataset", "5", "--at", "3"], "cannot be used with"),
        (["girder", "--dataset", "5", "--out", "-"], "specify a folder with --out"),
        (["girder", "--dataset", "5", "--out", "."], "the folder is not empty (allowed: a new or empty folder)"),
        (["girder", "--dataset", "5", "--quality", "best"], "unknown preset (allowed: low, medium, high, ultra)"),
        (["no-such-job", "--dataset", "5"], "no-such-job"),
        ([".", "--dataset", "5"], "applies only to scenarios"),
        (["drill-landing", "--dataset", "5", "--out", "empty"], "neither defects nor a task with a surface to inspect"),
    ],
)
def test_exact_bad_options_are_refused(tmp_path, options, message):
    """Checks exit code and message."""
    (tmp_path / "file.txt").write_text("", encoding="utf-8")
    done = subprocess.run([spandrel.COCKPIT, "render", *options], capture_output=True, text=True, check=False, timeout=120, cwd=tmp_path)
    assert done.returncode == 2 and message in done.stderr, (done.returncode, done.stderr)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file.txt"], "nothing is left behind"
