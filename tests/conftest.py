"""Shared by all tests: the robot, compiled once, and how hypothesis searches."""

from __future__ import annotations

import os
from collections.abc import Callable

import pytest
from hypothesis import HealthCheck, settings

from nao_sim.robot import Robot, load_robot

settings.register_profile(
    "checks",
    max_examples=50,
    deadline=None,  # shared machines are noisy; no test depends on the clock
    derandomize=bool(os.environ.get("CI")),
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)
settings.load_profile("checks")


@pytest.fixture(scope="session")
def robot() -> Robot:
    """NAO V5."""
    return load_robot()


@pytest.fixture(scope="session")
def simulator() -> Callable[[str], object]:
    """A simulator by base, compiled once and reset each time it is asked for."""
    from nao_sim.simulation.simulator import Simulator

    made: dict[str, Simulator] = {}

    def get(base: str) -> Simulator:
        if base not in made:
            made[base] = Simulator(base=base)  # type: ignore[arg-type]
        made[base].reset()
        return made[base]

    return get
