"""Makes the files of this folder: the heights and the aerial photograph of a fictitious river valley, as surveys deliver them (EPSG:32616, GeoTIFF).

usage: python make.py FOLDER

Requires numpy and rasterio."""

import pathlib
import sys

import numpy
import rasterio
from rasterio.transform import from_origin

# UTM zone 16 north, and the origin of the job there (pyproj).
SYSTEM = "EPSG:32616"
MIDDLE_M = (507_795.60, 4_475_033.75)
WATER_M = 155.0
# Heights: 91 x 91 pixels of 10 m. Photograph: 450 x 450 pixels of 2 m.
HEIGHTS = (91, 10.0)
PHOTO = (450, 2.0)


def grid(pixels, step_m):
    """Returns the coordinates of the pixels' centers from the middle, m: east and north."""
    at = (numpy.arange(pixels) - (pixels - 1) / 2) * step_m
    east, south = numpy.meshgrid(at, at)
    return east, -south


def bank_m(east, north):
    """Returns the distance from the river, m. The river runs north, with gentle bends; the banks are 48 m from its middle."""
    middle = 9.0 * numpy.sin(north / 150.0)
    return numpy.abs(east - middle) - 48.0


def heights_m(east, north):
    """Returns the heights above sea level. Surveys show the river as a level surface."""
    bank = bank_m(east, north)
    hills = 12.0 * (1.0 - numpy.exp(-((bank / 180.0) ** 2))) * (1.0 + 0.4 * numpy.sin(east / 70.0) * numpy.cos(north / 90.0))
    land = WATER_M + 5.0 * (1.0 - numpy.exp(-bank / 9.0)) + hills
    return numpy.where(bank > 0.0, land, WATER_M).astype("float32")


def smooth(values, rounds):
    """Blurs a picture."""
    for _ in range(rounds):
        values = sum(numpy.roll(values, shift, axis) for axis in (0, 1) for shift in (-1, 1)) / 4
    return values


def colors(east, north):
    """Returns fields, a wood, a road to the bridge and the river, as red, green, blue."""
    chance = numpy.random.default_rng(7)
    grain = chance.normal(0.0, 1.0, east.shape)
    strip = (numpy.floor((east + 0.25 * north) / 62.0) + 3 * numpy.floor((north - 0.2 * east) / 88.0)).astype(int) % 5
    crops = numpy.array([(126, 138, 70), (164, 150, 92), (96, 122, 60), (146, 128, 84), (112, 132, 66)], dtype=float)
    picture = crops[strip]
    furrows = 5.0 * numpy.sin((east + 0.25 * north) / 1.9)
    picture += (furrows + 4.0 * grain)[..., None]
    trees = smooth(chance.normal(0.0, 1.0, east.shape), 6)
    wood = (bank_m(east, north) < 26.0 + 90.0 * smooth(chance.normal(0.0, 1.0, east.shape), 60)) & (trees > -0.12)
    picture[wood] = numpy.array((52, 72, 40)) + 60.0 * trees[wood][:, None]
    road = (numpy.abs(north) < 6.0) | (numpy.abs(east + 210.0 - 0.1 * north) < 3.0)
    picture[road] = numpy.array((128, 126, 122)) + 2.0 * grain[road][:, None]
    river = bank_m(east, north) < 0.0
    picture[river] = numpy.array((64, 84, 80)) + 1.5 * grain[river][:, None]
    return numpy.clip(picture, 0, 255).astype("uint8").transpose(2, 0, 1)


def write(path, values, step_m, middle_m, **more):
    """Writes a raster around a middle."""
    bands = values if values.ndim == 3 else values[None]
    half_m = bands.shape[1] * step_m / 2
    place = from_origin(middle_m[0] - half_m, middle_m[1] + half_m, step_m, step_m)
    shape = {"height": bands.shape[1], "width": bands.shape[2], "count": bands.shape[0], "dtype": bands.dtype}
    with rasterio.open(path, "w", driver="GTiff", crs=SYSTEM, transform=place, **shape, **more) as file:
        file.write(bands)


def make(folder, middle_m=MIDDLE_M):
    """Writes both files."""
    write(folder / "elevation.tif", heights_m(*grid(*HEIGHTS)), HEIGHTS[1], middle_m, compress="deflate", predictor=3, nodata=-9999)
    write(folder / "photo.tif", colors(*grid(*PHOTO)), PHOTO[1], middle_m, compress="jpeg", photometric="rgb", interleave="pixel")


if __name__ == "__main__":
    make(pathlib.Path(sys.argv[1]))
