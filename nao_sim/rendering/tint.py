"""Colours that parts of a model take in some frames of a film, without a cost in the others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nao_sim.rendering.captions import Script

if TYPE_CHECKING:
    import mujoco

Array = NDArray[np.float64]
_UNSET = np.array((0.5, 0.5, 0.5, 1.0), np.float32)  # a geom of this colour shows its material's
_RGBA = 4


@dataclass(frozen=True)
class Tint:
    """What may take colour in a film, and what may be written into it.

    How much of it a frame shows is told by a row of numbers (width,): for each part the colour that covers it, as
    red, green, blue times opacity, and opacity, each 0 to 1; then what the script wants.  Zeros show nothing.

    Attributes:
        parts: indices of each part's geoms.
        takes: how far each of those geoms takes its part's colour, 0 to 1.
        script: what may be written.
    """

    parts: tuple[tuple[int, ...], ...] = ()
    takes: tuple[tuple[float, ...], ...] = ()
    script: Script = field(default_factory=Script)

    @property
    def covers(self) -> int:
        """Numbers in a row that tell the parts' colours; they come first."""
        return _RGBA * len(self.parts)

    @property
    def width(self) -> int:
        """Numbers in a row."""
        return self.covers + self.script.width

    def row(self, covers: Array, written: Array) -> Array:
        """Rows (..., width) of the parts' covers (..., parts, 4) and the script's rows (..., script.width)."""
        return np.concatenate([covers.reshape(*covers.shape[:-2], -1), written], axis=-1)

    def to_json(self) -> dict[str, Any]:
        """As JSON knows it."""
        return {"parts": self.parts, "takes": self.takes, "script": self.script.to_json()}

    @staticmethod
    def from_json(table: Mapping[str, Any]) -> Tint:
        """The tint that `to_json` told."""
        parts, takes = (tuple(map(tuple, table[key])) for key in ("parts", "takes"))
        return Tint(parts, takes, Script.from_json(table["script"]))


@dataclass(frozen=True, eq=False)
class Tinted:
    """A tint and what each frame of a film shows of it.

    Attributes:
        tint: what takes colour.
        rows: (N, tint.width) one a frame.
    """

    tint: Tint
    rows: Array


def cover(below: Array, colour: tuple[float, float, float], opacity: Array) -> Array:
    """Lay a colour over others (Porter and Duff 1984, `over`).

    Args:
        below: (..., 4) red, green, blue times opacity, and opacity.
        colour: red, green, blue, 0 to 1.
        opacity: (...) of the colour, 0 to 1.
    """
    share = np.asarray(opacity, np.float64)[..., None]
    return below * (1.0 - share) + np.array((*colour, 1.0)) * share


class Tinter:
    """Colours one model as the rows of a tint say.

    Args:
        model: its geoms' colours are changed; hand over one of your own.
        tint: what takes colour.
    """

    def __init__(self, model: mujoco.MjModel, tint: Tint) -> None:
        self._model, self._parts = model, len(tint.parts)
        self._geoms = np.array([geom for part in tint.parts for geom in part], int)
        self._part_of = np.repeat(np.arange(self._parts), [len(part) for part in tint.parts])
        self._takes = np.array([take for takes in tint.takes for take in takes], np.float64)
        self._plain = model.geom_rgba[self._geoms]
        self._shown = _shown_colours(model, self._geoms)

    def colour(self, row: Array) -> NDArray[np.int_]:
        """Colour the model as the covers at the beginning of a row say.

        Returns:
            The geoms (N,) that differ from their own colour.
        """
        covers = row[: _RGBA * self._parts].reshape(self._parts, _RGBA)[self._part_of]
        touched = covers[:, 3] * self._takes > 0.0
        colours = self._plain.copy()
        colours[touched, :3] = (
            self._shown[touched] * (1.0 - self._takes * covers[:, 3])[touched, None]
            + (self._takes[:, None] * covers[:, :3])[touched]
        )
        self._model.geom_rgba[self._geoms] = colours
        return self._geoms[touched]

    def clear(self) -> None:
        """Give every geom its own colour."""
        self._model.geom_rgba[self._geoms] = self._plain


def _shown_colours(model: mujoco.MjModel, geoms: NDArray[np.int_]) -> Array:
    """Red, green and blue (N, 3) in which MuJoCo draws geoms: their own where they have any, or their material's."""
    own, material = model.geom_rgba[geoms], model.geom_matid[geoms]
    inherits = (own == _UNSET).all(axis=1) & (material >= 0)
    shown = own[:, :3].astype(np.float64)
    shown[inherits] = model.mat_rgba[material[inherits], :3]
    return shown
