"""The safety light: one colour and one sentence that say whether the robot does what the person does.

Green: it does.  Amber: it does what is safe of it, or is about to begin.  Red:
it stands still.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from nao_sim.console import REASONS
from nao_sim.rendering.presets import load_safety
from nao_sim.robot import Robot
from nao_sim.safety.change import Change

Colour = Literal["green", "amber", "red"]
SHOWN = 3  # joints before the rest is left out
STAYS = 0.3  # s for which a colour other than green stays at least, so that it can be seen
LATE = 0.25  # s of delay worth a word
SILENT = 0.3  # s without a frame


@dataclass(frozen=True)
class Light:
    """What the light shows.

    Attributes:
        colour: `green`, `amber` or `red`.
        reason: why, in words.
    """

    colour: Colour
    reason: str


@dataclass(frozen=True)
class Situation:
    """What the light looks at besides what the guard changed.

    Attributes:
        fell: whether the robot left its feet.
        silence: s since the last frame; None before the first.
        seen: whether an arm of the person is.
        learning: whether it is not known yet what the numbers mean.
        paused: whether the robot was told to wait.
        delay: s that frames come late.
        slow: whether the machine falls behind.
    """

    fell: bool = False
    silence: float | None = None
    seen: bool = True
    learning: bool = False
    paused: bool = False
    delay: float = 0.0
    slow: bool = False


class Signal:
    """Shows one robot's light; it has a state.

    Args:
        robot: whose joints are named.
    """

    def __init__(self, robot: Robot) -> None:
        looks = load_safety()
        self._names = robot.joint_names
        angle = {name: np.radians(reason.least_deg) for name, reason in looks.reasons.items()}
        self._least = {name: np.where(robot.is_hand, looks.least_hand, least) for name, least in angle.items()}
        self._unit = [robot.report_unit(joint) for joint in range(len(self._names))]
        self._last, self._until = Light("green", ""), -np.inf

    def show(self, situation: Situation, changes: Sequence[Change], now: float) -> Light:
        """The light at `now` (s)."""
        light = _stopped(situation) or _waiting(situation) or self._changed(changes) or _strained(situation)
        if light is None:
            return self._last if now < self._until else Light("green", "the robot does what the person does")
        self._last, self._until = light, now + STAYS
        return light

    def noticed(self, changes: Iterable[Change]) -> list[tuple[Change, list[int]]]:
        """The changes that are large enough to be told, and the joints that each moved so far, the farthest first."""
        found = []
        for change in changes:
            large = np.flatnonzero(change.size >= self._least.get(change.reason, np.inf))
            if len(large):
                found.append((change, large[np.argsort(-change.size[large])].tolist()))
        return found

    def _changed(self, changes: Sequence[Change]) -> Light | None:
        noticed = self.noticed(changes)
        return Light("amber", "; ".join(self._told(change, joints) for change, joints in noticed)) if noticed else None

    def _told(self, change: Change, joints: Sequence[int]) -> str:
        if change.links:
            where = " and ".join(change.links)
        else:
            where = ", ".join(self._names[joint] for joint in joints[:SHOWN])
            where += f" and {len(joints) - SHOWN} more" if len(joints) > SHOWN else ""
        return f"{REASONS.get(change.reason, change.reason)} ({where})"


def _stopped(situation: Situation) -> Light | None:
    """Why the robot stands still, if it does."""
    if situation.fell:
        return Light("red", "the robot fell; reset it")
    if situation.paused or situation.silence is None or situation.learning:
        return None
    if situation.silence > SILENT:
        return Light("red", f"no frame for {situation.silence:.0f} s: it waits" if situation.silence >= 1.0 else
                     "no frames: it waits")  # fmt: skip
    return None if situation.seen else Light("red", "no arm of a person is seen: it waits")


def _waiting(situation: Situation) -> Light | None:
    if situation.paused:
        return Light("amber", "paused")
    if situation.silence is None:
        return Light("amber", "waiting for the first frame")
    return Light("amber", "finding out what the numbers mean") if situation.learning else None


def _strained(situation: Situation) -> Light | None:
    if situation.slow:
        return Light("amber", "this machine is too slow: the robot is behind")
    return Light("amber", f"frames come {situation.delay:.1f} s late") if situation.delay > LATE else None
