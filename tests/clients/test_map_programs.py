"""A map program finds the tiles of a job's site by their description (WMTS). GDAL reads both, as QGIS and other programs do."""

import io
import urllib.request

import numpy
import PIL.Image
import rasterio
import rasterio.windows

import webserver

# A tile that contains the origin of `two-bridges`: zoom, column and row.
ZOOM, COLUMN, ROW = 17, 68587, 46258
# Length of the equator in the projection of web maps, and half of it, m (EPSG:3857).
EQUATOR_M, WEST_M = 40_075_016.685578, -20_037_508.342789
# Largest mean difference between two pictures of one place, of 255: rounding to pixels. Other places differ more.
SAME_PLACE = 2.0


def test_val_gdal_finds_the_map_of_a_site_at_its_place(tmp_path, monkeypatch):
    """What GDAL draws of a place is the tile of that place."""
    monkeypatch.setenv("GDAL_DEFAULT_WMS_CACHE_PATH", str(tmp_path / "cache"))
    (tmp_path / "sessions").mkdir()
    server = webserver.Server(tmp_path / "sessions")
    try:
        with urllib.request.urlopen(f"{server.address}/tiles/two-bridges/{ZOOM}/{COLUMN}/{ROW}.png") as answer:
            png = answer.read()
        with PIL.Image.open(io.BytesIO(png)) as picture:
            tile = numpy.asarray(picture.convert("RGB"), dtype=float)
        size_m = EQUATOR_M / 2**ZOOM
        west, north = WEST_M + COLUMN * size_m, -WEST_M - ROW * size_m
        with rasterio.open(f"WMTS:{server.address}/tiles/two-bridges/WMTSCapabilities.xml,layer=two-bridges") as chart:
            assert chart.crs.to_epsg() == 3857

            def seen(east_m):
                bounds = (west + east_m, north - size_m, west + east_m + size_m, north)
                window = rasterio.windows.from_bounds(*bounds, chart.transform)
                return chart.read((1, 2, 3), window=window, out_shape=(3, *tile.shape[:2])).transpose(1, 2, 0)

            assert abs(seen(0.0) - tile).mean() < SAME_PLACE
            assert abs(seen(0.25 * size_m) - tile).mean() > SAME_PLACE, "a place beside it"
    finally:
        server.close()
