"""Timed ways through poses."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.robot import load_robot
from nao_sim.safety.route import SAMPLING, Route, coarse_first, looks, places, short_cut

DT = 0.02
ROBOT = load_robot()
TOP, ACCELERATION = 0.8 * ROBOT.max_speed, 0.8 * ROBOT.max_acceleration


@st.composite
def paths(draw: st.DrawFn) -> np.ndarray:
    """A few poses, any of them perhaps the same as the one before or a hair beside it."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    moves = random.uniform(-1.0, 1.0, (draw(st.integers(1, 6)), 26)) * (random.random(26) < 0.4)
    sizes = draw(st.lists(st.sampled_from([0.0, 1e-9, 0.02, 0.3, 2.0]), min_size=len(moves), max_size=len(moves)))
    return ROBOT.postures["StandInit"] + np.cumsum(moves * np.array(sizes)[:, None], axis=0)


def _distance(pose, path):
    """How far a pose is from the nearest piece of a path."""
    gaps = [np.abs(path - pose).max(axis=1).min()]
    for before, after in pairwise(path):
        move = after - before
        share = np.clip((pose - before) @ move / max(move @ move, 1e-30), 0.0, 1.0)
        gaps.append(np.abs(before + share * move - pose).max())
    return min(gaps)


@given(paths())
def test_a_route_is_on_its_path_from_end_to_end(path):
    route = Route(path, TOP, ACCELERATION)
    assert (route.at(-1.0) == path[0]).all()
    assert (route.at(route.duration) == path[-1]).all()
    assert (route.at(route.duration + 9.0) == path[-1]).all()
    assert max(_distance(route.at(t), path) for t in np.linspace(0.0, route.duration, 50)) < 1e-9


@given(paths(), st.floats(0.0, DT))
def test_no_joint_is_faster_or_speeds_up_more_than_it_may(path, offset):
    route = Route(path, TOP, ACCELERATION)
    times = np.arange(-3 * DT, route.duration + 3 * DT, DT) + offset
    speeds = np.diff([route.at(t) for t in times], axis=0) / DT
    assert (np.abs(speeds) <= TOP * (1 + 1e-9) + 1e-9).all()
    assert (np.abs(np.diff(speeds, axis=0)) / DT <= ACCELERATION * (1 + 1e-9) + 1e-6).all()


@given(st.integers(0, 25), st.floats(1e-3, 3.0))
def test_one_joint_alone_takes_the_shortest_time_there_is(joint, way):
    path = np.zeros((2, 26))
    path[1, joint] = way
    top, acceleration = TOP[joint], ACCELERATION[joint]
    shortest = way / top + top / acceleration if way > top**2 / acceleration else 2.0 * np.sqrt(way / acceleration)
    assert Route(path, TOP, ACCELERATION).duration == pytest.approx(shortest, rel=1e-9)


@given(paths())
def test_it_stands_at_every_corner(path):
    route, time = Route(path, TOP, ACCELERATION), 0.0
    for before, after in pairwise(path):
        time += Route(np.array([before, after]), TOP, ACCELERATION).duration
        assert route.at(time) == pytest.approx(after, abs=1e-7)
        assert np.abs(route.at(time + 1e-5) - route.at(time - 1e-5)).max() < ACCELERATION.max() * 1e-9


@given(paths())
def test_between_two_looks_no_joint_moves_farther_than_the_sampling(path):
    for before, after in pairwise(path):
        poses = np.concatenate([before[None], looks(before, after)])
        assert np.abs(np.diff(poses, axis=0)).max() <= SAMPLING + 1e-12
        assert (poses[-1] == after).all()
        assert sorted(map(tuple, coarse_first(poses))) == sorted(map(tuple, poses))


@given(paths(), st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0)), st.booleans())
def test_a_short_cut_begins_and_ends_on_the_path_and_keeps_the_rest(path, shares, at_corners):
    ends = np.sort(places(path, np.array(shares)))
    before, cut, after = short_cut(path, *(np.round(ends) if at_corners else ends))
    assert max(_distance(pose, path) for pose in cut) < 1e-9
    shorter = np.concatenate([before, cut, after])
    assert (shorter[0] == path[0]).all()
    assert (shorter[-1] == path[-1]).all()
    length = np.abs(np.diff(path, axis=0)).max(axis=1).sum()
    assert np.abs(np.diff(shorter, axis=0)).max(axis=1).sum() <= length + 1e-9
    kept = {pose.tobytes() for pose in path}
    assert {pose.tobytes() for pose in [*before, *after]} <= kept
