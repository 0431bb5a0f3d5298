"""A person's motion as a robot's: every rule of this room in the order that they build on each other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.imitation.feasible import feasible_positions
from nao_sim.imitation.filters import Cleaning, clean
from nao_sim.imitation.hands import hand_positions
from nao_sim.imitation.head import head_positions
from nao_sim.imitation.person import arm_directions, torso_frames
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.robot import START_POSTURE, Array, Robot, load_robot

Match = Literal["directions", "hands"]
Body = Literal["arms", "whole"]
Progress = Callable[[int, int], None]
NEEDED = ("left_shoulder", "left_elbow", "left_wrist", "right_shoulder", "right_elbow", "right_wrist")


@dataclass(frozen=True, eq=False)
class Retargeted:
    """A person's motion as the robot is asked to do it.

    Attributes:
        motion: joint positions at the person's frames, inside the documented limits.
        person: the person after filtering, at the motion's speed.
        notes: what a user should know, what the filters did among it.
    """

    motion: JointTrajectory
    person: Skeleton
    notes: tuple[str, ...]


def retarget(  # the options of the command line
    skeleton: Skeleton,
    robot: Robot | None = None,
    *,
    match: Match = "directions",
    body: Body = "arms",
    start: Array | None = None,
    raw: bool = False,
    speed: float = 1.0,
    progress: Progress | None = None,
) -> Retargeted:
    """Let the robot do what the person does, one to one.

    Args:
        skeleton: the person.
        robot: whose limits hold; NAO v5 where None.
        match: `directions` points the robot's upper arms and forearms as the
            person's; `hands` brings its hands to the same places.
        body: `arms` moves arms and head; `whole` the legs and the lean of the torso, too.
        start: (26,) the posture to stand in where nothing else is asked; StandInit where None.
        raw: whether to leave out the filters.
        speed: times as fast as recorded that the robot shall move.
        progress: called with frames done and frames in all, by what takes long.

    Raises:
        UsageError: no arm of the person is tracked.
    """
    robot = robot or load_robot()
    person, cleaning = (skeleton, Cleaning()) if raw else clean(skeleton)
    person = person.at_speed(speed)  # after the filters, which know how fast people are
    positions, notes = one_to_one(person, robot), cleaning.notes()
    if not np.isfinite(positions).any():
        raise UsageError(f"no arm to imitate: only {', '.join(skeleton.joints)}; expected {', '.join(NEEDED)}")
    if match == "hands":
        from nao_sim.imitation.hands_match import match_hands

        positions = match_hands(person, positions, robot, progress)
    if body == "whole":
        from nao_sim.imitation.whole_body import whole_body_notes, whole_body_positions

        stand = robot.postures[START_POSTURE] if start is None else start
        positions = whole_body_positions(person, positions, robot, stand)
        notes += whole_body_notes(person)
    given = np.asarray(np.isfinite(positions).any(axis=0))
    return Retargeted(JointTrajectory(person.times, positions, given), person, notes)


def one_to_one(
    skeleton: Skeleton,
    robot: Robot,
    previous: Array | None = None,
    upright: float | None = None,
    torso: Array | None = None,
) -> Array:
    """Arms, head, wrists and hands that point as the person's.

    The same for a whole recording and, frame by frame, for a stream.

    Args:
        skeleton: the person, T frames.
        robot: whose limits hold.
        previous: (26,) the positions of the frame before the first.
        upright: rad, the nod that counts as looking ahead, as `head_positions` has it.
        torso: (T, 3, 3) the skeleton's `torso_frames`, where they are known already.

    Returns:
        (T, 26) inside the documented limits; nan where nothing is tracked, legs included.
    """
    torso = torso_frames(skeleton) if torso is None else torso
    arms = feasible_positions(arm_directions(skeleton, torso), robot, previous)
    parts = [arms, head_positions(skeleton, upright, torso), hand_positions(skeleton, arms, torso)]
    return np.asarray(np.fmax.reduce(parts))  # each joint is finite in one part at most
