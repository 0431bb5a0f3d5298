"""Where the person's hands are on and before the body, and the same places on the robot's.

A place is carried over by one map for both hands, so that hands that meet keep
meeting.  Seen from between the shoulders in the torso's frame, forward and up
shrink as arms do.  Sideways the robot's shoulders, wide for its arms, come out
where the person's are: the midline stays the midline, and beyond a shoulder the
way goes on in arm lengths.  Near the head, which the robot has a big one of,
the direction from its centre and the distance from its surface count, so that
a hand at the mouth comes to the mouth, and one at the forehead to the forehead.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from nao_sim.body import SIDES, bones
from nao_sim.imitation.mass import link_frames
from nao_sim.imitation.person import first_known, middle, torso_frames, wrist
from nao_sim.motion import Skeleton
from nao_sim.robot import Array, Robot, facts

HEAD_CENTRE = np.array([-0.001, 0.0, 0.057])  # m, of the head's collision shape in its link
HEAD_RADIUS = 0.0575  # m, of that shape
PALM_ROOM = 0.040  # m from the surface of the head to the palm's middle: the hand's half thickness and the clearance
HEAD_HALF = 0.065  # heights of the body: half of a head (Drillis and Contini, as in body.toml)
PALM_HALF = 0.02  # heights: a palm that lies on something has its middle so far from it
NOSE_AHEAD = 0.06  # heights: nose before the middle of the head
NEAR_HEAD = 0.25  # arm lengths from the head's surface; from there on the head counts, at the surface alone


@dataclass(frozen=True, eq=False)
class Places:
    """A body's hands and head, seen from between the shoulders in the torso's frame.

    Attributes:
        hands: (T, 2, 3) m, middle of the left and the right palm.
        head: (T, 3) m, middle of the head; nan where it is not tracked.
        arm: m, from shoulder to palm along the bones.
        half_breadth: m, half the distance of the shoulders.
    """

    hands: Array
    head: Array
    arm: float
    half_breadth: float


def places_of(skeleton: Skeleton) -> Places:
    """The person's places; both arms count for the lengths, which are the recording's medians."""
    frames, centre = torso_frames(skeleton), middle(skeleton, "shoulder")

    def seen(points: Array) -> Array:
        return np.asarray(np.einsum("tji,tj->ti", frames, points - centre))

    palms = {side: palm(skeleton, side) for side in SIDES}
    lengths = [_way(skeleton, side, palms[side]) for side in SIDES]
    across = np.linalg.norm(skeleton.track("left_shoulder") - skeleton.track("right_shoulder"), axis=1)
    arm = _median(np.concatenate(lengths))
    return Places(
        hands=np.stack([seen(palms[side]) for side in SIDES], axis=1),
        head=seen(_head(skeleton, frames, arm / _arm_in_heights())),
        arm=arm,
        half_breadth=_median(across) / 2.0,
    )


def palm(skeleton: Skeleton, side: str) -> Array:
    """The middle of a palm (T, 3) m; where it is not tracked, before the wrist by its usual length."""
    knuckles = (skeleton.track(f"{side}_index_mcp") + skeleton.track(f"{side}_pinky_mcp")) / 2.0
    end = wrist(skeleton, side)
    length = _bone_lengths()
    straight = (end - skeleton.track(f"{side}_elbow")) * (length["hand"] / length["wrist"])
    return first_known([skeleton.track(f"{side}_hand"), knuckles, end + straight])


def robot_places(person: Places, positions: Array, robot: Robot) -> Array:
    """Where (T, 2, 3) m the middles of the robot's palms belong, in its torso.

    Args:
        person: the person's places.
        positions: (T, 26) rad, what is asked of the head; not finite where it looks ahead.
        robot: the order of the joints.
    """
    origin = {joint["name"]: np.array(joint["origin_m"]) for joint in facts()["joints"]}
    half, height = origin["LShoulderPitch"][1], origin["LShoulderPitch"][2]
    scale = robot_arm() / person.arm
    x, y, z = np.moveaxis(person.hands, -1, 0)
    inside, beyond = np.clip(y, -person.half_breadth, person.half_breadth), np.abs(y) - person.half_breadth
    sideways = inside * half / person.half_breadth + np.sign(y) * np.maximum(beyond, 0.0) * scale
    by_body = np.stack([x * scale, sideways, z * scale + height], axis=-1)
    turn, place = link_frames(np.nan_to_num(positions), robot, frozenset(["Head"]))["Head"]
    return _near_head(person, by_body, scale, place + turn @ HEAD_CENTRE)


def robot_arm() -> float:
    """From the robot's shoulder to the middle of its palm along the links, m."""
    origin = {joint["name"]: joint["origin_m"] for joint in facts()["joints"]}
    return float(origin["LElbowYaw"][0] + origin["LWristYaw"][0] + origin["LHand"][0])


def robot_hand() -> float:
    """From the robot's wrist to the middle of its palm, along the forearm, m."""
    return float(next(joint["origin_m"][0] for joint in facts()["joints"] if joint["name"] == "LHand"))


def _near_head(person: Places, by_body: Array, scale: float, head: Array) -> Array:
    """Places (T, 2, 3) that near the head go by the head."""
    heights = person.arm / _arm_in_heights()
    away = person.hands - person.head[:, None]
    distance = np.linalg.norm(away, axis=-1, keepdims=True)
    gap = np.maximum(distance - (HEAD_HALF + PALM_HALF) * heights, 0.0)
    direction = np.divide(away, distance, out=np.zeros(away.shape), where=distance > 0.0)
    by_head = head[:, None] + direction * (HEAD_RADIUS + PALM_ROOM + scale * gap)
    near = np.clip(1.0 - gap / (NEAR_HEAD * person.arm), 0.0, 1.0)
    weight = near * near * (3.0 - 2.0 * near)
    return np.where(np.isfinite(by_head), by_body + weight * (by_head - by_body), by_body)


def _head(skeleton: Skeleton, frames: Array, heights: float) -> Array:
    """The middle of the head (T, 3)."""
    behind_nose = skeleton.track("nose") - NOSE_AHEAD * heights * frames[:, :, 0]
    return first_known([middle(skeleton, "ear"), skeleton.track("head"), behind_nose])


def _way(skeleton: Skeleton, side: str, end: Array) -> Array:
    points = [skeleton.track(f"{side}_shoulder"), skeleton.track(f"{side}_elbow"), wrist(skeleton, side), end]
    return np.asarray(np.linalg.norm(np.diff(np.stack(points), axis=0), axis=-1).sum(axis=0))


def _bone_lengths() -> Mapping[str, float]:
    """Heights of the body, by the joint at the end of a left arm's bone."""
    ends = {bone.end: bone.length for bone in bones() if bone.start in {"left_shoulder", "left_elbow", "left_wrist"}}
    return {part: ends[f"left_{part}"] for part in ("elbow", "wrist", "hand")}


def _arm_in_heights() -> float:
    return sum(_bone_lengths().values())


def _median(values: Array) -> float:
    finite = values[np.isfinite(values)]
    return float(np.median(finite)) if len(finite) else np.nan
