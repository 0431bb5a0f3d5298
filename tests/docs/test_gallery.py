"""The gallery: its page, its pictures, and what shows them."""

from __future__ import annotations

import importlib.util
import sys

import pytest
from PIL import Image

from tests.docs.shown import DOCUMENTS, ROOT

GALLERY = ROOT / "render" / "gallery"
LARGEST, LARGEST_FILM = 3_000_000, 1_500_000  # bytes of all, and of the film


@pytest.fixture(scope="module")
def make():
    """`render/gallery/make.py`."""
    spec = importlib.util.spec_from_file_location("make", GALLERY / "make.py")
    module = importlib.util.module_from_spec(spec)
    before = list(sys.path)
    spec.loader.exec_module(module)
    sys.path[:] = before
    return module


def test_the_page_and_the_pictures_are_those_that_the_command_makes(make):
    assert (GALLERY / "README.md").read_text(encoding="utf-8") == make.page()
    made = {shot.name for shot in make.SHOTS} | {"how_it_works.svg"}
    assert {path.name for path in GALLERY.iterdir() if path.suffix in (".png", ".webp", ".svg")} == made


def test_the_pictures_are_small_and_the_film_loops(make):
    sizes = {path.name: path.stat().st_size for path in GALLERY.iterdir() if path.is_file()}
    assert sum(sizes.values()) < LARGEST
    for shot in make.SHOTS:
        with Image.open(GALLERY / shot.name) as picture:
            assert getattr(picture, "n_frames", 1) > 1 if shot.loop else min(picture.size) > 100
            if shot.loop:
                assert picture.info["loop"] == 0 and sizes[shot.name] < LARGEST_FILM


def test_every_picture_of_the_documents_is_there():
    import re

    for document in DOCUMENTS:
        for link in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", document.read_text(encoding="utf-8")):
            assert (document.parent / link).is_file(), f"{document}: {link}"
