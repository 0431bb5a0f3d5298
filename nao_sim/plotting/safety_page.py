"""A page about the guard: what was asked, commanded and done, what was changed and why, and how safe that was."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from nao_sim.console import REASONS
from nao_sim.plotting.lines import shade_handles
from nao_sim.plotting.palette import GREY, LEVEL, SHADE
from nao_sim.plotting.safety_panels import (
    CLEARANCES,
    draw_balance,
    draw_distance,
    draw_joint,
    in_words,
    reason_colour,
)
from nao_sim.plotting.similarity_page import stage_look
from nao_sim.plotting.style import Block, across, narrow, save_page, stacked
from nao_sim.robot import Robot
from nao_sim.safety.ledger import Ledger, ledger

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from nao_sim.plotting.style import Canvas
    from nao_sim.simulation.performance import Performance
    from nao_sim.simulation.rollout import Rollout
    from nao_sim.simulation.simulator import Simulator

    Panels: TypeAlias = dict[str, Callable[[Axes], None]]

MOST = 10  # joints on a page that does not show all
_HEIGHT, _BELOW = 1.45, 1.9  # in, of the plots of joints and of those below
_ENTRY = 0.2  # in, of a line of the legend
_WIDE = 11.0  # in; from here on the reasons take two columns of the legend
_WORDS = 46  # letters of a line of the legend on a narrow page


def save_safety_plot(
    report: Mapping[str, Any],
    performance: Performance,
    simulator: Simulator,
    path: Path,
    *,
    every: bool = False,
    size: str | None = None,
    more: Sequence[Block] = (),
) -> None:
    """Draw a run.

    Args:
        report: of the run, for the title.
        performance: the run.
        simulator: whose robot it was.
        path: a `.png`, `.svg` or `.pdf`.
        every: whether to show all joints that the recording has, not only those changed most.
        size: a name of `SIZES`; what suits the kind of file where None.
        more: what else to draw below.

    Raises:
        UsageError: it cannot be written there.
    """
    title, colour = _title(report)
    save_page([safety_block(performance, simulator, every=every), *more], path, title, colour=colour, size=size)


def safety_page(performance: Performance, simulator: Simulator, *, every: bool = False) -> Figure:
    """The block on a page of its own."""
    return stacked([safety_block(performance, simulator, every=every)])


def safety_block(performance: Performance, simulator: Simulator, *, every: bool = False) -> Block:
    """Joints over time with the reasons for their changes, self-distance, and the balance of a free robot."""
    joints, below = _panels(performance, simulator, every)
    book = ledger(performance.interventions)

    def layout(width: float) -> tuple[int, list[float]]:
        """Columns, and the heights of rows."""
        columns = 1 if narrow(width) else 2
        rows = -(-len(joints) // columns), -(-len(below) // columns)
        return columns, [_HEIGHT] * rows[0] + [_BELOW] * rows[1]

    def draw(canvas: Canvas) -> None:
        columns, heights = layout(across())
        grid, rows = canvas.add_gridspec(len(heights), columns, height_ratios=heights), -(-len(joints) // columns)
        for place, panel in enumerate(joints.values()):  # one column after the other
            axes = canvas.add_subplot(grid[place % rows, place // rows])
            panel(axes)
            axes.tick_params(labelbottom=False)
        for place, panel in enumerate(below.values()):
            beside = place % columns if len(below) > 1 else slice(None)
            panel(canvas.add_subplot(grid[rows + place // columns, beside]))
        _legend(canvas, book)

    return Block(
        "what was asked, commanded and done",
        draw,
        lambda width: sum(layout(width)[1]) + 0.5 + _ENTRY * _rows(_entries(book, width)),
    )


def safety_blocks(performance: Performance, simulator: Simulator) -> list[Block]:
    """The same in pieces: a block for each panel, and one for the legend."""
    joints, below = _panels(performance, simulator, every=False)

    def block(name: str, panel: Callable[[Axes], None], height: float) -> Block:
        def draw(canvas: Canvas) -> None:
            axes = canvas.add_subplot()
            panel(axes)
            axes.set_xlabel("time (s)")

        return Block(name, draw, lambda _: height)

    book = ledger(performance.interventions)
    key = Block("legend", lambda canvas: _legend(canvas, book), lambda width: _ENTRY * _rows(_entries(book, width)))
    heights = [_HEIGHT + 0.5] * len(joints) + [_BELOW + 0.3] * len(below)
    return [key, *(block(name, panel, height) for (name, panel), height in
                   zip((joints | below).items(), heights, strict=True))]  # fmt: skip


def _panels(performance: Performance, simulator: Simulator, every: bool) -> tuple[Panels, Panels]:
    """What to draw, by name: joints, and what is below them."""
    rollout, book, robot = performance.rollout, ledger(performance.interventions), simulator.robot
    joints: Panels = {
        robot.joint_names[joint]: partial(
            draw_joint, rollout=rollout, book=book.only(joint=joint), robot=robot, joint=joint
        )
        for joint in shown_joints(rollout, book, robot, every)
    }
    below: Panels = {"self-distance": partial(draw_distance, rollout=rollout, book=book)}
    if simulator.map.free:
        below["balance"] = partial(draw_balance, rollout=rollout, book=book, simulator=simulator)

    def timed(panel: Callable[[Axes], None]) -> Callable[[Axes], None]:
        def draw(axes: Axes) -> None:
            panel(axes)
            axes.axvspan(0.0, rollout.motion_start, color=SHADE, linewidth=0, zorder=0)
            axes.set_xlim(0.0, rollout.time[-1])

        return draw

    return tuple({name: timed(panel) for name, panel in part.items()} for part in (joints, below))  # type: ignore[return-value]


def shown_joints(rollout: Rollout, book: Ledger, robot: Robot, every: bool) -> list[int]:
    """The joints changed most, or all that the recording has; those that move most where nothing was changed.

    In NAOqi's order.
    """
    reach = robot.upper - robot.lower
    changed = np.bincount(book.joint, book.size, len(reach)) / reach
    if every:
        chosen = np.flatnonzero(np.isfinite(rollout.requested).any(axis=0) | (changed > 0.0))
    else:
        amount = changed if len(book) else np.ptp(rollout.command, axis=0) / reach
        chosen = np.argsort(-amount, kind="stable")[: min(MOST, max(int((amount > 0.0).sum()), 1))]
    return sorted(int(joint) for joint in chosen)


def _entries(book: Ledger, width: float) -> list[list[Any]]:
    """Handles of the legend by column: lines first, then reasons."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    floor, ceiling = CLEARANCES
    lines: list[Any] = [Line2D([], [], **stage_look(name), label=name) for name in ("requested", "commanded")]
    lines += [
        Line2D([], [], **stage_look("simulated"), label="simulated"),
        Line2D([], [], color=GREY, linestyle=":", linewidth=0.9, label="limit of the joint"),
        Line2D([], [], color=LEVEL, linestyle=":", linewidth=0.9,
               label=f"least: {ceiling:.0f} mm of commands, {floor:.0f} mm of the robot; 0 mm of balance"),
        Patch(facecolor=SHADE, label="on the way to the first pose"),
        *shade_handles(np.empty(book.run)),
    ]  # fmt: skip
    reasons = [Patch(facecolor=reason_colour(reason), label=REASONS.get(reason, reason)) for reason in in_words(book)]
    if narrow(width):
        return [_in_lines([*lines, *reasons])]
    split = len(lines) if width > _WIDE else len(reasons) or 1
    return [lines, *(reasons[start : start + split] for start in range(0, len(reasons), split))]


def _in_lines(handles: list[Any]) -> list[Any]:
    for handle in handles:
        handle.set_label(textwrap.fill(handle.get_label(), _WORDS))
    return handles


def _rows(entries: list[list[Any]]) -> int:
    """Lines that a legend takes."""
    return max(sum(1 + handle.get_label().count("\n") for handle in column) for column in entries)


def _legend(canvas: Canvas, book: Ledger) -> None:
    from matplotlib.patches import Patch

    entries = _entries(book, across())
    rows = max(map(len, entries))
    empty = [[Patch(alpha=0.0, label=" ")] * (rows - len(column)) for column in entries]
    handles = [handle for column, rest in zip(entries, empty, strict=True) for handle in (*column, *rest)]
    canvas.legend(handles=handles, loc="outside lower left", ncols=len(entries), columnspacing=4.0)


def _title(report: Mapping[str, Any]) -> tuple[str, str]:
    """The recording and its verdict, and the colour of that: red where something was switched off or went wrong."""
    from nao_sim.check_tables import verdict_words

    off = f"; switched off: {', '.join(report['rules_off'])}" if report["rules_off"] else ""
    title = f"{Path(report['recording']).name}: {verdict_words(report)}{off}"
    return title, LEVEL if off or report["wrong"] else "black"
