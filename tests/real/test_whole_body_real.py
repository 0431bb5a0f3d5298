"""People of motion capture and depth cameras: the robot follows with its whole body and stays on its feet."""

from pathlib import Path

import numpy as np
import pytest

from nao_sim.imitation.hand_places import places_of, robot_arm, robot_places
from nao_sim.imitation.mass import link_frames
from nao_sim.imitation.retarget import retarget
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.recordings import load
from nao_sim.robot import load_robot
from nao_sim.safety.self_distance import SelfDistance
from nao_sim.simulation import measures
from nao_sim.simulation.performance import perform

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "recordings"
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason=f"no {FOLDER}")
ROBOT = load_robot()


def piece(skeleton: Skeleton, begin: float, end: float, every: int) -> Skeleton:
    chosen = np.flatnonzero((skeleton.times >= begin) & (skeleton.times < end))[::every]
    return Skeleton(skeleton.times[chosen], skeleton.positions[chosen], skeleton.joints, skeleton.confidence[chosen])


@pytest.mark.parametrize(
    ("name", "begin", "end", "low"),
    [
        ("13_30.amc", 12.0, 16.5, 0.285),  # squats, quicker than legs that the robot stands on may move
        ("13_30.amc", 8.0, 12.0, 0.33),  # knees up
        ("14_14.amc.xz", 24.0, 32.0, 0.33),  # arm circles, twists and reaches to the sides
    ],
)
def test_exercises_stay_standing(simulator, name, begin, end, low):
    person = load(FOLDER / "cmu_mocap6" / "amc" / name).motion
    motion = retarget(piece(person, begin, end, 4), ROBOT, body="whole").motion
    rollout = perform(motion, simulator("free")).rollout
    balance = measures.balance(simulator("free").model, rollout)
    assert not balance.fell
    assert balance.min_support_margin > 0.03
    assert rollout.base_pose[:, 2].min() < low  # m, of the torso; StandInit has it at 0.32


@pytest.mark.parametrize("name", ["hello_s01_1", "rain_s02_1", "strong_s03_1"])
def test_signing_hands_come_nearer_to_their_places_and_keep_clear(name):
    person = load(FOLDER / "isl_kinect_signs" / "samples" / f"{name}.txt").motion
    ways = {match: retarget(person, ROBOT, match=match) for match in ("directions", "hands")}
    found = {match: hand_error(done.person, done.motion) for match, done in ways.items()}
    assert found["hands"] < 0.85 * found["directions"]
    distance, start = SelfDistance(), ROBOT.postures["StandInit"]
    poses = np.where(np.isfinite(ways["hands"].motion.positions), ways["hands"].motion.positions, start)
    assert min(distance.nearest(pose).distance for pose in poses) > 0.008


def hand_error(person: Skeleton, motion: JointTrajectory) -> float:
    """Mean way from the palms to where they belong, in arm lengths."""
    frames = link_frames(np.nan_to_num(motion.positions), ROBOT, frozenset(["l_wrist", "r_wrist"]))
    palms = [frames[link][1] + 0.05775 * frames[link][0][:, :, 0] for link in ("l_wrist", "r_wrist")]
    belongs = robot_places(places_of(person), motion.positions, ROBOT)
    return float(np.nanmean(np.linalg.norm(np.stack(palms, axis=1) - belongs, axis=2))) / robot_arm()
