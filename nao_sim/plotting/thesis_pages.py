"""Pictures of the thesis's learners: parameters, cost, learning rates, outputs, confusion, sparsity."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.gestures.held_out import confusion
from nao_sim.gestures.thesis.sections_descent import RATES
from nao_sim.gestures.thesis.sparsity import PAIR, SETS
from nao_sim.gestures.thesis.study import Study
from nao_sim.gestures.training_table import GESTURES
from nao_sim.imitation.features import FEATURES
from nao_sim.plotting.confusion import draw_confusion
from nao_sim.plotting.palette import LEFT, MIDDLE, RIGHT, SCALE
from nao_sim.plotting.style import Block, across, beside_each_other, narrow, save_page
from nao_sim.robot import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

    from nao_sim.plotting.style import Canvas

OURS, PUBLISHED, CONVERGED = LEFT, RIGHT, MIDDLE
PAIR_COLOURS = dict(zip(PAIR, (LEFT, RIGHT), strict=True))
_PANEL = 2.6  # in, least width of a panel
LONG = 200_000  # steps of the long cost curve


def save_pictures(study: Study, folder: Path) -> list[Path]:
    """Draw everything that has a picture.

    Args:
        study: what was computed.
        folder: where to.

    Returns:
        The files.

    Raises:
        UsageError: they cannot be written there.
    """
    paths = []
    for name, block in thesis_blocks(study).items():
        paths.append(folder / f"{name}.png")
        save_page([block], paths[-1])
    return paths


def save_study(study: Study, path: Path, size: str | None = None) -> None:
    """Draw everything on one page.

    Raises:
        UsageError: it cannot be written there.
    """
    save_page(list(thesis_blocks(study).values()), path, "The thesis, computed again", size=size)


def thesis_blocks(study: Study) -> dict[str, Block]:
    """Everything that has a picture, by its name."""
    drawn: dict[str, tuple[Callable[[Canvas, Study], None], float, int]] = {
        "parameters": (_parameters, 3.6, 2),
        "cost": (_cost, 3.4, 2),
        "rates": (_rates, 3.6, 1),
        "outputs": (_outputs, 3.6, 3),
        "confusion": (_confusion, 3.9, 3),
        "sparsity": (_sparsity, 6.4, 2),
    }

    def block(name: str, draw: Callable[[Canvas, Study], None], height: float, panels: int) -> Block:
        return Block(name, lambda canvas: draw(canvas, study), lambda width: height * -(-panels // _fit(panels, width)))

    return {name: block(name, *rest) for name, rest in drawn.items()}


def _fit(panels: int, width: float) -> int:
    return 1 if narrow(width) else beside_each_other(width, _PANEL, panels)


def _panels(canvas: Canvas, count: int) -> list[Axes]:
    """So many panels beside each other, as far as they fit."""
    columns = _fit(count, across())
    grid = canvas.add_gridspec(-(-count // columns), columns)
    return [canvas.add_subplot(grid[divmod(place, columns)]) for place in range(count)]


def _parameters(canvas: Canvas, study: Study) -> None:
    near, far = _panels(canvas, 2)
    places = np.arange(len(FEATURES) + 1)
    names = ["intercept", *FEATURES]
    near.bar(places - 0.2, study.figures.theta, 0.4, color=PUBLISHED, label="published, 50 rows")
    near.bar(places + 0.2, study.descent.theta_, 0.4, color=OURS, label="ours, 28 rows")
    near.set(title=f"After {study.figures.iterations} steps", ylabel="parameter")
    far.bar(places, study.closed.optimum, 0.6, color=CONVERGED, label="ours, 28 rows, converged")
    far.set(title="Converged")
    for axes in (near, far):
        axes.set_xticks(places, names, rotation=45, ha="right", rotation_mode="anchor")
        axes.axhline(0.0, color="black", linewidth=0.8)
        axes.legend()


def _cost(canvas: Canvas, study: Study) -> None:
    short, long = _panels(canvas, 2)
    rate = study.figures.learning_rate
    short.plot(study.descent.costs_, color=OURS, label=f"learning rate {rate}")
    steps = np.unique(np.geomspace(1, LONG, 400).astype(int))
    long.plot(steps, study.closed.cost(rate, steps), color=OURS, label=f"learning rate {rate}")
    long.axvline(study.figures.iterations, color=PUBLISHED, linewidth=1.0, label="where the thesis stopped")
    long.set(xscale="log", title="… and on")
    _plain_ticks(long.xaxis, np.array([1.0, 10.0, 100.0, 1e3, 1e4, 1e5]))
    short.set(title=f"The thesis's {study.figures.iterations} steps")
    for axes in (short, long):
        axes.axhline(study.closed.least_cost, color=CONVERGED, linestyle="--", label="converged")
        axes.set(xlabel="steps", ylabel="cost J", ylim=(0.0, None))
        axes.legend(loc="upper right")


def _rates(canvas: Canvas, study: Study) -> None:
    from matplotlib import colormaps

    axes = canvas.add_subplot()
    steps = np.arange(study.figures.iterations + 1)
    stable = [rate for rate in RATES if rate < study.closed.fastest_rate]
    for rate, colour in zip(stable, colormaps[SCALE](np.linspace(0.0, 0.9, len(stable))), strict=True):
        own = rate == study.figures.learning_rate
        label = f"{rate:g}, the thesis's" if own else f"{rate:g}"
        axes.plot(steps, study.closed.cost(rate, steps), color=colour, linewidth=2.6 if own else 1.3, label=label)
    axes.axhline(study.closed.least_cost, color=CONVERGED, linestyle="--", label="converged")
    limit = study.closed.fastest_rate
    axes.set(xlabel="steps", ylabel="cost J", yscale="log", title=f"Learning rates below {limit:.3f} converge")
    _plain_ticks(axes.yaxis, np.array([0.2, 0.5, 1.0, 2.0, 5.0]))
    axes.legend(title="learning rate", loc="center left", bbox_to_anchor=(1.0, 0.5))


def _plain_ticks(axis: Axis, values: Array) -> None:
    """Numbers on a logarithmic axis without powers of ten, which the style shows as text."""
    axis.set_ticks(values.tolist(), [f"{value:,g}" for value in values])
    axis.set_ticks([], minor=True)


def _outputs(canvas: Canvas, study: Study) -> None:
    angles = study.table.features_deg
    shown = {
        "Published parameters": study.output(study.figures.theta, angles),
        f"Ours after {study.figures.iterations} steps": study.descent.regress(angles),
        "Normal equation": study.normal.regress(angles),
    }
    panels = _panels(canvas, len(shown))
    for axes, (title, outputs) in zip(panels, shown.items(), strict=True):
        _draw_outputs(axes, study, outputs)
        axes.set(title=title, xlabel="gesture made")
    panels[0].set_ylabel("output, and the gesture it is rounded to")
    panels[0].legend(loc="upper left")


def _draw_outputs(axes: Axes, study: Study, outputs: Array) -> None:
    """Each row's output over its true class; right where it is in the shaded box."""
    for place, name in enumerate(GESTURES):
        low = -1.0 if place == 0 else place + 0.5
        high = len(GESTURES) + 1.5 if place == len(GESTURES) - 1 else place + 1.5
        axes.fill_between([place - 0.4, place + 0.4], low, high, color="#dceaf4", linewidth=0)
        own = outputs[study.table.labels == name]
        aside = np.linspace(-0.2, 0.2, len(own))
        right = (own >= low) & (own < high)
        axes.scatter(place + aside[right], own[right], s=16, color=OURS, label="right" if place == 0 else None)
        label = "wrong" if place == 0 else None
        axes.scatter(place + aside[~right], own[~right], s=16, color=PUBLISHED, marker="x", label=label)
    names = [f"{name} ({place + 1})" for place, name in enumerate(GESTURES)]
    axes.set_xticks(range(len(GESTURES)), GESTURES, rotation=45, ha="right", rotation_mode="anchor")
    axes.set_yticks(range(1, len(GESTURES) + 1), names)
    axes.set_ylim(-0.5, len(GESTURES) + 1.0)


def _confusion(canvas: Canvas, study: Study) -> None:
    trial = study.trials["normal equation"]
    labels = trial.held_out.labels
    shown = {
        "Published: 50 behaviours": study.figures.confusion,
        "Ours: its own 28 rows": confusion(labels, trial.own, GESTURES),
        "Ours: each user left out": confusion(labels, trial.held_out.predicted, GESTURES),
    }
    for axes, (title, matrix) in zip(_panels(canvas, len(shown)), shown.items(), strict=True):
        draw_confusion(axes, matrix, GESTURES)
        axes.set_title(f"{title},\n{np.trace(matrix)} right")


def _sparsity(canvas: Canvas, study: Study) -> None:
    """Left each feature by itself, right the rows where the features vary most: all ten, and the reduced ones."""
    if narrow():
        grid = np.array(_panels(canvas, 2 * len(SETS)), object).reshape(len(SETS), 2)
    else:
        grid = canvas.subplots(len(SETS), 2, width_ratios=(2.0, 1.0))
    for (each, plane), (name, features) in zip(grid, SETS.items(), strict=True):
        _draw_features(each, study, features)
        each.set_title(f"Side and piUp, {name} features ({len(features)})")
        _draw_plane(plane, study, features)
        plane.set_title("Where they vary most\n(numbers: users)")


def _draw_features(axes: Axes, study: Study, features: tuple[str, ...]) -> None:
    for aside, gesture in zip((-0.12, 0.12), PAIR, strict=True):
        rows = study.table.features_deg[study.table.labels == gesture]
        for place, name in enumerate(features):
            values = rows[:, FEATURES.index(name)]
            label = gesture if place == 0 else None
            axes.vlines(place + aside, values.min(), values.max(), color=PAIR_COLOURS[gesture], linewidth=0.8)
            axes.scatter(np.full(len(values), place + aside), values, s=14, color=PAIR_COLOURS[gesture], label=label)
    axes.set_xticks(range(len(features)), features)
    axes.set(ylabel="angle (°)", ylim=(-120.0, 235.0))
    axes.set_yticks(range(-90, 181, 45))
    axes.legend(loc="upper right", ncols=2)


def _draw_plane(axes: Axes, study: Study, features: tuple[str, ...]) -> None:
    """The first two principal components of both gestures' z-scores; the number is the user's."""
    columns = [FEATURES.index(name) for name in features]
    members = np.isin(study.table.labels, PAIR)
    values = study.z_scores(study.table.features_deg)[members][:, columns]
    centred = values - values.mean(axis=0)
    points = centred @ np.linalg.svd(centred, full_matrices=False)[2][:2].T
    for point, label, user in zip(points, study.table.labels[members], study.table.users[members], strict=True):
        axes.scatter(point[0], point[1], s=22, color=PAIR_COLOURS[label])
        axes.annotate(str(user), point, xytext=(4, 3), textcoords="offset points", fontsize="small")
    axes.set(xlabel="first principal component", ylabel="second")
