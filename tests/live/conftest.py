"""What the robots of these tests share, compiled once."""

from __future__ import annotations

import pytest

from nao_sim.live.moment import World
from nao_sim.live.worker import Orders, world_of


@pytest.fixture(scope="session")
def world() -> World:
    """NAO V5 with the built-in gestures."""
    return world_of(Orders())
