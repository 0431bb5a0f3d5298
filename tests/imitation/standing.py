"""People who stand, squat, lean and sway as they are told."""

from __future__ import annotations

from typing import Any

import numpy as np

from nao_sim.motion import Skeleton
from nao_sim.robot import load_robot

HEIGHT = 1.75
THIGH, SHANK = 0.245 * HEIGHT, 0.246 * HEIGHT
UP = np.array([0.0, 0.0, 1.0])
ROBOT = load_robot()


def standing(times: Any, squat: Any = 0.0, pitch: Any = 0.0, roll: Any = 0.0, sway: Any = 0.0) -> Skeleton:
    """A person at `times` (T,) s.

    Args:
        times: (T,) s.
        squat: how much nearer hips are to ankles than on straight legs, 0 to 1.
        pitch: rad, of the trunk, forward.
        roll: rad, of the trunk, to the right.
        sway: m, of the hips to the left.
    """
    times = np.asarray(times, float)
    squat, pitch, roll, sway = (np.broadcast_to(np.asarray(v, float), times.shape) for v in (squat, pitch, roll, sway))
    far = (1.0 - squat) * (THIGH + SHANK)
    ahead = np.sqrt(np.maximum(SHANK**2 - ((far**2 + SHANK**2 - THIGH**2) / (2.0 * far)) ** 2, 0.0))
    trunk = np.stack([np.sin(pitch) * np.cos(roll), -np.sin(roll), np.cos(pitch) * np.cos(roll)], axis=1)
    zero = np.zeros(times.shape)
    hip = np.stack([zero, sway, 0.07 + np.sqrt(far**2 - sway**2)], axis=1)
    points = {"pelvis": hip, "neck": hip + 0.31 * HEIGHT * trunk, "head": hip + 0.4 * HEIGHT * trunk}
    across = np.cross(trunk, np.cross([0.0, 1.0, 0.0], trunk))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        foot = np.array([0.0, 0.09 * sign, 0.07])
        points[f"{side}_ankle"] = np.tile(foot, (len(times), 1))
        points[f"{side}_hip"] = hip + np.array([0.0, 0.09 * sign, 0.0])
        middle = (points[f"{side}_ankle"] * THIGH + points[f"{side}_hip"] * SHANK) / (THIGH + SHANK)
        points[f"{side}_knee"] = middle + ahead[:, None] * [1.0, 0.0, 0.0]
        shoulder = hip + 0.29 * HEIGHT * trunk + 0.105 * HEIGHT * sign * across
        points[f"{side}_shoulder"] = shoulder
        points[f"{side}_elbow"] = shoulder - 0.172 * HEIGHT * UP
        points[f"{side}_wrist"] = shoulder - 0.318 * HEIGHT * UP
    return Skeleton(times, np.stack(list(points.values()), axis=1), tuple(points))


def restless(seed: int, seconds: float = 3.0) -> tuple[Skeleton, np.ndarray]:
    """Somebody who squats, bows, leans and sways at any speed, jumps included, and arms and a head that do anything."""
    random = np.random.default_rng(seed)
    times = np.arange(0.0, seconds, 1.0 / random.choice([8.0, 30.0, 60.0]))
    fastest = random.choice([0.5, 1.5, 3.0])

    def wave(low: float, high: float) -> np.ndarray:
        frequencies, phases = random.uniform(0.1, fastest, (3, 1)), random.uniform(0.0, 7.0, (3, 1))
        share = np.clip(np.sin(2.0 * np.pi * frequencies * times + phases).sum(axis=0) / 1.5, -1.0, 1.0)
        share = np.sign(share) if random.random() < 0.3 else share
        return low + (high - low) * (share + 1.0) / 2.0

    skeleton = standing(times, wave(0.0, 0.6), wave(-0.5, 1.2), wave(-0.7, 0.7), wave(-0.25, 0.25))
    knots = random.uniform(ROBOT.lower, ROBOT.upper, (1 + int(seconds * random.choice([0.5, 2.0, 10.0])), 26))
    arms = knots[(np.arange(len(times)) * len(knots)) // len(times)]
    arms[random.random(arms.shape) < 0.05] = np.nan
    legs = np.concatenate([ROBOT.limbs["LLeg"], ROBOT.limbs["RLeg"]])
    arms[:, legs] = np.nan
    return skeleton, arms
