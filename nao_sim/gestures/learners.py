"""Every learner of single postures, under one name each: the thesis's own and those it names as future work."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sklearn.ensemble import RandomForestClassifier, VotingRegressor
from sklearn.kernel_ridge import KernelRidge
from sklearn.linear_model import LogisticRegression, Ridge, RidgeClassifier
from sklearn.neighbors import KNeighborsClassifier
from sklearn.neural_network import MLPClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import PolynomialFeatures, StandardScaler
from sklearn.svm import SVC, SVR

from nao_sim.errors import UsageError
from nao_sim.gestures.arm_places import GROUPS, mirrored
from nao_sim.gestures.decision_rule import DecisionBasedRule
from nao_sim.gestures.regression import ClassScaleRegression, GradientDescentRegression, NormalEquationRegression
from nao_sim.robot import Array

ORDER = ("up", "piUp", "side", "forward", "down")  # of the decision rule: the thesis's, and piUp before side


@dataclass(frozen=True)
class Learner:
    """A way to learn labels from features.

    Attributes:
        about: what it is, in a few words.
        make: a new scikit-learn classifier with the given seed; those without chance leave it aside.
        random: whether the seed matters.
        places_only: whether it needs the columns of `nao_sim.gestures.arm_places.PLACES`.
    """

    about: str
    make: Callable[[int], Any]
    random: bool = False
    places_only: bool = False


def _scaled(model: Any) -> Any:
    return make_pipeline(StandardScaler(), model)


def _polynomial() -> Any:
    return make_pipeline(StandardScaler(), PolynomialFeatures(2), Ridge(1.0))


def _ensemble() -> Any:
    members = {
        "linear": _scaled(Ridge(1.0)),
        "polynomial": _polynomial(),
        "kernel": _scaled(KernelRidge(alpha=0.1, kernel="rbf", gamma=0.1)),
        "support vectors": _scaled(SVR(C=10.0)),
    }
    return VotingRegressor(list(members.items()))


LEARNERS: Mapping[str, Learner] = {
    "gradient descent": Learner("class numbers, 100 steps, as in the thesis", lambda _: GradientDescentRegression()),
    "normal equation": Learner("class numbers, as in the thesis", lambda _: NormalEquationRegression()),
    "polynomial regression": Learner("class numbers, degree 2, ridge", lambda _: ClassScaleRegression(_polynomial())),
    "ensemble of regressions": Learner("class numbers, mean of four", lambda _: ClassScaleRegression(_ensemble())),
    "one output a class": Learner("linear, ridge", lambda _: _scaled(RidgeClassifier())),
    "logistic": Learner("regularised, all classes at once", lambda _: _scaled(LogisticRegression(max_iter=1000))),
    "SVM": Learner("radial basis functions", lambda _: _scaled(SVC(C=10.0))),
    "k-NN": Learner("one neighbour", lambda _: _scaled(KNeighborsClassifier(1))),
    "random forest": Learner("100 trees", lambda seed: RandomForestClassifier(100, random_state=seed), random=True),
    "neural network": Learner(
        "one hidden layer of 16",
        lambda seed: _scaled(MLPClassifier((16,), solver="lbfgs", alpha=0.1, max_iter=1000, random_state=seed)),
        random=True,
    ),
    "decision rule": Learner(
        "the thesis's, with learned thresholds",
        lambda _: DecisionBasedRule(order=ORDER, groups=GROUPS),
        places_only=True,
    ),
}


def learner(name: str) -> Learner:
    """The learner of that name.

    Raises:
        UsageError: there is none.
    """
    if name not in LEARNERS:
        raise UsageError(f"no learner '{name}'; expected one of {', '.join(LEARNERS)}")
    return LEARNERS[name]


def learned_rule(places: Array, labels: NDArray[Any], none: str | None = "none") -> DecisionBasedRule:
    """The decision rule as it is used: learned from mirror images, too, so that both arms have the same thresholds.

    Args:
        places: (N, 12) as `nao_sim.gestures.arm_places.PLACES`, of gestures that both arms make alike.
        labels: (N,) of `GESTURES`.
        none: the label where no gesture holds; None forces the one that misses least.
    """
    rule = DecisionBasedRule(order=ORDER, groups=GROUPS, none=none)
    return rule.fit(np.concatenate([places, mirrored(places)]), np.concatenate([labels, labels]))
