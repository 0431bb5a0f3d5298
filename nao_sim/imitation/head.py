"""Where the person looks, as HeadYaw and HeadPitch.

With a face (nose or eyes, and ears) the line from between the ears to the face
is the direction of the head.  Eye centres and tip of the nose lie about as far
above as below the ears' height, so their middle needs no correction; the tip
of the nose alone lies 14 degrees below.

Without a face the head's centre over the neck tells the nod alone, and every
sensor has its own idea of upright (20 degrees apart): there the recording's
median counts as looking ahead.
"""

from __future__ import annotations

import numpy as np

from nao_sim.imitation.person import first_known, middle, torso_frames
from nao_sim.motion import Skeleton
from nao_sim.robot import Array, load_robot

HEAD_JOINTS = ("HeadYaw", "HeadPitch")
NOSE_DROP = np.radians(14.0)
_NOSE_OVER_EARS = 0.8  # tip of the nose from between the ears, in distances between the ears


def head_positions(skeleton: Skeleton, upright: float | None = None, torso: Array | None = None) -> Array:
    """The head's angles in the robot's joint vector.

    Args:
        skeleton: the person.
        upright: rad, the `nod` that counts as looking ahead,
            for people without a face; the skeleton's median where None.
        torso: (T, 3, 3) the skeleton's `torso_frames`, where they are known already.

    Returns:
        (T, 26), nan for every joint but `HEAD_JOINTS`, and for these where the
        head is not tracked.
    """
    robot = load_robot()
    torso = torso_frames(skeleton) if torso is None else torso
    yaw, pitch = _face_angles(skeleton, torso)
    if not np.isfinite(pitch).any():
        lean = nod(skeleton, torso)
        pitch = lean - (median(lean) if upright is None else upright)
    positions = np.full((len(skeleton), len(robot.joint_names)), np.nan)
    joints = [robot.index[name] for name in HEAD_JOINTS]
    positions[:, joints] = np.clip(np.stack([yaw, pitch], axis=1), robot.lower[joints], robot.upper[joints])
    return positions


def nod(skeleton: Skeleton, torso: Array) -> Array:
    """How far (T,) rad the head leans forward over the neck, seen from the torso."""
    neck = first_known([skeleton.track("neck"), skeleton.track("chest"), middle(skeleton, "shoulder")])
    x, _, z = _seen_from(torso, skeleton.track("head") - neck)
    return np.asarray(np.arctan2(x, z))


def median(values: Array) -> float:
    """The median of the finite values, 0 where there is none."""
    finite = values[np.isfinite(values)]
    return float(np.median(finite)) if len(finite) else 0.0


def _face_angles(skeleton: Skeleton, torso: Array) -> tuple[Array, Array]:
    """Yaw and pitch (T,) of the face; nan where no face is tracked."""
    nose, eyes, ears = skeleton.track("nose"), middle(skeleton, "eye"), middle(skeleton, "ear")
    face = first_known([(nose + eyes) / 2.0, eyes, nose])
    drop = np.where(np.isfinite(eyes).all(axis=1), 0.0, NOSE_DROP)
    x, y, z = _seen_from(torso, face - ears)
    if skeleton.planar:  # the depth that the ears' distance stands for
        breadth = _breadth(skeleton)
        x = np.sqrt(np.maximum((_NOSE_OVER_EARS * breadth) ** 2 - y**2, (0.1 * breadth) ** 2))
    return np.arctan2(y, x), -np.arctan2(z, np.hypot(x, y)) - drop


def _breadth(skeleton: Skeleton) -> float:
    """Distance between the ears, m, when the head is seen from the front."""
    apart = np.linalg.norm(skeleton.track("left_ear") - skeleton.track("right_ear"), axis=1)
    finite = apart[np.isfinite(apart)]
    return float(np.percentile(finite, 90)) if len(finite) else np.nan


def _seen_from(torso: Array, vectors: Array) -> Array:
    """Vectors (T, 3) in the torso's frame, as (3, T)."""
    return np.asarray(np.einsum("tji,tj->it", torso, vectors))
