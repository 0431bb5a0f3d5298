"""The stepper: with or without notes, alone or beside others, the same physics."""

from __future__ import annotations

import numpy as np

from nao_sim.simulation.simulator import Simulator


def test_advancing_without_notes_is_stepping_and_robots_that_share_a_model_do_not_meet():
    noted = Simulator()
    plain, beside = (Simulator(model=noted.model) for _ in range(2))
    command = np.array(noted.robot.postures["StandInit"])
    for step in range(10):
        command[2] -= 0.02
        state, positions = noted.step(command), plain.advance(command)
        np.testing.assert_array_equal(positions, state.positions, err_msg=f"step {step}")
        np.testing.assert_array_equal(plain.base_pose(), state.base_pose)
    assert beside.data.time == 0.0
