"""What robots share, and what comes of one control step of one of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco

from nao_sim.gestures.streaming import Decision
from nao_sim.gestures.vocabulary import Vocabulary
from nao_sim.live.light import Light
from nao_sim.live.timing import Counts
from nao_sim.robot import Array, Robot
from nao_sim.safety.change import Intervention
from nao_sim.safety.rules import ALL, Rules
from nao_sim.simulation.simulator import CONTROL_STEP


@dataclass(frozen=True, eq=False)
class World:
    """What all robots of a process share.

    Attributes:
        robot: which version.
        model: its compiled scene.
        vocabulary: the gestures to recognise.
        rules: what the guard keeps.
    """

    robot: Robot
    model: mujoco.MjModel
    vocabulary: Vocabulary
    rules: Rules = ALL


@dataclass(frozen=True, eq=False)
class Command:
    """What the robot is told at one control step.

    Attributes:
        step: its number, from 1.
        positions: (26,).
        frame_time: s, of the sender's clock, of the newest frame in it; nan before the first.
    """

    step: int
    positions: Array
    frame_time: float

    @property
    def time(self) -> float:
        """Seconds of the robot's time."""
        return self.step * CONTROL_STEP


@dataclass(frozen=True, eq=False)
class Moment:
    """What came of one control step.

    Attributes:
        step: its number, from 1.
        requested: (26,) what was asked; nan where nothing.
        commanded: (26,) what the guard made of it.
        simulated: (26,) where the joints are.
        base_pose: (7,) of the torso, m and unit quaternion (w x y z).
        intervention: what the guard changed, and why.
        frame_time: s, of the sender's clock, of the newest frame in it; nan before the first.
        age: s since that came; nan before.
        decision: the gesture that was recognised.
        errors: (2, 2) rad, angles between the person's arms and the robot's; nan where not known.
        light: whether the robot does what the person does.
        flags: `paused`, `recording`, `replaying`, where they are so.
        counts: how frames came.
    """

    step: int
    requested: Array
    commanded: Array
    simulated: Array
    base_pose: Array
    intervention: Intervention
    frame_time: float
    age: float
    decision: Decision | None
    errors: Array
    light: Light
    flags: tuple[str, ...]
    counts: Counts

    @property
    def time(self) -> float:
        """Seconds of the robot's time."""
        return self.step * CONTROL_STEP

    def change(self, reason: str, links: Sequence[str]) -> Array:
        """How far (26,) one reason moved each joint."""
        return next(each.size for each in self.intervention if (each.reason, each.links) == (reason, tuple(links)))
