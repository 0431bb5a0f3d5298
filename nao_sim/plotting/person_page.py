"""A page about a recording of a person."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nao_sim.health import together
from nao_sim.motion import Skeleton
from nao_sim.plotting.palette import LEFT, MISSING, RIGHT
from nao_sim.plotting.panels import bones_seen, draw_bone, draw_confidence
from nao_sim.plotting.stick_figures import FRONT, SIDE, draw_strip, heights, key_frames, spacing
from nao_sim.plotting.style import Block, legend_above, narrow, stacked

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from nao_sim.plotting.style import Canvas

_ROW, _BONES = 0.12, 2.0  # in, a joint's row in the raster, and the panels of the bones
_STRIP = (1.3, 3.6)  # in, least and most height of a row of stick figures
_AROUND = 0.55  # in, title and labels of a panel
_FIGURES, _FEWER = 6, 4  # in a row, and in one of a narrow page


def person_page(skeleton: Skeleton) -> Figure:
    """Stick figures at some instants; joints seen and bones over time, where there is time."""
    return stacked(person_blocks(skeleton))


def person_blocks(skeleton: Skeleton) -> list[Block]:
    """Of what the page is made; a person seen by one camera has a front only."""
    views = {"from the front": FRONT} | ({} if skeleton.planar else {"from the right side": SIDE})
    blocks = [
        Block(title, partial(_strip, skeleton=skeleton, title=title, across=view, legend=place == 0),
              partial(_strip_height, skeleton))
        for place, (title, view) in enumerate(views.items())
    ]  # fmt: skip
    if len(skeleton) > 1:
        height = _ROW * len(together(skeleton.joints)) + _AROUND
        blocks.append(Block("confidence", partial(_raster, skeleton=skeleton), lambda _: height))
        if bones := bones_seen(skeleton):
            draw = partial(_bones, skeleton=skeleton, names=bones)
            blocks.append(Block("bones", draw, lambda width: _BONES * -(-len(bones) // _side_by_side(bones, width))))
    return blocks


def _frames(skeleton: Skeleton, width: float | None = None) -> NDArray[np.intp]:
    return key_frames(skeleton, _FEWER if narrow(width) else _FIGURES)


def _strip_height(skeleton: Skeleton, width: float) -> float:
    frames = _frames(skeleton, width)
    low, high = heights(skeleton, frames)
    natural = 0.93 * width * (high - low) / (len(frames) * spacing(skeleton, frames))
    return float(np.clip(natural, *_STRIP)) + _AROUND


def _strip(canvas: Canvas, *, skeleton: Skeleton, title: str, across: int, legend: bool) -> None:
    axes = canvas.add_subplot()
    draw_strip(axes, skeleton, _frames(skeleton), across)
    axes.set_title(title)
    if legend:
        legend_above(axes, _sides(), 1 if narrow() else None)


def _raster(canvas: Canvas, *, skeleton: Skeleton) -> None:
    from matplotlib.patches import Patch

    axes = canvas.add_subplot()
    mesh = draw_confidence(axes, skeleton)
    axes.set_title("confidence")
    bar = canvas.colorbar(mesh, ax=axes, pad=0.01, fraction=0.02, ticks=[0.0, 0.5, 1.0])
    bar.ax.tick_params(labelsize="small", length=0)
    bar.outline.set_visible(False)
    legend_above(axes, [Patch(facecolor=MISSING, label="missing")])


def _bones(canvas: Canvas, *, skeleton: Skeleton, names: list[str]) -> None:
    columns = _side_by_side(names)
    grid = canvas.add_gridspec(-(-len(names) // columns), columns)
    for place, name in enumerate(names):
        draw_bone(canvas.add_subplot(grid[divmod(place, columns)]), skeleton, name)


def _side_by_side(names: list[str], width: float | None = None) -> int:
    return min(len(names), 2) if narrow(width) else len(names)


def _sides() -> list[Any]:
    from matplotlib.lines import Line2D

    sides = {"the person's left": LEFT, "the person's right": RIGHT}
    return [Line2D([], [], color=colour, linewidth=2.2, label=label) for label, colour in sides.items()]
