"""A page about joint angles: each joint over time, within the robot's limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nao_sim.health import beyond_limits
from nao_sim.motion import JointTrajectory
from nao_sim.plotting.lines import draw_over_time, shade_handles
from nao_sim.plotting.palette import LEFT, RIGHT, SHADE, SIDE_COLOURS, SIDE_WIDTHS, WARNING
from nao_sim.plotting.style import Block, across, beside_each_other, narrow, stacked
from nao_sim.robot import Array, Robot

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from nao_sim.plotting.style import Canvas

_COLUMNS, _LEAST, _HEIGHT = 4, 2.6, 1.75  # of small plots in a row at most; in, the least width and the height of one
_SIDES = {"L": "left", "R": "right"}


def angles_page(motion: JointTrajectory, robot: Robot) -> Figure:
    """The block on a page of its own."""
    return stacked([angles_block(motion, robot)])


def angles_block(motion: JointTrajectory, robot: Robot) -> Block:
    """Every joint asked for; twins share a plot, the right one mirrored, so that equal poses coincide."""
    plots = _plots(motion, robot)

    def draw(canvas: Canvas) -> None:
        columns = beside_each_other(across(), _LEAST, _COLUMNS)
        grid = canvas.add_gridspec(max(-(-len(plots) // columns), 1), columns)
        for place, (name, joints) in enumerate(plots.items()):
            _draw(canvas.add_subplot(grid[divmod(place, columns)]), motion, robot, name, joints)
        _legend(canvas, motion.times)

    def height(width: float) -> float:
        rows = -(-len(plots) // beside_each_other(width, _LEAST, _COLUMNS))
        return _HEIGHT * rows + (1.4 if narrow(width) else 0.8)

    return Block("joint angles over time", draw, height)


def _plots(motion: JointTrajectory, robot: Robot) -> dict[str, list[int]]:
    """The joints of each plot by its title: a joint of the middle, or one of the left, the right or both."""
    asked = motion.given & np.isfinite(motion.positions).any(axis=0)
    plots: dict[str, list[int]] = {}
    for joint in np.flatnonzero(asked).tolist():
        middle = robot.mirror_of[joint] == joint
        plots.setdefault(robot.joint_names[joint][0 if middle else 1 :], []).append(joint)
    return plots


def _draw(axes: Axes, motion: JointTrajectory, robot: Robot, name: str, joints: list[int]) -> None:
    unit = robot.report_unit(joints[0])
    for joint in joints:
        side = robot.joint_names[joint][0] if robot.mirror_of[joint] != joint else ""
        sign = float(robot.mirror_sign[joint]) if side == "R" else 1.0
        values = motion.positions[:, joint]
        beyond = beyond_limits(values, robot.lower[joint], robot.upper[joint])
        lower, upper = sorted(unit * sign * limit for limit in (robot.lower[joint], robot.upper[joint]))
        _line(axes, motion.times, unit * sign * values, beyond, _SIDES.get(side, ""))
    axes.axhspan(lower, upper, color=SHADE, zorder=0)
    room = 0.06 * (upper - lower)
    axes.set(title=name, xlim=(motion.times[0], max(motion.times[-1], motion.times[0] + 1e-3)), xlabel="time (s)")
    axes.set_ylabel("opening" if robot.is_hand[joints[0]] else "angle (°)")
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, lower - room), max(high, upper + room))
    axes.margins(x=0.0)


def _line(axes: Axes, times: Array, values: Array, beyond: NDArray[np.bool_], side: str) -> None:
    """A line, with what is beyond the limits marked."""
    draw_over_time(axes, times, values, color=SIDE_COLOURS[side], linewidth=SIDE_WIDTHS[side])
    if beyond.any():
        wrong = np.where(beyond, values, np.nan)
        draw_over_time(axes, times, wrong, color=WARNING, linewidth=4.0, alpha=0.8, zorder=1.5)


def _legend(canvas: Canvas, times: Array) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles = [
        Line2D([], [], color=LEFT, linewidth=SIDE_WIDTHS["left"], label="left"),
        Line2D([], [], color=RIGHT, linewidth=SIDE_WIDTHS["right"], label="right, mirrored"),
        Line2D([], [], color=WARNING, linewidth=4.0, alpha=0.8, label="beyond the limits"),
        Patch(facecolor=SHADE, label="within the limits"),
        *shade_handles(times),
    ]
    canvas.legend(handles=handles, loc="outside lower left", ncols=1 if narrow() else 4)
