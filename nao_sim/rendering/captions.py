"""Words in a picture: labels with a coloured dot in its lower left corner, which fade and slide where others come and
go; the time in its lower right corner; and titles over parts of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from PIL import Image

Array = NDArray[np.float64]
Plate = tuple[Array, Array]  # colours times opacity (h, w, 3), 0 to 255, and opacity (h, w, 1)
_SMALLEST = 6.0  # pixels; smaller letters cannot be told apart
_INK, _PLATE = (255, 255, 255, 255), (22, 24, 30, 205)
_SHARPER = 4  # dots and plates are drawn so much larger, then reduced
_NARROW = 0.75  # in pictures of a smaller width for their height letters are smaller, too
_MARGIN = 0.6  # of a line's height, from the picture's edges
TENTHS = 10.0  # of a second are told


@dataclass(frozen=True)
class Label:
    """A word with a dot.

    Attributes:
        word: what it says.
        colour: red, green and blue of the dot, 0 to 1.
    """

    word: str
    colour: tuple[float, float, float]


@dataclass(frozen=True)
class Title:
    """Words that stand in every picture.

    Attributes:
        words: what they say.
        middle: where their middle is, as a share of the picture's width.
        top: where they begin, as a share of its height.
    """

    words: str
    middle: float
    top: float


@dataclass(frozen=True)
class Script:
    """All that may be written into a picture.

    How much of it a picture shows is told by a row of numbers (width,): the opacity of each label, 0 to 1, then the
    time (s) where there is a clock.

    Attributes:
        labels: the first one lowest.
        letter: height of a line, as a share of the picture's.
        titles: over parts of the picture.
        clock: whether the time is told.
    """

    labels: tuple[Label, ...] = ()
    letter: float = 0.04
    titles: tuple[Title, ...] = ()
    clock: bool = False

    @property
    def width(self) -> int:
        """Numbers in a row."""
        return len(self.labels) + self.clock

    def to_json(self) -> dict[str, Any]:
        """As JSON knows it."""
        return asdict(self)

    @staticmethod
    def from_json(table: Mapping[str, Any]) -> Script:
        """The script that `to_json` told."""
        labels = tuple(Label(label["word"], tuple(label["colour"])) for label in table["labels"])
        return Script(labels, table["letter"], tuple(Title(**title) for title in table["titles"]), table["clock"])


class Captions:
    """Writes a script into pictures.

    Args:
        script: what may be written.
        size: (width, height) in pixels of the pictures.
    """

    def __init__(self, script: Script, size: tuple[int, int]) -> None:
        self._script, self._size = script, size
        self._labels: dict[int, Plate] = {}
        self._height = max(_SMALLEST, script.letter * min(size[1], size[0] / _NARROW))

    def _label(self, number: int) -> Plate:
        """A label, cut to the picture; drawn when it is first needed, for most never are."""
        if number not in self._labels:
            label = self._script.labels[number]
            self._labels[number] = _cut(_plate(label.word, self._height, label.colour), self._size)
        return self._labels[number]

    @cached_property
    def _titles(self) -> list[Plate]:
        return [_cut(_plate(title.words, self._height), self._size) for title in self._script.titles]

    def draw(self, row: Array, picture: NDArray[np.uint8]) -> None:
        """Write what a row (script.width,) says into a picture (height, width, 3)."""
        margin = round(_MARGIN * self._height)
        for title, plate in zip(self._script.titles, self._titles, strict=True):
            left = round(title.middle * picture.shape[1] - plate[1].shape[1] / 2)
            _lay(picture[round(title.top * len(picture)) + margin :, max(0, left) :], *plate)
        bottom = len(picture) - _MARGIN * self._height
        for i in np.flatnonzero(row[: len(self._script.labels)] > 0.0):
            colours, opaque = self._label(int(i))
            top = max(0, round(bottom) - len(colours))
            _lay(picture[top:, margin:], colours * row[i], opaque * row[i])
            bottom -= 1.15 * len(colours) * row[i]
        if self._script.clock:
            _, opaque = plate = _cut(_clock(round(TENTHS * row[-1]), self._height), self._size)
            top, left = (
                max(0, side - margin - own) for side, own in zip(picture.shape[:2], opaque.shape[:2], strict=True)
            )
            _lay(picture[top:, left:], *plate)


def _lay(place: NDArray[np.uint8], colours: Array, opaque: Array) -> None:
    """Lay colours times opacity (h, w, 3) over the upper left corner of `place`, as far as it reaches."""
    height, width = min(len(place), len(colours)), min(place.shape[1], colours.shape[1])
    below = place[:height, :width]
    below[:] = np.rint(below * (1.0 - opaque[:height, :width]) + colours[:height, :width])


def _cut(plate: Image.Image, size: tuple[int, int]) -> Plate:
    """A plate as far as it fits into a picture of `size`."""
    pixels = np.asarray(plate, np.float64)[: size[1], : size[0]]
    return pixels[..., :3] * pixels[..., 3:] / 255.0, pixels[..., 3:] / 255.0


@lru_cache(4)
def _clock(tenths: int, height: float) -> Image.Image:
    return _plate(f"{tenths / TENTHS:.1f} s", height)


def _plate(words: str, height: float, dot: tuple[float, float, float] | None = None) -> Image.Image:
    """Words as a picture with opacity: behind a dot, if any, on a dark plate, legible on any ground."""
    from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.load_default(0.66 * height)
    left, right, tall = (1.15 if dot else 0.5) * height, 0.5 * height, round(1.0 * height)
    wide = round(left + font.getlength(words) + right)
    large = Image.new("RGBA", (_SHARPER * wide, _SHARPER * tall))
    draw, unit = ImageDraw.Draw(large), _SHARPER * height
    draw.rounded_rectangle((0, 0, large.width - 1, large.height - 1), 0.3 * unit, fill=_PLATE)
    if dot:
        fill = tuple(round(255 * value) for value in dot)
        draw.ellipse((0.30 * unit, 0.20 * unit, 0.90 * unit, 0.80 * unit), fill, _INK, round(0.07 * unit))
    plate = large.resize((wide, tall), Image.Resampling.BOX)
    ImageDraw.Draw(plate).text((left, tall / 2), words, _INK, font, anchor="lm")
    return plate
