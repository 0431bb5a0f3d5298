"""How the hands are turned and how far they are open, where their joints are tracked.

With all arm angles 0, NAO's arms point forward, palms inwards, thumbs up: the
line from the little finger's knuckle to the index finger's points up.  Turned
by WristYaw t about the forearm it points along (0, -sin t, cos t) in the
forearm's frame, on both sides.
"""

from __future__ import annotations

import numpy as np

from nao_sim.body import SIDES
from nao_sim.imitation.person import first_known, torso_frames
from nao_sim.motion import Skeleton
from nao_sim.robot import Array, load_robot

FINGERS = ("index", "middle", "ring", "pinky")
CLOSED, OPEN = 0.5, 0.92  # fingertip to wrist over the way along the bones, of a fist and of a flat hand


def hand_positions(skeleton: Skeleton, arms: Array, torso: Array | None = None) -> Array:
    """Wrists and hands in the robot's joint vector.

    Args:
        skeleton: the person.
        arms: (T, 26) rad, the arms that the robot takes.
        torso: (T, 3, 3) the skeleton's `torso_frames`, where they are known already.

    Returns:
        (T, 26), nan for every joint but LWristYaw, RWristYaw, LHand and RHand,
        and for these where the hand's joints are not tracked.
    """
    robot = load_robot()
    positions = np.full(arms.shape, np.nan)
    torso = torso_frames(skeleton) if torso is None else torso
    for side in SIDES:
        letter = side[0].upper()
        # which way a palm looks is a question of depth
        if {f"{side}_index_mcp", f"{side}_pinky_mcp"} <= set(skeleton.joints) and not skeleton.planar:
            yaw = robot.index[f"{letter}WristYaw"]
            turned = _wrist_yaw(skeleton, side, torso, _forearm_frame(arms, letter))
            positions[:, yaw] = np.clip(turned, robot.lower[yaw], robot.upper[yaw])
        positions[:, robot.index[f"{letter}Hand"]] = hand_opening(skeleton, side)
    return positions


def hand_opening(skeleton: Skeleton, side: str) -> Array:
    """How far (T,) a hand is open, 0 a fist and 1 flat; nan without its finger joints.

    The distance from wrist to fingertip shrinks as fingers bend, while the way
    along the bones does not.
    """
    tracked = [finger for finger in FINGERS if f"{side}_{finger}_tip" in skeleton.joints]
    if not tracked:
        return np.full(len(skeleton), np.nan)
    shares = np.stack([_extension(skeleton, side, finger) for finger in tracked])
    known = np.isfinite(shares)
    total = np.where(known, shares, 0.0).sum(axis=0)
    mean = np.divide(total, known.sum(axis=0), out=np.full(len(skeleton), np.nan), where=known.any(axis=0))
    return np.clip((mean - CLOSED) / (OPEN - CLOSED), 0.0, 1.0)


def _extension(skeleton: Skeleton, side: str, finger: str) -> Array:
    wrist = first_known([skeleton.track(f"{side}_wrist"), skeleton.track(f"{side}_hand")])
    chain = [wrist, *(skeleton.track(f"{side}_{finger}_{joint}") for joint in ("mcp", "pip", "dip", "tip"))]
    way = np.linalg.norm(np.diff(np.stack(chain), axis=0), axis=-1).sum(axis=0)
    direct = np.linalg.norm(chain[-1] - chain[0], axis=-1)
    return np.divide(direct, way, out=np.full(len(skeleton), np.nan), where=way > 0.0)


def _wrist_yaw(skeleton: Skeleton, side: str, torso: Array, forearm: Array) -> Array:
    across = skeleton.track(f"{side}_index_mcp") - skeleton.track(f"{side}_pinky_mcp")
    _, y, z = np.einsum("tkj,tlk,tl->jt", forearm, torso, across)
    return np.asarray(np.arctan2(-y, z))


def _forearm_frame(arms: Array, letter: str) -> Array:
    """Orientation (T, 3, 3) of the forearm in the torso, before the wrist turns."""
    from scipy.spatial.transform import Rotation

    robot = load_robot()
    angles = [
        arms[:, robot.index[letter + name]] for name in ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll")
    ]
    known = np.asarray(np.isfinite(angles).all(axis=0))
    turns = Rotation.from_euler("YZX", np.where(known, angles[:3], 0.0).T)
    bends = Rotation.from_euler("Z", np.where(known, angles[3], 0.0)[:, None])
    return np.where(known[:, None, None], (turns * bends).as_matrix(), np.nan)
