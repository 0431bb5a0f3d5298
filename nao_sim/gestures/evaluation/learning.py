"""A vocabulary out of labelled examples, as `nao-sim train` and every fold of an evaluation learn it."""

from __future__ import annotations

from collections.abc import Sequence

from nao_sim.errors import UsageError
from nao_sim.gestures.directions import joined
from nao_sim.gestures.evaluation.data_set import Example
from nao_sim.gestures.evaluation.kinds import Kinds, of_kind
from nao_sim.gestures.movements import MovementRecogniser
from nao_sim.gestures.poses import PoseRecogniser
from nao_sim.gestures.vocabulary import Vocabulary


def learn(examples: Sequence[Example], kinds: Kinds, single_arms: bool = False) -> Vocabulary:
    """Learn poses and movements; negative examples teach nothing.

    Args:
        examples: of any people in any order.
        kinds: which labels are poses, which movements.
        single_arms: whether to add each symmetric pose with one arm alone.

    Raises:
        UsageError: no example shows a gesture, or a name is that of a pose and of a movement.
    """
    shown = [example for example in examples if example.known]
    poses, movements = of_kind(kinds, "poses", shown), of_kind(kinds, "movements", shown)
    if not (poses or movements):
        raise UsageError("no example to learn from; expected at least one gesture")
    taught = learn_poses(poses, single_arms) if poses else None, learn_movements(movements) if movements else None
    try:
        return Vocabulary(*taught)
    except ValueError as error:  # a pose with one arm alone may have the name of a movement
        raise UsageError(str(error)) from None


def learn_poses(examples: Sequence[Example], single_arms: bool = False) -> PoseRecogniser:
    """Learn poses from the frames of their examples in which the arms keep still."""
    labels = [example.label for example in examples for _ in range(len(example.pose))]
    return PoseRecogniser.fit(joined([example.pose for example in examples]), labels, single_arms)


def learn_movements(examples: Sequence[Example]) -> MovementRecogniser:
    """Learn movements."""
    return MovementRecogniser.fit([each.window for each in examples], [each.label for each in examples])
