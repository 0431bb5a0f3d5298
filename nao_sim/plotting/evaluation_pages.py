"""Pictures of an evaluation: what was taken for what, who was recognised how well, learners side by side."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.gestures.evaluation.outcome import Outcome
from nao_sim.gestures.shares import Share
from nao_sim.plotting.confusion import draw_confusion
from nao_sim.plotting.palette import LEFT, MIDDLE, RIGHT
from nao_sim.plotting.style import Block, narrow, save_page, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from nao_sim.gestures.evaluation.evaluate import Evaluation
    from nao_sim.plotting.style import Canvas

MANY = 24  # classes, from which on a matrix takes most of the page
LONGEST_NAME = 24  # characters
_LONGEST_NARROW = 12
_SHARE = "share (%), with 95 % interval"


def save_confusion(outcome: Outcome, title: str, path: Path, size: str | None = None) -> None:
    """Draw what was taken for what, and beside it how many of each gesture were recognised.

    Raises:
        UsageError: it cannot be written there.
    """
    save_page([confusion_block(outcome)], path, title, size=size)


def save_users(outcome: Outcome, title: str, path: Path, size: str | None = None) -> None:
    """Draw how many gestures of each user were recognised, the worst first, beside the share of all.

    Raises:
        UsageError: it cannot be written there.
    """
    save_page([users_block(outcome)], path, title, size=size)


def save_learners(outcomes: Mapping[str, Outcome], title: str, path: Path, size: str | None = None) -> None:
    """Draw learners side by side: recognised, with none as an answer and without.

    Raises:
        UsageError: it cannot be written there.
    """
    save_page([learners_block(outcomes)], path, title, size=size)


def save_evaluation(found: Evaluation, path: Path, size: str | None = None) -> None:
    """Draw all of an evaluation on one page.

    Raises:
        UsageError: it cannot be written there.
    """
    shown = [f"{kind} by {part.focus} {part.shown.accuracy} right" for kind, part in found.parts.items()]
    title = "; ".join([*shown, found.plan.words])
    save_page(list(evaluation_blocks(found).values()), path, title[:1].upper() + title[1:], size=size)


def save_training(
    counts: Mapping[str, tuple[int, int]], judged: Evaluation | None, path: Path, size: str | None = None
) -> None:
    """Draw what was learned from, and how well users left out are recognised, where that is known.

    Args:
        counts: of each gesture the examples, and the users who made them.
        judged: by users left out.
        path: a `.png`, `.svg` or `.pdf`.
        size: a name of `SIZES`; what suits the kind of file where None.

    Raises:
        UsageError: it cannot be written there.
    """
    blocks = [examples_block(counts), *(evaluation_blocks(judged).values() if judged else ())]
    words = "what was learned from" + (", and how well users left out are recognised" if judged else "")
    save_page(blocks, path, words[:1].upper() + words[1:], size=size)


def evaluation_blocks(found: Evaluation) -> dict[str, Block]:
    """Every picture of an evaluation by the name that the text has for it."""
    blocks = {}
    for kind, part in found.parts.items():
        blocks[f"{kind}_confusion"] = confusion_block(part.shown, kind)
        if len(part.shown.by_users) > 1:
            blocks[f"{kind}_users"] = users_block(part.shown, kind)
        if len(part.outcomes) > 1:
            blocks[f"{kind}_learners"] = learners_block(part.outcomes, kind)
    return blocks


def confusion_block(outcome: Outcome, kind: str = "gestures") -> Block:
    """What was taken for what, and beside or below it how many of each of a kind were recognised."""
    many, shown = len(outcome.classes) > MANY, np.flatnonzero(outcome.confusion.sum(axis=1))
    natural = max(3.6, (0.2 if many else 0.36) * len(shown) + 2.0)

    def draw(canvas: Canvas) -> None:
        size = "xx-small" if many else "x-small" if narrow() else None
        classes = [_short(name) for name in outcome.classes]
        matrix, bars = _two(canvas, (3.0, 1.0) if many else (1.3, 1.0))
        draw_confusion(matrix, outcome.confusion[shown], classes, size, [classes[place] for place in shown])
        matrix.set_aspect("auto" if many else "equal")
        matrix.set_title(f"{kind.capitalize()}: taken for each other how often")
        _draw_shares(bars, _recalls(outcome), size)
        bars.set_title("Recognised, of each")

    return Block("what was taken for what", draw, lambda width: natural * (2.0 if narrow(width) else 1.0))


def _two(canvas: Canvas, widths: tuple[float, float]) -> tuple[Axes, Axes]:
    """Two panels beside each other, or below each other on a narrow page."""
    first, second = canvas.subplots(2, 1) if narrow() else canvas.subplots(1, 2, width_ratios=widths)
    return first, second


def _recalls(outcome: Outcome) -> dict[str, Share]:
    shares = {each.label: each.recall for each in outcome.by_classes}
    if outcome.false_alarms.count:
        quiet = outcome.false_alarms
        shares["none"] = Share(quiet.count - quiet.right, quiet.count)
    return shares


def users_block(outcome: Outcome, kind: str = "gestures") -> Block:
    """How many gestures of each user were recognised, the worst first, beside the share of all."""
    users = outcome.by_users

    def draw(canvas: Canvas) -> None:
        axes = canvas.add_subplot()
        _draw_shares(axes, users)
        axes.axvline(100.0 * outcome.accuracy.value, color=MIDDLE, linestyle="--", label="all users")
        axes.set_ylabel("user")
        _legend(axes, f"{kind.capitalize()}: each user")

    return Block("who was recognised how well", draw, lambda _: max(2.6, 0.28 * len(users) + 1.4))


def learners_block(outcomes: Mapping[str, Outcome], kind: str = "gestures") -> Block:
    """Learners side by side: recognised, with none as an answer and without."""

    def draw(canvas: Canvas) -> None:
        axes = canvas.add_subplot()
        _draw_shares(axes, {name: each.accuracy for name, each in outcomes.items()}, label="told none counts as wrong")
        places = [place for place, each in enumerate(outcomes.values()) if each.told_none.right]
        forced = [100.0 * each.forced.value for each in outcomes.values() if each.told_none.right]
        axes.plot(
            forced, places, "D", linestyle="none", color=RIGHT, markersize=5.0, fillstyle="none",
            label="none is no answer",
        )  # fmt: skip
        axes.set_ylabel("learner")
        _legend(axes, f"{kind.capitalize()}: each learner")

    return Block("learners side by side", draw, lambda _: 0.42 * len(outcomes) + 1.8)


def examples_block(counts: Mapping[str, tuple[int, int]]) -> Block:
    """How many examples of each gesture there were to learn from, and by how many users: label to both numbers."""

    def draw(canvas: Canvas) -> None:
        from matplotlib.ticker import MaxNLocator

        axes = canvas.add_subplot()
        places = np.arange(len(counts))
        examples, users = np.array(list(counts.values()), int).reshape(-1, 2).T
        axes.barh(places, examples, 0.6, color=LEFT, label="examples")
        axes.plot(users, places, "D", color=RIGHT, markersize=5.0, label="users")
        axes.set_yticks(places, [_short(name) for name in counts])
        axes.set(xlabel="number of examples and of users", ylabel="gesture", ylim=(len(counts) - 0.5, -0.5))
        axes.set_xlim(0.0, None)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        _legend(axes, "Learned from")

    return Block("what was learned from", draw, lambda _: max(2.2, 0.3 * len(counts) + 1.4))


def _legend(axes: Axes, title: str) -> None:
    """Where nothing is drawn: beside the plot, or above it on a narrow page, where a title is the page's matter."""
    if narrow():
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=1, borderaxespad=0.2)
    else:
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
        axes.set_title(title)


def _draw_shares(axes: Axes, shares: Mapping[str, Share], size: str | None = None, label: str | None = None) -> None:
    """A line for each share from 0 to 100 %, the first on top, and whiskers of its interval."""
    values = np.array([share.value for share in shares.values()])
    bounds = np.array([share.interval for share in shares.values()])
    places = np.arange(len(shares))
    axes.errorbar(
        100.0 * values, places, xerr=100.0 * np.stack([values - bounds[:, 0], bounds[:, 1] - values]).clip(0.0),
        fmt="o", color=LEFT, markersize=4.0, elinewidth=1.2, capsize=2.0, label=label,
    )  # fmt: skip
    axes.set_yticks(places, [_named(name, share) for name, share in shares.items()], fontsize=size)
    axes.set(xlim=(-2.0, 102.0), ylim=(len(shares) - 0.5, -0.5), xlabel="share (%)" if narrow() else _SHARE)


def _named(name: str, share: Share) -> str:
    return f"{_short(name)} ({share.right}/{share.count})"


def _short(name: str) -> str:
    return shortened(name, _LONGEST_NARROW if narrow() else LONGEST_NAME)
