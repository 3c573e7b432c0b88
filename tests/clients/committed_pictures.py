"""Compares pages with committed pictures.

SPANDREL_WEB_PICTURES=write overwrites the committed pictures: look at them before you commit them.
"""

import io
import os
import pathlib

import numpy
from PIL import Image, ImageChops

COMMITTED = pathlib.Path(__file__).parent / "pictures"
WRITES = os.environ.get("SPANDREL_WEB_PICTURES") == "write"
# Sizes of the window, px.
SIZES = {"desktop": (1280, 900), "tablet": (768, 1024), "phone": (390, 844)}
# Color scheme of the pictures in each language.
SCHEMES = {"en-GB": "light", "de-DE": "dark", "es-ES": "light"}
# A committed picture has half of the screenshot's width and height.
SCALE = 2
# Side of the squares whose mean colors are compared, px of the committed picture. Versions of Chromium smooth the edges of letters
# differently; in the mean of a square, this is little.
BLOCK_PX = 8
# Largest mean difference of a picture and of its worst square, of 255. A text of one line, missing or moved by its height, changes
# its squares by 20 and more.
MEAN_LIMIT = 1.5
BLOCK_LIMIT = 15.0
# WebP needs a third of the bytes of JPEG for these pictures.
FORMAT = {"format": "WEBP", "quality": 75, "method": 2}
# The tests install this font.
FONT = "* { font-family: 'DejaVu Sans' !important; } .code, code, pre { font-family: 'DejaVu Sans Mono' !important; }"
# Replaces texts in the page and in its fields.
REPLACE = """texts => {
    const replaced = text => Object.entries(texts).reduce((text, [from, to]) => text.replaceAll(from, to), text);
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) { const now = replaced(walker.currentNode.data); if (now !== walker.currentNode.data) walker.currentNode.data = now; }
    document.querySelectorAll('input').forEach(input => { if (texts[input.value]) input.value = texts[input.value]; });
}"""


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


def encoded(image):
    """Returns a picture as a file."""
    file = io.BytesIO()
    image.save(file, **FORMAT)
    return file.getvalue()


def decoded(file):
    """Returns the picture in a file."""
    return Image.open(io.BytesIO(file)).convert("RGB")


def compare(name, image, folder):
    """Returns what is wrong with a picture; None if it looks as committed."""
    path = COMMITTED / f"{name}.webp"
    if WRITES:
        path.write_bytes(encoded(image))
    if not path.exists():
        return f"{path} does not exist"
    # The compression changes dark colors by a step or two: it changes both pictures.
    mean, worst = differences(decoded(encoded(image)), decoded(path.read_bytes()))
    print(f"{name}: mean {mean:.2f}, worst square {worst:.1f}")
    if mean <= MEAN_LIMIT and worst <= BLOCK_LIMIT:
        return None
    now = folder / f"{name}.png"
    image.save(now)
    return f"{name}: mean {mean:.2f} (at most {MEAN_LIMIT}), worst square {worst:.1f} (at most {BLOCK_LIMIT}): compare {now} with {path}"


def compare_sizes(page, name, locale, folder, texts):
    """Compares an open page in all sizes, with these texts replaced because they differ between runs. Returns what is wrong."""
    page.evaluate(REPLACE, texts)
    wrong = []
    for size, (width, height) in SIZES.items():
        page.set_viewport_size({"width": width, "height": height})
        wrong.append(compare(f"{name}-{size}-{locale[:2]}", screenshot(page), folder))
    return list(filter(None, wrong))
