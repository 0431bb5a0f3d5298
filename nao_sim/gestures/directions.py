"""How a person holds the arms, told so that every person and every sensor tells it alike.

Four unit directions (upper arm and forearm of both sides, in the person's own
frame) do not change with the person's size, place or turn.  They have no
ill-conditioned angle: the azimuth of an arm that hangs is noise, its direction
is not.  Each comes with a trust from 0 to 1, so that a bad arm is left out of a
decision instead of spoiling it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache

import numpy as np

from nao_sim import body
from nao_sim.imitation.features import directions_of, elbow_disagreement, interior_angle
from nao_sim.imitation.filters.rejection import MIN_CONFIDENCE
from nao_sim.imitation.person import arm_directions, middle, shoulder_centre, wrist
from nao_sim.motion import Skeleton
from nao_sim.recordings.angles.thesis_table import SUSPECT
from nao_sim.robot import Array, read_only

SEGMENTS = (2, 2)  # side (left, right), segment (upper arm, forearm)
FOLDED = np.radians(15.0)  # rad; flesh stops elbows at an interior angle of 30 to 40 degrees
_MIRROR = np.array([1.0, -1.0, 1.0])
_ENDS = (("shoulder", "elbow"), ("elbow", "wrist"))


@dataclass(frozen=True, eq=False)
class ArmReadings:
    """How the arms were held in T frames.

    Attributes:
        directions: (T, 2, 2, 3) unit vectors, x forward, y left, z up: side
            (left, right), segment (upper arm, forearm); nan where unknown.
        trust: (T, 2, 2) from 0 (not to be used) to 1; 0 where unknown.
        planar: whether one camera saw them and x is 0 throughout.
        seen: (T, 2, 2) how long a segment was seen, in lengths of an average
            person's; 1 where depth is known.
    """

    directions: Array
    trust: Array = field(default_factory=lambda: np.ones(()))
    planar: bool = False
    seen: Array = field(default_factory=lambda: np.ones(()))

    def __post_init__(self) -> None:
        directions = read_only(self.directions)
        if directions.ndim != 4 or directions.shape[1:] != (*SEGMENTS, 3):  # noqa: PLR2004
            raise ValueError(f"directions has shape {directions.shape}; expected (T, 2, 2, 3)")
        known = np.isfinite(directions).all(axis=-1)
        trust = np.where(known, np.nan_to_num(np.broadcast_to(self.trust, known.shape)), 0.0)
        object.__setattr__(self, "directions", directions)
        object.__setattr__(self, "trust", read_only(trust))
        object.__setattr__(self, "seen", read_only(np.broadcast_to(self.seen, known.shape)))

    def __len__(self) -> int:
        return len(self.directions)

    def __getitem__(self, frames: slice | Array) -> ArmReadings:
        """Some of the frames."""
        return ArmReadings(self.directions[frames], self.trust[frames], self.planar, self.seen[frames])

    def mirrored(self) -> ArmReadings:
        """The person seen in a mirror: left and right change places."""
        return ArmReadings(self.directions[:, ::-1] * _MIRROR, self.trust[:, ::-1], self.planar, self.seen[:, ::-1])


def readings_of_skeleton(skeleton: Skeleton) -> ArmReadings:
    """The readings of a person, in 3D or in the plane of a picture."""
    return readings_of_arms(skeleton, arm_directions(skeleton))


def readings_of_arms(skeleton: Skeleton, directions: Array) -> ArmReadings:
    """The readings of a person whose `person.arm_directions` (T, 2, 2, 3) are known already.

    A segment is trusted as far as the less certain of its two ends, and not at
    all below `MIN_CONFIDENCE`.  A forearm folded onto its upper arm is no
    posture of an elbow, so neither segment of that arm is trusted; a picture
    can show it so, because it lacks depth.  There a segment counts less the
    shorter it is seen: the nearer it points to the camera, the less its
    direction in the picture says about where it points.
    """
    trust = _segment_confidence(skeleton)
    trust = np.where(trust < MIN_CONFIDENCE, 0.0, trust)
    if skeleton.planar:
        seen = _seen_lengths(skeleton)
        return ArmReadings(directions, trust * np.minimum(seen, 1.0), True, seen)
    with np.errstate(invalid="ignore"):
        folded = interior_angle(directions) < FOLDED
    return ArmReadings(directions, np.where(folded[..., None], 0.0, trust))


def readings_of_features(features: Array) -> ArmReadings:
    """The readings of rows of the thesis's ten features (T, 10) rad.

    Two directions say all that the ten features do, except that the interior
    elbow angle is told a second time.  Where both differ by more than the
    reader's `SUSPECT`, the row contradicts itself; that arm is trusted as much
    less as the square of the difference is larger, as a measurement is of such
    an error.
    """
    trust = np.minimum(SUSPECT / np.maximum(elbow_disagreement(features), SUSPECT), 1.0) ** 2
    return ArmReadings(directions_of(features), np.repeat(trust[..., None], 2, axis=-1))


def joined(readings: Sequence[ArmReadings]) -> ArmReadings:
    """Several readings one after the other; planar where the first is."""
    parts = [np.concatenate([getattr(each, name) for each in readings]) for name in ("directions", "trust", "seen")]
    return ArmReadings(parts[0], parts[1], readings[0].planar, parts[2])


def _segment_confidence(skeleton: Skeleton) -> Array:
    """(T, 2, 2): the confidence of the less certain end."""
    columns = {name: place for place, name in enumerate(skeleton.joints)}
    missing = np.zeros(len(skeleton))

    def of(side: str, joint: str) -> Array:
        names = (f"{side}_{joint}", f"{side}_hand") if joint == "wrist" else (f"{side}_{joint}",)
        found = [skeleton.confidence[:, columns[name]] for name in names if name in columns]
        return np.maximum(found[0], found[-1]) if found else missing

    return np.stack(
        [np.stack([np.minimum(of(side, a), of(side, b)) for a, b in _ENDS], axis=1) for side in body.SIDES], axis=1
    )


def _seen_lengths(skeleton: Skeleton) -> Array:
    """(T, 2, 2): lengths in the picture, in those of an average person with this trunk; 1 where no trunk is seen."""
    trunk = np.linalg.norm(shoulder_centre(skeleton) - middle(skeleton, "hip"), axis=1) / bone_length("pelvis", "chest")
    lengths = [[_length(skeleton, side, *ends) for ends in _ENDS] for side in body.SIDES]
    with np.errstate(invalid="ignore", divide="ignore"):
        seen = np.moveaxis(np.array(lengths), -1, 0) / trunk[:, None, None]
    return np.where(np.isfinite(seen), seen, 1.0)


def _length(skeleton: Skeleton, side: str, start: str, end: str) -> Array:
    """(T,) in lengths of the average person of height 1."""
    bone = bone_length(f"left_{start}", f"left_{end}")
    far = wrist(skeleton, side) if end == "wrist" else skeleton.track(f"{side}_{end}")
    length: Array = np.linalg.norm(far - skeleton.track(f"{side}_{start}"), axis=1) / bone
    return length


@cache
def bone_length(start: str, end: str) -> float:
    """Typical length of a bone, heights of the body."""
    return next(bone.length for bone in body.bones() if (bone.start, bone.end) == (start, end))
