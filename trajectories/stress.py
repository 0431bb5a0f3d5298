"""The motion that asks for everything a robot must not do, for `make_trajectories.py`."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from nao_sim.motion import JointTrajectory
from nao_sim.recordings import joint_csv_text
from nao_sim.robot import Array, load_robot

RATE = 50.0  # Hz
ROBOT = load_robot()
START = ROBOT.postures["StandInit"]
MIDDLE, HALF = (ROBOT.upper + ROBOT.lower) / 2.0, (ROBOT.upper - ROBOT.lower) / 2.0
LEGS = np.concatenate([ROBOT.limbs["LLeg"], ROBOT.limbs["RLeg"]])
UPPER_BODY = np.setdiff1d(np.arange(len(START)), LEGS)

# Left arm, degrees: where ShoulderPitch, ShoulderRoll, ElbowYaw and ElbowRoll put the hand inside something.
ARM = ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll")
CHEST = (60.0, -18.0, -9.0, -88.0)
BELLY = (61.0, -13.0, 15.0, -66.0)
FACE = (-44.0, -3.0, -19.0, -88.0)
THIGH = (88.0, -10.0, -109.0, -4.0)
AHEAD = (-6.0, -17.0, 41.0, -52.0)
BACK = (112.0, -3.0, 8.0, -88.0)

Segment = Callable[[Array], Array]  # (N,) s since its start -> (N, 26)


def held(times: Array) -> Array:
    """The start posture (N, 26), one row for each time."""
    return np.tile(START, (len(times), 1))


def limits(times: Array) -> Array:
    """Head, arms and hands swing half as far again as their limits."""
    asked = held(times)
    swing = np.sin(2.0 * np.pi * 0.5 * times)[:, None]
    asked[:, UPPER_BODY] = (MIDDLE + 1.5 * HALF * swing)[:, UPPER_BODY]
    return asked


def head_coupling(times: Array) -> Array:
    """HeadYaw sweeps its range while HeadPitch stays at one end of its own, then at the other."""
    asked = held(times)
    yaw, pitch = ROBOT.index["HeadYaw"], ROBOT.index["HeadPitch"]
    asked[:, yaw] = ROBOT.upper[yaw] * np.sin(2.0 * np.pi * times)
    asked[:, pitch] = np.where(times < times[len(times) // 2], ROBOT.upper[pitch], ROBOT.lower[pitch])
    return asked


def ankle_coupling(times: Array) -> Array:
    """AnklePitch sweeps its range while AnkleRoll stays at one end of its own, then at the other."""
    asked = held(times)
    for side in "LR":
        pitch, roll = ROBOT.index[side + "AnklePitch"], ROBOT.index[side + "AnkleRoll"]
        asked[:, pitch] = MIDDLE[pitch] + HALF[pitch] * np.sin(2.0 * np.pi * times)
        asked[:, roll] = np.where(times < times[len(times) // 2], ROBOT.upper[roll], ROBOT.lower[roll])
    return asked


def legs(times: Array) -> Array:
    """Splits, kicks, deep knees, and two hip yaws that one motor cannot both obey."""
    asked = held(times)
    swing = np.sin(2.0 * np.pi * 0.8 * times[:, None] + 0.9 * np.arange(len(START)))
    asked[:, LEGS] = (MIDDLE + HALF * swing)[:, LEGS]
    return asked


def speed(times: Array) -> Array:
    """Head and arms swing at ten times their motors' no-load speed."""
    asked = held(times)
    reach = np.minimum(HALF, 1.0)
    asked[:, UPPER_BODY] = (MIDDLE + reach * np.sin(10.0 * ROBOT.no_load_speed / reach * times[:, None]))[:, UPPER_BODY]
    return asked


def hands_to(*targets: tuple[float, ...], sides: str = "LR") -> Segment:
    """A segment that takes the hands to each target in turn, and dwells there."""

    def segment(times: Array) -> Array:
        asked = held(times)
        stops = np.stack([START, *(with_arms(target, sides) for target in targets)])
        progress = times / (times[-1] + 1.0 / RATE) * len(targets)
        reached = np.minimum(progress.astype(int), len(targets) - 1)
        u = np.clip(2.0 * (progress - reached), 0.0, 1.0)[:, None]
        asked[:] = stops[reached] + u**2 * (3.0 - 2.0 * u) * (stops[reached + 1] - stops[reached])
        return asked

    return segment


def with_arms(arm: tuple[float, ...], sides: str) -> Array:
    """The start posture (26,) with arms as given in degrees for the left one."""
    posture = START.copy()
    for name, angle in zip(ARM, arm, strict=True):
        posture[ROBOT.index["L" + name]] = np.radians(angle)
    mirrored = ROBOT.mirror(posture)
    left, right = ROBOT.limbs["LArm"], ROBOT.limbs["RArm"]
    both = START.copy()
    both[left] = posture[left] if "L" in sides else START[left]
    both[right] = mirrored[right] if "R" in sides else START[right]
    return both


def holes(times: Array) -> Array:
    """Arms swing while cells are nan, inf, -inf or empty, for a frame or for long."""
    asked = limits(times * 0.5)
    frame, joint = np.meshgrid(np.arange(len(times)), np.arange(len(START)), indexing="ij")
    asked[(frame * 7 + joint * 3) % 11 == 0] = np.nan
    asked[(frame * 5 + joint) % 17 == 0] = np.inf
    asked[(frame * 3 + joint * 5) % 19 == 0] = -np.inf
    asked[len(times) // 2 : len(times) // 2 + 10] = np.nan
    return asked


def jumps(times: Array) -> Array:
    """All 26 joints jump anywhere in their range five times a second."""
    random = np.random.default_rng(2012)
    targets = ROBOT.lower + (ROBOT.upper - ROBOT.lower) * random.random((int(times[-1] * 5.0) + 1, len(START)))
    return targets[(times * 5.0).astype(int)]


SEGMENTS: tuple[tuple[float, Segment, str], ...] = (
    (1.0, held, "the start posture"),
    (2.0, limits, "head, arms and hands half as far again as their limits"),
    (2.0, head_coupling, "HeadYaw over its range with HeadPitch at its ends"),
    (2.0, ankle_coupling, "AnklePitch over its range with AnkleRoll at its ends"),
    (1.6, legs, "both legs over their range, left and right HipYawPitch apart"),
    (1.6, speed, "head and arms at ten times the no-load speed"),
    (2.0, hands_to(CHEST, BELLY), "both hands into the chest, then the belly"),
    (1.4, hands_to(FACE), "both hands into the face"),
    (1.4, hands_to(THIGH), "both hands into the thighs"),
    (1.4, hands_to(AHEAD), "the hands into each other"),
    (1.6, hands_to(CHEST, BACK, sides="L"), "the left arm through the torso from front to back"),
    (2.0, holes, "cells that are nan, inf, -inf and empty, and 0.2 s with nothing asked at all"),
    (2.0, jumps, "every joint jumps anywhere five times a second"),
    (1.0, held, "the start posture"),
)


def stress() -> JointTrajectory:
    """All segments, one after the other."""
    parts = [segment(np.arange(round(duration * RATE)) / RATE) for duration, segment, _ in SEGMENTS]
    positions = np.concatenate(parts)
    return JointTrajectory(np.arange(len(positions)) / RATE, positions)


def _comments() -> tuple[str, ...]:
    start, lines = 0.0, ["Everything a robot must not do: for testing what keeps it safe. Never for a real robot."]
    for duration, _, what in SEGMENTS:
        lines.append(f"{start:5.1f} s to {start + duration:4.1f} s: {what}")
        start += duration
    return tuple(lines)


COMMENTS = _comments()


def stress_text(motion: JointTrajectory, comments: Sequence[str], decimals: int) -> str:
    """The file's text; every other row says nan where the writer leaves a cell empty."""
    lines = joint_csv_text(motion, comments, decimals).splitlines()
    for number in range(len(comments) + 1, len(lines), 2):
        lines[number] = ",".join(cell or "nan" for cell in lines[number].split(","))
    return "\n".join(lines) + "\n"
