"""The floor between both soles, and the pose seen from it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings

from nao_sim.safety.floor import Floor
from nao_sim.safety.posed import PosedRobot
from tests.safety.standing_robots import ROBOT, putter, slopes, standing

POSED = PosedRobot()
FLOOR = Floor(POSED)
LINKS = np.array([POSED.model.body(name).id for name in ("l_wrist", "Head", "RTibia")])
put = putter(POSED, FLOOR.update)


def links():
    return POSED.data.xipos[LINKS]


@given(standing())
def test_soles_lie_on_it(pose):
    put(pose)
    assert FLOOR.corners()[:, 2] == pytest.approx(0.0, abs=1e-9)
    assert FLOOR.corners().mean(axis=0) == pytest.approx(0.0, abs=1e-9)
    assert FLOOR.turn.T @ FLOOR.turn == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(FLOOR.turn) == pytest.approx(1.0)


@given(standing())
def test_the_mirrored_pose_is_seen_mirrored(pose):
    put(pose)
    corners, placement = FLOOR.corners(), FLOOR.placement()
    put(ROBOT.mirror(pose))
    twins = FLOOR.corners()[[7, 6, 5, 4, 3, 2, 1, 0]]  # of the other sole, the other way round
    assert twins == pytest.approx(corners * [1.0, -1.0, 1.0], abs=1e-4)
    # the way from right to left, mirrored, is the way from left to right; turns change their sense
    assert FLOOR.placement() == pytest.approx(placement * [-1, 1, -1, 1, -1, 1], abs=1e-4)


@settings(max_examples=6)
@given(standing())
def test_what_moves_has_the_slopes_of_finite_differences(pose):
    put(pose)
    assert FLOOR.centre_moves() == pytest.approx(slopes(lambda: FLOOR.centre, pose, put), abs=1e-6)
    assert FLOOR.moves(LINKS, links()) == pytest.approx(slopes(lambda: FLOOR.seen(links()), pose, put), abs=1e-6)
    assert FLOOR.placement_moves() == pytest.approx(slopes(FLOOR.placement, pose, put), abs=1e-6)


@given(standing(), standing())
def test_arms_do_not_move_it(pose, other):
    arms = ROBOT.joints_of("Head", "LArm", "RArm")
    put(pose)
    turn, origin = FLOOR.turn.copy(), FLOOR.origin.copy()
    put(np.where(arms, other, pose))
    followed = FLOOR.centre
    put(other)  # whose legs are elsewhere
    put(np.where(arms, other, pose))
    assert (FLOOR.turn == turn).all() and (FLOOR.origin == origin).all() and (FLOOR.centre == followed).all()
