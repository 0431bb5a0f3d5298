"""What a recording of a person is like over time: when each joint is seen, and how long the bones are."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nao_sim import body
from nao_sim.health import GAP, bone_lengths, together
from nao_sim.motion import Skeleton
from nao_sim.plotting.lines import COLUMNS, draw_over_time, with_breaks
from nao_sim.plotting.palette import CONFIDENCE, MISSING, SHADE, SIDE_COLOURS, SIDE_WIDTHS
from nao_sim.plotting.style import side_of
from nao_sim.robot import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh
    from matplotlib.colors import Colormap

BONES = {"upper arm": ("shoulder", "elbow"), "forearm": ("elbow", "wrist"), "thigh": ("hip", "knee"),
         "shank": ("knee", "ankle")}  # fmt: skip


def draw_confidence(axes: Axes, skeleton: Skeleton) -> QuadMesh:
    """Confidence by joint and time, below 0 where a joint is missing; nothing where there is no frame.

    Returns:
        The mesh, for a colour bar.
    """
    rows = together(skeleton.joints)
    edges, frames = columns(skeleton.times)
    values = np.stack([skeleton.confidence[:, members].mean(axis=1) for members in rows.values()])
    means = np.stack([values[:, start:end].mean(axis=1) for start, end in frames], axis=1)
    cells = np.full((len(rows), len(edges) - 1), np.nan)
    cells[:, ::2] = np.where(means > 0.0, means, -1.0)
    mesh = axes.pcolormesh(
        edges, np.arange(len(rows) + 1), cells, cmap=_colours(), vmin=0.0, vmax=1.0, rasterized=True, linewidth=0
    )
    axes.set_facecolor(SHADE)
    axes.set_yticks(np.arange(len(rows)) + 0.5, [row.replace("_", " ") for row in rows], fontsize="x-small")
    for label, row in zip(axes.get_yticklabels(), rows, strict=True):
        label.set_color(SIDE_COLOURS[side_of(row)])
    axes.set(ylim=(len(rows), 0), xlabel="time (s)", xlim=(edges[0], edges[-1]))
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False)
    axes.hlines(np.arange(1, len(rows)), edges[0], edges[-1], color="white", linewidth=0.7)
    return mesh


def _colours() -> Colormap:
    """What is well is pale, what is missing dark, so that a glance finds it."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("confidence", CONFIDENCE).with_extremes(under=MISSING)


def columns(times: Array, most: int = COLUMNS) -> tuple[Array, NDArray[np.int_]]:
    """A picture's columns, with nothing in every second one: the pauses between frames, mostly of no width.

    Returns:
        (2 C,) s, where columns begin and end, C at most `most`; (C, 2) their first frame and the one after the last.
    """
    typical = float(np.median(np.diff(times)))
    before = np.minimum(np.diff(times, prepend=times[0] - typical), GAP * typical) / 2.0
    after = np.minimum(np.diff(times, append=times[-1] + typical), GAP * typical) / 2.0
    step = -(-len(times) // most)
    starts = np.arange(0, len(times), step)
    ends = np.minimum(starts + step, len(times))
    edges = np.stack([times[starts] - before[starts], times[ends - 1] + after[ends - 1]], axis=1)
    return edges.ravel(), np.stack([starts, ends], axis=1)


def bones_seen(skeleton: Skeleton) -> list[str]:
    """Which of `BONES` the recording has, on either side."""
    return [name for name in BONES if any(np.isfinite(each).any() for each in _lengths(skeleton, name).values())]


def draw_bone(axes: Axes, skeleton: Skeleton, name: str) -> None:
    """Length of a bone of both sides over time."""
    highest = 1.0
    for side, lengths in _lengths(skeleton, name).items():
        if np.isfinite(lengths).any():
            times, shown = with_breaks(skeleton.times, 100.0 * lengths)
            draw_over_time(axes, times, shown, color=SIDE_COLOURS[side], linewidth=SIDE_WIDTHS[side])
            usual, long = np.nanquantile(100.0 * lengths, [0.5, 0.95])  # outliers may leave the picture
            highest = max(highest, 1.5 * float(usual), 1.2 * float(long))
    axes.set(title=name, xlabel="time (s)", ylabel="length (cm)", ylim=(0.0, highest))
    axes.set_xlim(skeleton.times[0], skeleton.times[-1])


def _lengths(skeleton: Skeleton, name: str) -> dict[str, Array]:
    start, end = BONES[name]
    return {side: bone_lengths(skeleton, body.Bone(f"{side}_{start}", f"{side}_{end}", np.nan)) for side in body.SIDES}
