"""A small model and the machine's back end."""

import mujoco
import numpy as np
import pytest

from nao_sim.errors import RenderingError
from nao_sim.rendering import Backend, choose_backend

SIZE = (160, 120)

XML = """<mujoco>
  <statistic center="0 0 0.3" extent="0.6"/>
  <asset>
    <texture name="sky" type="skybox" builtin="gradient" rgb1="1 1 1" rgb2="0.6 0.7 0.9" width="64" height="384"/>
    <texture name="floor" type="2d" builtin="checker" rgb1="0.8 0.8 0.8" rgb2="0.5 0.5 0.5" width="64" height="64"/>
    <material name="floor" texture="floor" texuniform="true" texrepeat="4 4" reflectance="0.2"/>
  </asset>
  <worldbody>
    <light type="directional" pos="1 1 2" dir="-0.4 -0.4 -0.8"/>
    <geom name="floor" type="plane" size="0 0 0.05" material="floor"/>
    <body pos="0 0 0.35">
      <joint name="lift" type="slide" axis="0 0 1"/>
      <geom type="capsule" size="0.06 0.2" rgba="0.9 0.3 0.1 1"/>
      <body pos="0 0.1 0.1">
        <joint name="arm" axis="1 0 0"/>
        <geom type="capsule" fromto="0 0 0 0 0.2 0" size="0.03" rgba="0.9 0.9 0.9 1"/>
        <camera name="CameraTop" xyaxes="0 -1 0 0 0 1"/>
      </body>
    </body>
  </worldbody>
</mujoco>"""


@pytest.fixture(scope="session")
def model() -> mujoco.MjModel:
    """A body that slides up and down and waves an arm (nq = 2)."""
    return mujoco.MjModel.from_xml_string(XML)


@pytest.fixture(scope="session")
def poses() -> np.ndarray:
    """(20, 2) all different."""
    phase = np.linspace(0.0, 2.0, 20)
    return np.stack([0.05 * np.sin(phase), phase - 1.0], axis=1)


@pytest.fixture(scope="session")
def backend() -> Backend:
    """What renders here."""
    try:
        return choose_backend()
    except RenderingError as error:
        pytest.skip(str(error))
