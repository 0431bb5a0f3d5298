"""The posed robot's slopes."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.safety.posed import PosedRobot
from tests.motions import poses

POSED = PosedRobot()
BODIES = st.integers(1, POSED.model.nbody - 1)
STEP = 1e-6
TORSO = POSED.model.body("torso").id


def _put(pose):
    POSED.put(POSED.map.to_qpos(pose))


def _place(body, fixed):
    """Where (3,) a point given in a body's frame is."""
    return POSED.data.xpos[body] + POSED.data.xmat[body].reshape(3, 3) @ fixed


def _points(seed):
    """A point in a body's frame and a direction, (3,) each."""
    random = np.random.default_rng(seed)
    return random.uniform(-0.1, 0.1, 3), random.normal(size=3)


def _slopes(pose, place):
    """Finite differences (26,) of what `place` tells, by each joint."""
    slopes = np.empty(26)
    for joint, move in enumerate(STEP * np.eye(26)):
        _put(pose + move)
        after = place()
        _put(pose - move)
        slopes[joint] = (after - place()) / (2.0 * STEP)
    _put(pose)
    return slopes


@settings(max_examples=40)
@given(poses(), BODIES, st.integers(0, 2**32 - 1))
def test_a_point_of_a_body_parts_from_the_torso_as_it_moves(pose, body, seed):
    fixed, direction = _points(seed)
    slopes = _slopes(pose, lambda: direction @ _place(body, fixed))
    found = POSED.parting(TORSO, body, _place(body, fixed), direction)
    np.testing.assert_allclose(found, slopes, rtol=0.0, atol=1e-8)


@settings(max_examples=40)
@given(poses(), BODIES, BODIES, st.integers(0, 2**32 - 1))
def test_the_parting_is_how_a_point_of_one_body_leaves_the_same_point_of_another(pose, first, second, seed):
    fixed, direction = _points(seed)
    _put(pose)
    point = _place(first, fixed)
    on_second = POSED.data.xmat[second].reshape(3, 3).T @ (point - POSED.data.xpos[second])
    slopes = _slopes(pose, lambda: direction @ (_place(second, on_second) - _place(first, fixed)))
    found = POSED.parting(first, second, point, direction)
    np.testing.assert_allclose(found, slopes, rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(POSED.parting(second, first, point, direction), -found, rtol=0.0, atol=1e-12)


@settings(max_examples=20)
@given(poses(), poses())
def test_whatever_the_pose_the_torso_is_held_looking_along_x_and_upright(pose, another):
    torso = POSED.model.body("torso").id
    _put(pose)
    place = POSED.data.xpos[torso].copy()
    _put(another)
    assert np.array_equal(POSED.data.xpos[torso], place)
    np.testing.assert_allclose(POSED.data.xmat[torso].reshape(3, 3), np.eye(3), rtol=0.0, atol=1e-12)
