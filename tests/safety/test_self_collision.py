"""Self-collision at poses."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from nao_sim.robot import load_robot
from nao_sim.safety.posed import PosedRobot, hand_of_finger
from nao_sim.safety.self_collision import CLEARANCE, WIDEST, SelfCollisionRule, clearance
from tests.motions import poses
from tests.safety.shape_pairs import shape_pairs

ROBOT = load_robot()
WITHIN = 0.012
POSED = PosedRobot(WIDEST + WITHIN)
RULE = SelfCollisionRule(POSED)
PAIRS = list(shape_pairs(POSED.model))


def _near(pose, within=WITHIN, **more):
    POSED.put(POSED.map.to_qpos(pose))
    return RULE.near(within, **more)


def _smallest(found):
    """The smallest value of each pair of links."""
    smallest = {}
    for value, links, _ in found:
        smallest[links] = min(value, smallest.get(links, np.inf))
    return smallest


def _asked_one_by_one(pose):
    """Each pair of shapes that may touch, asked for its distance."""
    POSED.put(POSED.map.to_qpos(pose))
    smallest = {}
    for first, second in PAIRS:
        bodies = POSED.model.geom_bodyid[[first, second]]
        links = tuple(sorted(hand_of_finger(POSED.model.body(body).name) for body in bodies))
        distance = mujoco.mj_geomDistance(POSED.model, POSED.data, first, second, 0.05, None)
        value = distance - clearance(links)
        smallest[links] = min(value, smallest.get(links, np.inf))
    return smallest


@settings(max_examples=40)
@given(poses(), st.sampled_from([0.0, 0.0005, WITHIN]))
def test_near_pairs_are_those_that_asking_each_pair_of_shapes_finds(pose, within):
    near, asked = _smallest(_near(pose, within)), _asked_one_by_one(pose)
    assert near.keys() <= asked.keys()
    for links, value in asked.items():
        if abs(value - within) > 1e-6:
            assert (links in near) == (value < within), links
        if links in near:
            assert near[links] == pytest.approx(value, abs=1e-6), links


def _distance(pose, shapes):
    POSED.put(POSED.map.to_qpos(pose))
    return mujoco.mj_geomDistance(POSED.model, POSED.data, *shapes, 0.1, None)


def _slopes(pose, shapes, step):
    """Differences (26,) of two shapes' distance, forward and backward."""
    here = _distance(pose, shapes)
    moved = (_distance(pose + move, shapes) for move in np.concatenate([step * np.eye(26), -step * np.eye(26)]))
    forward, backward = (np.array(list(moved)).reshape(2, 26) - here) / step
    return forward, -backward


def _check_gradients(pose, only=""):
    """The gradient of each pair of shapes that is near; how many were compared."""
    compared = 0
    found = _near(pose)
    geoms = POSED.data.contact.geom.copy()
    margins = [RULE.margin(*near) for near in found]
    for margin, (value, links, i) in zip(margins, found, strict=True):
        shapes = geoms[i]
        assert (margin.value, margin.links) == (value, links)
        names = [POSED.model.body(body).name for body in POSED.model.geom_bodyid[shapes]]
        if value < -CLEARANCE or not any(only in name for name in names):
            continue
        forward, backward = _slopes(pose, shapes, 1e-5)
        if np.abs(forward - backward).max() > 1e-3:  # parallel capsules, whose nearest points are about to jump
            continue
        np.testing.assert_allclose(margin.gradient, (forward + backward) / 2.0, rtol=0.0, atol=1e-4, err_msg=links)
        compared += 1
    return compared


@settings(max_examples=20)
@given(poses())
def test_gradients_are_the_finite_differences_of_the_distances(pose):
    assume(_check_gradients(pose))


def test_a_hands_opening_counts_in_the_gradient():
    assert sum(_check_gradients(pose, "Finger") for pose in _hands_near_things()) >= 5


def _hands_near_things():
    pose, random = ROBOT.postures["Crouch"].copy(), np.random.default_rng(0)
    for _ in range(30):
        pose[ROBOT.limbs["LArm"]] = random.uniform(ROBOT.lower, ROBOT.upper)[ROBOT.limbs["LArm"]]
        yield pose


def _mirrored(link):
    return {"L": "R", "R": "L", "l": "r", "r": "l"}.get(link[0], link[0]) + link[1:]


@settings(max_examples=40)
@given(poses())
def test_the_mirrored_pose_has_the_mirrored_pairs(pose):
    plain, mirrored = _smallest(_near(pose)), _smallest(_near(ROBOT.mirror(pose)))
    turned = {tuple(sorted(map(_mirrored, links))): value for links, value in plain.items()}
    for links in turned.keys() | mirrored.keys():
        assert mirrored.get(links, WITHIN) == pytest.approx(turned.get(links, WITHIN), abs=2e-6), links


@settings(max_examples=40)
@given(poses(), st.data())
def test_a_pair_may_be_allowed_to_be_nearer_and_no_other_is(pose, data):
    near = _smallest(_near(pose))
    assume(near)
    pair, smaller = data.draw(st.sampled_from(sorted(near))), data.draw(st.floats(-0.02, CLEARANCE))
    allowed = _smallest(_near(pose, allowed={pair: smaller}))
    expected = near | {pair: near[pair] + clearance(pair) - smaller}
    assert allowed == pytest.approx({links: value for links, value in expected.items() if value < WITHIN}, abs=1e-12)
