"""From a data set to a vocabulary that knows its gestures, and what the robot does for them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from nao_sim.errors import UsageError
from nao_sim.gestures.evaluation.data_set import DataSet
from nao_sim.gestures.evaluation.kinds import Kind, Kinds
from nao_sim.gestures.evaluation.learning import learn
from nao_sim.gestures.examples import Kind as Shape
from nao_sim.gestures.teaching import typical
from nao_sim.gestures.vocabulary import Vocabulary, built_in_motions
from nao_sim.lesson import robot_motion
from nao_sim.motion import JointTrajectory
from nao_sim.robot import Robot, load_robot

Progress = Callable[[str, int, int], None]
SHAPES: dict[Kind, Shape] = {"poses": "pose", "movements": "movement"}


@dataclass(frozen=True, eq=False)
class Trained:
    """What came of a data set.

    Attributes:
        vocabulary: all that was learned, and what the robot does.
        robot: by gesture what its motion is, in a few words.
    """

    vocabulary: Vocabulary
    robot: dict[str, str]


def train(data: DataSet, kinds: Kinds, single_arms: bool, motions: bool, progress: Progress) -> Trained:
    """Learn the gestures of a data set, and record the robot's motions for them.

    Args:
        data: the examples.
        kinds: of its gestures.
        single_arms: whether to learn each symmetric pose with one arm alone, too.
        motions: whether to record motions of the examples, and not only take those that come with nao-sim.
        progress: called with a stage, and how many of its steps are done.

    Raises:
        UsageError: the examples do not do.
    """
    learned = learn(data.examples, kinds, single_arms)
    known = {name: motion for name, motion in built_in_motions().items() if name in learned.names}
    robot = dict.fromkeys(known, "as nao-sim's own")
    for number, (label, kind) in enumerate(kinds.of.items() if motions else ()):
        progress("motions", number, len(kinds.of))
        if found := _motion(data, label, SHAPES[kind], load_robot()):
            known[label], robot[label] = found
    lacking = {label: "rests: no example from which to take a motion" for label in kinds.of if label not in robot}
    return Trained(Vocabulary(learned.poses, learned.movements, known), robot | lacking)


def _motion(data: DataSet, label: str, shape: Shape, robot: Robot) -> tuple[JointTrajectory, str] | None:
    """What the robot does for a gesture, after its most typical example; None where the examples do not allow it."""
    own = [each for each in data.examples if each.label == label and each.shown is not None]
    if not own:
        return None
    shown = [each.shown for each in own if each.shown is not None]
    chosen = typical(shown, shape)
    try:
        motion, changed = robot_motion(shown[chosen], shape, robot)
    except UsageError:
        return None
    apart = math.degrees(changed)
    safe = f", made safe: changed by {apart:.0f}° on average" if apart >= 1.0 else ""
    return motion, f"as in {own[chosen].place}{safe}"
