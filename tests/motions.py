"""Hypothesis strategies for what a user might ask of the robot."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from nao_sim.motion import JointTrajectory
from nao_sim.robot import load_robot

RATE = 50.0


@st.composite
def wild_motions(draw: st.DrawFn, seconds: float = 3.0) -> JointTrajectory:
    """Anything: jumps or sweeps, far beyond limits, any subset of joints, gaps, at any rate."""
    robot = load_robot()
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    rate = draw(st.sampled_from([5.0, 20.0, 50.0, 120.0]))
    reach = draw(st.sampled_from([0.3, 1.0, 1.6]))
    times = np.arange(0.0, seconds, 1.0 / rate)
    middle, half = (robot.lower + robot.upper) / 2, (robot.upper - robot.lower) / 2 * reach
    kind = draw(st.sampled_from(["jumps", "sweeps", "all together", "ends"]))
    if kind == "sweeps":
        frequency, phase = random.uniform(0.2, 4.0, 26), random.uniform(0.0, 2 * np.pi, 26)
        share = np.sin(2 * np.pi * frequency * times[:, None] + phase)
    elif kind == "all together":
        share = np.repeat(np.sign(np.sin(2 * np.pi * random.uniform(0.3, 4.0) * times))[:, None], 26, axis=1)
    else:
        knots = random.uniform(-1.0, 1.0, (1 + int(seconds * draw(st.sampled_from([1.0, 4.0, 20.0]))), 26))
        knots = np.sign(knots) if kind == "ends" else knots
        share = knots[np.minimum((times / seconds * len(knots)).astype(int), len(knots) - 1)]
    positions = middle + half * share
    positions[random.random(positions.shape) < draw(st.sampled_from([0.0, 0.05]))] = np.nan
    given = random.random(26) < draw(st.sampled_from([0.5, 1.0]))
    given[random.integers(26)] = True
    return JointTrajectory(times, np.where(given, positions, np.nan), given)


@st.composite
def poses(draw: st.DrawFn) -> np.ndarray:
    """A pose (26,) anywhere within the documented limits."""
    robot = load_robot()
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    return random.uniform(robot.lower, robot.upper)


@st.composite
def trajectories(draw: st.DrawFn, *, gaps: bool = True, first: float = 0.0) -> JointTrajectory:
    """A few frames of any angles and openings (0..1) from `first` (s) on, of any joints, perhaps with gaps."""
    robot = load_robot()
    joints = np.array(draw(st.lists(st.integers(0, 25), min_size=1, max_size=6, unique=True)))
    frames = draw(st.integers(1, 6))
    angle, opening = st.floats(-7.0, 7.0), st.floats(0.0, 1.0)
    gap = st.sampled_from([np.nan, np.inf, -np.inf])
    positions = np.full((frames, 26), np.nan)
    for joint in joints:
        value = opening if robot.is_hand[joint] else angle
        column = st.lists(value | gap if gaps else value, min_size=frames, max_size=frames)
        positions[:, joint] = draw(column)
    steps = draw(st.lists(st.floats(2e-3, 10.0), min_size=frames, max_size=frames))
    start = first + draw(st.floats(0.0, 5.0))
    return JointTrajectory(start + np.cumsum(steps) - steps[0], positions, np.isin(np.arange(26), joints))
