"""A body reduced to where its parts point, a person's and a robot's alike, so that the two can be compared.

The ten links and the two ways to look at them are those of the program that
its authors published with Zhang et al. (2018; see `similarity_measures`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from nao_sim.body import SIDES
from nao_sim.imitation.arms import arm_directions_of, shoulder_of, turned_in
from nao_sim.imitation.features import UPPER_ARM
from nao_sim.imitation.mass import link_frames
from nao_sim.imitation.person import arm_directions, first_known, middle, torso_frames, unit, wrist
from nao_sim.motion import Skeleton
from nao_sim.robot import Array, facts, load_robot

ARM_LINKS = ("left_upper_arm", "left_forearm", "right_upper_arm", "right_forearm")
LINKS = ("torso", "head", *ARM_LINKS, "left_thigh", "left_shank", "right_thigh", "right_shank")
_LINKS_NEEDED = frozenset({"Head", "l_wrist", "r_wrist", "l_ankle", "r_ankle"})  # and all on the way to them
_SAME_TIME = 1e-6  # s


@dataclass(frozen=True, eq=False)
class BodyDirections:
    """Where the parts of a body point, over time; nan where that is not known.

    Attributes:
        times: (T,) s, strictly increasing.
        arms: (T, 2, 2, 3) unit vectors in the torso's frame: side, segment.
        hands: (T, 2, 3) from the shoulder to the hand in the torso's frame, arm lengths.
        upright: (T, 10, 3) unit vectors along `LINKS` in a frame with z up that faces where the torso faces.
        local: (T, 10, 3) unit vectors along `LINKS`, each in the frame of the link that it hangs on (the torso's
            own in the upright frame).
    """

    times: Array
    arms: Array
    hands: Array
    upright: Array
    local: Array

    def at(self, times: Array) -> BodyDirections:
        """The body at other times (N,), between frames where it must; nan outside and beside unknown frames."""
        left, right, weight = self._between(times)
        parts = {field.name: getattr(self, field.name) for field in fields(self) if field.name != "times"}
        between = {name: _blend(part[left], part[right], weight) for name, part in parts.items()}
        units = {name: part if name == "hands" else unit(part) for name, part in between.items()}
        return BodyDirections(times, **units)

    def _between(self, times: Array) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
        right = np.clip(np.searchsorted(self.times, times), 1, max(len(self.times) - 1, 1))
        left, right = right - 1, np.minimum(right, len(self.times) - 1)
        span = np.where(right > left, self.times[right] - self.times[left], 1.0)
        weight = (times - self.times[left]) / span
        for edge in (0.0, 1.0):
            weight = np.where(np.abs(weight - edge) * span < _SAME_TIME, edge, weight)
        return left, right, np.where((weight < 0.0) | (weight > 1.0), np.nan, weight)


def person_body(person: Skeleton) -> BodyDirections:
    """A person's body.

    The head's link runs from between the shoulders to the head, or to between
    the ears.  An arm's length is the median of the recording.
    """
    frames = torso_frames(person)
    base = first_known([person.track("chest"), middle(person, "shoulder"), person.track("neck")])
    head = first_known([person.track("head"), middle(person, "ear")]) - base
    legs = np.stack([np.stack(_leg(person, side), axis=1) for side in SIDES], axis=1)
    reach = [wrist(person, side) - person.track(f"{side}_shoulder") for side in SIDES]
    hands = np.stack([way / _arm_length(person, side) for way, side in zip(reach, SIDES, strict=True)], axis=1)
    return _body(
        person.times,
        arms=arm_directions(person),
        hands=_seen_from(frames, hands),
        legs=_seen_from(frames, unit(legs)),
        head=_seen_from(frames, unit(head)),
        torso=frames,
    )


def robot_body(times: Array, positions: Array, base_pose: Array | None = None) -> BodyDirections:
    """A robot's body.

    Its hand lies on the forearm's line, `HandOffsetX` beyond the wrist.  The
    elbow's sideways offset moves the forearm, and with it the hand, 15 mm.

    Args:
        times: (T,) s.
        positions: (T, 26), not finite where a joint is not known.
        base_pose: (T, 7) of the torso, as in a rollout.  Without it the foot that
            reaches lower stands flat, as in the authors' program; the torso is
            upright where the legs are not known.
    """
    positions = np.where(np.isfinite(positions), positions, np.nan)
    frames = link_frames(positions, load_robot(), _LINKS_NEEDED)
    legs = [[-frames[letter + link][0][:, :, 2] for link in ("Thigh", "Tibia")] for letter in "LR"]
    return _body(
        times,
        arms=arm_directions_of(positions),
        hands=np.stack([_robot_hand(frames, letter) for letter in "LR"], axis=1),
        legs=np.stack([np.stack(leg, axis=1) for leg in legs], axis=1),
        head=frames["Head"][0][:, :, 2],
        torso=_standing(frames) if base_pose is None else _rotation(base_pose),
    )


def _body(times: Array, *, arms: Array, hands: Array, legs: Array, head: Array, torso: Array) -> BodyDirections:
    """Everything from directions in the torso's frame and the torso's own (T, 3, 3)."""
    facing = np.arctan2(torso[:, 1, 0], torso[:, 0, 0])
    level = _about_z(-facing) @ torso
    limbs = np.concatenate([head[:, None], *(_pairs(part) for part in (arms, legs))], axis=1)
    trunk = level[:, None, :, 2]
    hanging = [head[:, None], _pairs(_hung_arms(arms)), _pairs(_hung_legs(legs))]
    return BodyDirections(
        times,
        arms=arms,
        hands=hands,
        upright=np.concatenate([trunk, np.einsum("tij,tnj->tni", level, limbs)], axis=1),
        local=np.concatenate([trunk, *hanging], axis=1),
    )


def _pairs(limbs: Array) -> Array:
    """(T, 4, 3): left upper, left lower, right upper, right lower of limbs (T, 2, 2, 3)."""
    return limbs.reshape(len(limbs), 4, 3)


def _hung_arms(arms: Array) -> Array:
    """Upper arms in the torso's frame, forearms in the frame that ShoulderPitch and ShoulderRoll give the upper arm."""
    upper_arm, forearm = np.moveaxis(arms, (2, 3), (0, 1))
    pitch, roll, _ = shoulder_of(upper_arm)
    return np.stack([arms[:, :, UPPER_ARM], np.stack(turned_in(forearm, pitch, roll), axis=-1)], axis=2)


def _hung_legs(legs: Array) -> Array:
    """Thighs in the torso's frame, shanks by how far the knee, which has one axis, is bent."""
    thigh, shank = legs[:, :, 0], legs[:, :, 1]
    bent, straight = np.linalg.norm(np.cross(thigh, shank), axis=-1), np.sum(thigh * shank, axis=-1)
    return np.stack([thigh, np.stack([-bent, np.zeros_like(bent), -straight], axis=-1)], axis=2)


def _robot_hand(frames: Mapping[str, tuple[Array, Array]], letter: str) -> Array:
    """(T, 3) in arm lengths, in the torso's frame."""
    origin = {joint["name"]: joint["origin_m"] for joint in facts()["joints"]}
    beyond = origin[f"{letter}Hand"][0]
    length = origin[f"{letter}ElbowYaw"][0] + origin[f"{letter}WristYaw"][0] + beyond
    wrist_at, forearm = frames[f"{letter.lower()}_wrist"][1], frames[f"{letter}ForeArm"][0]
    reach: Array = wrist_at + beyond * forearm[:, :, 0] - frames[f"{letter}Bicep"][1]
    return reach / length


def _standing(frames: Mapping[str, tuple[Array, Array]]) -> Array:
    """How the torso (T, 3, 3) leans over the lower foot when that one stands flat; upright where no foot is known."""
    left, right = frames["l_ankle"], frames["r_ankle"]
    other = (right[1][:, 2] < left[1][:, 2]) | np.isnan(left[0]).any(axis=(1, 2))
    torso = np.swapaxes(np.where(other[:, None, None], right[0], left[0]), 1, 2)
    return np.where(np.isfinite(torso).all(axis=(1, 2), keepdims=True), torso, np.eye(3))


def _rotation(base_pose: Array) -> Array:
    """The rotation matrices (T, 3, 3) of poses (T, 7; x y z, qw qx qy qz)."""
    from scipy.spatial.transform import Rotation

    matrices: Array = Rotation.from_quat(base_pose[:, [4, 5, 6, 3]]).as_matrix()
    return matrices


def _about_z(angle: Array) -> Array:
    """Rotation matrices (T, 3, 3)."""
    cosine, sine, zero, one = np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)
    return np.moveaxis(np.array([[cosine, -sine, zero], [sine, cosine, zero], [zero, zero, one]]), -1, 0)


def _leg(person: Skeleton, side: str) -> tuple[Array, Array]:
    hip, knee, ankle = (person.track(f"{side}_{joint}") for joint in ("hip", "knee", "ankle"))
    return knee - hip, ankle - knee


def _arm_length(person: Skeleton, side: str) -> float:
    """Upper arm and forearm, m; nan where they are never seen."""
    shoulder, elbow = person.track(f"{side}_shoulder"), person.track(f"{side}_elbow")
    way = np.linalg.norm(elbow - shoulder, axis=1) + np.linalg.norm(wrist(person, side) - elbow, axis=1)
    way = way[np.isfinite(way) & (way > 0.0)]
    return float(np.median(way)) if len(way) else np.nan


def _seen_from(frames: Array, vectors: Array) -> Array:
    """Vectors (T, ..., 3) in frames (T, 3, 3) whose columns are their axes."""
    return np.asarray(np.einsum("tji,t...j->t...i", frames, vectors))


def _blend(before: Array, after: Array, weight: Array) -> Array:
    """Between two arrays (N, ...) by weights (N,); the end points themselves are exact."""
    weight = weight.reshape(-1, *(1,) * (before.ndim - 1))
    between = before * (1.0 - weight) + after * weight
    return np.where(weight == 0.0, before, np.where(weight == 1.0, after, between))
