"""A made-up person in front of a Kinect v2, for `make_trajectories.py`: constant bones, moved by minimum jerk."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from nao_sim import body
from nao_sim.robot import Array

RATE = 30.0  # Hz
TICKS = 10_000_000  # of the sensor's clock in a second
FIRST = 1_000_000_000  # ticks
TRACKED = 2  # Kinect's tracking state
DECIMALS = 4  # of a metre
HEIGHT = 1.7  # m
AWAY, SENSOR = 2.4, 0.95  # m, from the sensor to the person, and from the floor to the sensor
HIPS = 0.52  # above the ankles, heights of the body: knees a little bent
ANKLE = 0.045  # above the floor, heights of the body

# In the order of Kinect v2 (Kinect for Windows SDK 2.0, enumeration JointType).
JOINTS = (
    "pelvis", "spine", "neck", "head",
    "left_shoulder", "left_elbow", "left_wrist", "left_hand",
    "right_shoulder", "right_elbow", "right_wrist", "right_hand",
    "left_hip", "left_knee", "left_ankle", "left_foot",
    "right_hip", "right_knee", "right_ankle", "right_foot",
    "chest", "left_hand_tip", "left_thumb", "right_hand_tip", "right_thumb",
)  # fmt: skip

# Where upper arm and forearm point, as (forward, outward, up) of any length.
Arm = tuple[tuple[float, float, float], tuple[float, float, float]]
REST: Arm = ((0.04, 0.26, -1.0), (0.3, 0.16, -1.0))
WAVING: Arm = ((0.25, 1.0, 0.12), (0.3, 0.12, 1.0))
ON_HIP: Arm = ((-0.1, 0.45, -1.0), (0.6, 0.1, -0.7))
POINTING: Arm = ((1.0, 0.5, -0.1), (1.0, 0.42, 0.05))
OPEN: Arm = ((0.45, 0.75, -0.75), (0.8, 0.6, 0.1))
KEYFRAMES: tuple[tuple[float, Arm, Arm], ...] = (  # s, left, right
    (0.0, REST, REST),
    (0.4, REST, REST),
    (1.5, ON_HIP, WAVING),
    (3.7, ON_HIP, WAVING),
    (4.9, POINTING, REST),
    (5.7, POINTING, REST),
    (6.6, OPEN, OPEN),
    (6.9, OPEN, OPEN),
    (7.7, REST, REST),
    (8.0, REST, REST),
)
WAVE_HZ, WAVE_FROM, WAVE_TO = 1.2, 1.3, 3.9  # s
OUTWARD = {"left": np.array([1.0, 1.0, 1.0]), "right": np.array([1.0, -1.0, 1.0])}


def minimum_jerk(u: Array) -> Array:
    """From 0 to 1 while u goes from 0 to 1 (Flash and Hogan, 1985)."""
    u = np.clip(u, 0.0, 1.0)
    return u**3 * (10.0 - 15.0 * u + 6.0 * u**2)


def waving_person() -> tuple[Array, Array]:
    """Times (T,) in s and joints (T, 25, 3) in m: x forward, y left, z up, the floor at z = 0."""
    times = np.arange(round(KEYFRAMES[-1][0] * RATE) + 1) / RATE
    found = _trunk(times)
    for side in body.SIDES:
        found |= _arm(times, found[f"{side}_shoulder"], side) | _leg(found[f"{side}_hip"], side)
    return times, np.stack([found[name] for name in JOINTS], axis=1) * HEIGHT


def _length(start: str, end: str) -> float:
    """A typical bone, in heights of the body."""
    return next(bone.length for bone in body.bones() if (bone.start, bone.end) == (start, end))


def _trunk(times: Array) -> dict[str, Array]:
    """The trunk sways a little, and the head with it."""
    sway = np.sin(2.0 * np.pi * 0.25 * times)
    pelvis = np.column_stack([0.0 * sway, 0.008 * sway, np.full(len(times), HIPS + ANKLE)])
    up = _unit(np.column_stack([0.02 + 0.0 * sway, -0.03 * sway, np.ones(len(times))]))
    left = _unit(np.cross(up, [1.0, 0.0, 0.0]))
    found = {name: pelvis + up * _length("pelvis", name) for name in ("spine", "chest", "neck")} | {"pelvis": pelvis}
    found["head"] = found["neck"] + _unit(up + np.array([0.12, 0.0, 0.0])) * _length("neck", "head")
    for side, sign in zip(body.SIDES, (1.0, -1.0), strict=True):
        half = sign * _length("left_shoulder", "right_shoulder") / 2.0
        found[f"{side}_shoulder"] = found["chest"] + left * half - up * 0.01
        found[f"{side}_hip"] = pelvis + np.array([0.0, sign * _length("left_hip", "right_hip") / 2.0, -0.02])
    return found


def _arm(times: Array, shoulder: Array, side: str) -> dict[str, Array]:
    upper, fore = (_pointing(times, side, part) for part in (0, 1))
    if side == "right":
        swing = minimum_jerk((times - WAVE_FROM) / 0.6) * minimum_jerk((WAVE_TO - times) / 0.6)
        fore[:, 1] += 0.42 * swing * np.sin(2.0 * np.pi * WAVE_HZ * (times - WAVE_FROM))
    upper, fore = (_unit(part) * OUTWARD[side] for part in (upper, fore))
    elbow = shoulder + upper * _length("left_shoulder", "left_elbow")
    wrist = elbow + fore * _length("left_elbow", "left_wrist")
    inward = _unit(np.cross(fore, upper)) if side == "left" else _unit(np.cross(upper, fore))
    places = {"elbow": elbow, "wrist": wrist, "hand": wrist + fore * _length("left_wrist", "left_hand"),
              "hand_tip": wrist + fore * 0.105, "thumb": wrist + fore * 0.04 + inward * 0.025}  # fmt: skip
    return {f"{side}_{name}": place for name, place in places.items()}


def _pointing(times: Array, side: str, part: int) -> Array:
    """(T, 3) forward, outward, up: from keyframe to keyframe, each reached at its time."""
    asked: Sequence[tuple[float, Array]] = [
        (time, _unit(np.array(both[body.SIDES.index(side)][part]))) for time, *both in KEYFRAMES
    ]
    towards = np.tile(asked[0][1], (len(times), 1))
    for (start, before), (end, after) in pairwise(asked):
        towards += minimum_jerk((times - start) / (end - start))[:, None] * (after - before)
    return _unit(towards)


def _leg(hip: Array, side: str) -> dict[str, Array]:
    """The foot stands; the knee is where both bones meet, ahead."""
    thigh, shank, foot = (_length(*(f"left_{end}" for end in ends))
                          for ends in (("hip", "knee"), ("knee", "ankle"), ("ankle", "foot")))  # fmt: skip
    ankle = np.tile(np.array([0.0, 0.06, ANKLE]) * OUTWARD[side], (len(hip), 1))
    way = ankle - hip
    apart = np.linalg.norm(way, axis=1, keepdims=True)
    along = (thigh**2 - shank**2 + apart**2) / (2.0 * apart)
    ahead = _unit(np.cross(way, [0.0, -1.0, 0.0]))
    knee = hip + way / apart * along + ahead * np.sqrt(np.maximum(thigh**2 - along**2, 0.0))
    toes = ankle + np.array([np.sqrt(foot**2 - 0.03**2), 0.0, -0.03])
    return {f"{side}_knee": knee, f"{side}_ankle": ankle, f"{side}_foot": toes}


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def kinect_text(times: Array, positions: Array, comments: Sequence[str]) -> str:
    """As Kinect v2 tools write it: ticks, then x y z and the tracking state of each joint, seen from the sensor.

    A person who faces the sensor has the left joints at the smaller x; y points up and z away from the sensor.

    Args:
        times: (T,) s.
        positions: (T, 25, 3) m, in the order of `JOINTS`; x forward, y left, z up.
        comments: lines above the numbers.
    """
    seen = np.stack([-positions[..., 1], positions[..., 2] - SENSOR, AWAY - positions[..., 0]], axis=-1)
    lines = [f"# {comment}" for comment in comments]
    for time, frame in zip(times, np.round(seen, DECIMALS) + 0.0, strict=True):
        joints = (f"{x:.{DECIMALS}f},{y:.{DECIMALS}f},{z:.{DECIMALS}f},{TRACKED}" for x, y, z in frame)
        lines.append(f"{FIRST + round(time * TICKS)},{','.join(joints)}")
    return "\n".join(lines) + "\n"
