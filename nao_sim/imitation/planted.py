"""Where the legs of a robot on planted feet can take its torso, in balance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nao_sim.imitation.lean import PITCH, REACH, ROLL, SWAY
from nao_sim.imitation.legs import (
    HIP_PITCH,
    HIP_ROLL,
    HIP_YAW_PITCH,
    LEG_JOINTS,
    TWIST,
    Stance,
    hip_centre,
    leg_lengths,
    leg_positions,
    lowest_hip_pitch,
    stance_of,
    torso_turn,
)
from nao_sim.imitation.mass import centre_of_mass, masses
from nao_sim.robot import Array, Mask, Robot

KNEE = REACH  # column of the robot's lean, rad, that stands in the place of the person's reach
FIRST = ([KNEE], [PITCH], [ROLL, SWAY])  # what the limits cut last
STRAIGHTEST = 0.35  # rad, KneePitch of the longer leg; nearer to straight a knee is too fast for its motor
LIMIT_MARGIN = np.radians(0.6)  # more than the guard keeps, so that it leaves the legs alone
COUPLING_MARGIN = np.radians(1.5)
_BALANCING = 5  # steps
_GAIN = 1.3  # the torso moves about 1.3 times as far as the centre of mass
_BALANCED = 1e-3  # m
_TRIES = np.array([0.2, 0.4, 0.6, 0.8])  # shares of a way, looked at together
_ROUNDS = 5  # of tries: the last ones are 1/3125 of the way apart
_CHUNK = 20_000  # frames at a time


@dataclass(frozen=True, eq=False)
class Planted:
    """A robot on planted feet.

    A lean (T, 4) of its torso is `KNEE` rad, the bend of a leg that reaches
    from the middle of the feet to the middle of the hips, `PITCH` and `ROLL`
    rad, and `SWAY` m of the centre of mass to the left.

    Attributes:
        robot: whose limits and masses hold.
        joints: (2, 6) indices of `LEG_JOINTS`, left and right.
        stance: where the feet stand.
        start: (2, 6) rad, the legs' angles in the start posture.
        standing: (4,) the lean of it.
        upper: (3,) m, centre of mass of all but the legs in it, in the torso.
        centre: (2,) m, centre of mass of the robot in it, over the feet.
    """

    robot: Robot
    joints: NDArray[np.int_]
    stance: Stance
    start: Array
    standing: Array
    upper: Array
    centre: Array

    @classmethod
    def of(cls, robot: Robot, start: Array) -> Planted:
        """A robot in a standing posture (26,)."""
        joints = np.array([[robot.index[letter + name] for name in LEG_JOINTS] for letter in "LR"])
        stance = stance_of(start, robot)
        turn = stance.torso
        pitch, roll = np.arctan2(-turn[2, 0], turn[0, 0]), np.arctan2(-turn[1, 2], turn[1, 1])
        standing = np.array([bend(np.linalg.norm(stance.hips)), pitch, roll, 0.0])
        upper = centre_of_mass(start[None], robot, legs=False)[0]
        planted = cls(robot, joints, stance, start[joints], standing, upper, np.zeros(2))
        centre = planted.over_feet(planted.start[None], stance.hips[None], turn[None], upper[None])[0]
        return cls(robot, joints, stance, planted.start, standing, upper, centre)

    def shift(self, lean: Array, upper: Array) -> Array:
        """How far (T, 2) m arms and head move the centre of mass, over what they do in the start posture."""
        above, below = masses(self.robot)
        moved = np.einsum("tij,tj->ti", torso_turn(lean[:, PITCH], lean[:, ROLL]), upper - self.upper)
        return np.asarray(moved[:, :2] * above / (above + below))

    def nearest(self, wish: Array, upper: Array, shift: Array) -> tuple[Array, Array]:
        """The nearest possible lean (T, 4) to a wished one, and the legs (T, 2, 6) rad for it.

        As much as possible of the squat comes first, then of the bow, then of the sides.

        Args:
            wish: (T, 4).
            upper: (T, 3) m, centre of mass of all but the legs, in the torso.
            shift: (T, 2) m, how far off its place the centre of mass may be.
        """
        legs, fine = self.legs(wish, upper, shift)
        if fine.all():
            return wish, legs
        hard = ~fine
        lean = np.tile(self.standing, (int(hard.sum()), 1))
        for columns in FIRST:
            further = lean.copy()
            further[:, columns] = wish[hard][:, columns]
            lean = self._towards(lean, further, upper[hard], shift[hard])
        nearest = wish.copy()
        nearest[hard] = lean
        found, fine = self.legs(lean, upper[hard], shift[hard])
        legs[hard] = np.where(fine[:, None, None], found, self.start)
        return nearest, legs

    def _towards(self, safe: Array, wish: Array, upper: Array, shift: Array) -> Array:
        """The farthest possible lean (T, 4) on the straight way from a safe one to a wished one."""
        share = self.legs(wish, upper, shift)[1].astype(float)
        left, width = np.flatnonzero(share == 0.0), 1.0
        for _ in range(_ROUNDS if len(left) else 0):
            tries = share[left, None] + width * _TRIES
            lean = safe[left, None] + tries[:, :, None] * (wish - safe)[left, None]
            same = np.repeat(left, len(_TRIES))
            fine = self.legs(lean.reshape(-1, 4), upper[same], shift[same])[1].reshape(tries.shape)
            width /= len(_TRIES) + 1
            share[left] += width * np.logical_and.accumulate(fine, axis=1).sum(axis=1)
        return np.asarray(safe + share[:, None] * (wish - safe))

    def legs(self, lean: Array, upper: Array, shift: Array) -> tuple[Array, Mask]:
        """Angles (T, 2, 6) rad of the legs for a lean, and whether (T,) they are within all limits; as `nearest`."""
        if len(lean) > _CHUNK:
            parts = np.array_split(np.arange(len(lean)), len(lean) // _CHUNK + 1)
            angles, fine = zip(*(self.legs(lean[i], upper[i], shift[i]) for i in parts), strict=True)
            return np.concatenate(angles), np.concatenate(fine)
        turn, far = torso_turn(lean[:, PITCH], lean[:, ROLL]), self._reach(lean)
        goal = self.centre + shift + lean[:, [SWAY]] * [0.0, 1.0]
        hips = np.tile(self.stance.hips, (len(lean), 1))
        for _ in range(_BALANCING):
            hips[:, 2] = np.sqrt(np.maximum(far**2 - (hips[:, :2] ** 2).sum(axis=1), 0.0))
            found, turned = leg_positions(hips, turn, self.stance)
            off = self.over_feet(found, hips, turned, upper) - goal
            hips[:, :2] -= _GAIN * off
        return found, self._within(found) & (np.abs(off).max(axis=1) < _BALANCED)

    def over_feet(self, legs: Array, hips: Array, torso: Array, upper: Array) -> Array:
        """Where (T, 2) m the centre of mass is, seen from above."""
        above, below = masses(self.robot)
        positions = np.zeros((len(legs), len(self.robot.joint_names)))
        positions[:, self.joints.ravel()] = legs.reshape(len(legs), self.joints.size)
        lower = centre_of_mass(positions, self.robot, legs=True)
        centre = (above * upper + below * lower) / (above + below) - hip_centre()
        return np.asarray((hips + np.einsum("tij,tj->ti", torso, centre))[:, :2])

    def _reach(self, lean: Array) -> Array:
        """From the middle of the feet to the middle of the hips (T,) m; a hip that rises must stay in reach."""
        straight = max(float(reach(np.array(STRAIGHTEST))), float(np.linalg.norm(self.stance.hips)))
        half = float(np.linalg.norm(self.stance.ankles[0] - self.stance.ankles[1])) / 2.0
        tilt = np.abs(np.sin(lean[:, ROLL] - self.standing[ROLL]))
        return np.minimum(reach(lean[:, KNEE]), straight - half * tilt)

    def _within(self, legs: Array) -> Mask:
        """Whether (T,) angles (T, 2, 6) are inside all limits, margins included."""
        lower, upper = symmetric_limits(self.robot)
        lower, upper = lower[self.joints] + LIMIT_MARGIN, upper[self.joints] - LIMIT_MARGIN
        within = ((legs >= lower) & (legs <= upper)).all(axis=(1, 2))
        within &= (legs[:, :, HIP_PITCH] >= lowest_hip_pitch(legs[:, :, HIP_ROLL] * [1.0, -1.0])).all(axis=1)
        within &= np.abs(legs[:, 0, HIP_YAW_PITCH]) <= TWIST
        flat, joints = legs.reshape(len(legs), self.joints.size), self.joints.ravel().tolist()
        for coupling in self.robot.couplings:
            if coupling.joint in joints:
                angle, by = flat[:, joints.index(coupling.joint)], flat[:, joints.index(coupling.by)]
                low, high = coupling.bounds(by)
                within &= (angle >= low + COUPLING_MARGIN) & (angle <= high - COUPLING_MARGIN)
        return np.asarray(within)


def symmetric_limits(robot: Robot) -> tuple[Array, Array]:
    """Lower and upper limits (26,) that hold on both sides: NAO's knees and ankles differ by up to 0.6 degrees."""
    mirrored = robot.mirror(np.stack([robot.lower, robot.upper]))
    return np.maximum(robot.lower, mirrored.min(axis=0)), np.minimum(robot.upper, mirrored.max(axis=0))


def bend(distance: Array | np.floating) -> Array:
    """KneePitch (...) rad at a distance (...) m from ankle to hip (law of cosines)."""
    thigh, tibia = leg_lengths()
    return np.arccos(np.clip((distance**2 - thigh**2 - tibia**2) / (2.0 * thigh * tibia), -1.0, 1.0))


def reach(knee: Array) -> Array:
    """The inverse of `bend`."""
    thigh, tibia = leg_lengths()
    return np.asarray(np.sqrt(thigh**2 + tibia**2 + 2.0 * thigh * tibia * np.cos(knee)))
