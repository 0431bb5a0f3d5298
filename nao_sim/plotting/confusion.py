"""What was taken for what."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from nao_sim.plotting.palette import SHARES

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LIGHT = 0.6  # of the darkest cell, from which on its number is white


def draw_confusion(
    axes: Axes, matrix: Any, classes: Sequence[str], size: str | None = None, made: Sequence[str] | None = None
) -> None:
    """Draw counts (R, K): rows are the true classes, columns those predicted; shades are shares of a row.

    Args:
        axes: where.
        matrix: the counts.
        classes: (K,) names of the columns.
        size: of the numbers and names, as matplotlib calls it; the style's own where None.
        made: (R,) names of the rows; the columns' where None.
    """
    made = classes if made is None else made
    shares = matrix / np.maximum(matrix.sum(axis=1, keepdims=True), 1)
    axes.imshow(shares, cmap=SHARES, vmin=0.0, vmax=1.0)
    for row, column in np.argwhere(matrix > 0).tolist():
        colour = "white" if shares[row, column] > _LIGHT else "black"
        axes.text(column, row, str(matrix[row, column]), ha="center", va="center", color=colour, fontsize=size)
    axes.set_xticks(range(len(classes)), classes, rotation=45, ha="right", rotation_mode="anchor", fontsize=size)
    axes.set_yticks(range(len(made)), made, fontsize=size)
    axes.set(xlabel="recognised", ylabel="made")
    axes.grid(visible=False)
