"""Sizes and kinds of pictures: right for papers, and the same bytes each time."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from PIL import Image

from nao_sim.plotting.style import SIZES, Block, narrow, save_page, styled, svg_text


def _block(title: str = "a line") -> Block:
    def draw(canvas) -> None:
        axes = canvas.add_subplot()
        axes.plot([0.0, 1.0], [0.0, 1.0])
        axes.set(title=title, xlabel="time (s)", ylabel="angle (°)")

    return Block(title, draw, lambda width: 3.0 if narrow(width) else 2.0)


def _points(path: Path) -> tuple[float, float]:
    """Width and height of a picture in points."""
    if path.suffix == ".svg":
        root = ET.parse(path).getroot()
        return float(root.get("width").removesuffix("pt")), float(root.get("height").removesuffix("pt"))
    _, _, width, height = re.search(rb"/MediaBox \[([^\]]+)\]", path.read_bytes())[1].split()
    return float(width), float(height)


@pytest.mark.parametrize("kind", [".svg", ".pdf"])
def test_pictures_for_papers_are_as_wide_as_a_page_or_as_a_column_and_their_text_can_be_read(kind, tmp_path):
    for size, inches in ((None, 7.16), ("column", 3.5), ("screen", 12.0)):
        path = tmp_path / f"{size}{kind}"
        save_page([_block()], path, size=size)
        assert _points(path)[0] == pytest.approx(72.0 * inches, abs=0.5)
    for name in ("page", "column"):
        with styled(name):
            import matplotlib

            assert matplotlib.rcParams["font.size"] == 8.0 and matplotlib.rcParams["axes.labelsize"] >= 8.0


def test_pixels_are_many_enough_for_print(tmp_path):
    save_page([_block()], tmp_path / "a.png", size="column")
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.width == 1050 and picture.info["dpi"][0] == pytest.approx(300, abs=0.1)
    save_page([_block()], tmp_path / "a.png")
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.width == round(SIZES["screen"].width * SIZES["screen"].dpi)


@pytest.mark.parametrize("kind", [".png", ".svg", ".pdf"])
def test_the_same_plot_gives_the_same_bytes_without_a_date(kind, tmp_path):
    paths = [tmp_path / f"{name}{kind}" for name in "ab"]
    for path in paths:
        save_page([_block(), _block("another")], path, "title")
    first, second = (path.read_bytes() for path in paths)
    assert first == second and b"CreationDate" not in first and b"<dc:date" not in first


def test_text_looks_the_same_everywhere(tmp_path):
    assert "<text" not in svg_text(_block())  # outlines, which need no font
    save_page([_block()], tmp_path / "a.pdf")
    assert b"/FontFile2" in (tmp_path / "a.pdf").read_bytes()  # TrueType inside, not Type 3


def test_a_long_title_takes_lines_and_never_leaves_the_page(tmp_path):
    from nao_sim.plotting.style import stacked

    with styled("column"):
        figure = stacked([_block()], "a very long name of a recording " * 12)
        figure.canvas.draw()
        box = figure._suptitle.get_window_extent()
        assert "\n" in figure._suptitle.get_text()
        assert box.x0 >= 0.0 and box.x1 <= figure.bbox.width and box.y1 <= figure.bbox.height + 1.0
