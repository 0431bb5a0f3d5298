"""The sample motions: as generated, within the robot's limits, and clear of its body."""

import subprocess
import sys

import mujoco
import numpy as np
import pytest

from nao_sim import body
from nao_sim.imitation.retarget import retarget
from nao_sim.lesson import guarded
from nao_sim.motion import Skeleton
from nao_sim.paths import MODEL, TRAJECTORIES
from nao_sim.recordings import load
from nao_sim.robot import load_robot

ROBOT = load_robot()
GESTURES = sorted(path.relative_to(TRAJECTORIES).with_suffix("").as_posix() for path in TRAJECTORIES.glob("gestures/*"))
GENTLE = ["wave", "greeting", "arm_circles", *GESTURES]
START = ROBOT.postures["StandInit"]


def motion(name):
    return load(TRAJECTORIES / f"{name}.csv").motion


def whole(trajectory):
    """Positions (T, 26) with the start posture where nothing is asked."""
    return np.where(np.isfinite(trajectory.positions), trajectory.positions, START)


def test_the_files_are_what_the_program_makes():
    program = TRAJECTORIES / "make_trajectories.py"
    made = subprocess.run([sys.executable, str(program), "--check"], capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stdout + made.stderr


def test_every_file_is_in_the_list_of_origins():
    origins = (TRAJECTORIES / "README.md").read_text(encoding="utf-8")
    assert not [path.name for path in TRAJECTORIES.rglob("*.csv") if f"`{path.name}`" not in origins]


@pytest.mark.parametrize("name", GENTLE)
def test_a_gentle_motion_starts_and_ends_at_rest_within_limits_and_half_the_speed(name):
    trajectory = motion(name)
    positions = whole(trajectory)
    assert np.isfinite(trajectory.positions[:, trajectory.given]).all()
    assert not trajectory.given[ROBOT.limbs["LLeg"]].any() and not trajectory.given[ROBOT.limbs["RLeg"]].any()
    np.testing.assert_allclose(positions[[0, -1]], np.stack([START, START]), atol=0.01)
    assert (positions > ROBOT.lower - 1e-9).all() and (positions < ROBOT.upper + 1e-9).all()
    for coupling in ROBOT.couplings:
        lower, upper = coupling.bounds(positions[:, coupling.by])
        assert (positions[:, coupling.joint] >= lower).all() and (positions[:, coupling.joint] <= upper).all()
    speed = np.abs(np.diff(positions, axis=0)) / np.diff(trajectory.times)[:, None]
    assert (speed <= 0.5 * ROBOT.no_load_speed).all()


@pytest.fixture(scope="module")
def touching():
    """The pairs of bodies in contact at positions (N, 26), found by the model's kinematics."""
    model = mujoco.MjModel.from_xml_path(str(MODEL / "nao_h25.xml"))
    data = mujoco.MjData(model)
    addresses = [model.joint(joint).qposadr[0] for joint in ROBOT.joint_names]

    def touching(poses):
        pairs = set()
        for positions in poses:
            data.qpos[addresses] = positions
            mujoco.mj_forward(model, data)
            for contact in data.contact:
                pairs.add(frozenset(model.body(model.geom_bodyid[geom]).name for geom in contact.geom))
        return pairs

    return touching


@pytest.mark.parametrize("name", GENTLE)
def test_a_gentle_motion_touches_nothing(touching, name):
    assert not touching(whole(motion(name))[::5])


@pytest.mark.parametrize("name", [name for name in GESTURES if "right_" not in name])
def test_the_guard_lets_a_gesture_pass_unchanged(name):
    safe, changed = guarded(motion(name), ROBOT)
    assert changed < 1e-9 and len(safe) > 100


@pytest.mark.parametrize("name", [name for name in GESTURES if "right_" in name])
def test_a_gesture_of_the_right_is_that_of_the_left_in_the_mirror(name):
    left = motion(name.replace("right_", "left_")).mirrored()
    np.testing.assert_allclose(motion(name).positions, left.positions, atol=1e-9)


@pytest.mark.parametrize(
    ("time", "bodies"),
    [
        (10.9, {"torso"}),
        (12.1, {"torso"}),
        (13.5, {"Head"}),
        (14.9, {"LThigh", "RThigh"}),
        (16.3, {"l_wrist", "r_wrist"}),
        (17.9, {"torso"}),
    ],
)
def test_the_stress_motion_puts_the_hands_into_the_body(touching, time, bodies):
    (pose,) = motion("stress").sample(np.array([time]))
    assert bodies <= set().union(*touching([pose]))


@pytest.mark.parametrize(
    ("name", "asked"),
    [
        ("side", {"ShoulderPitch": 0, "ShoulderRoll": 72, "ElbowRoll": -6}),
        ("forward", {"ShoulderPitch": 0, "ShoulderRoll": 5, "ElbowRoll": -6}),
        ("piUp", {"ShoulderPitch": 0, "ShoulderRoll": 70, "ElbowYaw": -90, "ElbowRoll": -85}),
        ("up", {"ShoulderPitch": -85, "ShoulderRoll": 10, "ElbowRoll": -6}),
        ("down", {"ShoulderPitch": 88, "ShoulderRoll": 14, "ElbowRoll": -6}),
    ],
)
def test_a_gesture_holds_its_posture_on_both_sides(name, asked):
    held = motion(f"gestures/{name}").sample(np.array([3.0]))[0]
    for side, mirrored in (("L", held), ("R", ROBOT.mirror(held))):
        for joint, angle in asked.items():
            assert np.degrees(mirrored[ROBOT.index["L" + joint]]) == pytest.approx(angle, abs=0.01), side


def test_the_stress_motion_asks_for_what_is_forbidden():
    trajectory = motion("stress")
    positions = trajectory.positions
    finite = np.where(np.isfinite(positions), positions, START)
    speed = np.abs(np.diff(finite, axis=0)) / np.diff(trajectory.times)[:, None]
    upper_body = np.setdiff1d(np.arange(26), np.concatenate([ROBOT.limbs["LLeg"], ROBOT.limbs["RLeg"]]))
    assert trajectory.given.all() and 20.0 < trajectory.duration < 25.0
    assert (finite.max(axis=0) > ROBOT.upper)[upper_body].all() and (finite.min(axis=0) < ROBOT.lower)[upper_body].all()
    assert (speed.max(axis=0) > ROBOT.no_load_speed).all()
    assert np.isnan(positions).any() and (positions == np.inf).any() and (positions == -np.inf).any()
    for coupling in ROBOT.couplings:
        lower, upper = coupling.bounds(finite[:, coupling.by])
        assert (finite[:, coupling.joint] > upper + 0.05).any() and (finite[:, coupling.joint] < lower - 0.05).any()
    text = (TRAJECTORIES / "stress.csv").read_text()
    assert ",," in text and ",nan," in text


def test_the_person_is_read_as_one_in_front_of_a_kinect():
    recording = load(TRAJECTORIES / "person_wave.csv")
    skeleton = recording.motion
    assert isinstance(skeleton, Skeleton) and "Kinect v2" in recording.reason
    assert 6.0 <= skeleton.times[-1] <= 8.0 and (skeleton.confidence == 1.0).all()
    for bone in body.bones():
        length = np.linalg.norm(skeleton.track(bone.end) - skeleton.track(bone.start), axis=1)
        if bone.start.partition("_")[2] != "shoulder" or bone.end.partition("_")[2] != "hip":
            np.testing.assert_allclose(length, length.mean(), atol=5e-4, err_msg=str(bone))


def test_the_person_waves_with_the_right_hand_and_points_with_the_left():
    skeleton = load(TRAJECTORIES / "person_wave.csv").motion
    waving, pointing = (int(np.searchsorted(skeleton.times, time)) for time in (2.5, 5.3))
    assert skeleton.track("right_wrist")[waving, 2] > skeleton.track("head")[waving, 2]
    assert (skeleton.track("left_wrist") - skeleton.track("left_shoulder"))[pointing, 0] > 0.4  # m, ahead
    assert (skeleton.track("left_wrist") - skeleton.track("right_wrist"))[0, 1] > 0.4  # left is left


def test_the_robot_can_do_what_the_person_does(touching):
    asked = retarget(load(TRAJECTORIES / "person_wave.csv").motion, ROBOT).motion
    positions = whole(asked)
    assert (np.abs(np.diff(positions, axis=0)) / np.diff(asked.times)[:, None] <= ROBOT.no_load_speed).all()
    assert not touching(positions[::5])
