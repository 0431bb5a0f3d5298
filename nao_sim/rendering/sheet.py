"""Pictures side by side with words below them, as a picture or a page to print."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nao_sim.errors import UsageError
from nao_sim.files import beside

if TYPE_CHECKING:
    pass

Picture = NDArray[np.uint8]
KINDS = (".png", ".jpg", ".jpeg", ".pdf")
_PAPER, _INK = (255, 255, 255), (40, 44, 52)
_GAP = 0.02  # of a picture's width, between pictures and around them
_LINE = 0.09  # of a picture's height, for words below it
_LEAST_LINE = 12  # pixels
_DPI = 150.0


def sheet(pictures: Sequence[Picture], words: Sequence[str], columns: int | None = None) -> Picture:
    """Pictures in rows, each with its words below it.

    Args:
        pictures: (height, width, 3) each, all of one size, at least one.
        words: of each; where all are empty there is no room for them.
        columns: how many stand side by side; about as many as rows where None.

    Returns:
        (height, width, 3); a single picture without words as it is.
    """
    from PIL import Image, ImageDraw, ImageFont

    if len(pictures) == 1 and not words[0]:
        return pictures[0]
    height, width = pictures[0].shape[:2]
    columns = columns or math.ceil(math.sqrt(len(pictures)))
    gap, line = max(2, round(_GAP * width)), max(_LEAST_LINE, round(_LINE * height)) if any(words) else 0
    rows = -(-len(pictures) // columns)
    size = gap + columns * (width + gap), gap + rows * (height + line + gap)
    paper = Image.new("RGB", size, _PAPER)
    draw, font = ImageDraw.Draw(paper), ImageFont.load_default(0.6 * max(line, _LEAST_LINE))
    for i, (picture, word) in enumerate(zip(pictures, words, strict=True)):
        left, top = gap + i % columns * (width + gap), gap + i // columns * (height + line + gap)
        paper.paste(Image.fromarray(picture), (left, top))
        draw.text((left + width / 2, top + height + line / 2), word, _INK, font, anchor="mm")
    return np.asarray(paper)


def check_sheet(path: Path) -> None:
    """Refuse the name of a file of no kind that a picture can be written as.

    Raises:
        UsageError: it ends otherwise.
    """
    if path.suffix.lower() not in KINDS:
        raise UsageError(f"{path}: cannot write '{path.suffix or path.name}' pictures; expected {', '.join(KINDS)}")


def save_sheet(picture: Picture, path: Path) -> None:
    """Write a picture (height, width, 3), whole or not at all; a .pdf is a page of its size.

    Raises:
        UsageError: it cannot be written there, or under that name.
    """
    from PIL import Image

    check_sheet(path)
    with beside(path) as draft:  # each kind of file takes those options that it knows
        Image.fromarray(picture).save(draft, dpi=(_DPI, _DPI), resolution=_DPI, quality=92)
