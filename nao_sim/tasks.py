"""What the robot is asked to do with a recording, and where that comes from."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Protocol

from nao_sim.errors import UsageError
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.recordings import Recording
from nao_sim.rendering.arrangements import load_arrangement
from nao_sim.robot import START_POSTURE, Robot, load_robot

if TYPE_CHECKING:
    from nao_sim.gestures.recognised import Recognised
    from nao_sim.gestures.vocabulary import Vocabulary
    from nao_sim.imitation.retarget import Retargeted
    from nao_sim.replay import Orders


class Progress(Protocol):
    """Told how far the work is."""

    def __call__(self, stage: str, done: int, total: int) -> None:
        """`done` of `total` steps of a stage are finished."""


@dataclass(frozen=True, eq=False)
class Task:
    """What the robot is asked to do, and where it comes from.

    Attributes:
        recording: the file as read.
        robot: who is asked.
        motion: what is asked, at the speed at which it is asked.
        retargeted: the person whom the motion follows frame by frame, if it does.
        recognised: the gestures which the motion plays, if it does.
    """

    recording: Recording
    robot: Robot
    motion: JointTrajectory
    retargeted: Retargeted | None = None
    recognised: Recognised | None = None

    @property
    def person(self) -> Skeleton | None:
        """The person whom the motion follows, in the recording's time."""
        source = self.retargeted or self.recognised
        return source.person if source else None

    @property
    def notes(self) -> tuple[str, ...]:
        """What a user should know of how the motion came about."""
        source = self.retargeted or self.recognised
        return source.notes if source else ()


def tasks_of(recording: Recording, orders: Orders, progress: Progress) -> tuple[Task, ...]:
    """What the robot is asked to do, or what two are: the first imitates, the second plays gestures.

    Raises:
        UsageError: as `task_of`.
    """
    if not orders.both:
        return (task_of(recording, orders, progress),)
    player = task_of(recording, orders, progress)
    return task_of(recording, replace(orders, vocabulary=None), progress), player


def task_of(recording: Recording, orders: Orders, progress: Progress) -> Task:
    """What the robot is asked to do: the recording's own joint angles, or those that follow its person or gestures.

    Raises:
        UsageError: the person cannot be followed.
    """
    robot, motion = load_robot(orders.robot), recording.motion
    if isinstance(motion, JointTrajectory):
        return Task(recording, robot, motion.at_speed(orders.speed))
    if orders.vocabulary:
        return _gestures_of(recording, motion, robot, orders.vocabulary, orders.speed)
    from nao_sim.imitation.retarget import retarget

    try:
        retargeted = retarget(
            motion,
            robot,
            match=orders.match,
            body=orders.body,
            start=robot.postures[START_POSTURE],
            raw=orders.raw,
            speed=orders.speed,
            progress=lambda done, total: progress("retargeting", done, total),
        )
    except UsageError as error:
        raise UsageError(f"{recording.path}: {error}") from None
    return Task(recording, robot, retargeted.motion, retargeted)


def _gestures_of(recording: Recording, person: Skeleton, robot: Robot, vocabulary: Vocabulary, speed: float) -> Task:
    """Recognise gestures, and ask the robot for its motions for them.

    Raises:
        UsageError: no arm of the person is tracked.
    """
    from nao_sim.gestures.recognised import recognise

    try:
        recognised = recognise(person, vocabulary)
    except UsageError as error:
        raise UsageError(f"{recording.path}: {error}") from None
    motion = recognised.performed(robot, robot.postures[START_POSTURE])
    recognised = replace(recognised, person=person.at_speed(speed))
    return Task(recording, robot, motion.at_speed(speed), recognised=recognised)


def check_options(orders: Orders, recording: Recording) -> None:
    """Do not pass over an option that a recording of a robot's own motion has no use for.

    Raises:
        UsageError: one is given.
    """
    arrange = orders.film.arrangement if orders.film else ""
    given = {
        f"--mode {'both' if orders.both else 'gestures'}": orders.vocabulary is not None,
        "--match hands": orders.match == "hands",
        "--body whole": orders.body == "whole",
        "--raw": orders.raw,
        f"--arrange {arrange}": bool(arrange) and load_arrangement(arrange).needs_person,
    }
    if isinstance(recording.motion, JointTrajectory) and any(given.values()):
        option = next(option for option, is_given in given.items() if is_given)
        raise UsageError(
            f"{recording.path}: holds joint angles ({recording.format}); expected a person's recording for {option}"
        )
