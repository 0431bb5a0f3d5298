"""What a learner said of examples, and the figures of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from nao_sim.gestures.held_out import confusion
from nao_sim.gestures.poses import NONE
from nao_sim.gestures.shares import Share, between_groups, share_of
from nao_sim.robot import Array

Texts = NDArray[Any]


class ClassFigures(NamedTuple):
    """How one gesture did.

    Attributes:
        label: of it.
        recall: how many of its examples were recognised.
        precision: how many of the examples that were taken for it are examples of it.
        f1: harmonic mean of both, 0 where both are 0.
    """

    label: str
    recall: Share
    precision: Share
    f1: float


@dataclass(frozen=True, eq=False)
class Outcome:
    """What a learner said of N examples that it had not learned from.

    Attributes:
        labels: (N,) what they show, `none` where no gesture.
        predicted: (N,) what they were taken for, `none` where for no gesture.
        nearest: (N,) what they were taken for where `none` is no answer.
        users: (N,) who made them.
        seconds: (N,) that each decision took.
        trained: s that learning took, a fold.
    """

    labels: Texts
    predicted: Texts
    nearest: Texts
    users: Texts
    seconds: Array
    trained: float = math.nan

    @property
    def known(self) -> NDArray[np.bool_]:
        """(N,) which show a gesture."""
        return np.asarray(self.labels != NONE)

    @property
    def accuracy(self) -> Share:
        """Gestures recognised; those told `none` are wrong."""
        return share_of((self.labels == self.predicted)[self.known])

    @property
    def forced(self) -> Share:
        """Gestures recognised where `none` is no answer."""
        return share_of((self.labels == self.nearest)[self.known])

    @property
    def told_none(self) -> Share:
        """Gestures that were told `none`."""
        return share_of((self.predicted == NONE)[self.known])

    @property
    def false_alarms(self) -> Share:
        """Examples of no gesture that were told one."""
        return share_of((self.predicted != NONE)[~self.known])

    @property
    def by_classes(self) -> tuple[ClassFigures, ...]:
        """Of each gesture that was shown, sorted."""
        found = []
        for label in np.unique(self.labels[self.known]):
            recall = share_of((self.predicted == label)[self.labels == label])
            precision = share_of((self.labels == label)[self.predicted == label])
            f1 = 2.0 * recall.right / (recall.count + precision.count)
            found.append(ClassFigures(str(label), recall, precision, f1))
        return tuple(found)

    @property
    def macro_f1(self) -> float:
        """Mean F1 of the gestures that were shown; nan where none was."""
        return float(np.mean([each.f1 for each in self.by_classes])) if self.known.any() else math.nan

    @property
    def by_users(self) -> dict[str, Share]:
        """Accuracy of each user who showed a gesture, the worst first; `?` where nobody is named."""
        known, right = self.users[self.known], (self.labels == self.predicted)[self.known]
        shares = {str(user) or "?": share_of(right[known == user]) for user in np.unique(known)}
        return dict(sorted(shares.items(), key=lambda item: (item[1].value, -item[1].count, item[0])))

    @property
    def users_interval(self) -> tuple[float, float]:
        """Of the accuracy, where users and not examples are drawn."""
        return between_groups((self.labels == self.predicted)[self.known], self.users[self.known])

    @property
    def classes(self) -> tuple[str, ...]:
        """All labels that were shown or answered, sorted, `none` last."""
        named = {*map(str, self.labels), *map(str, self.predicted)}
        return (*sorted(named - {NONE}), *(named & {NONE}))

    @property
    def confusion(self) -> NDArray[np.int_]:
        """(K, K) how often each of the `classes` (row) was taken for each (column)."""
        return confusion(self.labels, self.predicted, self.classes)

    def as_report(self) -> dict[str, Any]:
        """As the JSON has it; times are left out, as they differ from run to run."""
        return {
            "accuracy": self.accuracy.as_report(),
            "accuracy_interval_between_users": [round(bound, 6) for bound in self.users_interval],
            "macro_f1": round(self.macro_f1, 6),
            "forced_accuracy": self.forced.as_report(),
            "gestures_told_none": self.told_none.as_report(),
            "negatives_told_a_gesture": self.false_alarms.as_report(),
            "classes": {
                each.label: {
                    "recall": each.recall.as_report(), "precision": each.precision.as_report(), "f1": round(each.f1, 6)
                }
                for each in self.by_classes
            },
            "users": {user: share.as_report() for user, share in self.by_users.items()},
            "confusion": {"classes": list(self.classes), "counts": self.confusion.tolist()},
        }  # fmt: skip
