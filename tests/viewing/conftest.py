"""A short performance of a person's recording, and the stage it is shown on."""

from __future__ import annotations

import pytest

from nao_sim.paths import TRAJECTORIES
from nao_sim.performed import Performed, perform_recording
from nao_sim.recordings import Source
from nao_sim.replay import Orders
from nao_sim.viewing.stage import Stage, stage_of

FRAMES = 75


@pytest.fixture(scope="session")
def recording(tmp_path_factory):
    """The first seconds of a person who raises an arm."""
    path = tmp_path_factory.mktemp("viewing") / "raises <b> & waves.csv"
    lines = (TRAJECTORIES / "person_wave.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    path.write_text("".join(lines[:FRAMES]), encoding="utf-8")
    return path


@pytest.fixture(scope="session")
def performed(recording) -> Performed:
    return perform_recording(Orders(Source(recording)), lambda stage, done, total: None)


@pytest.fixture(scope="session")
def stage(performed) -> Stage:
    """Leave its colours as they were."""
    return stage_of(performed, "studio", "orange")
