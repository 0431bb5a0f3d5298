"""A picture of a recording in a file."""

from __future__ import annotations

from pathlib import Path

from nao_sim.motion import Skeleton
from nao_sim.plotting.style import save, styled
from nao_sim.recordings import Recording
from nao_sim.robot import Robot, load_robot


def save_picture(recording: Recording, path: Path, robot: Robot | None = None) -> None:
    """Draw a recording: stick figures, joints seen and bones of a person; angles of a robot.

    Args:
        recording: what to draw.
        path: a `.png`, `.svg` or `.pdf`.
        robot: whose limits to draw; NAO v5 where None.

    Raises:
        UsageError: it cannot be written there.
    """
    from nao_sim.plotting.angles_page import angles_page
    from nao_sim.plotting.person_page import person_page

    motion = recording.motion
    with styled():
        person = isinstance(motion, Skeleton)
        figure = person_page(motion) if isinstance(motion, Skeleton) else angles_page(motion, robot or load_robot())
        frames = "1 frame" if len(motion) == 1 else f"{len(motion)} frames in {motion.duration:.2f} s"
        what = "a person" if person else "joint angles"
        figure.suptitle(f"{recording.path.name}: {what}, {frames} ({recording.format})", x=0.01, ha="left", fontsize=11)
        save(figure, path)
