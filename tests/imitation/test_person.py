from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from nao_sim.imitation.features import LEFT, RIGHT
from nao_sim.imitation.person import arm_directions, torso_frames
from nao_sim.motion import Skeleton

JOINTS = {
    "left_shoulder": (0.0, 0.18, 1.40),
    "right_shoulder": (0.0, -0.18, 1.40),
    "left_hip": (0.0, 0.10, 0.95),
    "right_hip": (0.0, -0.10, 0.95),
    "pelvis": (0.0, 0.0, 0.95),
    "spine": (0.0, 0.0, 1.10),
    "neck": (0.0, 0.0, 1.45),
}
FRAMES = 5
seeds = st.integers(0, 2**32 - 1)


def person(seed: int, without: tuple[str, ...] = ()) -> Skeleton:
    """Somebody upright who faces +x and waves their arms about."""
    rng = np.random.default_rng(seed)
    tracks = {name: np.tile(place, (FRAMES, 1)) for name, place in JOINTS.items()}
    for side in ("left", "right"):
        upper, fore = (_directions(rng, FRAMES) for _ in range(2))
        tracks[f"{side}_elbow"] = tracks[f"{side}_shoulder"] + 0.30 * upper
        tracks[f"{side}_wrist"] = tracks[f"{side}_elbow"] + 0.25 * fore
    tracks = {name: track for name, track in tracks.items() if name not in without}
    return Skeleton(np.arange(FRAMES) / 30.0, np.stack(list(tracks.values()), axis=1), tuple(tracks))


def _directions(rng: np.random.Generator, count: int) -> np.ndarray:
    vectors = rng.normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def test_the_frame_of_somebody_upright_is_the_world_s():
    np.testing.assert_allclose(torso_frames(person(0)), np.tile(np.eye(3), (FRAMES, 1, 1)), atol=1e-12)


@given(seeds)
@settings(max_examples=30)
def test_directions_are_those_from_joint_to_joint(seed):
    somebody = person(seed)
    directions = arm_directions(somebody)
    for side, name in ((LEFT, "left"), (RIGHT, "right")):
        upper = somebody.track(f"{name}_elbow") - somebody.track(f"{name}_shoulder")
        fore = somebody.track(f"{name}_wrist") - somebody.track(f"{name}_elbow")
        np.testing.assert_allclose(directions[:, side, 0], upper / 0.30, atol=1e-9)
        np.testing.assert_allclose(directions[:, side, 1], fore / 0.25, atol=1e-9)


@given(seeds)
@settings(max_examples=30)
def test_moving_turning_leaning_and_growing_change_no_direction(seed):
    somebody, rng = person(seed), np.random.default_rng(seed)
    turns = Rotation.random(FRAMES, random_state=seed).as_matrix()
    moved = np.einsum("tij,tkj->tki", turns, somebody.positions) * rng.uniform(0.3, 2.0) + rng.normal(size=3)
    np.testing.assert_allclose(arm_directions(replace(somebody, positions=moved)), arm_directions(somebody), atol=1e-9)


@given(seeds)
@settings(max_examples=30)
def test_the_mirrored_person_points_the_mirrored_way(seed):
    somebody = person(seed)
    mirrored = arm_directions(somebody)[:, ::-1] * (1.0, -1.0, 1.0)
    np.testing.assert_allclose(arm_directions(somebody.mirrored()), mirrored, atol=1e-12)


@pytest.mark.parametrize(
    "hidden",
    [("left_hip", "right_hip"), ("left_hip",), ("pelvis", "spine"), ("left_hip", "right_hip", "pelvis", "spine")],
    ids="-".join,
)
def test_hidden_legs_change_nothing_for_somebody_upright(hidden):
    np.testing.assert_allclose(arm_directions(person(1, hidden)), arm_directions(person(1)), atol=1e-9)


def test_one_hidden_shoulder_leaves_the_other_arm_known():
    directions = arm_directions(person(2, ("right_shoulder",)))
    np.testing.assert_allclose(directions[:, LEFT], arm_directions(person(2))[:, LEFT], atol=1e-2)
    assert np.isnan(directions[:, RIGHT, 0]).all()


def test_the_hand_stands_in_for_a_wrist_that_is_not_tracked():
    somebody = person(3)
    names = tuple(name.replace("wrist", "hand") for name in somebody.joints)
    np.testing.assert_array_equal(arm_directions(replace(somebody, joints=names)), arm_directions(somebody))


def test_what_is_not_tracked_has_no_direction():
    directions = arm_directions(person(4, ("left_shoulder", "right_shoulder", "left_hip", "right_hip", "neck")))
    assert np.isnan(directions).all()


def test_joints_in_one_place_have_no_direction():
    somebody = person(5)
    tracks = somebody.positions.copy()
    tracks[:, somebody.joints.index("left_elbow")] = tracks[:, somebody.joints.index("left_shoulder")]
    assert np.isnan(arm_directions(replace(somebody, positions=tracks))[:, LEFT, 0]).all()
