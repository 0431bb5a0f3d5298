"""A page about a recording of a person."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from nao_sim.health import together
from nao_sim.motion import Skeleton
from nao_sim.plotting.panels import MISSING, bones_seen, draw_bone, draw_confidence
from nao_sim.plotting.stick_figures import FRONT, SIDE, draw_strip, heights, key_frames, spacing
from nao_sim.plotting.style import LEFT, RIGHT, WIDTH, page

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ROW, _BONES = 0.12, 2.0  # in, a joint's row in the raster, and the panels of the bones
_STRIP = (1.3, 3.6)  # in, least and most height of a row of stick figures
_AROUND = 0.55  # in, title and labels of a panel


def person_page(skeleton: Skeleton) -> Figure:
    """Stick figures at some instants; joints seen and bones over time, where there is time.

    A person seen by one camera has a front only.
    """
    frames = key_frames(skeleton)
    views = {"from the front": FRONT} | ({} if skeleton.planar else {"from the right side": SIDE})
    low, high = heights(skeleton, frames)
    strip = float(np.clip(0.93 * WIDTH * (high - low) / (len(frames) * spacing(skeleton, frames)), *_STRIP)) + _AROUND
    moves = len(skeleton) > 1
    bones = bones_seen(skeleton) if moves else []
    raster = [_ROW * len(together(skeleton.joints)) + _AROUND] if moves else []
    rows = [strip] * len(views) + raster + [_BONES] * bool(bones)
    figure = page(sum(rows) + 0.5)
    grid = figure.add_gridspec(len(rows), 1, height_ratios=rows)
    for place, (title, across) in enumerate(views.items()):
        axes = figure.add_subplot(grid[place])
        draw_strip(axes, skeleton, frames, across)
        axes.set_title(title)
        if place == 0:
            _legend(axes, _sides())
    if moves:
        _raster(figure, figure.add_subplot(grid[len(views)]), skeleton)
    if bones:
        inner = grid[len(views) + 1].subgridspec(1, len(bones))
        for place, name in enumerate(bones):
            draw_bone(figure.add_subplot(inner[place]), skeleton, name)
    return figure


def _raster(figure: Figure, axes: Axes, skeleton: Skeleton) -> None:
    from matplotlib.patches import Patch

    mesh = draw_confidence(axes, skeleton)
    axes.set_title("confidence")
    bar = figure.colorbar(mesh, ax=axes, pad=0.01, fraction=0.02, ticks=[0.0, 0.5, 1.0])
    bar.ax.tick_params(labelsize=7.5, length=0)
    bar.outline.set_visible(False)
    _legend(axes, [Patch(facecolor=MISSING, label="missing")])


def _sides() -> list[Any]:
    from matplotlib.lines import Line2D

    sides = {"the person's left": LEFT, "the person's right": RIGHT}
    return [Line2D([], [], color=colour, linewidth=2.2, label=label) for label, colour in sides.items()]


def _legend(axes: Axes, handles: list[Any]) -> None:
    """Beside the title."""
    axes.legend(handles=handles, ncols=len(handles), loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.1)
