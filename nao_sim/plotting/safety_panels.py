"""Panels about the guard: a joint and why it was changed, self-distance, balance."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from nao_sim.console import REASONS
from nao_sim.plotting.lines import draw_over_time, visible
from nao_sim.plotting.palette import GREY, LEVEL, OTHER_REASON, REASON_COLOURS
from nao_sim.plotting.similarity_page import stage_look
from nao_sim.robot import Array, Robot
from nao_sim.safety.ledger import Ledger
from nao_sim.safety.self_collision import CLEARANCE
from nao_sim.safety.self_distance import HORIZON
from nao_sim.safety.trajectory_distance import smallest_distances
from nao_sim.simulation.measures import stance
from nao_sim.simulation.rollout import Rollout
from nao_sim.simulation.simulator import CONTROL_STEP
from nao_sim.verdict import NEAREST_M

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from nao_sim.simulation.simulator import Simulator

CLEARANCES = (1000.0 * NEAREST_M, 1000.0 * CLEARANCE)  # mm, of the simulated robot and of commands
_FALLING = -50.0  # mm; farther outside its feet a robot cannot be saved, and how far says nothing
_LANE = 0.055  # height of a reason's lane, as a share of the plot


def draw_joint(axes: Axes, rollout: Rollout, book: Ledger, robot: Robot, joint: int) -> None:
    """What was asked of a joint, commanded and done, its limits where they are in sight, and the reasons."""
    unit = robot.report_unit(joint)
    stages = {"simulated": rollout.joint_positions, "requested": rollout.requested, "commanded": rollout.command}
    lines = {stage: unit * values[:, joint] for stage, values in stages.items()}
    for stage, values in lines.items():
        draw_over_time(axes, rollout.time, values, **stage_look(stage))
    lowest, highest = _range(np.concatenate(list(lines.values())), 0.1 if robot.is_hand[joint] else 5.0)
    for limit in (unit * robot.lower[joint], unit * robot.upper[joint]):
        if lowest <= limit <= highest:
            axes.axhline(limit, color=GREY, linewidth=0.8, linestyle=":")
    axes.set(title=robot.joint_names[joint], ylabel="opening" if robot.is_hand[joint] else "angle (°)")
    _lanes(axes, book, lowest, highest)


def draw_distance(axes: Axes, rollout: Rollout, book: Ledger) -> None:
    """Smallest distance between the robot's parts, of commands and of the simulated robot."""
    for stage, distances in zip(("simulated", "commanded"), _distances(rollout), strict=True):
        draw_over_time(axes, rollout.time, distances, **stage_look(stage))
    _levels(axes, CLEARANCES)
    axes.set(title=f"self-distance ({1000 * HORIZON:.0f} mm: that or more)", ylabel="distance (mm)", xlabel="time (s)")
    lowest = min(0.0, axes.get_ylim()[0])
    _lanes(axes, book.where(_is(book, "self_collision", "detour")), lowest, 1050.0 * HORIZON)
    axes.set_yticks([0.0, *CLEARANCES, 15.0, 1000.0 * HORIZON])


def draw_balance(axes: Axes, rollout: Rollout, book: Ledger, simulator: Simulator) -> None:
    """How far inside its feet the centre of mass of the simulated robot was."""
    margins = _margins(rollout, simulator)
    draw_over_time(axes, rollout.time, margins, **stage_look("simulated"))
    _levels(axes, (0.0,))
    axes.set(title="balance: centre of mass inside the feet", ylabel="margin (mm)", xlabel="time (s)")
    lowest, highest = _range(np.append(margins, 0.0), 10.0)
    _lanes(axes, book.where(_is(book, "balance")), lowest, highest)


@lru_cache(maxsize=1)  # a run is often drawn twice: for a picture and for a page
def _distances(rollout: Rollout) -> tuple[Array, Array]:
    """(T,) mm of the simulated robot, and of its commands."""
    done, commanded = (1000.0 * smallest_distances(poses) for poses in (rollout.joint_positions, rollout.command))
    return done, commanded


@lru_cache(maxsize=1)
def _margins(rollout: Rollout, simulator: Simulator) -> Array:
    """(T,) mm, how far the centre of mass is inside the feet; nan where there is no hope."""
    margins = 1000.0 * stance(simulator.model, rollout).margin
    return np.where(margins > _FALLING, margins, np.nan)


def _range(values: Array, least: float) -> tuple[float, float]:
    """From the smallest to the largest finite value, and `least` at least, with some room."""
    finite = values[np.isfinite(values)]
    lowest, highest = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
    room = max(0.06 * (highest - lowest), (least - highest + lowest) / 2.0)
    return lowest - room, highest + room


def _levels(axes: Axes, heights: Sequence[float]) -> None:
    for height in heights:
        axes.axhline(height, color=LEVEL, linewidth=0.9, linestyle=":")


def _lanes(axes: Axes, book: Ledger, lowest: float, highest: float) -> None:
    """Below values from `lowest` to `highest`, a lane for each reason, coloured when it held."""
    from matplotlib.ticker import MaxNLocator

    reasons = in_words(book)
    room = _LANE * len(reasons)
    axes.set_ylim(lowest - (highest - lowest) * room / (1.0 - room), highest)
    ticks = MaxNLocator(4, steps=[1, 1.5, 2, 3, 4.5, 6, 10]).tick_values(lowest, highest)
    axes.set_yticks([tick for tick in ticks if lowest <= tick <= highest])
    for place, reason in enumerate(reversed(reasons)):
        spells = CONTROL_STEP * (book.only(reason=reason).spells + np.array([0, 1]))
        lane, colour = (_LANE * (place + 0.08), _LANE * 0.84), reason_colour(reason)
        shown = visible(spells, CONTROL_STEP * book.run)
        axes.broken_barh(shown, lane, transform=axes.get_xaxis_transform(), color=colour, linewidth=0)


def _is(book: Ledger, *reasons: str) -> Any:
    """Rows (N,) of some reasons."""
    return np.isin(np.array(book.reason_names, object)[book.reason], reasons) if len(book) else slice(0)


def in_words(book: Ledger) -> list[str]:
    """The reasons, those that have words first and in the order of these."""
    return [*(reason for reason in REASONS if reason in book.reasons), *(r for r in book.reasons if r not in REASONS)]


def reason_colour(reason: str) -> str:
    """The colour of a lane."""
    return REASON_COLOURS.get(reason, OTHER_REASON)
