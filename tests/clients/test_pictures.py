"""Photos and videos of a recorded session, read by third-party programs."""

import json
import re
import struct
import subprocess

import numpy
import pytest
from PIL import Image

import display
import spandrel

# Maximum size of one photo and all photos in the report, bytes.
MOST_BYTES, ALL_BYTES = 400_000, 4_000_000
# Small enough for a software driver to render quickly.
SIZE = (640, 480)
# A wider size; pictures must keep the sensor's aspect ratio.
WITHIN = (800, 480)
# A hundred-thousandth of a degree is about a meter. EXIF has a resolution of a ten-thousandth of an arcsecond, 3 mm.
PLACE_DEG = 1e-7


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    """A synthetic expert's flight with photos."""
    assert display.DRIVERS, "Mesa's software Vulkan is missing: apt-get install mesa-vulkan-drivers"
    sessions = tmp_path_factory.mktemp("sessions")
    spandrel.run("demo", "--skill", "expert", "--seed", "7", "--speed", "max", "--sessions", str(sessions))
    (folder,) = sessions.iterdir()
    return folder


def degrees(parts, reference):
    """Converts degrees, minutes, seconds to one number."""
    d, m, s = (float(p) for p in parts)
    return (d + m / 60 + s / 3600) * (-1 if reference in ("S", "W") else 1)


@pytest.mark.timeout(900)
def test_val_photos_contain_position_and_exposure(session):
    """Pillow reads EXIF and XMP; the report contains the photos."""
    spandrel.run("render", str(session), "--snapshots", "--quality", "low", "--size", f"{WITHIN[0]}x{WITHIN[1]}", program=spandrel.COCKPIT)
    taken = json.loads((session / "assessment.json").read_text(encoding="utf-8"))["snapshots"]["taken"]
    photographs = sorted((session / "snapshots").glob("[0-9][0-9][0-9][0-9].jpg"))
    assert taken > 0 and len(photographs) >= taken, (taken, photographs)
    copies = [path.parent / "small" / path.name for path in photographs]
    assert sum(path.stat().st_size for path in copies) <= ALL_BYTES
    for path, copy in zip(photographs, copies):
        assert copy.stat().st_size <= MOST_BYTES and Image.open(copy).size[0] <= 1280
        image = Image.open(path)
        image.load()
        assert image.size == SIZE and image.getextrema() != ((0, 0),) * 3
        exif = image.getexif()
        gps, camera = exif.get_ifd(0x8825), exif.get_ifd(0x8769)
        assert exif[0x010F] == "Spandrel" and re.fullmatch(r"\d{4}:\d\d:\d\d \d\d:\d\d:\d\d", camera[0x9003])
        xmp = image.info["xmp"].decode("utf-8")
        told = dict(re.findall(r'([\w-]+:\w+)="([^"]*)"', xmp))
        latitude, longitude = degrees(gps[2], gps[1]), degrees(gps[4], gps[3])
        assert abs(latitude - float(told["drone-dji:GpsLatitude"])) < PLACE_DEG
        assert abs(longitude - float(told["drone-dji:GpsLongitude"])) < PLACE_DEG
        assert abs(float(gps[17]) - float(told["drone-dji:GimbalYawDegree"]) % 360) < 0.02
        assert -90 <= float(told["drone-dji:GimbalPitchDegree"]) <= 90
        assert (int(camera[0xA002]), int(camera[0xA003])) == SIZE
        if "spandrel:DistanceMetre" in told:
            # Width over distance equals width over focal length, on the ground as on the sensor.
            wide = float(camera[0xA002]) * float(told["spandrel:GroundSamplingDistanceMillimetre"]) / 1000
            assert camera[0xA210] == 3, "the sensor's resolution must be per centimeter"
            plate = 10 * float(camera[0xA002]) / float(camera[0xA20E])
            assert abs(wide / float(told["spandrel:DistanceMetre"]) - plate / float(camera[0x920A])) < 1e-3
    assert (session / "report.html").read_text(encoding="utf-8").count("data:image/jpeg;base64,") >= taken


@pytest.mark.timeout(900)
def test_val_masks_label_the_counted_defects(session):
    """Checks that Pillow reads 16 bits per pixel, and that each defect counted in a photo is labeled in it, inside the
    bounding box in the legend."""
    size = f"{SIZE[0]}x{SIZE[1]}"
    spandrel.run("render", str(session), "--snapshots", "--masks", "--quality", "low", "--size", size, program=spandrel.COCKPIT)
    legends = sorted((session / "snapshots").glob("*.masks.json"))
    assert len(legends) == len(list((session / "snapshots").glob("*.jpg"))) > 0
    labeled = 0
    for path in legends:
        legend = json.loads(path.read_text(encoding="utf-8"))
        stem = path.name.removesuffix(".masks.json")
        pixels = {kind: numpy.asarray(Image.open(path.with_name(f"{stem}.{kind}.png"))) for kind in ("elements", "defects")}
        assert all(of.shape == (SIZE[1], SIZE[0]) for of in pixels.values())
        assert {entry["element"]: entry["pixels"] for entry in legend["elements"]} == pixel_counts(pixels["elements"])
        assert {entry["id"]: entry["pixels"] for entry in legend["defects"]} == pixel_counts(pixels["defects"])
        for entry in legend["defects"]:
            rows, columns = numpy.nonzero(pixels["defects"] == entry["id"])
            left, top, width, height = entry["box_px"]
            assert (columns.min(), rows.min()) == (left, top)
            assert (columns.max() - left + 1, rows.max() - top + 1) == (width, height)
            # Most of a defect is on its element, but its outline may extend over an edge.
            assert (pixels["elements"][rows, columns] == entry["element"]).mean() > 0.5
        labeled += bool(legend["defects"])
    assert labeled >= len(legends) / 2, "an expert must photograph defects"


def pixel_counts(labels):
    """Returns the number of pixels for each label, excluding unlabeled pixels."""
    return {int(label): int(count) for label, count in zip(*numpy.unique(labels[labels > 0], return_counts=True))}


@pytest.mark.timeout(900)
def test_val_video_has_all_pictures_and_chapters(session, tmp_path):
    """Checks the length and the number of pictures in the file's index, and that each photo in the time span has a
    chapter."""
    film = tmp_path / "flight.mp4"
    events = [json.loads(line) for line in (session / "events.jsonl").read_text(encoding="utf-8").splitlines()]
    photos_s = [event["t_s"] for event in events if event["event"] == "snapshot"]
    # Half a minute around the first photo.
    begin_s = max(int(photos_s[0]) - 15, 0)
    options = ["--quality", "low", "--size", "320x240", "--fps", "2", "--span", f"{begin_s},{begin_s + 30}"]
    spandrel.run("render", str(session), "--video", str(film), *options, program=spandrel.COCKPIT)
    data = film.read_bytes()
    assert data[4:8] == b"ftyp"
    at = data.index(b"stts")
    entries = struct.unpack(">I", data[at + 8 : at + 12])[0]
    runs = struct.unpack(f">{2 * entries}I", data[at + 12 : at + 12 + 8 * entries])
    assert sum(runs[::2]) == 61, "30 s at 2 Hz, including both ends"
    at = data.index(b"mdhd")
    scale, length = struct.unpack(">II", data[at + 16 : at + 24])
    assert abs(length / scale - 30.5) < 0.01
    # GStreamer's demuxer and decoder must find the same number of pictures with that size.
    raw = tmp_path / "flight.raw"
    chain = f"filesrc location={film} ! qtdemux ! avdec_h264 ! videoconvert ! video/x-raw,format=GRAY8 ! filesink location={raw}"
    subprocess.run(["gst-launch-1.0", "-q", *chain.split()], check=True, timeout=300)
    assert raw.stat().st_size == 61 * 320 * 240
    chapters = film.with_suffix(".vtt").read_text(encoding="utf-8")
    taken = sum(begin_s <= at_s <= begin_s + 30 for at_s in photos_s)
    found = re.findall(r"(\d\d:\d\d:\d\d\.\d{3}) --> (\d\d:\d\d:\d\d\.\d{3})", chapters)
    assert chapters.startswith("WEBVTT\n") and len(found) == taken > 0
    for start, end in found:
        assert "00:00:00.000" <= start < end <= "00:00:30.500"
