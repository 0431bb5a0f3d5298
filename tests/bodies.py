"""People made from a robot's poses, by MuJoCo's own kinematics."""

from __future__ import annotations

import numpy as np

from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.mujoco_model import JointMap, robot_alone
from nao_sim.robot import load_robot

UPPER_ARM, FOREARM = 0.105, 0.1137  # m, NAO's to the elbow's axis and on to the hand
ROBOT = load_robot()


class Kinematics:
    """How the robot's links are turned and where they are, in the torso's frame."""

    def __init__(self, positions: np.ndarray) -> None:
        import mujoco

        model = robot_alone()
        data = mujoco.MjData(model)
        self.turns: dict[str, np.ndarray] = {}
        self.places: dict[str, np.ndarray] = {}
        turns, places = [], []
        for qpos in JointMap(model).to_qpos(positions):
            data.qpos[:] = qpos
            mujoco.mj_kinematics(model, data)
            turns.append(data.xmat.reshape(-1, 3, 3).copy())
            places.append(data.xpos.copy())
        torso = model.body("torso").id
        back = np.swapaxes(np.array(turns)[:, torso], 1, 2)
        for i in range(model.nbody):
            self.turns[model.body(i).name] = back @ np.array(turns)[:, i]
            self.places[model.body(i).name] = np.einsum(
                "tij,tj->ti", back, np.array(places)[:, i] - np.array(places)[:, torso]
            )

    def standing(self) -> np.ndarray:
        """The torso's orientation (T, 3, 3) over the lower foot, standing flat."""
        lower = self.places["r_ankle"][:, 2] < self.places["l_ankle"][:, 2]
        foot = np.where(lower[:, None, None], self.turns["r_ankle"], self.turns["l_ankle"])
        return np.swapaxes(foot, 1, 2)


def person_like(motion: JointTrajectory, *, upright: bool = False) -> Skeleton:
    """Somebody of NAO's arm lengths and human legs whose every link points as the robot's.

    Args:
        motion: the robot's, every joint finite.
        upright: whether the torso stands upright, whatever the legs do.
    """
    body = Kinematics(motion.positions)
    points = {"pelvis": np.zeros((len(motion), 3)), "chest": np.tile((0.0, 0.0, 0.5), (len(motion), 1))}
    points["head"] = points["chest"] + 0.2 * body.turns["Head"][:, :, 2]
    for side, sign in (("left", 1.0), ("right", -1.0)):
        letter = side[0].upper()
        shoulder, hip = (np.tile(at, (len(motion), 1)) for at in ((0.0, 0.2 * sign, 0.5), (0.0, 0.1 * sign, 0.0)))
        elbow = shoulder + UPPER_ARM * body.turns[f"{letter}Bicep"][:, :, 0]
        knee = hip - 0.4 * body.turns[f"{letter}Thigh"][:, :, 2]
        points |= {f"{side}_shoulder": shoulder, f"{side}_elbow": elbow, f"{side}_hip": hip, f"{side}_knee": knee}
        points[f"{side}_wrist"] = elbow + FOREARM * body.turns[f"{letter}ForeArm"][:, :, 0]
        points[f"{side}_ankle"] = knee - 0.4 * body.turns[f"{letter}Tibia"][:, :, 2]
    torso = np.broadcast_to(np.eye(3), (len(motion), 3, 3)) if upright else body.standing()
    positions = np.einsum("tij,tnj->tni", torso, np.stack(list(points.values()), axis=1))
    return Skeleton(motion.times, positions, tuple(points))


def smooth_motion(seed: int, seconds: float, rate: float = 50.0) -> JointTrajectory:
    """All joints in slow, unrepeating movement inside their limits."""
    random = np.random.default_rng(seed)
    times = np.arange(0.0, seconds, 1.0 / rate)
    frequency, phase = random.uniform(0.1, 1.5, (4, 1, 26)), random.uniform(0.0, 2 * np.pi, (4, 1, 26))
    share = np.sin(2 * np.pi * frequency * times[:, None] + phase).mean(axis=0)
    middle, half = (ROBOT.lower + ROBOT.upper) / 2, (ROBOT.upper - ROBOT.lower) / 2
    return JointTrajectory(times, middle + half * share)


def random_poses(seed: int, frames: int) -> JointTrajectory:
    """Poses anywhere inside the limits, 50 a second; knees bent forward only, as people's."""
    random = np.random.default_rng(seed)
    positions = random.uniform(ROBOT.lower, ROBOT.upper, (frames, 26))
    knees = [ROBOT.index["LKneePitch"], ROBOT.index["RKneePitch"]]
    positions[:, knees] = np.abs(positions[:, knees])
    return JointTrajectory(0.02 * np.arange(frames), positions)
