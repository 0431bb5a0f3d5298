"""What the legs' motors bear."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings

from nao_sim.safety.bearing import STRENGTH, Bearing
from nao_sim.safety.floor import Floor
from nao_sim.safety.posed import PosedRobot
from tests.safety.standing_robots import ROBOT, STAND, bent, putter, slopes, standing

POSED = PosedRobot()
FLOOR = Floor(POSED)
BEARING = Bearing(ROBOT, POSED, FLOOR)
put = putter(POSED, FLOOR.update)
KNEE = list(STRENGTH).index("KneePitch")


@given(standing())
def test_a_lever_is_how_the_centre_of_mass_rises_with_its_joint(pose):
    put(pose)
    joints = [ROBOT.index[side + name] for side in "LR" for name in STRENGTH]
    rises = [FLOOR.centre_moves_on(i // len(STRENGTH))[2, joint] for i, joint in enumerate(joints)]
    assert BEARING.levers() == pytest.approx(np.array(rises), abs=1e-9)


@settings(max_examples=6)
@given(standing())
def test_what_is_left_has_the_slopes_of_finite_differences(pose):
    put(pose)
    found = BEARING.gradients(np.arange(len(BEARING.margins())))
    assert found == pytest.approx(slopes(BEARING.margins, pose, put), abs=1e-5)


def test_knees_bear_more_the_deeper_they_bend():
    left = []
    for depth in (0.2, 0.4, 0.6):  # on straight legs they bear it the other way
        put(bent(STAND, -depth, 2.0 * depth, 0.0))
        left.append(BEARING.margins()[[KNEE, KNEE + len(STRENGTH)]])
    assert (np.diff(left, axis=0) < 0.0).all(), left


def test_the_leg_toward_which_it_sways_bears_more():
    put(bent(STAND, -0.3, 0.6, -0.2))
    toward_left = BEARING.margins()
    put(bent(STAND, -0.3, 0.6, 0.2))
    assert toward_left[KNEE] < BEARING.margins()[KNEE] - 0.005
