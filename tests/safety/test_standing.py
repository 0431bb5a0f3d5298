"""Balance along ways."""

from __future__ import annotations

import numpy as np
from hypothesis import given

from nao_sim.robot import LEGS
from nao_sim.safety.balance import Balance
from nao_sim.safety.posed import PosedRobot
from nao_sim.safety.standing import Standing
from tests.safety.standing_robots import ROBOT, STAND, bent, standing

DT = 0.02
SQUAT = bent(STAND, -0.4, 0.8, 0.1)


def on_its_feet():
    posed = PosedRobot()
    posed.put(posed.map.to_qpos(STAND))
    return Standing(Balance(ROBOT, posed), posed, ROBOT.joints_of(*LEGS), STAND)


@given(standing())
def test_what_was_looked_at_before_changes_no_answer(pose):
    """Ways of the arms over legs that stand are told alike, after a look at legs that move."""
    arms = np.where(ROBOT.joints_of(*LEGS), STAND, STAND + 0.02 * (pose - STAND))
    fresh, used = on_its_feet(), on_its_feet()
    used.kept(np.array([STAND, SQUAT]), DT, 0.0)
    line = np.array([STAND, arms])
    for rounding in (0.0, 0.01, 0.02, 0.03, 0.04):  # m
        assert fresh.kept(line, DT, rounding) == used.kept(line, DT, rounding)
    for one in (fresh, used):
        one.findings(np.array([STAND, SQUAT]), np.ones((2, 26)), DT) if one is used else None
        one.moved(arms, DT)
    np.testing.assert_array_equal(fresh._now.places, used._now.places)
