"""The Decision Based Rule: thresholds in a table, tried class by class.

I. I. Itauma's MSc thesis (Istanbul Technical University, 2012) compared the
elbows' places beside the shoulders with 16 thresholds, in the order up,
sideways, forward, down, and set them by hand for each user.  Here a table
given by hand stays as it is; without one, thresholds are learned from labelled
data and are the same sort of table.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import check_is_fitted, validate_data

from nao_sim.gestures.learned_thresholds import learn
from nao_sim.gestures.thresholds import Threshold, class_margins
from nao_sim.robot import Array


class DecisionBasedRule(ClassifierMixin, BaseEstimator):  # type: ignore[misc]  # sklearn has no types
    """The first class all of whose thresholds hold.

    Args:
        thresholds: a table set by hand, for columns as it numbers them; learned
            by `fit` where None.
        order: the labels in the order they are tried; where None that of the table, or sorted.
        groups: columns that are decided about together, as those of an elbow: each group
            tells a class from all others that it can be told from.  One group where None.
        reach: where a learned threshold is on the way from the class to its
            neighbour, as a share; below 0.5 there is room for `none` between them.
        bound: the same for bounds that tell no two classes apart, but keep out what is far
            from all; no bounds where None.
        none: the label where no class holds; the class that misses least where None.

    Attributes:
        thresholds_: the table, learned or given.
        classes_: (K,) labels, sorted.
    """

    def __init__(
        self,
        thresholds: Sequence[Threshold] | None = None,
        *,
        order: Sequence[Any] | None = None,
        groups: Sequence[Sequence[int]] | None = None,
        reach: float = 0.5,
        bound: float | None = 0.7,
        none: Any = None,
    ) -> None:
        self.thresholds = thresholds
        self.order = order
        self.groups = groups
        self.reach = reach
        self.bound = bound
        self.none = none

    def fit(self, X: Any, y: Any) -> Self:  # noqa: N803 (scikit-learn's names)
        """Learn from quantities (N, F) and labels (N,); a given table learns nothing from them.

        Raises:
            ValueError: shapes, types or values are not as expected, the table speaks of a column
                that is not there, or `order` leaves out a label.
        """
        X, y = validate_data(self, X, y, dtype=np.float64)  # noqa: N806
        check_classification_targets(y)
        self.classes_ = np.unique(y)
        self.order_ = self._order()
        if self.thresholds is None:
            groups = [range(X.shape[1])] if self.groups is None else self.groups
            self.thresholds_ = learn(X, y, self.order_, groups, self.reach, self.bound)
        else:
            self.thresholds_ = tuple(self.thresholds)
        if highest := [row.quantity for row in self.thresholds_ if row.quantity >= X.shape[1]]:
            raise ValueError(f"the table has a threshold for column {highest[0]}, the data has {X.shape[1]} columns")
        return self

    def margins(self, X: Any) -> Array:  # noqa: N803
        """How well each class holds (N, K), in the order in which they are tried: `class_margins`."""
        check_is_fitted(self)
        return class_margins(self.thresholds_, self.order_, validate_data(self, X, dtype=np.float64, reset=False))

    def predict(self, X: Any) -> NDArray[Any]:  # noqa: N803
        """The labels (N,)."""
        margins = self.margins(X)
        holds = margins >= 0.0
        labels = np.array(self.order_, dtype=None if self.none is None else object)
        found = labels[np.where(holds.any(axis=1), np.argmax(holds, axis=1), np.argmax(margins, axis=1))]
        return found if self.none is None else _plain(np.where(holds.any(axis=1), found, self.none))

    def _order(self) -> list[Any]:
        labels = self.classes_.tolist()
        if self.thresholds is not None and self.order is None:
            return list(dict.fromkeys(row.label for row in self.thresholds))
        order = labels if self.order is None else list(self.order)
        if missing := [label for label in labels if label not in order]:
            raise ValueError(f"label {missing[0]!r} is not in the order {', '.join(map(str, order))}")
        return [label for label in order if label in labels or self.thresholds is not None]


def _plain(labels: NDArray[Any]) -> NDArray[Any]:
    """Text as text, and anything else as the objects they are."""
    return labels.astype(str) if all(isinstance(label, str) for label in labels) else labels
