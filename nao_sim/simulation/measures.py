"""What the simulated robot did: limits, speeds, distances, balance and tracking."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import mujoco
import numpy as np

from nao_sim.mujoco_model import JointMap
from nao_sim.robot import Array, Robot
from nao_sim.safety.coupling import coupling_excess
from nao_sim.safety.support import SOLES, sole_corners
from nao_sim.simulation.rollout import Rollout
from nao_sim.simulation.simulator import CONTROL_STEP, State

FALLEN_TILT = np.radians(20.0)  # of the flatter sole; it bows and squats as far as it likes, on its feet
LIMIT_TOLERANCE = np.radians(0.1)
LIFTED = 0.01  # m; a sole's corner higher than this carries nothing
MOVING = np.radians(1.0)  # a joint that moves less tells nothing about lag
LONGEST_LAG = 0.3  # s
ROUNDING = 1e-9  # m
PIECE = 5000  # steps looked at together: an hour of them at once takes gigabytes


@dataclass(frozen=True)
class Balance:
    """How the robot stood.

    Attributes:
        fell: whether it left its feet at any time.
        min_support_margin: m from the centre of mass, seen from above, to the
            nearest edge of the support polygon; negative outside; None when pinned.
    """

    fell: bool
    min_support_margin: float | None


def limit_violations(robot: Robot, states: list[State]) -> tuple[int, float]:
    """Control steps with a simulated joint beyond its limit by more than 0.1 deg, and the largest excess (rad)."""
    beyond = [np.maximum(robot.lower - s.lowest, s.highest - robot.upper)[~robot.is_hand].max() for s in states]
    excess = np.maximum(beyond, 0.0)
    return int((excess > LIMIT_TOLERANCE).sum()), float(excess.max(initial=0.0))


def max_speed_ratio(robot: Robot, states: list[State]) -> float:
    """Largest simulated speed of any joint over its motor's no-load speed."""
    return float(max((s.fastest / robot.no_load_speed).max() for s in states))


def max_coupling_excess(robot: Robot, rollout: Rollout) -> float:
    """Largest excess (rad) of a simulated joint over the limit that another joint sets."""
    return float(max(coupling_excess(coupling, rollout.joint_positions).max() for coupling in robot.couplings))


def balance(model: mujoco.MjModel, rollout: Rollout) -> Balance:
    """Whether the robot fell, and how near it came to that."""
    if not JointMap(model).free:
        return Balance(False, None)
    stood = stance(model, rollout)
    return Balance(bool((stood.tilt > FALLEN_TILT).any()), float(stood.margin.min()))


@dataclass(frozen=True, eq=False)
class Stance:
    """How a free robot stood in each of T steps.

    Attributes:
        margin: (T,) m, of its centre of mass inside its support polygon seen from above; negative outside,
            minus infinity with fewer than two corners of its soles on the floor.
        tilt: (T,) rad, of the sole that lies flatter.
    """

    margin: Array
    tilt: Array


@lru_cache(maxsize=1)  # the report, a picture and a page of the same run ask for it
def stance(model: mujoco.MjModel, rollout: Rollout) -> Stance:
    """How a free-standing robot stood."""
    joints, data = JointMap(model), mujoco.MjData(model)
    soles = [model.geom(sole).id for sole in SOLES]
    centres, corners, upright = (np.empty((len(rollout), *shape)) for shape in ((2,), (8, 3), (2,)))
    for step, qpos in enumerate(joints.to_qpos(rollout.joint_positions, rollout.base_pose)):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        centres[step], upright[step] = data.subtree_com[1, :2], data.geom_xmat[soles, 8]
        corners[step] = np.concatenate([sole_corners(model, data, sole) for sole in SOLES])
    grounded = np.where(corners[..., 2:] < LIFTED, corners[..., :2], np.nan)
    tilt = np.arccos(np.clip(upright.max(axis=1), -1.0, 1.0))
    pieces = [slice(start, start + PIECE) for start in range(0, len(rollout), PIECE)]
    return Stance(np.concatenate([support_margin(centres[piece], grounded[piece]) for piece in pieces]), tilt)


def support_margin(points: Array, contacts: Array) -> Array:
    """How far (m) points (..., 2) are inside the convex hulls of contacts (..., N, 2); negative outside.

    A line through two contacts is an edge of the hull where no contact lies to
    its right.  The margin is the smallest distance to the left of an edge, so
    where all contacts are in a line nothing is inside.

    Args:
        points: seen from above.
        contacts: not a number where there is none.

    Returns:
        (...) m; minus infinity on fewer than two contacts.
    """
    along = contacts[..., None, :, :] - contacts[..., :, None, :]  # from i to j
    with np.errstate(invalid="ignore"):
        left = np.stack([-along[..., 1], along[..., 0]], axis=-1) / np.linalg.norm(along, axis=-1, keepdims=True)
        side = np.einsum(
            "...ijkc,...ijc->...ijk", contacts[..., None, None, :, :] - contacts[..., :, None, None, :], left
        )
        is_edge = np.isfinite(left).all(axis=-1) & ~(side < -ROUNDING).any(axis=-1)
        inside = np.einsum("...ijc,...ijc->...ij", points[..., None, None, :] - contacts[..., :, None, :], left)
    margin = np.where(is_edge, inside, np.inf).min(axis=(-2, -1), initial=np.inf)
    return np.where(is_edge.any(axis=(-2, -1)), margin, -np.inf)


def tracking(rollout: Rollout) -> tuple[Array, float | None]:
    """Root-mean-square difference (26,) of simulated joints from commands, and the lag (s) of the joints that moved.

    The lag is the delay, in control steps refined by a parabola, at which the
    commands fit the simulated motion best; None where nothing moved.
    """
    command, done = rollout.command, rollout.joint_positions
    rmse = np.sqrt(np.mean((done - command) ** 2, axis=0))
    moving = np.ptp(command, axis=0) > MOVING
    longest = min(round(LONGEST_LAG / CONTROL_STEP), len(rollout) - 2)
    if not moving.any() or longest <= 1:
        return rmse, None
    command, done = command[:, moving], done[:, moving]
    errors = [np.mean((done[n:] - command[: len(command) - n]) ** 2) for n in range(longest + 1)]
    best = int(np.argmin(errors))
    return rmse, (best + _parabola_offset(errors, best)) * CONTROL_STEP


def _parabola_offset(errors: list[np.floating], best: int) -> float:
    if not 0 < best < len(errors) - 1:
        return 0.0
    before, at, after = (float(errors[i]) for i in (best - 1, best, best + 1))
    bend = before - 2 * at + after
    return 0.5 * (before - after) / bend if bend > 0 else 0.0
