"""Values over time: gaps stay gaps, a lone value is a dot, and an hour can be read."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nao_sim.health import GAP
from nao_sim.plotting.palette import MIDDLE
from nao_sim.robot import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLUMNS = 1200  # that a picture can show
_STRETCHES = 800  # of a line that is too long to be drawn value by value
_WHOLE = 10_000  # values; as many are drawn as they are
_PALE = 0.3


@dataclass(frozen=True, eq=False)
class Stretches:
    """Values over time, S stretches of it; not a number where a stretch has no finite one.

    Attributes:
        times: (S,) s, the middle of each.
        lowest: (S,) the smallest value.
        middle: (S,) the median.
        highest: (S,) the largest value.
    """

    times: Array
    lowest: Array
    middle: Array
    highest: Array


def draw_over_time(axes: Axes, times: Array, values: Array, **look: Any) -> None:
    """Draw values (T,) over times (T,) s.

    A line breaks where they are not finite, and a lone value is a dot.  Of many a shade shows from the smallest to the
    largest in each stretch, and the line is their median.
    """
    if is_long(values):
        parts = stretches(times, values)
        shade = {"color": look.get("color"), "alpha": _PALE, "linewidth": 0.0, "zorder": look.get("zorder", 1.8)}
        axes.fill_between(parts.times, parts.lowest, parts.highest, **shade)
        times, values = parts.times, parts.middle
    axes.plot(times, values, **look)
    alone = lone(values)
    if alone.any():
        dots = {key: look[key] for key in ("color", "zorder", "alpha") if key in look}
        size = 1.0 + 1.5 * float(look.get("linewidth", 1.3))
        axes.plot(times[alone], values[alone], linestyle="none", marker="o", markersize=size, **dots)


def is_long(values: Array) -> bool:
    """Whether values (T,) are too many to be drawn one by one."""
    return len(values) > _WHOLE


def shade_handles(values: Array) -> list[Any]:
    """What a legend says of the shades of values (T,), if they have any."""
    from matplotlib.patches import Patch

    words = "long: median of each stretch, shaded from smallest to largest"
    return [Patch(facecolor=MIDDLE, alpha=_PALE, linewidth=0.0, label=words)] if is_long(values) else []


def stretches(times: Array, values: Array, most: int = _STRETCHES) -> Stretches:
    """Values (T,) over times (T,) s by stretches of about as many frames, `most` at most."""
    edges = np.linspace(0, len(values), min(most, len(values)) + 1).astype(int)
    known = np.where(np.isfinite(values), values, np.nan)
    rows = np.full((3, len(edges) - 1), np.nan)
    for place, (start, end) in enumerate(pairwise(edges.tolist())):
        piece = known[start:end]
        if np.isfinite(piece).any():
            rows[:, place] = np.nanmin(piece), np.nanmedian(piece), np.nanmax(piece)
    return Stretches((times[edges[:-1]] + times[edges[1:] - 1]) / 2.0, *rows)


def lone(values: Array) -> NDArray[np.bool_]:
    """(T,) finite values with none beside them."""
    around = np.concatenate([[False], np.isfinite(values), [False]])
    return np.asarray(around[1:-1] & ~around[:-2] & ~around[2:])


def with_breaks(times: Array, values: Array) -> tuple[Array, Array]:
    """Times and values with a gap in every pause between frames."""
    if len(times) < 2:  # noqa: PLR2004
        return times, values
    intervals = np.diff(times)
    pauses = np.flatnonzero(intervals > GAP * np.median(intervals)) + 1
    return np.insert(times, pauses, times[pauses]), np.insert(values, pauses, np.nan)


def visible(spells: Array, run: float) -> list[tuple[float, float]]:
    """Spells (N, 2), starts and ends in s, as starts and lengths that a picture of a `run` (s) can show.

    None is narrower than a column of the picture, and those nearer than that are one.
    """
    if not len(spells):
        return []
    least = run / COLUMNS
    starts, ends = spells[:, 0], np.maximum(spells[:, 1], spells[:, 0] + least)
    apart = np.flatnonzero(starts[1:] - ends[:-1] >= least)
    firsts, lasts = np.append(0, apart + 1), np.append(apart, len(spells) - 1)
    return list(zip(starts[firsts].tolist(), (ends[lasts] - starts[firsts]).tolist(), strict=True))
