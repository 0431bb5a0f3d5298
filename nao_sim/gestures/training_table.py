"""The training table of the thesis: 28 labelled postures of both arms by six users (`trajectories/README.md`)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nao_sim.paths import TRAJECTORIES
from nao_sim.recordings.angles.thesis_table import postures
from nao_sim.recordings.source import Source
from nao_sim.robot import Array, read_only

GESTURES = ("side", "forward", "piUp", "up", "down")  # the class scale: side is 1, down 5
PATH = TRAJECTORIES / "thesis_table_a1.csv"
Labels = NDArray[np.str_]


@dataclass(frozen=True, eq=False)
class TrainingTable:
    """Labelled postures.

    Attributes:
        features: (N, 10) rad, in the order of `nao_sim.imitation.features.FEATURES`.
        labels: (N,) the gestures.
        users: (N,) whose they are, from 1.
    """

    features: Array
    labels: Labels
    users: NDArray[np.int_]

    @property
    def features_deg(self) -> Array:
        """(N, 10) degrees, as printed."""
        return np.asarray(np.round(np.degrees(self.features), 9), np.float64)


def thesis_table() -> TrainingTable:
    """The 28 printed rows; each user begins with the scale's first gesture.

    Raises:
        RecordingError: the file is missing or damaged.
    """
    _, features, labels = postures(Source(PATH))
    named = np.array(labels)
    users = np.cumsum(named == GESTURES[0])
    return TrainingTable(read_only(features), read_only(named, np.str_), read_only(users, np.int_))


def contradictions(table: TrainingTable) -> list[tuple[int, ...]]:
    """Rows that are one posture under several labels.

    Returns:
        Their numbers, from 1, a tuple for each such posture.
    """
    _, posture = np.unique(table.features, axis=0, return_inverse=True)
    alike = [np.flatnonzero(posture.ravel() == each) for each in range(posture.max() + 1)]
    found = [rows for rows in alike if len(set(table.labels[rows])) > 1]
    return sorted(tuple(int(row) + 1 for row in rows) for rows in found)


def ceiling(table: TrainingTable) -> int:
    """How many rows any function of the features can get right: of one posture the most frequent label."""
    _, posture = np.unique(table.features, axis=0, return_inverse=True)
    counts = [np.unique(table.labels[posture.ravel() == each], return_counts=True)[1] for each in set(posture.ravel())]
    return int(sum(count.max() for count in counts))
