"""How sparsely two gestures fill the space of features, all ten or only those that do not depend on others.

The interior elbow angles are dependent: the directions of upper arm and forearm determine them.  The reduced
features leave them out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nao_sim.gestures.held_out import leave_one_user_out
from nao_sim.gestures.regression import NormalEquationRegression
from nao_sim.gestures.training_table import TrainingTable
from nao_sim.imitation.features import FEATURES
from nao_sim.robot import Array

PAIR = ("side", "piUp")
DEPENDENT = ("RER", "LER")
REDUCED = tuple(name for name in FEATURES if name not in DEPENDENT)
SETS = {"all ten": FEATURES, "reduced": REDUCED}


@dataclass(frozen=True)
class Sparsity:
    """Two gestures in a set of features.

    Attributes:
        features: their names.
        condition: condition number of the printed rows' z-scores: what least squares can multiply an error by.
        nearest: the least distance between rows of the two gestures, z-scores.
        own: the normal equation's right answers among its own rows, all gestures.
        held_out: the same with each user left out.
        pair: the same for the two gestures alone.
        rows: how many rows, and how many of the two gestures.
    """

    features: tuple[str, ...]
    condition: float
    nearest: float
    own: int
    held_out: int
    pair: int
    rows: tuple[int, int]


def sparsity(table: TrainingTable, z_scores: Array, features: tuple[str, ...]) -> Sparsity:
    """Measure.

    Args:
        table: the rows.
        z_scores: (N, 10) of their features.
        features: which of them.
    """
    columns = [FEATURES.index(name) for name in features]
    values, members = table.features_deg[:, columns], np.isin(table.labels, PAIR)
    first, second = (z_scores[table.labels == name][:, columns] for name in PAIR)
    apart = np.linalg.norm(first[:, None] - second[None], axis=-1)
    model = NormalEquationRegression().fit(values, table.labels)
    everyone = leave_one_user_out(NormalEquationRegression, values, table.labels, table.users)
    pair = leave_one_user_out(NormalEquationRegression, values[members], table.labels[members], table.users[members])
    return Sparsity(
        features,
        float(np.linalg.cond(z_scores[:, columns])),
        float(apart.min()),
        int((model.predict(values) == table.labels).sum()),
        everyone.correct,
        pair.correct,
        (len(values), int(members.sum())),
    )
