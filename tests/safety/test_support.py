"""What soles span on the floor."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from nao_sim.safety.posed import PosedRobot
from nao_sim.safety.support import SOLES, Support, hull, sole_corners

places = st.tuples(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2))
corners = st.lists(places, min_size=3, max_size=9)


@given(corners)
def test_the_edges_of_a_hull_go_round(points):
    assume(np.linalg.matrix_rank(np.array(points) - points[0], tol=1e-3) == 2)
    edges = hull(points)
    assert [end for _, end in edges] == [start for start, _ in edges[1:] + edges[:1]]


@given(corners, st.lists(st.floats(0.0, 1.0), min_size=9, max_size=9))
def test_what_is_between_corners_is_inside_and_corners_are_on_the_edge(points, weights):
    points = np.round(points, 4)  # corners that are all but the same have no direction between them
    assume(np.linalg.matrix_rank(points - points[0], tol=1e-3) == 2)
    share = np.array(weights[: len(points)]) + 1e-3
    support = Support.of(points)
    assert np.linalg.norm(support.normals, axis=1) == pytest.approx(1.0)
    assert support.inside(points).min() > -1e-9
    assert support.inside(points).min(axis=0) == pytest.approx(0.0, abs=1e-9)  # each edge has its corners
    assert support.inside(share @ points / share.sum()).min() > -1e-9
    assert support.inside(points.mean(axis=0) + np.array([1.0, 0.0])).min() < 0.0


def test_soles_lie_side_by_side_under_the_robot(robot):
    posed = PosedRobot()
    posed.put(posed.map.to_qpos(robot.postures["StandZero"]))
    left, right = (sole_corners(posed.model, posed.data, sole) for sole in SOLES)
    assert np.ptp([*left[:, 2], *right[:, 2]]) < 1e-6
    assert left[:, 1].min() > right[:, 1].max() > -0.1
    assert left[:, 0] == pytest.approx(right[[3, 2, 1, 0], 0], abs=1e-3)
