"""Leave-one-user-out: every user is judged by what was learned from all others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nao_sim.robot import Array


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
    if len(np.unique(users)) < 2:  # noqa: PLR2004
        raise ValueError("rows of one user; expected two users or more")
    predicted = np.empty_like(labels)
    for user in np.unique(users):
        out = users == user
        predicted[out] = make().fit(features[~out], labels[~out]).predict(features[out])
    return HeldOut(labels, predicted, users)


def confusion(labels: NDArray[Any], predicted: NDArray[Any], classes: tuple[str, ...]) -> NDArray[np.int_]:
    """How often each class (row) was taken for each (column), (K, K)."""
    return np.array([[int(((labels == a) & (predicted == b)).sum()) for b in classes] for a in classes])
