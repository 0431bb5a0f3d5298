"""Soles, hulls and the pose seen from a sole."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.robot import load_robot
from nao_sim.safety.posed import PosedRobot
from nao_sim.safety.support import SOLES, Ground, hull, inside, sole_corners
from tests.motions import poses

ROBOT, POSED = load_robot(), PosedRobot()
GROUNDS = Ground(POSED, 0), Ground(POSED, 1)
STEP = 1e-6
places = st.tuples(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2))


def put(pose):
    POSED.put(POSED.map.to_qpos(pose))
    mujoco.mj_comPos(POSED.model, POSED.data)


def slopes(value, pose):
    """Central differences of a value by each joint, last axis."""
    columns = []
    for joint in range(len(pose)):
        ends = []
        for step in (STEP, -STEP):
            moved = pose.copy()
            moved[joint] += step
            put(moved)
            ends.append(np.array(value()))
        columns.append((ends[0] - ends[1]) / (2.0 * STEP))
    put(pose)
    return np.stack(columns, axis=-1)


@given(st.lists(places, min_size=3, max_size=9))
def test_every_point_is_inside_every_edge_of_the_hull(points):
    area = np.linalg.matrix_rank(np.array(points) - points[0], tol=1e-3)
    if area < 2:
        return
    edges = hull(points)
    assert [end for _, end in edges] == [start for start, _ in edges[1:] + edges[:1]]
    for start, end in edges:
        if np.hypot(*np.subtract(points[start], points[end])) > 1e-4:
            assert all(inside(point, points[start], points[end]) > -1e-6 for point in points)


@pytest.mark.parametrize("ground", GROUNDS)
@settings(max_examples=5)
@given(pose=poses())
def test_derivatives_are_those_of_finite_differences(ground, pose):
    put(pose)
    shape = int(np.argmax(ground.heights()))
    assert ground.centre_moves() == pytest.approx(slopes(ground.centre, pose), abs=1e-7)
    assert ground.corner_moves(2) == pytest.approx(slopes(lambda: ground.other_corners()[2], pose), abs=1e-7)
    assert ground.height_moves(shape) == pytest.approx(slopes(lambda: ground.heights()[shape], pose), abs=1e-7)
    levers = np.array([ground.lever_moves(row) for row in range(6)])
    assert levers == pytest.approx(slopes(ground.levers, pose), abs=1e-7)


@pytest.mark.parametrize("ground", GROUNDS)
@given(pose=poses())
def test_a_lever_is_how_the_centre_of_mass_rises_with_its_joint(ground, pose):
    put(pose)
    assert ground.levers() == pytest.approx(ground.centre_moves()[2, ground.joints], abs=1e-9)


@pytest.mark.parametrize(("side", "ground"), [*enumerate(GROUNDS)])
@given(pose=poses())
def test_the_floor_is_the_sole(side, ground, pose):
    put(pose)
    own = ground.seen(sole_corners(POSED.model, POSED.data, SOLES[side]))
    other = ground.seen(sole_corners(POSED.model, POSED.data, SOLES[1 - side]))
    assert own == pytest.approx(ground.corners, abs=1e-9)
    assert own[:, 2] == pytest.approx(0.0, abs=1e-9)
    assert other == pytest.approx(ground.other_corners(), abs=1e-9)


def test_two_soles_share_the_weight(robot):
    put(robot.postures["StandInit"])
    shares = [ground.share() for ground in GROUNDS]
    assert sum(shares) == pytest.approx(1.0, abs=1e-3)
    assert shares[0] == pytest.approx(0.5, abs=0.01)
