"""Rendering only what can change gives the same picture as rendering all of it."""

import subprocess
import sys
import textwrap

import mujoco

from nao_sim.rendering.backend import gl_environment

_COMPARE = """
    import os, sys, mujoco, numpy as np
    from nao_sim.rendering.painter import Painter
    from nao_sim.rendering.presets import load_camera, load_quality, load_shadow
    size, poses = (160, 120), np.random.default_rng(1).uniform(-0.1, 0.5, (6, 2))
    def pictures(whole, camera):
        model = mujoco.MjModel.from_binary_path(sys.argv[1])
        painter = Painter(model, size, load_camera(camera), load_quality("standard"), load_shadow(), whole)
        out = np.zeros((len(poses), size[1], size[0], 3), np.uint8)
        for pose, picture in zip(poses, out):
            painter.paint(pose, picture)
        assert whole or painter._movers is not None
        return out.astype(int)
    for camera in ("front", "three-quarter", "side", "top"):
        difference = np.abs(pictures(True, camera) - pictures(False, camera)).max(axis=-1)
        print(camera, (difference > 3).mean(), flush=True)
        assert (difference > 3).mean() < 1e-3
    os._exit(0)
"""


def test_a_part_and_the_whole_are_the_same(model, backend, tmp_path):
    mujoco.mj_saveModel(model, str(tmp_path / "model.mjb"), None)
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(_COMPARE), str(tmp_path / "model.mjb")],
        env=gl_environment(backend.name),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
