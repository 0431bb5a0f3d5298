"""A sample of a person's joints: where its parts are, how long its bones, which way is up and left.

All of it is in the units and axes of whoever asks, and is nan where the joints
for it are missing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from nao_sim.body import Bone, bones
from nao_sim.robot import Array

BEYOND = {"wrist": 1.34, "ankle": 1.07}  # from elbow to hand in forearms, from knee to toes in shanks (body.toml)
STAND_INS = {"wrist": "hand", "ankle": "foot"}  # of layouts with one point at the end of a limb


@dataclass(frozen=True, eq=False)
class Body:
    """A sample of a person's joints.

    Attributes:
        joints: (J,) names, as `nao_sim.body` has them.
        values: (S, J, 3) positions, nan where missing.
    """

    joints: tuple[str, ...]
    values: Array

    def track(self, *names: str) -> Array:
        """The mean (S, 3) of some joints; nan unless all are there."""
        if not all(name in self.joints for name in names):
            return np.full((len(self.values), 3), np.nan)
        return np.mean([self.values[:, self.joints.index(name)] for name in names], axis=0)

    def limb(self, name: str) -> Array:
        """A joint, or where its limb ends if it is not there: a hand for the wrist, toes for the ankle, (S, 3)."""
        return self.track(_limb(name, self.joints))

    def first(self, *choices: Sequence[str]) -> Array:
        """In each frame the first of several means that is known, (S, 3)."""
        found = self.track(*choices[0])
        for choice in choices[1:]:
            found = np.where(np.isnan(found), self.track(*choice), found)
        return found

    @cached_property
    def shoulders(self) -> Array:
        """Between the shoulders, (S, 3)."""
        return self.first(("left_shoulder", "right_shoulder"), ("chest",), ("neck",))

    @cached_property
    def hips(self) -> Array:
        """Between the hips, (S, 3)."""
        return self.first(("left_hip", "right_hip"), ("pelvis",))

    @cached_property
    def head(self) -> Array:
        """The head or what is known of it, (S, 3)."""
        return self.first(("head",), ("left_ear", "right_ear"), ("left_eye", "right_eye"), ("nose",), ("neck",))

    @cached_property
    def upward(self) -> Array:
        """From the pelvis to the head, or the longest known part of that way, (S, 3) of length 1."""
        ways = (self.head - self.hips, self.shoulders - self.hips, self.head - self.track("spine"))
        found = ways[0]
        for way in (*ways[1:], self.shoulders - self.track("spine"), self.head - self.shoulders):
            found = np.where(np.isnan(found), way, found)
        return unit(found)

    @cached_property
    def leftward(self) -> Array:
        """From the right shoulder (or hip) to the left, (S, 3) of length 1."""
        across = self.track("left_shoulder") - self.track("right_shoulder")
        return unit(np.where(np.isnan(across), self.track("left_hip") - self.track("right_hip"), across))

    @cached_property
    def lengths(self) -> dict[Bone, Array]:
        """Known lengths (N,) of each bone that has any."""
        known, starts, ends = bones_between(self.joints)
        lengths = np.linalg.norm(self.values[:, ends] - self.values[:, starts], axis=2)
        if np.isfinite(lengths).all():
            return {bone: lengths[:, column] for column, bone in enumerate(known)}
        found = {bone: lengths[np.isfinite(lengths[:, column]), column] for column, bone in enumerate(known)}
        return {bone: length for bone, length in found.items() if len(length)}

    @cached_property
    def medians(self) -> dict[Bone, float]:
        """Median length of each bone that has any."""
        lengths = list(self.lengths.values())
        if lengths and all(len(known) == len(self.values) for known in lengths):
            return dict(zip(self.lengths, np.median(lengths, axis=1).tolist(), strict=True))
        return {bone: float(np.median(known)) for bone, known in self.lengths.items()}

    @cached_property
    def height(self) -> float:
        """The height that the bones tell: the median over bones; nan where none has a length."""
        return median(np.array([length / bone.length for bone, length in self.medians.items()]))

    @cached_property
    def width(self) -> float:
        """From shoulder to shoulder."""
        width = median(np.linalg.norm(self.track("left_shoulder") - self.track("right_shoulder"), axis=1))
        return max(width, 1e-9 * self.height)


@cache
def bones_between(joints: tuple[str, ...]) -> tuple[tuple[Bone, ...], list[int], list[int]]:
    """The bones whose ends are among some joints, and where those ends are."""
    all_bones = (_ending(bone, joints) for bone in bones())
    known = tuple(bone for bone in all_bones if bone.start in joints and bone.end in joints)
    return known, [joints.index(bone.start) for bone in known], [joints.index(bone.end) for bone in known]


def _ending(bone: Bone, joints: tuple[str, ...]) -> Bone:
    """A bone, or the longer one to where its limb ends if its own end is not there."""
    end = _limb(bone.end, joints)
    if end in (bone.end, bone.start):
        return bone
    return Bone(bone.start, end, bone.length * BEYOND[bone.end.partition("_")[2]])


def _limb(name: str, joints: tuple[str, ...]) -> str:
    side, _, part = name.partition("_")
    other = f"{side}_{STAND_INS[part]}" if part in STAND_INS else name
    return other if name not in joints and other in joints else name


def ahead(of: Array, forward: Array) -> Array:
    """How far vectors (S, 3) go along directions (S, 3), (S,)."""
    return np.einsum("si,si->s", of, forward)


def unit(vectors: Array) -> Array:
    """Vectors (S, 3) at length 1; nan where there is no direction."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def median(values: Array) -> float:
    """The median of what is finite; nan where nothing is."""
    known = np.sort(values[np.isfinite(values)])
    return float(known[len(known) // 2] + known[(len(known) - 1) // 2]) / 2 if len(known) else np.nan


def middle(vectors: Array) -> Array:
    """The median (3,) of the known ones of some vectors (S, 3); nan where none is."""
    return np.array([median(component) for component in vectors.T])
