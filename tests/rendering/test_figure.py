from dataclasses import replace
from functools import cache

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.motion import Skeleton
from nao_sim.rendering.figure import HIDDEN, add_figure, figure_of
from nao_sim.rendering.presets import load_figure
from nao_sim.simulation.scene import compiled, compose

STANDING = {
    "head": (0.0, 0.0, 1.65),
    "left_shoulder": (0.0, 0.18, 1.40),
    "right_shoulder": (0.0, -0.18, 1.40),
    "left_elbow": (0.0, 0.48, 1.40),
    "right_elbow": (0.0, -0.18, 1.10),
    "left_wrist": (0.0, 0.48, 1.65),
    "right_wrist": (0.0, -0.18, 0.85),
    "left_hip": (0.0, 0.09, 0.93),
    "right_hip": (0.0, -0.09, 0.93),
    "left_knee": (0.0, 0.09, 0.50),
    "right_knee": (0.0, -0.09, 0.50),
    "left_ankle": (0.0, 0.09, 0.08),
    "right_ankle": (0.0, -0.09, 0.08),
}
FRAMES = 4


def person(seed: int = 0, without: tuple[str, ...] = (), noise: float = 0.02) -> Skeleton:
    rng = np.random.default_rng(seed)
    tracks = {name: np.add(place, noise * rng.normal(size=(FRAMES, 3))) for name, place in STANDING.items()}
    kept = {name: track for name, track in tracks.items() if name not in without}
    return Skeleton(np.arange(FRAMES) / 10.0, np.stack(list(kept.values()), axis=1), tuple(kept))


@cache
def robot_at_rest() -> np.ndarray:
    """The positions of a scene without a figure."""
    return compiled(compose()).qpos0


def all_capsules(skeleton: Skeleton) -> list[dict[str, np.ndarray]]:
    """For each frame both ends (2, 3) of each bone of the figure, as MuJoCo places it."""
    figure = figure_of(skeleton)
    scene = compose()
    add_figure(scene, figure)
    model = compiled(scene)
    assert model.nq == len(robot_at_rest()) + figure.poses.shape[1]
    data, found = mujoco.MjData(model), []
    for pose in figure.poses:
        data.qpos[:] = np.concatenate([robot_at_rest(), pose])
        mujoco.mj_kinematics(model, data)
        ends = {}
        for name, length in figure.lengths.items():
            body = data.body(f"person_{name}")
            axis = body.xmat.reshape(3, 3)[:, 2] * length / 2.0
            ends[name] = np.stack([body.xpos - axis, body.xpos + axis])
        found.append(ends)
    return found


def capsules(skeleton: Skeleton, frame: int) -> dict[str, np.ndarray]:
    """Of one frame."""
    return all_capsules(skeleton)[frame]


def test_bones_lie_between_their_joints_at_the_robot_s_size():
    still = person(noise=0.0)
    ends = capsules(still, 2)
    upper, fore = ends["left_shoulder-left_elbow"], ends["left_elbow-left_wrist"]
    np.testing.assert_allclose(upper[1], fore[0], atol=1e-9)
    np.testing.assert_allclose(fore[1] - fore[0], (0.0, 0.0, np.linalg.norm(fore[1] - fore[0])), atol=1e-9)
    scale = np.linalg.norm(upper[1] - upper[0]) / 0.30
    for name, (start, end) in ends.items():
        if "-" in name:
            joints = name.split("-")
            wanted = scale * np.subtract(STANDING[joints[1]], STANDING[joints[0]])
            np.testing.assert_allclose(end - start, wanted, atol=1e-9, err_msg=name)
    assert 0.4 < scale * 1.75 / load_figure().height * 0.55 < 0.7


@given(st.integers(0, 1000))
@settings(max_examples=5, deadline=None)
def test_the_figure_stays_on_its_spot_with_its_feet_on_the_floor(seed):
    walking = person(seed)
    walking = replace(walking, positions=walking.positions + np.linspace((0, 0, 0), (3, 1, 0), FRAMES)[:, None])
    for ends in all_capsules(walking):
        hips = ends["left_hip-right_hip"].mean(axis=0)
        np.testing.assert_allclose(hips[:2], load_figure().place, atol=1e-9)
        assert min(end[:, 2].min() for end in ends.values()) > -0.02


def test_what_is_not_tracked_lies_under_the_floor_in_those_frames():
    somebody = person()
    positions = somebody.positions.copy()
    positions[1, somebody.joints.index("left_wrist")] = np.nan
    gap = replace(somebody, positions=positions)
    seen, lost = all_capsules(gap)[:2]
    assert seen["left_elbow-left_wrist"][:, 2].min() > 0.0
    np.testing.assert_allclose(lost["left_elbow-left_wrist"].mean(axis=0), HIDDEN, atol=1e-9)


def test_somebody_without_legs_floats_at_the_height_of_their_shoulders():
    legs = tuple(name for name in STANDING if name.endswith(("hip", "knee", "ankle")))
    ends = capsules(person(without=legs), 0)
    assert 0.6 < ends["left_shoulder-right_shoulder"][:, 2].mean() / load_figure().height < 0.95


def test_hands_alone_are_no_figure():
    hands = Skeleton(np.array([0.0]), np.zeros((1, 1, 3)), ("left_hand",))
    assert figure_of(hands) is None


@pytest.mark.parametrize("bone", ["left_elbow-left_wrist", "right_elbow-right_wrist", "head"])
def test_sides_have_colours_of_their_own(bone):
    looks = load_figure()
    wanted = {"left": looks.left, "right": looks.right}.get(bone.split("_")[0], looks.middle)
    assert looks.colour(bone) == wanted


def test_a_moment_shows_the_nearest_frame():
    figure = figure_of(person())
    np.testing.assert_array_equal(figure.at(np.array([-1.0, 0.04, 0.06, 0.29, 9.0])), figure.poses[[0, 0, 1, 3, 3]])
