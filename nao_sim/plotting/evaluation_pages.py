"""Pictures of an evaluation: what was taken for what, who was recognised how well, learners side by side."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.gestures.evaluation.outcome import Outcome
from nao_sim.gestures.shares import Share
from nao_sim.plotting.confusion import draw_confusion
from nao_sim.plotting.style import LEFT, MIDDLE, RIGHT, page, save, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MANY = 24  # classes, from which on a matrix takes most of the page
LONGEST_NAME = 24  # characters
_SMALL = 5.5  # pt
_SHARE = "share (%), with 95 % interval"


def save_confusion(outcome: Outcome, title: str, path: Path) -> None:
    """Draw what was taken for what, and beside it how many of each gesture were recognised.

    Raises:
        UsageError: it cannot be written there.
    """
    classes, many = [_short(name) for name in outcome.classes], len(outcome.classes) > MANY
    shown = np.flatnonzero(outcome.confusion.sum(axis=1))
    with styled():
        figure = page(max(3.6, (0.2 if many else 0.36) * len(shown) + 2.0))
        matrix, bars = figure.subplots(1, 2, width_ratios=(3.0, 1.0) if many else (1.3, 1.0))
        size = _SMALL if many else None
        draw_confusion(matrix, outcome.confusion[shown], classes, size, [classes[place] for place in shown])
        matrix.set_aspect("auto" if many else "equal")
        matrix.set_title("How often each was taken for each")
        shares = {each.label: each.recall for each in outcome.by_classes}
        if outcome.false_alarms.count:
            quiet = outcome.false_alarms
            shares["none"] = Share(quiet.count - quiet.right, quiet.count)
        _draw_shares(bars, shares, size)
        bars.set_title("Recognised, of each")
        figure.suptitle(title, x=0.01, ha="left", fontsize=11)
        save(figure, path)


def save_users(outcome: Outcome, title: str, path: Path) -> None:
    """Draw how many gestures of each user were recognised, the worst first, beside the share of all.

    Raises:
        UsageError: it cannot be written there.
    """
    with styled():
        users = outcome.by_users
        figure = page(max(2.6, 0.28 * len(users) + 1.4))
        axes = figure.add_subplot()
        _draw_shares(axes, users)
        axes.axvline(100.0 * outcome.accuracy.value, color=MIDDLE, linestyle="--", label="all users")
        axes.set_ylabel("user")
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
        figure.suptitle(title, x=0.01, ha="left", fontsize=11)
        save(figure, path)


def save_learners(outcomes: Mapping[str, Outcome], title: str, path: Path) -> None:
    """Draw learners side by side: recognised, with none as an answer and without.

    Raises:
        UsageError: it cannot be written there.
    """
    with styled():
        figure = page(0.42 * len(outcomes) + 1.6)
        axes = figure.add_subplot()
        _draw_shares(axes, {name: each.accuracy for name, each in outcomes.items()}, label="told none counts as wrong")
        places = [place for place, each in enumerate(outcomes.values()) if each.told_none.right]
        forced = [100.0 * each.forced.value for each in outcomes.values() if each.told_none.right]
        axes.plot(forced, places, "D", color=RIGHT, markersize=5.0, fillstyle="none", label="none is no answer")
        axes.set_ylabel("learner")
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
        figure.suptitle(title, x=0.01, ha="left", fontsize=11)
        save(figure, path)


def _draw_shares(axes: Axes, shares: Mapping[str, Share], size: float | None = None, label: str | None = None) -> None:
    """A line for each share from 0 to 100 %, the first on top, and whiskers of its interval."""
    values = np.array([share.value for share in shares.values()])
    bounds = np.array([share.interval for share in shares.values()])
    places = np.arange(len(shares))
    axes.errorbar(
        100.0 * values, places, xerr=100.0 * np.stack([values - bounds[:, 0], bounds[:, 1] - values]).clip(0.0),
        fmt="o", color=LEFT, markersize=4.0, elinewidth=1.2, capsize=2.0, label=label,
    )  # fmt: skip
    axes.set_yticks(places, [_named(name, share) for name, share in shares.items()], fontsize=size)
    axes.set(xlim=(-2.0, 102.0), ylim=(len(shares) - 0.5, -0.5), xlabel=_SHARE)


def _named(name: str, share: Share) -> str:
    return f"{_short(name)} ({share.right}/{share.count})"


def _short(name: str) -> str:
    return name if len(name) <= LONGEST_NAME else f"{name[: LONGEST_NAME - 1]}…"
