"""Gestures by name: how each is recognised, and what the robot does for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from nao_sim import body
from nao_sim.gestures.movements import MovementRecogniser
from nao_sim.gestures.poses import PoseRecogniser
from nao_sim.gestures.training_table import thesis_table
from nao_sim.motion import JointTrajectory
from nao_sim.paths import TRAJECTORIES
from nao_sim.recordings import load

MOTIONS = TRAJECTORIES / "gestures"  # a file each, called like the gesture


@dataclass(frozen=True, eq=False)
class Vocabulary:
    """What can be recognised, and what the robot does then.

    Attributes:
        poses: tells poses, if any are known.
        movements: tells movements, if any are known.
        motions: what the robot does for a gesture: one frame is a pose that it holds.  A
            gesture may lack one, and a motion may wait for a gesture that is still to be taught.
    """

    poses: PoseRecogniser | None = None
    movements: MovementRecogniser | None = None
    motions: Mapping[str, JointTrajectory] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "motions", MappingProxyType(dict(self.motions)))
        if self.poses is None and self.movements is None:
            raise ValueError("neither poses nor movements; expected some")
        if both := set(self.pose_names) & set(self.movement_names):
            raise ValueError(f"'{min(both)}' is a pose and a movement; expected one of them")

    @property
    def pose_names(self) -> tuple[str, ...]:
        """Of the poses."""
        return self.poses.names if self.poses else ()

    @property
    def movement_names(self) -> tuple[str, ...]:
        """Of the movements."""
        return self.movements.names if self.movements else ()

    @property
    def names(self) -> tuple[str, ...]:
        """Of all that can be recognised, poses first."""
        return (*self.pose_names, *self.movement_names)

    def motion_of(self, name: str) -> JointTrajectory | None:
        """What the robot does for a gesture: its own motion, or the other side's in a mirror; None for nothing."""
        if name in self.motions:
            return self.motions[name]
        twin = self.motions.get(body.twin(name))
        return twin.mirrored() if twin else None


def built_in() -> Vocabulary:
    """The thesis's five poses, those of one arm, and the robot's motions of `trajectories/gestures`.

    Raises:
        RecordingError: a file of the package is missing or damaged.
    """
    table = thesis_table()
    poses = PoseRecogniser.of_thesis_rows(table.features, table.labels.tolist())
    return Vocabulary(poses, motions=built_in_motions())


def built_in_motions() -> dict[str, JointTrajectory]:
    """The robot's motions that come with the package, by the gesture's name."""
    found = {path.stem: load(path).motion for path in sorted(MOTIONS.glob("*.csv"))}
    return {name: motion for name, motion in found.items() if isinstance(motion, JointTrajectory)}
