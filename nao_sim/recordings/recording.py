"""What reading a file gives: the motion, and how the file was understood."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from nao_sim.motion import JointTrajectory, Skeleton


@dataclass(frozen=True)
class Label:
    """What a stretch of a recording shows.

    Attributes:
        name: the source's own word for it.
        start: s, the first instant of it.
        end: s, the last instant of it.
    """

    name: str
    start: float
    end: float


def label_of_all(name: object, lasts: float) -> tuple[Label, ...]:
    """The one label of a recording of `lasts` s that a file gives a name; none where `name` is no word."""
    return (Label(name, 0.0, lasts),) if isinstance(name, str) and name else ()


@dataclass(frozen=True)
class Recording:
    """A file that was read.

    Attributes:
        path: the file.
        format: the reader's name for what it is, e.g. `joint-angle CSV`.
        reason: what in the file told so, in a few words.
        motion: the motion in it, a robot's or a person's.
        frames: how many frames (rows, poses) the file holds.
        notes: what a user should know of how it was read.
        labels: the stretches that the file names, in order.
    """

    path: Path
    format: str
    reason: str
    motion: JointTrajectory | Skeleton
    frames: int
    notes: tuple[str, ...] = ()
    labels: tuple[Label, ...] = ()
