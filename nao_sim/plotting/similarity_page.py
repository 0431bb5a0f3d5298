"""A page about an imitation: how far the arms are from the person's over time, at every stage."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.plotting.style import page, save, styled
from nao_sim.robot import Array

if TYPE_CHECKING:
    from nao_sim.imitation.similarity import Similarity

NEAREST = "nearest"
# M. Okabe and K. Ito, Color Universal Design (2008): told apart by colour-blind people, too.
_COLOURS = {"requested": "#56B4E9", "commanded": "#E69F00", "simulated": "#009E73", NEAREST: "black"}


def save_similarity_plot(score: Similarity, title: str, path: Path) -> None:
    """Draw the mean angle between the arms over time, for each stage and NAO's nearest pose.

    Args:
        score: what to draw.
        title: what is imitated, and by what.
        path: a `.png`, `.svg` or `.pdf`.

    Raises:
        UsageError: it cannot be written there.
    """
    lines = {stage: part.direction_errors for stage, part in score.stages.items()} | {NEAREST: score.limits}
    with styled():
        figure = page(4.0)
        axes = figure.add_subplot()
        for name, errors in lines.items():
            style = ":" if name == NEAREST else "-"
            axes.plot(score.times, np.degrees(_mean(errors)), label=name, color=_COLOURS[name], linestyle=style)
        axes.set(xlabel="time of the robot (s)", ylabel="angle between the arms (°)", ylim=(0.0, None))
        axes.legend(loc="upper right")
        figure.suptitle(title, x=0.01, ha="left", fontsize=11)
        save(figure, path)


def _mean(errors: Array) -> Array:
    """The mean (T,) of what is known of errors (T, 2, 2)."""
    known = np.isfinite(errors)
    total, count = np.where(known, errors, 0.0).sum(axis=(1, 2)), known.sum(axis=(1, 2))
    return np.divide(total, count, out=np.full(len(total), np.nan), where=count > 0)
