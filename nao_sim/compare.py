"""The imitation score of a robot's motion against the recording that it imitates."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nao_sim.errors import UsageError
from nao_sim.files import check_results
from nao_sim.options import Layout, Person, Rate, Rig, Unit, Version

if TYPE_CHECKING:
    from rich.table import Table

    from nao_sim.motion import JointTrajectory
    from nao_sim.simulation.rollout import Rollout

NEAREST = "nearest"
ROWS = {  # what a line shows: the path to it in a stage of the report, and its digits
    "left upper arm (°)": ("direction_error_deg left_upper_arm mean", 1),
    "left forearm (°)": ("direction_error_deg left_forearm mean", 1),
    "right upper arm (°)": ("direction_error_deg right_upper_arm mean", 1),
    "right forearm (°)": ("direction_error_deg right_forearm mean", 1),
    "both arms (°)": ("direction_error_deg all mean", 1),
    "both arms, median (°)": ("direction_error_deg all median", 1),
    "both arms, 95 % below (°)": ("direction_error_deg all p95", 1),
    "beyond the nearest (°)": ("excess_deg mean", 1),
    "hands (arm lengths)": ("hand_error_arm_lengths all mean", 3),
    "WBF similarity": ("wbf mean", 3),
    "LLF similarity": ("llf mean", 3),
    "delay (ms)": ("lag_ms", 0),
}

# how much longer or shorter than the recording an imitation may last, the rest at its end included
DOUBTFUL_S, DOUBTFUL_SHARE = 2.0, 0.05


def compare(
    human: Annotated[Path, typer.Argument(help="The recording that was imitated: a person, or joint angles.")],
    rollout: Annotated[Path, typer.Argument(help="What the robot did: an NPZ of play --rollout, or joint angles.")],
    *,
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Also write the score as JSON.")] = None,
    plot: Annotated[Path | None, typer.Option(metavar="PNG", help="Also draw the error over time.")] = None,
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
    if plot and plot.suffix.lower() != ".png":
        raise UsageError(f"--plot {plot}: expected a name that ends in .png")
    check_results([json, plot], human, rollout)
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

        save_similarity_plot(score, f"{rollout.name} imitating {human.name}", plot)
    if doubt := _doubt(recording.motion.duration, imitation):
        typer.echo(f"note: {doubt}")
    _print(report, [path for path in (json, plot) if path])


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

    console, score = Console(), report["similarity"]
    console.print(Text(f"{report['rollout']} imitating {report['human']}", style="bold"), soft_wrap=True)
    measured = " and ".join(f"{100 * share:.0f} % ({side})" for side, share in score["coverage"].items())
    console.print(Text(f"arms measured in {measured} of the frames; {score['compared']} moments compared"))
    console.print(_table(score))
    for path in written:
        console.print(Text(str(path)), soft_wrap=True)


def _table(score: Mapping[str, Any]) -> Table:
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    table.add_column("mean, where it does not say", style="bold", no_wrap=True)
    columns = {NEAREST: {"direction_error_deg": score["limits_deg"]}, **score["stages"]}
    for name in columns:
        table.add_column(name, justify="right", no_wrap=True)
    for label, (path, digits) in ROWS.items():
        table.add_row(label, *(_cell(column, path, digits) for column in columns.values()))
    return table


def _cell(part: Any, path: str, digits: int) -> str:
    """The number at a path of keys in a part of the report."""
    for key in path.split():
        part = (part or {}).get(key)
    return "-" if part is None else f"{part:.{digits}f}"
