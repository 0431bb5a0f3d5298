"""The whole body: the robot squats, leans and sways as the person, on planted feet, without falling.

Of the person four numbers a frame count (`lean.py`).  The robot's torso takes
as much of them as its joints and motors allow, over feet that stay where they
are, and moves so that its centre of mass stays over their middle (`planted.py`);
the legs follow from that in closed form (`legs.py`).
"""

from __future__ import annotations

import numpy as np

from nao_sim.imitation.calm import calm, filled, slow_above
from nao_sim.imitation.lean import REACH, lean_of, lifted_share
from nao_sim.imitation.legs import leg_lengths
from nao_sim.imitation.mass import centre_of_mass
from nao_sim.imitation.planted import KNEE, Planted, bend
from nao_sim.motion import Skeleton
from nao_sim.robot import STANDING_ACCELERATION, STANDING_SPEED, Array, Mask, Robot

STRAIGHT = 0.985  # reach of a leg that counts as straight: people stand with knees bent by up to 20 degrees
LEAST = np.array([0.0, -0.5, -0.5, -0.03])  # rad, rad, rad, m: KNEE, PITCH, ROLL, SWAY
MOST = np.array([2.1, 1.3, 0.5, 0.03])
FASTEST = np.array([3.0, 2.0, 1.0, 0.1])  # a second
SHALLOW = np.array([0.015, 0.010])  # m, forward and sideways: what arms and head may shift the centre of mass
SHIFTING = np.array([0.1, 0.1])  # m/s, of the torso in answer to more than that
SOFTNESS = (0.04, 2.0)  # s, time constants of the smoothing: the usual one, and the longest where motors cannot follow
SOFTER = 1.5  # times, in each round where they cannot
SPREADING = 2.0  # 1/s, of the time constant's logarithm
SPARE = 0.9  # of the motors' speed and acceleration is used
SUDDEN = 0.02  # s that a change of speed takes, a step of the motion controller
LIFTED_SHARE = 0.02  # of the frames, from where on lifted feet are worth a note
_ROUNDS = 16


def whole_body_positions(skeleton: Skeleton, arms: Array, robot: Robot, start: Array) -> Array:
    """Fill in the legs.

    Args:
        skeleton: the person, T frames.
        arms: (T, 26) what is asked of arms and head; nan where nothing is.
        robot: whose limits and masses hold.
        start: (26,) the standing posture before the motion, whose feet stay planted.

    Returns:
        (T, 26) `arms` with the legs filled in; these stay in the start posture
        if the person's are not tracked.
    """
    planted = Planted.of(robot, start)
    legs = np.broadcast_to(planted.start, (len(skeleton), *planted.start.shape))
    wish = lean_of(skeleton)
    if np.isfinite(wish[:, REACH]).any():
        upright = np.array([1.0, 0.0, 0.0, 0.0])
        upper = centre_of_mass(filled(skeleton.times, arms, start), robot, legs=False)
        legs = _plan(planted, skeleton.times, _wish(planted, filled(skeleton.times, wish, upright)), upper)
    positions = np.array(arms)
    positions[:, planted.joints.ravel()] = legs.reshape(len(legs), planted.joints.size)
    return positions


def whole_body_notes(skeleton: Skeleton) -> tuple[str, ...]:
    """What a user should know of how the legs follow this person."""
    wish = lean_of(skeleton)
    if not np.isfinite(wish[:, REACH]).any():
        return ("hip, knee and ankle are not tracked: the legs keep the start posture",)
    notes = []
    if skeleton.planar:
        notes.append("one camera without depth: leaning forward is not seen")
    lifted = lifted_share(skeleton)
    if lifted > LIFTED_SHARE:
        notes.append(f"a foot is off the floor in {lifted:.0%} of the frames: the robot's feet stay on it")
    return tuple(notes)


def _wish(planted: Planted, person: Array) -> Array:
    """What the robot should do (T, 4) for what a person does (T, 4), finite, as `lean_of` says."""
    lean = planted.standing + person * [0.0, 1.0, 1.0, sum(leg_lengths())]
    longest = float(np.linalg.norm(planted.stance.hips))
    lean[:, KNEE] = bend(longest * np.minimum(person[:, REACH] / STRAIGHT, 1.0))
    return np.asarray(np.clip(lean, np.minimum(LEAST, planted.standing), np.maximum(MOST, planted.standing)))


def _plan(planted: Planted, times: Array, wish: Array, upper: Array) -> Array:
    """Legs (T, 2, 6) rad for a wished lean (T, 4), in balance and slow enough for the motors.

    Where a motor could not follow, the motion is smoothed more, and again.

    Args:
        planted: the robot.
        times: (T,) s.
        wish: (T, 4).
        upper: (T, 3) m, centre of mass of all but the legs, in the torso.
    """
    middle = np.broadcast_to(planted.upper, upper.shape)  # what can be done hardly depends on where the arms are
    wish = planted.nearest(wish, middle, np.zeros((len(times), 2)))[0]
    softness = np.full(len(times), SOFTNESS[0])
    for _ in range(_ROUNDS):
        lean = calm(times, wish, FASTEST, softness)
        shift = planted.shift(lean, upper)
        shift -= calm(times, shift - np.clip(shift, -SHALLOW, SHALLOW), SHIFTING, softness)
        legs = planted.nearest(lean, upper, shift)[1]
        late = effort(planted, times, legs) > 1.0
        if not late.any():
            break
        softness = _softer(times, softness, late)
    return legs


def effort(planted: Planted, times: Array, legs: Array) -> Array:
    """Speeds and accelerations (T,) of legs (T, 2, 6) over what their motors can do, the greatest of each frame."""
    if len(times) == 1:
        return np.zeros(1)
    steps = np.diff(times)[:, None, None]
    speed = np.zeros((len(times) + 1, *legs.shape[1:]))  # before each frame, and after the last
    speed[1:-1] = np.diff(legs, axis=0) / steps
    fast = np.abs(speed) / np.minimum(planted.robot.max_speed[planted.joints], STANDING_SPEED)
    # the way between frames is straight: speed changes all at once, and the guard spreads that out where it must
    step = np.minimum(np.concatenate([steps, steps[-1:]]), np.concatenate([steps[:1], steps]))
    lasts = np.minimum(step, np.maximum(step / 2.0, SUDDEN))
    lasts[[0, -1]] = np.maximum(lasts[[0, -1]], SUDDEN)
    acceleration = np.minimum(planted.robot.max_acceleration[planted.joints], STANDING_ACCELERATION)
    sudden = np.abs(np.diff(speed, axis=0)) / lasts / acceleration
    return np.asarray(np.maximum(np.maximum(fast[1:], fast[:-1]), sudden).max(axis=(1, 2)) / SPARE)


def _softer(times: Array, softness: Array, late: Mask) -> Array:
    """Time constants (T,) s that are longer around late frames (T,)."""
    wanted = np.log(np.where(late, softness * SOFTER, softness))
    spread = slow_above(wanted[:, None], SPREADING * np.diff(times)[:, None])[:, 0]
    return np.asarray(np.minimum(np.exp(spread), SOFTNESS[1]))
