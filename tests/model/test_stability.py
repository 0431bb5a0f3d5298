"""Thrown about by full-range commands the simulation stays sound, in every version, free and pinned."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from .conftest import Scene, Start

VERSIONS = ("v4", "v5", "v6")
BASES = ("free", "pinned")


@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("version", VERSIONS)
def test_every_version_compiles_free_and_pinned(scene: Scene, version: str, base: str) -> None:
    model = scene(version, base)
    assert (model.nq, model.nv, model.nu) == ((49, 48, 25) if base == "free" else (42, 42, 25))


@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("version", ["v5", "v6"])
def test_ten_seconds_of_full_range_commands_raise_no_warning(
    scene: Scene, started: Start, version: str, base: str
) -> None:
    model, random = scene(version, base), np.random.default_rng(0)
    data = started(model, "StandInit")
    for _ in range(100):
        data.ctrl[:] = random.uniform(*model.actuator_ctrlrange.T)
        for _ in range(round(0.1 / model.opt.timestep)):
            mujoco.mj_step(model, data)
        assert np.isfinite(data.qpos).all()
        assert np.isfinite(data.qvel).all()
    assert data.time == pytest.approx(10.0)
    assert data.warning.number.sum() == 0


@pytest.mark.parametrize("version", VERSIONS)
def test_a_free_robot_falls_no_faster_than_gravity_and_not_through_the_floor(
    scene: Scene, started: Start, version: str
) -> None:
    model = scene(version)
    data = started(model, "Stand")
    data.qpos[2] += 0.1
    heights = [data.qpos[2]]
    while data.time < 2.0:
        mujoco.mj_step(model, data)
        heights.append(data.qpos[2])
    fallen = heights[0] - np.array(heights)
    times = model.opt.timestep * np.arange(len(heights))
    assert (fallen <= 9.81 / 2 * times**2 + 9.81 * model.opt.timestep * times + 1e-6).all()
    assert data.qpos[2] > 0.04


def test_a_pinned_robot_hangs_clear_of_the_floor(scene: Scene, started: Start) -> None:
    model = scene("v5", "pinned")
    for posture in ("StandZero", "StandInit"):
        data = started(model, posture)
        mujoco.mj_forward(model, data)
        assert data.ncon == 0
