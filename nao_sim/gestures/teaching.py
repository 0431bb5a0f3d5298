"""A gesture added to a vocabulary from a few examples of it, of anybody."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nao_sim import body
from nao_sim.errors import UsageError
from nao_sim.gestures.directions import joined
from nao_sim.gestures.examples import MOSTLY, Example, Kind
from nao_sim.gestures.gesture_stream import stream_gestures
from nao_sim.gestures.movements import MovementRecogniser
from nao_sim.gestures.pose_examples import REST
from nao_sim.gestures.poses import NONE, PoseRecogniser
from nao_sim.gestures.streaming import segments_of
from nao_sim.gestures.vocabulary import Vocabulary
from nao_sim.gestures.windows import measures
from nao_sim.motion import JointTrajectory
from nao_sim.robot import Array


@dataclass(frozen=True, eq=False)
class Lesson:
    """What was learned; the robot's motion for it is still to be recorded.

    Attributes:
        name: of the gesture.
        kind: pose or movement.
        why: what in the examples says so, in a few words.
        vocabulary: with the gesture, and without any motion for it.
        known: whether the gesture was known before.
        typical: which of the examples is the most typical one.
        like: for each example the known gesture that it was taken for, `none` for none.
        heard: for each example what a stream announces in it now.
    """

    name: str
    kind: Kind
    why: str
    vocabulary: Vocabulary
    known: bool
    typical: int
    like: tuple[str, ...]
    heard: tuple[tuple[str, ...], ...]

    @property
    def rivals(self) -> tuple[str, ...]:
        """Known gestures for which examples were taken before the lesson, the most frequent first."""
        own = {NONE, self.name, body.twin(self.name)}
        return tuple(name for name, _ in Counter(self.like).most_common() if name not in own)

    @property
    def recognised(self) -> int:
        """In how many of its examples a stream announces it."""
        return sum(self.name in labels for labels in self.heard)

    @property
    def also_heard(self) -> tuple[str, ...]:
        """What else is announced in them, the most frequent first; hanging arms left out."""
        found = Counter(label for labels in self.heard for label in set(labels))
        return tuple(name for name, _ in found.most_common() if name not in (self.name, REST))

    def with_motion(self, motion: JointTrajectory) -> Vocabulary:
        """The vocabulary with what the robot does for the gesture; the other side's is that in a mirror."""
        motions = {name: each for name, each in self.vocabulary.motions.items() if name != body.twin(self.name)}
        return Vocabulary(self.vocabulary.poses, self.vocabulary.movements, {**motions, self.name: motion})


def teach(vocabulary: Vocabulary, name: str, examples: Sequence[Example], kind: Kind | None = None) -> Lesson:
    """Learn a gesture.

    A known pose gets the meaning of the examples; a known movement these
    examples besides those that it has.

    Args:
        vocabulary: what is known already.
        name: of the gesture; with one of `left_…` or `right_…` the other side's is learned, too.
        examples: one or more.
        kind: what it is; what most of the examples look like where None.

    Raises:
        UsageError: the examples do not do, or the name is one of the other kind.
    """
    found, why = (kind, f"--kind {kind}") if kind else kind_of(examples)
    _check_name(vocabulary, name, found)
    taught = _poses(vocabulary, name, examples) if found == "pose" else _movements(vocabulary, name, examples)
    left = {other: motion for other, motion in vocabulary.motions.items() if other != name}
    learned = Vocabulary(taught.poses, taught.movements, left)
    return Lesson(
        name=name,
        kind=found,
        why=why,
        vocabulary=learned,
        known=name in vocabulary.names,
        typical=typical(examples, found),
        like=tuple(_taken_for(vocabulary, example, found) for example in examples),
        heard=tuple(_announced(learned, example) for example in examples),
    )


def kind_of(examples: Sequence[Example]) -> tuple[Kind, str]:
    """Whether examples show a pose or a movement, and why."""
    share = float(np.mean([example.stillness for example in examples]))
    told = f"arms kept still for {100 * share:.0f} % of the time in which they do not hang"
    limit = f"{100 * MOSTLY:.0f} %"
    return ("pose", f"{told}, {limit} or more") if share >= MOSTLY else ("movement", f"{told}, less than {limit}")


def typical(examples: Sequence[Example], kind: Kind) -> int:
    """The example that is nearest to all others."""
    if len(examples) == 1:
        return 0
    if kind == "pose":
        known = [np.nan_to_num(example.readings.directions).mean(axis=0).ravel() for example in examples]
    else:
        known = [measures(example.window) for example in examples]
    table = np.stack(known)
    spread = table.std(axis=0)
    table = table / np.where(spread > 0.0, spread, 1.0)
    apart: Array = np.linalg.norm(table[:, None] - table, axis=2).sum(axis=1)
    return int(apart.argmin())


def _check_name(vocabulary: Vocabulary, name: str, kind: Kind) -> None:
    if name == NONE or not name.strip() or not name.isprintable():
        raise UsageError(f"a gesture called '{name}'; expected a word, and not '{NONE}', which means no gesture")
    others, other = (vocabulary.pose_names, "pose") if kind == "movement" else (vocabulary.movement_names, "movement")
    if name in others:
        raise UsageError(f"'{name}' is a {other} already; expected another name, or --kind {other}")


def _poses(vocabulary: Vocabulary, name: str, examples: Sequence[Example]) -> Vocabulary:
    readings = joined([example.readings for example in examples])
    poses = vocabulary.poses or PoseRecogniser.fit(readings, [name] * len(readings), single_arms=False)
    return Vocabulary(poses.taught(name, readings), vocabulary.movements)


def _movements(vocabulary: Vocabulary, name: str, examples: Sequence[Example]) -> Vocabulary:
    windows = [example.window for example in examples]
    if vocabulary.movements:
        return Vocabulary(vocabulary.poses, vocabulary.movements.taught(name, windows))
    return Vocabulary(vocabulary.poses, MovementRecogniser.fit(windows, [name] * len(windows)))


def _taken_for(vocabulary: Vocabulary, example: Example, kind: Kind) -> str:
    """The gesture of the same kind that an example was taken for before the lesson."""
    if kind == "movement":
        return vocabulary.movements.decide(example.window).label if vocabulary.movements else NONE
    labels = vocabulary.poses.decide(example.readings).labels if vocabulary.poses else (NONE,)
    return Counter(labels).most_common(1)[0][0]


def _announced(vocabulary: Vocabulary, example: Example) -> tuple[str, ...]:
    return tuple(segment.label for segment in segments_of(stream_gestures(vocabulary, example.skeleton)))
