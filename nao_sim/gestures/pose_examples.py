"""Poses out of examples: where the segments of each point, and how far examples of it differ."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from nao_sim import body
from nao_sim.errors import UsageError
from nao_sim.gestures.directions import ArmReadings
from nao_sim.imitation.person import unit
from nao_sim.robot import Array, Mask

TOLERANCE = np.radians(90.0 / 4.0)
REST = "down"  # where the other arm is in a pose of one arm
LIKE = np.radians(45.0)  # poses of 90 degrees apart are told half way between them
_MIRROR = np.array([1.0, -1.0, 1.0])
_HANGING = np.broadcast_to([0.0, 0.0, -1.0], (2, 2, 3))


class Pose(NamedTuple):
    """A pose.

    Attributes:
        name: what it is called.
        mean: (2, 2, 3) unit vectors: side (left, right), segment (upper arm, forearm), coordinate.
        spread: (2, 2) rad, standard deviation.
    """

    name: str
    mean: Array
    spread: Array

    def mirrored(self) -> Pose:
        """The pose in a mirror, under the twin of its name."""
        return Pose(body.twin(self.name), _mirrored(self.mean), self.spread[::-1])


def hanging(means: Array) -> Mask:
    """(..., 2) which arms of poses (..., 2, 2, 3) hang."""
    return np.asarray((means[..., 2] < -np.cos(LIKE)).all(axis=-1))


def pose_of(readings: ArmReadings, labels: Sequence[str], name: str) -> Pose:
    """The pose that examples of it show, both arms pooled where it is symmetric.

    Raises:
        UsageError: no example shows every segment.
    """
    rows = np.array([label == name for label in labels])
    directions, trust = np.nan_to_num(readings.directions[rows]), readings.trust[rows]
    mean = _mean(directions, trust, name)
    if _is_symmetric(mean):
        directions = np.concatenate([directions, directions[:, ::-1] * _MIRROR])
        trust = np.concatenate([trust, trust[:, ::-1]])
        mean = _mean(directions, trust, name)
    off = np.arccos(np.clip(np.einsum("tabi,abi->tab", directions, mean), -1.0, 1.0))
    weight = trust.sum()
    variance = float((trust * off**2).sum() / weight) / 2.0  # two ways to be off in space
    return Pose(name, mean, np.full((2, 2), np.hypot(TOLERANCE, np.sqrt(variance))))


def single_arms(poses: Sequence[Pose]) -> list[Pose]:
    """Each symmetric pose of raised arms with one arm alone, the other as in `REST`; names that are taken left out."""
    taken = {pose.name for pose in poses}
    straight = Pose(REST, _HANGING, np.full((2, 2), TOLERANCE))
    rest = next((pose for pose in poses if pose.name == REST), straight)
    raised = [pose for pose in poses if _is_symmetric(pose.mean) and not hanging(pose.mean).any()]
    found = []
    for pose in raised:
        for side, word in enumerate(body.SIDES):
            own = (np.arange(2) == side)[:, None]
            mean = np.where(own[..., None], pose.mean, rest.mean)
            found.append(Pose(f"{word}_{pose.name}", mean, np.where(own, pose.spread, rest.spread)))
    return [pose for pose in found if pose.name not in taken]


def _mean(directions: Array, trust: Array, name: str) -> Array:
    mean = np.einsum("tabi,tab->abi", directions, trust)
    if not (np.linalg.norm(mean, axis=-1) > 1e-6).all():  # noqa: PLR2004 (there is none, or opposite ones)
        raise UsageError(f"pose '{name}': no example shows all segments of the arms; expected at least one")
    return unit(mean)


def _is_symmetric(mean: Array) -> bool:
    return bool((np.einsum("abi,abi->ab", mean, _mirrored(mean)) > np.cos(LIKE)).all())


def _mirrored(mean: Array) -> Array:
    return mean[::-1] * _MIRROR
