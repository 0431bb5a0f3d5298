"""Words with a coloured dot in the lower left corner of a picture; they fade, and slide where others come and go."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from PIL import Image

Array = NDArray[np.float64]
_SMALLEST = 6.0  # pixels; smaller letters cannot be told apart
_INK, _PLATE = (255, 255, 255, 255), (22, 24, 30, 205)
_SHARPER = 4  # dots and plates are drawn so much larger, then reduced


@dataclass(frozen=True)
class Label:
    """A word with a dot.

    Attributes:
        word: what it says.
        colour: red, green and blue of the dot, 0 to 1.
    """

    word: str
    colour: tuple[float, float, float]


class Captions:
    """Draws labels into pictures, the first label lowest.

    Args:
        labels: that may appear.
        letter: height of a line, as a share of the picture's.
        size: (width, height) in pixels of the pictures.
    """

    def __init__(self, labels: tuple[Label, ...], letter: float, size: tuple[int, int]) -> None:
        self._labels, self._size = labels, size
        self._height = max(_SMALLEST, letter * size[1])

    @cached_property
    def _plates(self) -> list[tuple[Array, Array]]:
        """Each label's colours times opacity (h, w, 3), 0 to 255, and opacity (h, w, 1), cut to the picture."""
        plates = [np.asarray(_plate(label, self._height), np.float64) for label in self._labels]
        width, height = self._size
        cut = [plate[:height, :width] for plate in plates]
        return [(plate[..., :3] * plate[..., 3:] / 255.0, plate[..., 3:] / 255.0) for plate in cut]

    def draw(self, opacities: Array, picture: NDArray[np.uint8]) -> None:
        """Draw the labels of `opacities` (labels,), 0 to 1, into a picture (height, width, 3)."""
        margin = 0.6 * self._height
        bottom = len(picture) - margin
        for i in np.flatnonzero(opacities > 0.0):
            colours, opaque = self._plates[i]
            top = max(0, round(bottom) - len(colours))
            _lay(picture[top:, round(margin) :], colours * opacities[i], opaque * opacities[i])
            bottom -= 1.15 * len(colours) * opacities[i]


def _lay(place: NDArray[np.uint8], colours: Array, opaque: Array) -> None:
    """Lay colours times opacity (h, w, 3) over the upper left corner of `place`, as far as it reaches."""
    height, width = min(len(place), len(colours)), min(place.shape[1], colours.shape[1])
    below = place[:height, :width]
    below[:] = np.rint(below * (1.0 - opaque[:height, :width]) + colours[:height, :width])


def _plate(label: Label, height: float) -> Image.Image:
    """A label as a picture with opacity: dot and word on a dark plate, legible on any ground."""
    from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.load_default(0.66 * height)
    left, right, tall = 1.15 * height, 0.5 * height, round(1.0 * height)
    wide = round(left + font.getlength(label.word) + right)
    large = Image.new("RGBA", (_SHARPER * wide, _SHARPER * tall))
    draw, unit = ImageDraw.Draw(large), _SHARPER * height
    draw.rounded_rectangle((0, 0, large.width - 1, large.height - 1), 0.3 * unit, fill=_PLATE)
    dot = tuple(round(255 * value) for value in label.colour)
    draw.ellipse((0.30 * unit, 0.20 * unit, 0.90 * unit, 0.80 * unit), dot, _INK, round(0.07 * unit))
    plate = large.resize((wide, tall), Image.Resampling.BOX)
    ImageDraw.Draw(plate).text((left, tall / 2), label.word, _INK, font, anchor="lm")
    return plate
