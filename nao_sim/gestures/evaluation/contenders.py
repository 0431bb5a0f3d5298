"""All learners of gestures behind one interface: examples in, a judge of further examples out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.gestures.arm_places import places_of_directions
from nao_sim.gestures.directions import ArmReadings
from nao_sim.gestures.evaluation.data_set import Example
from nao_sim.gestures.evaluation.kinds import Kind
from nao_sim.gestures.learners import LEARNERS, Learner
from nao_sim.gestures.movements import MovementRecogniser
from nao_sim.gestures.poses import NONE, PoseRecogniser
from nao_sim.gestures.sequence_learners import SEQUENCE_LEARNERS
from nao_sim.gestures.vocabulary import Vocabulary
from nao_sim.robot import Array

OURS = "nao_sim"
ALL = "all"
SEED = 0


class Answer(NamedTuple):
    """What an example is taken for.

    Attributes:
        label: a gesture, or `none`.
        nearest: the gesture where `none` is no answer.
    """

    label: str
    nearest: str


Judge = Callable[[Example], Answer]


@dataclass(frozen=True)
class Contender:
    """A way to learn gestures of one kind.

    Attributes:
        name: what users call it.
        about: what it is, in a few words.
        train: learn from examples of gestures.
    """

    name: str
    about: str
    train: Callable[[Sequence[Example]], Judge]


ABOUT_OURS: Mapping[Kind, str] = {
    "poses": "directions of the arms, spreads from geometry",
    "movements": "kernel ridge regression on measures of a window",
}


def judge_of(vocabulary: Vocabulary, kind: Kind) -> Judge:
    """This project's own recogniser of a kind; it says `none` of everything where the vocabulary has none."""
    if kind == "poses":
        return pose_judge(vocabulary.poses) if vocabulary.poses else knows_nothing
    return movement_judge(vocabulary.movements) if vocabulary.movements else knows_nothing


def knows_nothing(_: Example) -> Answer:
    """The judge that nobody taught anything."""
    return Answer(NONE, NONE)


def pose_judge(recogniser: PoseRecogniser) -> Judge:
    """Most frames decide."""

    def judge(example: Example) -> Answer:
        found = recogniser.decide(example.pose)
        return Answer(most(found.labels), most(found.nearest))

    return judge


def movement_judge(recogniser: MovementRecogniser) -> Judge:
    """The whole stretch is one window."""

    def judge(example: Example) -> Answer:
        found = recogniser.decide(example.window)
        return Answer(found.label, found.nearest)

    return judge


def contenders(wanted: str, kinds: Sequence[Kind]) -> dict[Kind, list[Contender]]:
    """The learners called `wanted` beside ours, by kind; `all` for all of them, our own name for none.

    Raises:
        UsageError: there is none of that name for any of the kinds.
    """
    found = {}
    for kind in kinds:
        registry = LEARNERS if kind == "poses" else SEQUENCE_LEARNERS
        found[kind] = [_contender(*each, kind) for each in registry.items() if wanted in (ALL, each[0])]
    if wanted not in (OURS, ALL) and not any(found.values()):
        of = " and ".join(kinds)
        known = [each.name for group in contenders(ALL, kinds).values() for each in group]
        raise UsageError(f"--learner '{wanted}': no learner of {of}; expected one of {', '.join([ALL, OURS, *known])}")
    return found


def most(labels: Iterable[str]) -> str:
    """The most frequent label; of several the first."""
    return Counter(map(str, labels)).most_common(1)[0][0]


def _contender(name: str, learner: Learner, kind: Kind) -> Contender:
    train = _frames if kind == "poses" else _windows
    return Contender(name, learner.about, lambda examples: train(name, learner, examples))


def _frames(name: str, learner: Learner, examples: Sequence[Example]) -> Judge:
    """A classifier of single frames; most frames decide."""
    values = np.concatenate([_features(each.pose, learner) for each in examples])
    labels = np.array([each.label for each in examples for _ in range(len(each.pose))])
    try:
        model = learner.make(SEED).fit(values, labels)
    except ValueError as error:
        raise UsageError(f"learner '{name}': {str(error).splitlines()[0]}") from None

    def judge(example: Example) -> Answer:
        label = most(model.predict(_features(example.pose, learner)))
        return Answer(label, label)

    return judge


def _features(readings: ArmReadings, learner: Learner) -> Array:
    """(T, 12) directions or places, 0 where they are unknown."""
    known = np.nan_to_num(np.where(readings.trust[..., None] > 0.0, readings.directions, 0.0))
    return places_of_directions(known) if learner.places_only else known.reshape(len(known), -1)


def _windows(name: str, learner: Learner, examples: Sequence[Example]) -> Judge:
    """A classifier of windows, which may have `nearest(windows)`, too, where it can answer `none`."""
    model = learner.make(SEED)
    try:
        model.fit([each.window for each in examples], [each.label for each in examples])
    except ValueError as error:
        raise UsageError(f"learner '{name}': {str(error).splitlines()[0]}") from None
    forced = getattr(model, "nearest", model.predict)

    def judge(example: Example) -> Answer:
        label = str(model.predict([example.window])[0])
        return Answer(label, str(forced([example.window])[0]) if label == NONE else label)

    return judge
