"""The parts of a picture, painted side by side or one over the other, and what is written over all of them."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from nao_sim.rendering.arrangements import View
from nao_sim.rendering.captions import Captions
from nao_sim.rendering.painter import Painter, Picture
from nao_sim.rendering.preset_kinds import Quality, Shadow
from nao_sim.rendering.tint import Tint

_BORDER = (235, 238, 242)


class Panels:
    """Paints pictures of several views of one model; as many OpenGL contexts as views, all on one thread.

    Args:
        model: path of the compiled model.
        size: (width, height) in pixels of what is painted, supersampling included.
        views: the parts of the picture, later ones over earlier ones.
        quality: what is drawn.
        shadow: the square that has shadows.
        tint: what may take colour or be written, if anything.

    Raises:
        UsageError: the model has no camera of that name.
    """

    def __init__(
        self,
        model: str,
        size: tuple[int, int],
        views: tuple[View, ...],
        quality: Quality,
        shadow: Shadow,
        tint: Tint | None = None,
    ) -> None:
        self._tint, self._views, self._size = tint or Tint(), views, size
        self._boxes = [view.box(size) for view in views]
        models = [mujoco.MjModel.from_binary_path(model) for _ in views]  # painters change theirs
        self._painters = [
            Painter(each, box[2:], view.camera, quality, shadow, tint=tint)
            for each, box, view in zip(models, self._boxes, views, strict=True)
        ]
        self._buffers = [np.empty((height, width, 3), np.uint8) for _, _, width, height in self._boxes]
        self._nq = models[0].nq
        self._captions = Captions(self._tint.script, size)
        self._seen: NDArray[np.float64] | None = None

    def paint(self, row: NDArray[np.float64], out: Picture) -> None:
        """Paint a row into `out` (height, width, 3): each view's pose, each camera's numbers, the tint's."""
        seen, written = np.split(row, [len(row) - self._tint.script.width])
        if self._seen is None or not np.array_equal(seen, self._seen):  # a clock ticks on while nothing moves
            self._paint_views(seen)
            self._seen = seen.copy()
        for buffer, box, view in zip(self._buffers, self._boxes, self._views, strict=True):
            self._insert(buffer, box, view, out)
        self._captions.draw(written, out)

    def _paint_views(self, seen: NDArray[np.float64]) -> None:
        covers = seen[len(seen) - self._tint.covers :]
        posed, turned = 0, self._nq * len(self._views)
        for painter, buffer, view in zip(self._painters, self._buffers, self._views, strict=True):
            own = seen[posed : posed + self._nq], seen[turned : turned + view.camera.width], covers
            painter.paint(np.concatenate(own), buffer)
            posed, turned = posed + self._nq, turned + view.camera.width

    def _insert(self, buffer: Picture, box: tuple[int, int, int, int], view: View, out: Picture) -> None:
        left, top, width, height = box
        place = out[top : top + height, left : left + width]
        place[:] = buffer
        if view.border:
            line = max(1, round(view.border * self._size[1]))
            for edge in _inner_edges(box, self._size, line):
                place[edge] = _BORDER


def _inner_edges(box: tuple[int, int, int, int], size: tuple[int, int], line: int) -> list[tuple[slice, slice]]:
    """The edges of a part that are not edges of the picture, `line` pixels wide."""
    left, top, width, height = box
    every = slice(None)
    edges = [
        ((slice(0, line), every), top > 0),
        ((slice(-line, None), every), top + height < size[1]),
        ((every, slice(0, line)), left > 0),
        ((every, slice(-line, None)), left + width < size[0]),
    ]
    return [edge for edge, is_inner in edges if is_inner]
