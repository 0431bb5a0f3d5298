"""Learners tried on examples that they have not learned from."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from time import perf_counter

import numpy as np

from nao_sim.gestures.evaluation.contenders import Answer, Contender, Judge, judge_of, knows_nothing
from nao_sim.gestures.evaluation.data_set import Example
from nao_sim.gestures.evaluation.kinds import Kind, Kinds, of_kind
from nao_sim.gestures.evaluation.learning import learn
from nao_sim.gestures.evaluation.outcome import Outcome
from nao_sim.gestures.evaluation.splits import Split
from nao_sim.gestures.gesture_stream import stream_gestures
from nao_sim.gestures.poses import NONE
from nao_sim.gestures.streaming import PAUSE, segments_of
from nao_sim.gestures.vocabulary import Vocabulary

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Announcement:
    """What a stream said first of an example.

    Attributes:
        example: of what.
        label: what it announced; `none` where nothing.
        after: s from the example's first frame; nan where nothing.
    """

    example: Example
    label: str
    after: float


class _Tally:
    """Collects the answers of judges."""

    def __init__(self) -> None:
        self._rows: list[tuple[Example, Answer]] = []
        self._seconds: list[float] = []
        self._trained: list[float] = []

    def ask(self, train: Callable[[], Judge], asked: Sequence[Example], before: float = 0.0) -> None:
        """Have a judge learn, then decide; `before` s were spent on learning already."""
        began = perf_counter()
        judge = train()
        if asked:
            judge(asked[0])  # some learn when they are asked first
        self._trained.append(before + perf_counter() - began)
        for each in asked:
            began = perf_counter()
            self._rows.append((each, judge(each)))
            self._seconds.append(perf_counter() - began)

    def outcome(self) -> Outcome:
        """What was found."""
        fields = [(each.label, answer.label, answer.nearest, each.user) for each, answer in self._rows]
        labels, predicted, nearest, users = np.array(fields, dtype=str).reshape(-1, 4).T
        return Outcome(labels, predicted, nearest, users, np.array(self._seconds), float(np.median(self._trained)))


def judged(
    contender: Contender, examples: Sequence[Example], splits: Sequence[Split], kinds: Kinds, kind: Kind,
    progress: Progress | None = None,
) -> Outcome:  # fmt: skip
    """Try a learner on every example of a kind that a split judges.

    Raises:
        UsageError: it cannot learn from these examples.
    """
    tally = _Tally()
    for number, split in enumerate(splits, start=1):
        known, asked = (of_kind(kinds, kind, each) for each in _sides(examples, split))
        tally.ask(partial(contender.train, known) if known else partial(_itself, knows_nothing), asked)
        if progress:
            progress(number, len(splits))
    return tally.outcome()


def judged_ours(
    examples: Sequence[Example], splits: Sequence[Split], kinds: Kinds, single_arms: bool = False,
    given: Vocabulary | None = None, progress: Progress | None = None,
) -> tuple[dict[Kind, Outcome], tuple[Announcement, ...]]:  # fmt: skip
    """Try this project's own recognisers, each alone on its kind, and both together in a stream.

    They learn from each split, unless a vocabulary is given that has learned already.

    Raises:
        UsageError: they cannot learn from these examples.
    """
    tallies, found = {kind: _Tally() for kind in kinds.present}, list[Announcement]()
    for number, split in enumerate(splits, start=1):
        known, asked = _sides(examples, split)
        began = perf_counter()
        vocabulary = given or (learn(known, kinds, single_arms) if known else None)
        learned = perf_counter() - began
        for kind, tally in tallies.items():
            judge = judge_of(vocabulary, kind) if vocabulary else knows_nothing
            tally.ask(partial(_itself, judge), of_kind(kinds, kind, asked), learned)
        found += _announced(vocabulary, asked) if vocabulary else []
        if progress:
            progress(number, len(splits))
    return {kind: tally.outcome() for kind, tally in tallies.items()}, tuple(found)


def _itself(judge: Judge) -> Judge:
    return judge


def _sides(examples: Sequence[Example], split: Split) -> tuple[list[Example], list[Example]]:
    """The gestures that a split learns from, and all that it judges."""
    known = [each for each, use in zip(examples, split.train, strict=True) if use and each.known]
    return known, [each for each, use in zip(examples, split.test, strict=True) if use]


def _announced(vocabulary: Vocabulary, examples: Sequence[Example]) -> list[Announcement]:
    """What is announced first of each example that lasts long enough for a stream to say something."""
    found = []
    for each in examples:
        if each.person is not None and each.lasts >= PAUSE:
            segments = segments_of(stream_gestures(vocabulary, each.person))
            label, at = (segments[0].label, segments[0].start) if segments else (NONE, np.nan)
            found.append(Announcement(each, label, float(at - each.person.times[0])))
    return found
