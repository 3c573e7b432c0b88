"""Pages of the web server that show no times, in each language (with a different size or color scheme each), compared with committed pictures.

SPANDREL_WEB_PICTURES=write overwrites the committed pictures: look at them before you commit them.
"""

import io
import os
import pathlib

import numpy
import pytest
from PIL import Image, ImageChops

import webserver
from test_web import BrowserUser, browser  # noqa: F401 (`browser` is a fixture)

COMMITTED = pathlib.Path(__file__).parent / "pictures"
WRITES = os.environ.get("SPANDREL_WEB_PICTURES") == "write"
# A committed picture has half of the screenshot's width and height.
SCALE = 2
# Side of the squares whose mean colors are compared, px of the committed picture. Versions of Chromium smooth the edges of letters
# differently; in the mean of a square, this is little.
BLOCK_PX = 8
# Largest mean difference of a picture and of its worst square, of 255. A text of one line, missing or moved by its height, changes
# its squares by 20 and more.
MEAN_LIMIT = 1.5
BLOCK_LIMIT = 15.0
JPEG_QUALITY = 85
# The tests install this font.
FONT = "* { font-family: 'DejaVu Sans' !important; } .code, code, pre { font-family: 'DejaVu Sans Mono' !important; }"
LOOKS = [("desktop", "light", "en-GB"), ("phone", "light", "es-ES"), ("desktop", "dark", "de-DE")]
# Name of the picture, user, and path.
PAGES = [
    ("login", None, "/login"),
    ("sessions", "anna", "/sessions"),
    ("account", "anna", "/account"),
    ("briefing", "anna", "/scenarios/two-bridges/briefing"),
    ("scenarios", "ida", "/scenarios"),
    ("scenario", "ida", "/scenarios/practice"),
    ("new-scenario", "ida", "/scenarios/new"),
    ("editor", "ida", "/scenarios/new?from=practice&name=lake-crossing"),
    ("classes", "ida", "/classes"),
    ("trainees", "ida", "/trainees"),
    ("plan-rules", "ida", "/plan-rules"),
    ("rubric", "ida", "/rubric"),
    ("stations", "ida", "/stations"),
]


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    """A server without flights."""
    folder = tmp_path_factory.mktemp("pictures") / "sessions"
    folder.mkdir()
    webserver.set_passwords(folder, "anna")
    server = webserver.Server(folder)
    yield server
    server.close()


def screenshot(page):
    """Returns a picture of the visible part of a page, at the size of the committed pictures."""
    page.wait_for_function("[...document.images].every(image => image.complete)")
    image = Image.open(io.BytesIO(page.screenshot(animations="disabled", caret="hide", style=FONT))).convert("RGB")
    return image.resize((image.width // SCALE, image.height // SCALE), Image.Resampling.BOX)


def means(image):
    """Returns the image with each square in its mean color."""
    return image.resize((image.width // BLOCK_PX, image.height // BLOCK_PX), Image.Resampling.BOX)


def differences(one, other):
    """Returns the mean difference and that of the worst square, of 255."""
    if one.size != other.size:
        return 255.0, 255.0
    values = numpy.asarray(ImageChops.difference(means(one), means(other)), dtype=float).max(axis=2)
    return values.mean(), values.max()


def compare(name, image, folder):
    """Returns what is wrong with a picture; None if it looks as committed."""
    path = COMMITTED / f"{name}.jpg"
    if WRITES:
        COMMITTED.mkdir(exist_ok=True)
        image.save(path, quality=JPEG_QUALITY, subsampling=0)
    if not path.exists():
        return f"{path} does not exist"
    mean, worst = differences(image, Image.open(path).convert("RGB"))
    print(f"{name}: mean {mean:.2f}, worst square {worst:.1f}")
    if mean <= MEAN_LIMIT and worst <= BLOCK_LIMIT:
        return None
    now = folder / f"{name}.png"
    image.save(now)
    return f"{name}: mean {mean:.2f} (at most {MEAN_LIMIT}), worst square {worst:.1f} (at most {BLOCK_LIMIT}): compare {now} with {path}"


@pytest.mark.parametrize(("size", "scheme", "locale"), LOOKS)
def test_regress_pages_look_as_committed(browser, server, tmp_path, size, scheme, locale):
    people = {name: BrowserUser(browser, server, name, size, scheme, locale) for name in (None, "anna", "ida")}
    wrong = []
    for name, user, path in PAGES:
        person = people[user]
        assert person.go(path).status == 200, path
        if name == "editor":
            person.page.locator("#preview svg").nth(3).wait_for()
        wrong.append(compare(f"{name}-{size}-{scheme}-{locale[:2]}", screenshot(person.page), tmp_path))
    assert not any(wrong), "\n".join(filter(None, wrong))


def test_exact_comparison_detects_a_missing_line_and_tolerates_jpeg():
    plain = Image.new("RGB", (320, 240), "white")
    written = plain.copy()
    # A line of text covers about a quarter of its area.
    written.paste("black", (40, 100, 200, 102))
    assert differences(plain, written)[1] > BLOCK_LIMIT
    stored = io.BytesIO()
    written.save(stored, "JPEG", quality=JPEG_QUALITY, subsampling=0)
    mean, worst = differences(written, Image.open(stored).convert("RGB"))
    assert mean <= MEAN_LIMIT and worst <= BLOCK_LIMIT
