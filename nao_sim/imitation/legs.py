"""Both legs for a torso that moves over planted feet, in closed form.

A leg's three hip axes cross in one point and its two ankle axes in another,
so the leg is solved from the foot up: the distance of the points gives
KneePitch, the hip's direction seen from the foot AnkleRoll and AnklePitch, and
the turn that is left HipYawPitch, HipRoll and HipPitch (the left leg; the
right one is the left one in a mirror):

    hip - ankle        = foot Rx(-AnkleRoll) Ry(-AnklePitch) (tibia z + Ry(-KneePitch) thigh z)
    torso^T foot Rx(-AnkleRoll) Ry(-AnklePitch - KneePitch) = Ra(HipYawPitch) Rx(HipRoll) Ry(HipPitch)

with a = (0, 1, -1)/sqrt 2.  One motor turns both HipYawPitch joints: of the
ways to turn the torso about the vertical, one lets both legs ask the same of it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from nao_sim.imitation.mass import link_frames, turns
from nao_sim.mujoco_model import robot_alone
from nao_sim.robot import START_POSTURE, Array, Robot, facts, load_robot, read_only

LEG_JOINTS = ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
HIP_YAW_PITCH, HIP_ROLL, HIP_PITCH = range(3)
FEET = ("l_ankle", "r_ankle")
CLEARANCE = 0.0105  # m between thigh and torso; more than the guard keeps, so that it leaves the legs alone
TWIST = 0.02  # rad, the most that HipYawPitch is asked for
_LOOKS, _HALVINGS = 24, 10
_X, _Y, _Z = np.eye(3)
_HIP_AXIS = np.array([0.0, 1.0, -1.0])  # of the left HipYawPitch
Rule = Callable[[Array, Array, Array], Array]
_MIRROR = np.diag([1.0, -1.0, 1.0])
_MIRRORED_ANGLES = np.array([1.0, -1.0, 1.0, 1.0, 1.0, -1.0])  # of `LEG_JOINTS`, as `Robot.mirror_sign`
_YAW_SLOPE = 2.0 * np.sqrt(2.0)  # by which both HipYawPitch come apart as an upright torso turns
_YAW_STEPS = 3  # of the secant method
_AGREED = 1e-6  # rad


@dataclass(frozen=True, eq=False)
class Stance:
    """Where the feet stand, seen from the point between the ankles: x forward, y left, z up.

    Attributes:
        ankles: (2, 3) m, left and right.
        feet: (2, 3, 3) how the soles are turned.
        hips: (3,) m, the point between the hips in the start posture.
        torso: (3, 3) how the torso is turned there.
    """

    ankles: Array
    feet: Array
    hips: Array
    torso: Array


@cache
def leg_lengths() -> tuple[float, float]:
    """Thigh and tibia, m."""
    origin = {joint["name"]: joint["origin_m"] for joint in facts()["joints"]}
    return -float(origin["LKneePitch"][2]), -float(origin["LAnklePitch"][2])


@cache
def hip_centre() -> Array:
    """The point (3,) m between the hips in the torso."""
    return read_only(_hips().mean(axis=0))


@cache
def _hips() -> Array:
    """The left and the right hip (2, 3) m in the torso."""
    origin = {joint["name"]: joint["origin_m"] for joint in facts()["joints"]}
    return read_only([origin["LHipYawPitch"], origin["RHipYawPitch"]])


def lowest_hip_pitch(hip_roll: Array) -> Array:
    """How far a hip may bend, rad, at angles of (the left) HipRoll, with thighs and torso apart by `CLEARANCE`.

    It holds while HipYawPitch is at most `TWIST`.
    """
    return np.asarray(np.interp(hip_roll, *_thigh_on_torso()))


@cache
def _thigh_on_torso() -> tuple[Array, Array]:
    """Angles of the left HipRoll, and the lowest HipPitch there, (N,) rad each: bisected on the model."""
    robot = load_robot()
    roll, pitch = robot.index["LHipRoll"], robot.index["LHipPitch"]
    rolls = np.linspace(robot.lower[roll], robot.upper[roll], _LOOKS)
    high = np.full(_LOOKS, robot.postures[START_POSTURE][pitch])
    low = np.full(_LOOKS, robot.lower[pitch])
    for _ in range(_HALVINGS):
        half = (low + high) / 2.0
        near = _thigh_to_torso(rolls, half) < CLEARANCE
        low, high = np.where(near, half, low), np.where(near, high, half)
    return read_only(rolls), read_only(high)


def _thigh_to_torso(rolls: Array, pitches: Array) -> Array:
    """Distances (N,) m, at most 1, of the left thigh's and the torso's collision shapes, HipYawPitch at `TWIST`."""
    import mujoco

    model = robot_alone()
    data = mujoco.MjData(model)
    shapes = [np.flatnonzero(model.geom_bodyid == model.body(link).id).tolist() for link in ("torso", "LThigh")]
    joints = [model.joint(f"LHip{name}").qposadr[0] for name in ("YawPitch", "Roll", "Pitch")]
    apart = np.empty(len(rolls))
    for i, (roll, pitch) in enumerate(zip(rolls, pitches, strict=True)):
        data.qpos[joints] = TWIST, roll, pitch
        mujoco.mj_kinematics(model, data)
        apart[i] = min(mujoco.mj_geomDistance(model, data, a, b, 1.0, None) for a in shapes[0] for b in shapes[1])
    return apart


def stance_of(start: Array, robot: Robot) -> Stance:
    """The stance of a standing posture (26,)."""
    frames = link_frames(start[None], robot, frozenset(FEET))
    feet = np.stack([frames[foot][0][0] for foot in FEET])
    ankles = np.stack([frames[foot][1][0] for foot in FEET])
    up = _unit(feet[:, :, 2].sum(axis=0))
    left = _unit(np.cross(up, feet[:, :, 0].sum(axis=0)))
    ground = np.stack([np.cross(left, up), left, up])
    centre = ankles.mean(axis=0)
    hips = ground @ (hip_centre() - centre)
    return Stance(read_only((ankles - centre) @ ground.T), read_only(ground @ feet), read_only(hips), read_only(ground))


def torso_turn(pitch: Array, roll: Array) -> Array:
    """Rotations (T, 3, 3) of a torso that leans forward by `pitch` (T,) and then to its right by `roll` (T,), rad."""
    return np.asarray(turns(_Y, pitch) @ turns(_X, roll))


def leg_positions(hips: Array, torso: Array, stance: Stance) -> tuple[Array, Array]:
    """The angles of both legs.

    Args:
        hips: (T, 3) m, the point between the hips, as `Stance` has it.
        torso: (T, 3, 3) how the torso is turned, but for the turn about the
            vertical that the common motor asks for.
        stance: where the feet stand.

    Returns:
        (T, 2, 6) rad, left and right, of `LEG_JOINTS`, without limits, and the
        turn (T, 3, 3) of the torso; nan where a foot is out of reach.
    """
    yaw = _common_yaw(hips, torso, stance)
    turned = turns(_Z, yaw) @ torso
    left, right = _by_side(_left_leg, hips, turned, stance)
    angles = np.stack([left, right * _MIRRORED_ANGLES], axis=1)
    angles[~(np.abs(left[:, HIP_YAW_PITCH] - right[:, HIP_YAW_PITCH]) < _AGREED)] = np.nan
    angles[:, :, HIP_YAW_PITCH] = angles[:, :, HIP_YAW_PITCH].mean(axis=1, keepdims=True)
    return angles, turned


def _common_yaw(hips: Array, torso: Array, stance: Stance) -> Array:
    """The turn (T,) rad about the vertical where both HipYawPitch agree, by the secant method."""

    def apart(yaw: Array) -> Array:
        left, right = _by_side(_hip_yaw_pitch, hips, turns(_Z, yaw) @ torso, stance)
        return left - right

    before = np.zeros(len(hips))
    apart_before = apart(before)
    yaw = -apart_before / _YAW_SLOPE
    for _ in range(_YAW_STEPS):
        now = apart(yaw)
        moved = np.abs(now - apart_before) > 0.0
        step = np.divide(-now * (yaw - before), now - apart_before, out=np.zeros(len(yaw)), where=moved)
        before, apart_before, yaw = yaw, now, yaw + step
    return yaw


def _by_side(rule: Rule, hips: Array, torso: Array, stance: Stance) -> tuple[Array, Array]:
    """A left leg's rule for the left leg, and for the right leg in a mirror."""
    at = hips[:, None] + np.einsum("tij,sj->tsi", torso, _hips() - hip_centre())
    mirrored = (at[:, 1] - stance.ankles[1]) @ _MIRROR, _MIRROR @ torso @ _MIRROR, _MIRROR @ stance.feet[1] @ _MIRROR
    return rule(at[:, 0] - stance.ankles[0], torso, stance.feet[0]), rule(*mirrored)


def _hip_yaw_pitch(leg: Array, torso: Array, foot: Array) -> Array:
    """HipYawPitch (T,) alone, of a left leg from ankle to hip (T, 3).

    HipPitch leaves y where it is, and HipRoll in the plane of y and b = (0, 1, 1)/sqrt 2.
    """
    _, y, z = (leg @ foot).T
    across = np.stack([np.zeros(len(leg)), z, -y], axis=1) @ foot.T
    x, y, z = np.einsum("tji,tj->it", torso, across)
    return np.asarray(np.arctan2(x, (y + z) / np.sqrt(2.0)))


def _left_leg(leg: Array, torso: Array, foot: Array) -> Array:
    """All angles (T, 6) of a left leg from ankle to hip (T, 3)."""
    thigh, tibia = leg_lengths()
    x, y, z = (leg @ foot).T
    knee = _angle((x**2 + y**2 + z**2 - thigh**2 - tibia**2) / (2.0 * thigh * tibia))
    ankle_roll, up = np.arctan2(y, z), np.hypot(y, z)
    ankle_pitch = np.arctan2(-thigh * np.sin(knee), tibia + thigh * np.cos(knee)) - np.arctan2(x, up)
    hip = torso.swapaxes(1, 2) @ (foot @ turns(_X, -ankle_roll) @ turns(_Y, -ankle_pitch - knee))
    x, y, z = hip[:, :, 1].T  # see `_hip_yaw_pitch`
    across = (y + z) / np.sqrt(2.0)
    yaw_pitch = np.arctan2(x, across)
    roll = np.arctan2(np.hypot(x, across), (y - z) / np.sqrt(2.0)) - np.pi / 4.0
    x = np.einsum("tji,tjk->tik", turns(_HIP_AXIS, yaw_pitch) @ turns(_X, roll), hip)
    pitch = np.arctan2(x[:, 0, 2], x[:, 2, 2])
    return np.stack([yaw_pitch, roll, pitch, knee, ankle_pitch, ankle_roll], axis=1)


def _angle(cosine: Array) -> Array:
    """The angle (T,) of a cosine; nan where there is none."""
    with np.errstate(invalid="ignore"):
        return np.asarray(np.arccos(cosine))


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.linalg.norm(vector))
