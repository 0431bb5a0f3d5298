"""The imitation score of a robot's motion against the recording that it imitates."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nao_sim.errors import UsageError
from nao_sim.files import check_results
from nao_sim.options import (
    Html,
    Layout,
    Person,
    Plot,
    PlotSize,
    Rate,
    Rig,
    Unit,
    Version,
    check_page,
    check_picture,
    command_line,
)

if TYPE_CHECKING:
    from nao_sim.motion import JointTrajectory
    from nao_sim.simulation.rollout import Rollout

# how much longer or shorter than the recording an imitation may last, the rest at its end included
DOUBTFUL_S, DOUBTFUL_SHARE = 2.0, 0.05


def compare(
    human: Annotated[Path, typer.Argument(help="The recording that was imitated: a person, or joint angles.")],
    rollout: Annotated[Path, typer.Argument(help="What the robot did: an NPZ of play --rollout, or joint angles.")],
    *,
    context: typer.Context,
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Also write the score as JSON.")] = None,
    plot: Plot = None,
    plot_size: PlotSize = None,
    html: Html = None,
    robot: Version = "v5",
    unit: Unit = None,
    rate: Rate = None,
    layout: Layout = None,
    person: Person = None,
    rig: Rig = None,
) -> None:
    """Say how well a robot imitates: angles, hands, similarity, delay, and how much of the error is NAO's limits.

    A rollout knows when the recording's first frame was asked for and at what
    speed; a joint-angle recording is taken to begin with the human's first frame.
    """
    check_picture(plot)
    check_page(html)
    check_results([json, plot, html], human, rollout)
    from nao_sim.imitation.similarity import similarity
    from nao_sim.recordings import load
    from nao_sim.report import save_report
    from nao_sim.robot import load_robot

    recording = load(human, unit, rate, layout=layout, person=person, rig=rig)
    imitation = _robot_motion(rollout, unit, rate)
    score = similarity(recording.motion, imitation, load_robot(robot))
    if not len(score.times):
        raise UsageError(f"{rollout}: has no moment in common with {human}; expected the robot's imitation of it")
    report = {"human": str(human), "rollout": str(rollout), "robot": robot, "similarity": score.as_report()}
    if json:
        save_report(report, json)
    if plot:
        from nao_sim.plotting.similarity_page import save_similarity_plot

        save_similarity_plot(score, f"{rollout.name} imitating {human.name}", plot, plot_size and plot_size.value)
    if html:
        from nao_sim.web.documents import comparison_document
        from nao_sim.web.writing import write_document

        write_document(comparison_document(recording, rollout, score, command_line(context)), html)
    if doubt := _doubt(recording.motion.duration, imitation):
        typer.echo(f"note: {doubt}")
    _print(report, [path for path in (json, plot, html) if path])


def _doubt(lasts: float, robot: Rollout | JointTrajectory) -> str | None:
    """What speaks against the robot having imitated a recording of `lasts` seconds."""
    from nao_sim.motion import JointTrajectory

    if isinstance(robot, JointTrajectory):
        moved = robot.duration
    else:
        moved, lasts = float(robot.time[-1]) - robot.motion_start, lasts / robot.speed
    if abs(moved - lasts) <= DOUBTFUL_S + DOUBTFUL_SHARE * lasts:
        return None
    return f"the recording lasts {lasts:.1f} s, but the robot moved for {moved:.1f} s: is it this recording's motion?"


def _robot_motion(path: Path, unit: Any, rate: float | None) -> Rollout | JointTrajectory:
    """What the robot did, from a rollout or a joint-angle recording.

    Raises:
        RecordingError: the file cannot be read.
        UsageError: it holds a person, or lasts too long.
    """
    from nao_sim.motion import JointTrajectory
    from nao_sim.recordings import load
    from nao_sim.replay import LONGEST_S
    from nao_sim.simulation.rollout import Rollout, is_rollout

    if is_rollout(path):
        return Rollout.load(path)
    motion = (recording := load(path, unit, rate)).motion
    if motion.duration > LONGEST_S:
        raise UsageError(f"{path}: lasts {motion.duration / 3600:.1f} hours; expected at most {LONGEST_S / 3600:g}")
    if isinstance(motion, JointTrajectory):
        return motion
    raise UsageError(f"{path}: a person ({recording.format}); expected a robot's motion, from play or retarget")


def _print(report: Mapping[str, Any], written: list[Path]) -> None:
    from rich.console import Console
    from rich.text import Text

    from nao_sim.sections import print_table
    from nao_sim.similarity_tables import measured, score_section

    console, score = Console(), report["similarity"]
    console.print(Text(f"{report['rollout']} imitating {report['human']}", style="bold"), soft_wrap=True)
    console.print(Text(measured(score)))
    print_table(score_section(score), figures=True)
    for path in written:
        console.print(Text(str(path)), soft_wrap=True)
