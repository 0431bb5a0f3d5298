"""What `benchmarks/adversary.py` found worst, played again: every law holds on the simulated robot."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from nao_sim.robot import load_robot
from nao_sim.simulation.simulator import Simulator
from tests.safety.trial import Case, play

WORST = sorted((Path(__file__).parent / "worst").glob("*.npz"))


@cache
def simulator(version: str, base: str) -> Simulator:
    """Compiled once."""
    return Simulator(load_robot(version), base)  # type: ignore[arg-type]


@pytest.mark.parametrize("path", WORST, ids=lambda path: path.stem)
def test_the_worst_that_was_found_breaks_no_law(path):
    case = Case.load(path)
    trial = play(case.requests, simulator(case.version, case.base))
    assert trial.broken == {}
    assert trial.warnings == 0


@pytest.mark.parametrize(("period", "pattern"), [(0.3, 0), (0.4, 0), (0.6, 2), (0.8, 6)])
def test_joints_thrown_from_end_to_end_in_step_do_not_rock_it_over(period, pattern):
    robot, random = load_robot(), np.random.default_rng(pattern)
    sign = np.sign(random.normal(size=26)) if pattern else np.ones(26)
    middle, half = (robot.lower + robot.upper) / 2.0, (robot.upper - robot.lower) / 2.0
    there = np.arange(0.0, 3.6, 0.02) // period % 2.0 > 0.0
    trial = play(middle + np.where(there, 1.0, -1.0)[:, None] * sign * half, simulator("v5", "free"))
    assert trial.broken == {}


def test_there_are_worst_cases():
    assert len(WORST) >= 7


def test_a_law_is_seen_to_be_broken():
    """The laws are no dead letter: without a guard the arm hits the face, beyond its limits, too fast."""
    robot = load_robot()
    request = robot.postures["StandInit"].copy()
    request[robot.limbs["LArm"]] = [-0.9, -0.3, -0.3, -1.2, 0.0, 0.0]
    request[robot.index["HeadPitch"]] = 1.0
    trial = play(np.tile(request, (30, 1)), simulator("v5", "free"), lambda asked, dt: (asked, ()))
    assert {"limit", "command", "touch", "distance"} <= set(trial.broken)
