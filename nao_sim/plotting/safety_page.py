"""A page about the guard: what was asked and commanded, what was changed and why, and how safe that was."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from nao_sim.console import REASONS
from nao_sim.plotting.style import page, save, styled
from nao_sim.robot import Array, Robot
from nao_sim.safety.ledger import Ledger, ledger
from nao_sim.safety.self_collision import CLEARANCE
from nao_sim.safety.self_distance import HORIZON
from nao_sim.safety.trajectory_distance import smallest_distances
from nao_sim.simulation.measures import stance
from nao_sim.simulation.simulator import CONTROL_STEP
from nao_sim.verdict import NEAREST_M

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from nao_sim.simulation.performance import Performance
    from nao_sim.simulation.rollout import Rollout
    from nao_sim.simulation.simulator import Simulator

MOST = 10  # joints on a page that does not show all
CLEARANCES = (1000.0 * NEAREST_M, 1000.0 * CLEARANCE)  # mm, of the simulated robot and of commands
ASKED, COMMANDED, DONE = "#7F7F7F", "#000000", "#56B4E9"
# M. Okabe and K. Ito, Color Universal Design (2008), and greys: told apart by colour-blind people, too.
COLOURS = {
    "limit": "#CC79A7", "margin": "#F0E442", "one_motor": "#BFBFBF", "coupling": "#56B4E9", "speed": "#E69F00",
    "self_collision": "#D55E00", "detour": "#009E73", "balance": "#0072B2", "ramp": "#7F7F7F", "stale": "#000000",
}  # fmt: skip
_OTHER, _APPROACH, _LEVEL = "#4D4D4D", "#F2F2F2", "#CC0000"
_COLUMNS, _HEIGHT, _BELOW = 2, 1.45, 1.9  # of joints in a row; in, heights of their plots and of those below
_FALLING = -50.0  # mm; farther outside its feet a robot cannot be saved, and how far says nothing
_LANE = 0.055  # height of a reason's lane, as a share of the plot


def save_safety_plot(
    report: Mapping[str, Any], performance: Performance, simulator: Simulator, path: Path, *, every: bool = False
) -> None:
    """Draw a run.

    Args:
        report: of the run, for the title.
        performance: the run.
        simulator: whose robot it was.
        path: a `.png`, `.svg` or `.pdf`.
        every: whether to show all joints that the recording has, not only those changed most.

    Raises:
        UsageError: it cannot be written there.
    """
    with styled():
        figure = safety_page(performance, simulator, every=every)
        _title(figure, report)
        save(figure, path)


def safety_page(performance: Performance, simulator: Simulator, *, every: bool = False) -> Figure:
    """Joints over time with the reasons for their changes, self-distance, and the balance of a free robot."""
    rollout, book = performance.rollout, ledger(performance.interventions)
    joints = shown_joints(rollout, book, simulator.robot, every)
    rows = -(-len(joints) // _COLUMNS)
    figure = page(_HEIGHT * rows + _BELOW + 1.7)
    grid = figure.add_gridspec(rows + 1, _COLUMNS, height_ratios=[_HEIGHT] * rows + [_BELOW])
    below = [figure.add_subplot(grid[rows, 0 if simulator.map.free else slice(None)])]
    draw_distance(below[0], rollout, book)
    if simulator.map.free:
        below.append(figure.add_subplot(grid[rows, 1], sharex=below[0]))
        draw_balance(below[1], rollout, book, simulator)
    for place, joint in enumerate(joints):
        axes = figure.add_subplot(grid[place % rows, place // rows], sharex=below[0])  # one column after the other
        draw_joint(axes, rollout, book.only(joint=joint), simulator.robot, joint)
        axes.tick_params(labelbottom=False)
    for axes in figure.axes:
        axes.axvspan(0.0, rollout.motion_start, color=_APPROACH, linewidth=0, zorder=0)
    below[0].set_xlim(0.0, rollout.time[-1])
    _legend(figure, book)
    return figure


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


def draw_joint(axes: Axes, rollout: Rollout, book: Ledger, robot: Robot, joint: int) -> None:
    """What was asked of a joint and what was commanded, its limits where they are in sight, and the reasons."""
    unit = robot.report_unit(joint)
    asked, commanded = unit * rollout.requested[:, joint], unit * rollout.command[:, joint]
    axes.plot(rollout.time, asked, color=ASKED, linestyle="--", linewidth=1.1)
    axes.plot(rollout.time, commanded, color=COMMANDED, linewidth=1.3)
    lowest, highest = _range(np.concatenate([asked, commanded]), 0.1 if robot.is_hand[joint] else 5.0)
    for limit in (unit * robot.lower[joint], unit * robot.upper[joint]):
        if lowest <= limit <= highest:
            axes.axhline(limit, color=ASKED, linewidth=0.8, linestyle=":")
    axes.set(title=robot.joint_names[joint], ylabel="opening" if robot.is_hand[joint] else "angle (°)")
    _lanes(axes, book, lowest, highest)


def draw_distance(axes: Axes, rollout: Rollout, book: Ledger) -> None:
    """Smallest distance between the robot's parts, of commands and of the simulated robot."""
    for poses, colour, width in ((rollout.joint_positions, DONE, 1.8), (rollout.command, COMMANDED, 1.0)):
        axes.plot(rollout.time, 1000.0 * smallest_distances(poses), color=colour, linewidth=width)
    _levels(axes, CLEARANCES)
    axes.set(title=f"self-distance ({1000 * HORIZON:.0f} mm: that or more)", ylabel="distance (mm)", xlabel="time (s)")
    lowest = min(0.0, axes.get_ylim()[0])
    _lanes(axes, book.where(_is(book, "self_collision", "detour")), lowest, 1050.0 * HORIZON)
    axes.set_yticks([0.0, *CLEARANCES, 15.0, 1000.0 * HORIZON])


def draw_balance(axes: Axes, rollout: Rollout, book: Ledger, simulator: Simulator) -> None:
    """How far inside its feet the centre of mass of the simulated robot was."""
    margins = 1000.0 * stance(simulator.model, rollout).margin
    margins = np.where(margins > _FALLING, margins, np.nan)
    axes.plot(rollout.time, margins, color=DONE, linewidth=1.8)
    _levels(axes, (0.0,))
    title = "balance: centre of mass inside the support polygon"
    axes.set(title=title, ylabel="margin (mm)", xlabel="time (s)")
    lowest, highest = _range(np.append(margins, 0.0), 10.0)
    _lanes(axes, book.where(_is(book, "balance")), lowest, highest)


def _range(values: Array, least: float) -> tuple[float, float]:
    """From the smallest to the largest finite value, and `least` at least, with some room."""
    finite = values[np.isfinite(values)]
    lowest, highest = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
    room = max(0.06 * (highest - lowest), (least - highest + lowest) / 2.0)
    return lowest - room, highest + room


def _levels(axes: Axes, heights: Sequence[float]) -> None:
    for height in heights:
        axes.axhline(height, color=_LEVEL, linewidth=0.9, linestyle=":")


def _lanes(axes: Axes, book: Ledger, lowest: float, highest: float) -> None:
    """Below values from `lowest` to `highest`, a lane for each reason, coloured when it held."""
    from matplotlib.ticker import MaxNLocator

    reasons = _known(book)
    room = _LANE * len(reasons)
    axes.set_ylim(lowest - (highest - lowest) * room / (1.0 - room), highest)
    ticks = MaxNLocator(4, steps=[1, 1.5, 2, 3, 4.5, 6, 10]).tick_values(lowest, highest)
    axes.set_yticks([tick for tick in ticks if lowest <= tick <= highest])
    for place, reason in enumerate(reversed(reasons)):
        first, last = book.only(reason=reason).spells.T
        spells = list(zip(CONTROL_STEP * first, CONTROL_STEP * (last + 1 - first), strict=True))
        lane = (_LANE * (place + 0.08), _LANE * 0.84)
        axes.broken_barh(spells, lane, transform=axes.get_xaxis_transform(), color=_colour(reason), linewidth=0)


def _is(book: Ledger, *reasons: str) -> Any:
    """Rows (N,) of some reasons."""
    return np.isin(np.array(book.reason_names, object)[book.reason], reasons) if len(book) else slice(0)


def _known(book: Ledger) -> list[str]:
    """The reasons, those that have words first and in the order of these."""
    return [*(reason for reason in REASONS if reason in book.reasons), *(r for r in book.reasons if r not in REASONS)]


def _colour(reason: str) -> str:
    return COLOURS.get(reason, _OTHER)


def _legend(figure: Figure, book: Ledger) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    floor, ceiling = CLEARANCES
    lines = [
        Line2D([], [], color=ASKED, linestyle="--", linewidth=1.1, label="requested"),
        Line2D([], [], color=COMMANDED, label="commanded"),
        Line2D([], [], color=DONE, linewidth=1.8, label="simulated"),
        Line2D([], [], color=ASKED, linestyle=":", linewidth=0.9, label="limit of the joint"),
        Line2D([], [], color=_LEVEL, linestyle=":", linewidth=0.9,
               label=f"least: {ceiling:.0f} mm of commands, {floor:.0f} mm of the robot; 0 mm of balance"),
        Patch(facecolor=_APPROACH, label="on the way to the first pose"),
    ]  # fmt: skip
    reasons = [Patch(facecolor=_colour(reason), label=REASONS.get(reason, reason)) for reason in _known(book)]
    columns = 1 + -(-len(reasons) // len(lines))
    empty = [Patch(alpha=0.0, label=" ")] * (len(lines) * columns - len(lines) - len(reasons))
    figure.legend(handles=[*lines, *reasons, *empty], loc="outside lower left", ncols=columns, columnspacing=4.0)


def _title(figure: Figure, report: Mapping[str, Any]) -> None:
    """The recording and its verdict; in red what was switched off or went wrong."""
    from nao_sim.check_tables import verdict_words

    off = f"; switched off: {', '.join(report['rules_off'])}" if report["rules_off"] else ""
    title = f"{Path(report['recording']).name}: {verdict_words(report)}{off}"
    colour = _LEVEL if off or report["wrong"] else "black"
    figure.suptitle(title, x=0.01, ha="left", fontsize=11, color=colour)
