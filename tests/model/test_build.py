"""The files of the model are what its scripts write from its tables."""

from __future__ import annotations

import importlib.util
import subprocess
import sys

import mujoco
import pytest
from dm_control import mjcf

from nao_sim.paths import MODEL

SCRIPTS = MODEL / "scripts"
pytestmark = pytest.mark.skipif(not SCRIPTS.is_dir(), reason="an installed wheel carries the model, not what made it")
DRAWING = ("skimage", "fast_simplification", "trimesh")


def run(script: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(SCRIPTS / script), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_no_file_differs_from_what_its_tables_say() -> None:
    done = run("build.py", "--check")
    assert (done.returncode, done.stdout.strip()) == (0, "0 files differ"), done.stderr


@pytest.mark.skipif(
    missing := [name for name in DRAWING if importlib.util.find_spec(name) is None],
    reason=f"the extra 'model' is not installed: {', '.join(missing)}",
)
def test_no_shell_differs_from_its_drawing() -> None:
    done = run("make_shells.py", "--check")
    assert done.returncode == 0, done.stderr


def test_dm_control_and_mujoco_read_the_same_model() -> None:
    direct = mujoco.MjModel.from_xml_path(str(MODEL / "scene.xml"))
    parsed = mjcf.Physics.from_mjcf_model(mjcf.from_path(str(MODEL / "scene.xml"))).model.ptr
    for size in ("nq", "nv", "nu", "nbody", "ngeom", "nsite", "ncam", "nsensor", "neq", "nexclude", "nkey", "nmesh"):
        assert getattr(direct, size) == getattr(parsed, size), size
    for numbers in ("body_mass", "body_inertia", "body_pos", "body_quat", "jnt_axis", "jnt_range", "dof_armature",
                    "actuator_gainprm", "actuator_biasprm", "actuator_forcerange", "geom_pos", "geom_size",
                    "geom_contype", "geom_conaffinity", "site_pos", "cam_quat", "key_qpos", "key_ctrl"):  # fmt: skip
        assert getattr(direct, numbers) == pytest.approx(getattr(parsed, numbers), abs=1e-8), numbers


def test_nothing_is_named_with_a_slash() -> None:
    model = mujoco.MjModel.from_xml_path(str(MODEL / "scene.xml"))
    assert b"/" not in model.names
