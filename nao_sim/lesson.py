"""From recordings of a gesture to a vocabulary that knows it, and what the robot does for it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.files import check_results
from nao_sim.gestures.examples import Example, Kind, between, example_of
from nao_sim.gestures.performing import ARMS
from nao_sim.gestures.storage import load_vocabulary, save
from nao_sim.gestures.teaching import Lesson, teach
from nao_sim.gestures.vocabulary import Vocabulary, built_in
from nao_sim.imitation.retarget import retarget
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.recordings import Source, read
from nao_sim.robot import START_POSTURE, Robot, load_robot
from nao_sim.safety.guard import Guard
from nao_sim.simulation.performance import timeline
from nao_sim.simulation.simulator import CONTROL_STEP

HOLD = 2.0  # s for which a posture is asked for, so that the robot arrives on any way
Progress = Callable[[str, int, int], None]


@dataclass(frozen=True)
class Order:
    """What to learn.

    Attributes:
        name: of the gesture.
        sources: recordings of it.
        into: the vocabulary's file; what is in it is kept.
        base: another vocabulary's file to start from; the built-in one where None.
        kind: pose or movement; what the examples look like where None.
        start: s after the recording's first frame, where the only example begins.
        end: s, where it ends.
    """

    name: str
    sources: tuple[Source, ...]
    into: Path
    base: Path | None = None
    kind: Kind | None = None
    start: float | None = None
    end: float | None = None


@dataclass(frozen=True, eq=False)
class Taught:
    """What came of it.

    Attributes:
        lesson: what was learned.
        vocabulary: all that is known now, as it was saved.
        began_with: in words, what the vocabulary began with.
        changed: rad, by how much safety changed the robot's motion: of the joint changed most, the mean over time.
    """

    lesson: Lesson
    vocabulary: Vocabulary
    began_with: str
    changed: float


def give_lesson(order: Order, progress: Progress = lambda stage, done, total: None) -> Taught:
    """Read the examples, learn the gesture, record the robot's motion for it and save all.

    Raises:
        NaoSimError: a file cannot be read or written, or shows no gesture; nothing is written then.
    """
    check_results([order.into], *(source.path for source in order.sources))
    if not order.into.parent.is_dir():
        raise UsageError(f"{order.into}: no folder '{order.into.parent}'; expected one that is there")
    base, told = starting_point(order)
    examples = [_example(source, order) for source in order.sources]
    try:
        lesson = teach(base, order.name, examples, order.kind)
    except UsageError as error:
        raise UsageError(f"{order.sources[0].path}: {error}" if len(examples) == 1 else str(error)) from None
    motion, changed = robot_motion(examples[lesson.typical], lesson.kind, load_robot(), progress)
    vocabulary = lesson.with_motion(motion)
    save(order.into, vocabulary)
    return Taught(lesson, vocabulary, told, changed)


def starting_point(order: Order) -> tuple[Vocabulary, str]:
    """The vocabulary to add to, and in words which that is.

    Raises:
        UsageError: a file is no vocabulary, or there are two to choose from.
    """
    if order.into.exists() and order.base and order.base.resolve() != order.into.resolve():
        raise UsageError(
            f"--from {order.base}: {order.into} exists and is added to; expected another --into, or no --from"
        )
    if order.into.exists():
        return load_vocabulary(order.into), f"what {order.into} had"
    if order.base:
        return load_vocabulary(order.base), f"what {order.base} has"
    return built_in(), "the built-in vocabulary"


def robot_motion(
    example: Example, kind: Kind, robot: Robot, progress: Progress = lambda stage, done, total: None
) -> tuple[JointTrajectory, float]:
    """What the robot does for a gesture: what it imitates of an example, made safe.

    Of a pose the arms alone are kept, as a single frame; of a movement all that is
    imitated, while the arms do not hang.

    Returns:
        The motion, and by how much (rad) safety changed it on average.
    """
    imitated = retarget(
        example.pose if kind == "pose" else example.movement, robot, start=robot.postures[START_POSTURE]
    )
    asked = _posture(imitated.motion, robot) if kind == "pose" else imitated.motion
    safe, changed = guarded(asked, robot, progress)
    return (JointTrajectory(np.zeros(1), safe.positions[-1:], safe.given) if kind == "pose" else safe), changed


def guarded(
    motion: JointTrajectory, robot: Robot, progress: Progress = lambda stage, done, total: None
) -> tuple[JointTrajectory, float]:
    """A motion as the guard lets a standing robot do it, every control step; and its mean change (rad)."""
    start = robot.postures[START_POSTURE]
    guard = Guard(robot, start, standing=True)
    approach, requested = timeline(motion, start)
    commands = []
    for step, request in enumerate(requested, 1):
        commands.append(guard.step(request, CONTROL_STEP)[0])
        progress("checking", step, len(requested))
    times = CONTROL_STEP * np.arange(1, len(commands) + 1) - approach
    own = (times > -1e-9) & (times <= motion.duration + 1e-9)  # noqa: PLR2004  # without approach and rest
    asked, done = requested[own], np.stack(commands)[own]
    apart = np.where(np.isfinite(asked), np.abs(done - asked), 0.0)[:, motion.given & ~robot.is_hand]
    changed = float(apart.max(axis=1, initial=0.0).mean())
    return JointTrajectory(times[own] - times[own][0], done, motion.given), changed


def _posture(motion: JointTrajectory, robot: Robot) -> JointTrajectory:
    """The arms in the middle of a motion that holds still, held for `HOLD` seconds."""
    arms = robot.joints_of(*ARMS) & np.isfinite(motion.positions).any(axis=0)
    positions = np.full(len(arms), np.nan)
    positions[arms] = np.nanmedian(motion.positions[:, arms], axis=0)
    return JointTrajectory(np.array([0.0, HOLD]), np.stack([positions, positions]), arms)


def _example(source: Source, order: Order) -> Example:
    recording = read(source)
    if not isinstance(recording.motion, Skeleton):
        raise UsageError(f"{source.path}: holds joint angles ({recording.format}); expected a person's recording")
    try:
        return example_of(between(recording.motion, order.start, order.end))
    except UsageError as error:
        raise UsageError(f"{source.path}: {error}") from None
