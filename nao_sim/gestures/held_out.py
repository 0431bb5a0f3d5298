"""Who is judged by what was learned from whom: each user by all others, or each fold by the rest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nao_sim.robot import Array, Mask


@dataclass(frozen=True, eq=False)
class HeldOut:
    """What was predicted for users who were left out.

    Attributes:
        labels: (N,) the true ones.
        predicted: (N,) the predicted ones.
        users: (N,) whose the rows are.
    """

    labels: NDArray[Any]
    predicted: NDArray[Any]
    users: NDArray[Any]

    @property
    def correct(self) -> int:
        """How many are right."""
        return int((self.labels == self.predicted).sum())

    @property
    def by_user(self) -> Array:
        """(U,) share of each user's rows that are right, users in sorted order."""
        right = self.labels == self.predicted
        return np.array([right[self.users == user].mean() for user in np.unique(self.users)])


def leave_one_user_out(make: Callable[[], Any], features: Array, labels: NDArray[Any], users: NDArray[Any]) -> HeldOut:
    """Judge a learner.

    Args:
        make: a new scikit-learn classifier.
        features: (N, F).
        labels: (N,).
        users: (N,) whose the rows are.

    Raises:
        ValueError: there is only one user.
    """
    predicted = np.empty_like(labels)
    for out in each_user(users):
        predicted[out] = make().fit(features[~out], labels[~out]).predict(features[out])
    return HeldOut(labels, predicted, users)


def each_user(users: NDArray[Any]) -> list[Mask]:
    """The rows (N,) of each user, users in sorted order.

    Raises:
        ValueError: there is only one user.
    """
    names = np.unique(users)
    if len(names) < 2:  # noqa: PLR2004
        raise ValueError("rows of one user; expected two users or more")
    return [users == name for name in names]


def folds(labels: NDArray[Any], count: int, seed: int = 0) -> list[Mask]:
    """Rows (N,) dealt out by chance to `count` folds, each label as evenly as can be."""
    random, fold, dealt = np.random.default_rng(seed), np.empty(len(labels), int), 0
    for label in np.unique(labels):
        own = random.permutation(np.flatnonzero(labels == label))
        fold[own] = (dealt + np.arange(len(own))) % count
        dealt += len(own)
    return [fold == number for number in range(count)]


def confusion(labels: NDArray[Any], predicted: NDArray[Any], classes: tuple[str, ...]) -> NDArray[np.int_]:
    """How often each class (row) was taken for each (column), (K, K)."""
    return np.array([[int(((labels == a) & (predicted == b)).sum()) for b in classes] for a in classes])
