"""Tests that tools/check-links finds problems in a book; tools/book runs it on the project's book."""

import subprocess
import sys

import pytest

import spandrel

CHECK = spandrel.ROOT / "tools" / "check-links"
PAGES = {
    "index.html": '<h1 id="top">A</h1><a href="more/b.html#part">b</a><a href="https://example.org/x">elsewhere</a><a href="#top">top</a>',
    "more/b.html": '<h2 id="part">B</h2><img src="../images/c.png"><a href="../index.html">back</a>',
}
# Changes to the valid book: a page's old text, its new text, and the expected message.
FAULTS = {
    "page": ("index.html", "more/b.html#part", "more/gone.html", "more/gone.html: no such file"),
    "anchor": ("index.html", "#part", "#gone", "more/b.html#gone: no such anchor"),
    "own anchor": ("index.html", 'href="#top"', 'href="#gone"', "#gone: no such anchor"),
    "picture": ("more/b.html", "c.png", "gone.png", "images/gone.png: no such file"),
    "outside": ("index.html", "more/b.html#part", "../source/SUMMARY.md", "no such file in the book"),
}


@pytest.fixture
def book(tmp_path):
    """Returns the source and the built result of a book with two pages and a picture."""
    source, built = tmp_path / "source", tmp_path / "built"
    for folder in (source / "more", source / "images", built / "more", built / "images"):
        folder.mkdir(parents=True)
    (source / "SUMMARY.md").write_text("# Summary\n\n- [A](index.md)\n- [B](more/b.md)\n", encoding="utf-8")
    (source / "index.md").write_text("# A\n", encoding="utf-8")
    (source / "more" / "b.md").write_text("# B\n", encoding="utf-8")
    for folder in (source, built):
        (folder / "images" / "c.png").write_bytes(b"picture")
    for name, text in PAGES.items():
        (built / name).write_text(text, encoding="utf-8")
    return source, built


def check(book):
    """Returns the exit code and the output."""
    done = subprocess.run([sys.executable, str(CHECK), *map(str, book)], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def test_exact_valid_book_has_no_problems(book):
    """A book whose pages, anchors and pictures all exist has no problems. The check covers the repository's Markdown
    but not links to other sites."""
    code, printed = check(book)
    assert code == 0, printed


@pytest.mark.parametrize("fault", FAULTS)
def test_exact_broken_link_is_found(book, fault):
    """Each fault produces one message that describes it."""
    page, old, new, words = FAULTS[fault]
    path = book[1] / page
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")
    code, printed = check(book)
    assert code == 1 and words in printed, printed


def test_exact_pages_match_the_summary(book):
    """Finds unlisted pages, listed pages that are missing or empty, pages listed twice, and unused pictures."""
    source, _built = book
    (source / "orphan.md").write_text("# Orphan\n", encoding="utf-8")
    (source / "empty.md").write_text("\n", encoding="utf-8")
    (source / "images" / "unused.jpg").write_bytes(b"picture")
    with open(source / "SUMMARY.md", "a", encoding="utf-8") as summary:
        summary.write("- [Gone](gone.md)\n- [Empty](empty.md)\n- [A again](index.md)\n")
    code, printed = check(book)
    assert code == 1
    for words in (
        "orphan.md: not listed", "gone.md is missing or empty", "empty.md is missing or empty", "index.md is listed twice",
        "images/unused.jpg: no page shows this picture",
    ):
        assert words in printed, printed
