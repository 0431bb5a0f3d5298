"""What the thesis's learners make of its printed rows: every number that `nao-sim reproduce` shows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nao_sim.gestures.arm_places import places_of_directions
from nao_sim.gestures.decision_rule import DecisionBasedRule
from nao_sim.gestures.hand_set import HAND_SET, UPPER_ARM
from nao_sim.gestures.held_out import HeldOut, leave_one_user_out
from nao_sim.gestures.learners import LEARNERS, learned_rule
from nao_sim.gestures.regression import GradientDescentRegression, NormalEquationRegression
from nao_sim.gestures.thesis.closed_form import Descent
from nao_sim.gestures.thesis.published import Published, published
from nao_sim.gestures.training_table import GESTURES, TrainingTable, thesis_table
from nao_sim.imitation.features import directions_of
from nao_sim.robot import Array

_OUTWARD = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, 1.0]])


@dataclass(frozen=True, eq=False)
class Trial:
    """A way to learn, judged on the rows it was learned from and on users it has not seen.

    Attributes:
        name: of the learner.
        own: (N,) labels predicted for its own rows.
        held_out: those for users left out.
    """

    name: str
    own: NDArray[Any]
    held_out: HeldOut

    @property
    def own_correct(self) -> int:
        """How many of its own rows are right."""
        return int((self.own == self.held_out.labels).sum())


@dataclass(frozen=True, eq=False)
class Study:
    """Everything that was computed.

    Attributes:
        table: the printed rows.
        figures: the published ones.
        descent: gradient descent with the thesis's rate and steps.
        closed: the same cost for any rate and steps.
        normal: the normal equation.
        trials: learners judged, by name.
        hand_set: (N,) labels by the hand-set decision rule of the rows as postures of an adult, or `none`.
        rule: the decision rule with thresholds learned from all rows and their mirror images.
    """

    table: TrainingTable
    figures: Published
    descent: GradientDescentRegression
    closed: Descent
    normal: NormalEquationRegression
    trials: dict[str, Trial]
    hand_set: NDArray[np.str_]
    rule: DecisionBasedRule

    def z_scores(self, features_deg: Array) -> Array:
        """Features (N, 10) in degrees by mean and sample deviation of the printed rows."""
        return (features_deg - self.descent.mean_) / self.descent.deviation_

    def output(self, theta: Array, features_deg: Array) -> Array:
        """Outputs (N,) of parameters for z-scored features."""
        return theta[0] + self.z_scores(features_deg) @ theta[1:]


def study() -> Study:
    """Compute it all, a second of work."""
    table, figures = thesis_table(), published()
    angles, directions = table.features_deg, directions_of(table.features)
    descent = GradientDescentRegression(learning_rate=figures.learning_rate, max_iter=figures.iterations)
    descent.fit(angles, table.labels)
    z_scores = (angles - descent.mean_) / descent.deviation_
    numbers = np.array([GESTURES.index(label) + 1.0 for label in table.labels])
    closed = Descent(np.column_stack([np.ones(len(angles)), z_scores]), numbers)
    normal = NormalEquationRegression().fit(angles, table.labels)
    places = places_of_directions(directions)
    return Study(
        table,
        figures,
        descent,
        closed,
        normal,
        _trials(table, places),
        _by_hand(directions),
        learned_rule(places, table.labels),
    )


def _trials(table: TrainingTable, places: Array) -> dict[str, Trial]:
    angles = table.features_deg
    compared = {"gradient descent": angles, "normal equation": angles, "logistic": angles, "decision rule": places}
    return {name: _trial(name, values, table) for name, values in compared.items()}


def _trial(name: str, values: Array, table: TrainingTable) -> Trial:
    def make() -> Any:
        return LEARNERS[name].make(0)

    own = make().fit(values, table.labels).predict(values)
    return Trial(name, own, leave_one_user_out(make, values, table.labels, table.users))


def _by_hand(directions: Array) -> NDArray[np.str_]:
    """The hand-set rule's labels (N,) for directions (N, 2, 2, 3) of the adult that it was set for."""
    offsets = UPPER_ARM * (directions[:, :, 0] * _OUTWARD).reshape(len(directions), -1)
    rule = DecisionBasedRule(HAND_SET, none="none").fit(offsets, ["up"] * len(offsets))
    return rule.predict(offsets)
