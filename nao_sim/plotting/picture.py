"""A picture of a recording in a file."""

from __future__ import annotations

from pathlib import Path

from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.plotting.style import Block, save_page
from nao_sim.recordings import Recording
from nao_sim.robot import Robot, load_robot


def save_picture(recording: Recording, path: Path, robot: Robot | None = None, size: str | None = None) -> None:
    """Draw a recording: stick figures, joints seen and bones of a person; angles of a robot.

    Args:
        recording: what to draw.
        path: a `.png`, `.svg` or `.pdf`.
        robot: whose limits to draw; NAO v5 where None.
        size: a name of `SIZES`; what suits the kind of file where None.

    Raises:
        UsageError: it cannot be written there.
    """
    motion = recording.motion
    frames = "1 frame" if len(motion) == 1 else f"{len(motion)} frames in {motion.duration:.2f} s"
    what = "a person" if isinstance(motion, Skeleton) else "joint angles"
    title = f"{recording.path.name}: {what}, {frames} ({recording.format})"
    save_page(motion_blocks(motion, robot or load_robot()), path, title, size=size)


def save_angles(motion: JointTrajectory, path: Path, title: str, robot: Robot, size: str | None = None) -> None:
    """Draw joint angles that are in no file; the rest as in `save_picture`.

    Raises:
        UsageError: it cannot be written there.
    """
    save_page(motion_blocks(motion, robot), path, title, size=size)


def motion_blocks(motion: Skeleton | JointTrajectory, robot: Robot) -> list[Block]:
    """What there is to see of a motion."""
    from nao_sim.plotting.angles_page import angles_block
    from nao_sim.plotting.person_page import person_blocks

    return person_blocks(motion) if isinstance(motion, Skeleton) else [angles_block(motion, robot)]
