"""A data set evaluated: how well strangers' gestures are recognised."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.gestures.evaluation.contenders import ALL, OURS, Contender, contenders
from nao_sim.gestures.evaluation.data_set import DataSet
from nao_sim.gestures.evaluation.judging import Announcement, judged, judged_ours
from nao_sim.gestures.evaluation.kinds import Kind, Kinds, kinds_of
from nao_sim.gestures.evaluation.outcome import Outcome
from nao_sim.gestures.evaluation.splits import Plan, all_judged, plan
from nao_sim.gestures.vocabulary import Vocabulary

Progress = Callable[[str, int, int], None]


@dataclass(frozen=True)
class Wanted:
    """How to evaluate.

    Attributes:
        kind: what all gestures are taken for; decided by the data where None.
        folds: of a cross-validation by chance.
        learner: one that is tried beside ours, or `all`.
        single_arms: whether poses of both arms are learned with one arm alone, too.
        vocabulary: what judges all, so that nothing is learned; learned from the data where None.
        called: the vocabulary in a few words.
    """

    kind: Kind | None = None
    folds: int | None = None
    learner: str = OURS
    single_arms: bool = False
    vocabulary: Vocabulary | None = None
    called: str = "a vocabulary"


@dataclass(frozen=True)
class Part:
    """What was found of one kind of gestures.

    Attributes:
        outcomes: by learner, ours first.
        focus: the learner that the user is most interested in.
        left_out: learners that could not be tried, and why.
    """

    outcomes: dict[str, Outcome]
    focus: str
    left_out: tuple[str, ...] = ()

    @property
    def shown(self) -> Outcome:
        """That of the focus."""
        return self.outcomes[self.focus]


@dataclass(frozen=True)
class Evaluation:
    """What was found of a data set.

    Attributes:
        data: learned from, and judged by where there are no others.
        kinds: of its gestures.
        plan: who learned from whom.
        parts: by kind.
        announcements: of ours in a stream.
        skipped: recordings that could not be read, and why.
        notes: what a user should know of the figures.
    """

    data: DataSet
    kinds: Kinds
    plan: Plan
    parts: dict[Kind, Part]
    announcements: tuple[Announcement, ...]
    skipped: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def users(self) -> tuple[str, ...]:
        """Whose examples were judged, sorted."""
        asked = zip(self.plan.examples, *(split.test for split in self.plan.splits), strict=True)
        return tuple(sorted({each.user for each, *tests in asked if any(tests)}))

    @property
    def between_users(self) -> bool:
        """Whether there are several users to draw from."""
        return len(self.users) > 1


def evaluate(
    data: DataSet, test: DataSet | None = None, wanted: Wanted | None = None, progress: Progress | None = None
) -> Evaluation:
    """Evaluate learners on a data set.

    Args:
        data: the examples.
        test: others, that all of those are judged by.
        wanted: how; as `Wanted` has it where None.
        progress: called with a stage, and how many of its steps are done.

    Raises:
        UsageError: the data do not allow what is wanted.
        RecordingError: an example does not; names the line.
    """
    wanted = wanted or Wanted()
    if wanted.vocabulary:
        planned, kinds = _given(data, test, wanted, wanted.vocabulary)
    else:
        planned, kinds = plan(data, test, wanted.folds), kinds_of(data, wanted.kind)
    others = contenders(wanted.learner, kinds.present)
    if test is not None:
        kinds = kinds.joined(kinds_of(test, wanted.kind, kinds))
    tell = partial(progress, OURS) if progress else None
    own, announcements = judged_ours(
        planned.examples, planned.splits, kinds, wanted.single_arms, wanted.vocabulary, tell
    )
    parts = {
        kind: _part(kind, outcome, others.get(kind, []), wanted, planned, kinds, progress)
        for kind, outcome in own.items()
        if outcome.known.any()
    }
    skipped = (*data.skipped, *(test.skipped if test else ()))
    return Evaluation(data, kinds, planned, parts, announcements, skipped, _notes(planned, kinds, wanted.vocabulary))


def _given(data: DataSet, test: DataSet | None, wanted: Wanted, vocabulary: Vocabulary) -> tuple[Plan, Kinds]:
    """All judged by a vocabulary that has learned already; its gestures are of the kinds that it knows them as."""
    if test is not None or wanted.folds or wanted.single_arms or wanted.learner != OURS:
        raise UsageError(
            f"{wanted.called} has learned already; expected no --test, --folds, --learner or --single-arms"
        )
    known: dict[str, Kind] = dict.fromkeys(vocabulary.pose_names, "poses")
    known |= dict.fromkeys(vocabulary.movement_names, "movements")
    return all_judged(data, wanted.called), kinds_of(data, wanted.kind, Kinds(known, ()))


def _part(  # everything that a part is made of
    kind: Kind, own: Outcome, others: list[Contender], wanted: Wanted, planned: Plan, kinds: Kinds,
    progress: Progress | None,
) -> Part:  # fmt: skip
    """Try the other learners; of all of them, those that cannot learn from these examples are left out."""
    outcomes, left_out = {OURS: own}, []
    for each in others:
        tell = partial(progress, each.name) if progress else None
        try:
            outcomes[each.name] = judged(each, planned.examples, planned.splits, kinds, kind, tell)
        except UsageError as error:
            if wanted.learner != ALL:
                raise
            left_out.append(str(error))
    focus = wanted.learner if wanted.learner in outcomes else OURS
    return Part(outcomes, focus, tuple(left_out))


def _notes(planned: Plan, kinds: Kinds, vocabulary: Vocabulary | None) -> tuple[str, ...]:
    """Gestures that are judged and that nobody taught."""
    if vocabulary:
        unknown = [label for label in kinds.of if label not in vocabulary.names]
        return (f"Not in the vocabulary, so that they count as wrong: {', '.join(unknown)}.",) if unknown else ()
    untaught = []
    for label in kinds.of:
        own = np.array([each.label == label for each in planned.examples])
        lost = sum(bool((own & split.test).any() and not (own & split.train).any()) for split in planned.splits)
        if lost:
            untaught.append(f"{label} (in {lost} of {len(planned.splits)})")
    if not untaught:
        return ()
    return (f"In some rounds there is nothing to learn these from, and they count as wrong: {', '.join(untaught)}.",)
