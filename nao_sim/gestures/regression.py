"""Linear regression onto a scale of classes, as in I. I. Itauma's MSc thesis (Istanbul Technical University, 2012).

Classes are numbered in the order of the scale (side = 1, forward = 2, piUp = 3,
up = 4, down = 5), the number is regressed on the features, and the real-valued
output is rounded to a class.  That takes the classes for ordered and evenly
spaced, which gestures are not: these learners are here to be measured.

All are scikit-learn classifiers and keep its conventions.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.base import BaseEstimator, ClassifierMixin, clone
from sklearn.linear_model import LinearRegression
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import check_is_fitted, validate_data

from nao_sim.gestures.training_table import GESTURES
from nao_sim.robot import Array


class _ScaleRegression(ClassifierMixin, BaseEstimator):  # type: ignore[misc]  # sklearn has no types
    """A regression onto class numbers; what is fitted is the subclass's."""

    def __init__(self, *, scale: Sequence[Any] | None = None) -> None:
        self.scale = scale

    def fit(self, X: Any, y: Any) -> Self:  # noqa: N803 (scikit-learn's names)
        """Learn from features (N, F) and labels (N,).

        Raises:
            ValueError: shapes, types or values are not as expected, or a label is not on the scale.
        """
        X, y = validate_data(self, X, y, dtype=np.float64)  # noqa: N806
        check_classification_targets(y)
        self.classes_, members = np.unique(y, return_inverse=True)
        self.values_ = _values(self.classes_, self.scale)
        self._fit(X, self.values_[members])
        return self

    def regress(self, X: Any) -> Array:  # noqa: N803
        """The outputs (N,) on the scale of class numbers, before they are rounded."""
        check_is_fitted(self)
        return self._outputs(validate_data(self, X, dtype=np.float64, reset=False))

    def predict(self, X: Any) -> NDArray[Any]:  # noqa: N803
        """The labels (N,): of the classes that were learned, the one whose number is nearest; half-way, the higher."""
        outputs = self.regress(X)
        order = np.argsort(self.values_)
        values = self.values_[order]
        return self.classes_[order][np.searchsorted((values[1:] + values[:-1]) / 2.0, outputs, side="right")]

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.classifier_tags.poor_score = True  # classes on a line: three of them need not be told apart
        return tags

    def _fit(self, features: Array, values: Array) -> None:
        raise NotImplementedError

    def _outputs(self, features: Array) -> Array:
        raise NotImplementedError


class GradientDescentRegression(_ScaleRegression):
    """Batch gradient descent from zero on z-scored features.

    It minimises J(theta) = |A theta - y|^2 / (2 N), A the z-scored features
    after a column of ones, by theta <- theta - alpha A^T (A theta - y) / N.
    The z-scores divide by the sample standard deviation (N - 1).

    Args:
        learning_rate: alpha.
        max_iter: how many steps; the thesis took 100, far from convergence.
        scale: the labels in order; where None, `GESTURES` if it has all of them, else sorted.

    Attributes:
        theta_: (1 + F,) parameters, the intercept first.
        costs_: (max_iter + 1,) J before the first and after each step.
        mean_, deviation_: (F,) of the features.
        n_iter_: steps taken.
    """

    def __init__(self, *, learning_rate: float = 0.01, max_iter: int = 100, scale: Sequence[Any] | None = None) -> None:
        super().__init__(scale=scale)
        self.learning_rate = learning_rate
        self.max_iter = max_iter

    def _fit(self, features: Array, values: Array) -> None:
        self.mean_, self.deviation_ = features.mean(axis=0), _deviation(features)
        known = self._design(features)
        self.theta_ = np.zeros(known.shape[1])
        self.costs_ = np.empty(self.max_iter + 1)
        for step in range(self.max_iter + 1):
            errors = known @ self.theta_ - values
            self.costs_[step] = errors @ errors / (2.0 * len(values))
            if step < self.max_iter:
                self.theta_ -= self.learning_rate / len(values) * (known.T @ errors)
        self.n_iter_ = self.max_iter

    def _design(self, features: Array) -> Array:
        return _with_ones((features - self.mean_) / self.deviation_)

    def _outputs(self, features: Array) -> Array:
        return self._design(features) @ self.theta_


class NormalEquationRegression(_ScaleRegression):
    """The normal equation theta = (A^T A)^-1 A^T y, A the features as they are after a column of ones.

    It is solved by singular values, so that features which depend on each other
    give the shortest of all solutions and no error.

    Args:
        scale: the labels in order; where None, `GESTURES` if it has all of them, else sorted.

    Attributes:
        theta_: (1 + F,) parameters, the intercept first.
    """

    def _fit(self, features: Array, values: Array) -> None:
        self.theta_ = np.linalg.lstsq(_with_ones(features), values, rcond=None)[0]

    def _outputs(self, features: Array) -> Array:
        return _with_ones(features) @ self.theta_


class ClassScaleRegression(_ScaleRegression):
    """Any regressor of scikit-learn onto the scale of class numbers.

    Args:
        regressor: what to fit; least squares where None.
        scale: the labels in order; where None, `GESTURES` if it has all of them, else sorted.

    Attributes:
        regressor_: the fitted regressor.
    """

    def __init__(self, regressor: Any = None, *, scale: Sequence[Any] | None = None) -> None:
        super().__init__(scale=scale)
        self.regressor = regressor

    def _fit(self, features: Array, values: Array) -> None:
        self.regressor_ = clone(LinearRegression() if self.regressor is None else self.regressor).fit(features, values)

    def _outputs(self, features: Array) -> Array:
        return np.asarray(self.regressor_.predict(features), float)


def _values(classes: NDArray[Any], scale: Sequence[Any] | None) -> Array:
    """The numbers (K,) of sorted classes, from 1."""
    labels = classes.tolist()
    places = list(scale if scale is not None else GESTURES if set(labels) <= set(GESTURES) else labels)
    if missing := [label for label in labels if label not in places]:
        raise ValueError(f"label {missing[0]!r} is not on the scale {', '.join(map(str, places))}")
    return np.array([places.index(label) + 1.0 for label in labels])


def _deviation(features: Array) -> Array:
    """Sample standard deviations (F,), 1 where a feature never changes."""
    spread = features.std(axis=0, ddof=1) if len(features) > 1 else np.zeros(features.shape[1])
    return np.where(spread > 0.0, spread, 1.0)


def _with_ones(features: Array) -> Array:
    return np.column_stack([np.ones(len(features)), features])
