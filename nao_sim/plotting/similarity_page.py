"""An imitation over time: how far the arms are from the person's at every stage, and how alike the bodies are."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from nao_sim.plotting.lines import draw_over_time, shade_handles
from nao_sim.plotting.palette import NEAREST, STAGE_LINES, STAGE_WIDTHS, STAGES
from nao_sim.plotting.style import Block, legend_above, narrow, save_page
from nao_sim.robot import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from nao_sim.imitation.similarity import Similarity
    from nao_sim.plotting.style import Canvas

_LABELS = {NEAREST: "NAO's nearest pose"}
_ANGLE = "angle between the arms (°)"


def save_similarity_plot(score: Similarity, title: str, path: Path, size: str | None = None) -> None:
    """Draw the score over time.

    Args:
        score: what to draw.
        title: what is imitated, and by what.
        path: a `.png`, `.svg` or `.pdf`.
        size: a name of `SIZES`; what suits the kind of file where None.

    Raises:
        UsageError: it cannot be written there.
    """
    save_page([similarity_block(score)], path, title, size=size)


def similarity_block(score: Similarity) -> Block:
    """Above the mean angle between the arms, at each stage and of NAO's nearest pose; below both similarities."""

    def draw(canvas: Canvas) -> None:
        angles, alike = canvas.subplots(2, 1, sharex=True, height_ratios=(1.4, 1.0))
        _draw_angles(angles, score)
        _draw_similarities(alike, score)
        if len(score.times):
            alike.set_xlim(score.times[0], max(score.times[-1], score.times[0] + 1e-3))
        alike.set_xlabel("time of the robot (s)")
        if shades := shade_handles(score.times):
            canvas.legend(handles=shades, loc="outside lower left")

    return Block("similarity over time", draw, lambda width: 5.2 if narrow(width) else 4.6)


def _draw_angles(axes: Axes, score: Similarity) -> None:
    lines = {stage: part.direction_errors for stage, part in score.stages.items()} | {NEAREST: score.limits}
    for name in sorted(lines, key=lambda name: -STAGE_WIDTHS[name]):
        errors = np.degrees(_mean(lines[name].reshape(len(score.times), -1)))
        draw_over_time(axes, score.times, errors, **stage_look(name), label=_LABELS.get(name, name))
    axes.set(ylabel=_ANGLE, ylim=(0.0, None))
    _legend(axes, "arms", [_LABELS.get(name, name) for name in STAGES if name in lines])


def _draw_similarities(axes: Axes, score: Similarity) -> None:
    stage = list(score.stages)[-1]
    kinds = {"whole body (WBF)": ("-", score.stages[stage].wbf), "each link (LLF)": ("--", score.stages[stage].llf)}
    for label, (line, cosines) in kinds.items():
        look = stage_look(stage) | {"linestyle": line, "linewidth": 1.3}
        draw_over_time(axes, score.times, _mean(cosines), **look, label=label)
    axes.set(ylabel="mean cosine (1: alike)")
    lowest, _ = axes.get_ylim()
    axes.set_ylim(max(min(lowest, 0.9), -1.05), 1.02)
    _legend(axes, f"similarity, {stage}", list(kinds))


def _legend(axes: Axes, title: str, labels: list[str]) -> None:
    """Lines in an order, above at the right; on a narrow page there is no room for a title beside them."""
    handles, names = axes.get_legend_handles_labels()
    found = dict(zip(names, handles, strict=True))
    legend_above(axes, [found[label] for label in labels], 2 if narrow() else None)
    if not narrow():
        axes.set_title(title)


def stage_look(name: str) -> dict[str, Any]:
    """How a line of a stage is drawn."""
    return {"color": STAGES[name], "linestyle": STAGE_LINES[name], "linewidth": STAGE_WIDTHS[name]}


def _mean(values: Array) -> Array:
    """The mean (T,) of what is known of values (T, N); nan where nothing is."""
    known = np.isfinite(values)
    total, count = np.where(known, values, 0.0).sum(axis=1), known.sum(axis=1)
    return np.divide(total, count, out=np.full(len(total), np.nan), where=count > 0)
