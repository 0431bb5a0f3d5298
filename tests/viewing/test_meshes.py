"""Surfaces: closed, facing outwards, and of the size that MuJoCo gives their shapes."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from nao_sim.simulation.scene import compile_scene
from nao_sim.viewing.meshes import Surface, surface_of

SHAPES = {
    "sphere": ("0.1", 4 / 3 * np.pi * 0.1**3),
    "capsule": ("0.1 0.2", 4 / 3 * np.pi * 0.1**3 + np.pi * 0.1**2 * 0.4),
    "cylinder": ("0.1 0.2", np.pi * 0.1**2 * 0.4),
    "ellipsoid": ("0.1 0.2 0.3", 4 / 3 * np.pi * 0.006),
    "box": ("0.1 0.2 0.3", 8 * 0.006),
}


def _volume(surface: Surface) -> float:
    """By the divergence theorem."""
    a, b, c = np.moveaxis(surface.points[surface.faces], 1, 0)
    return float((a * np.cross(b, c)).sum() / 6.0)


@pytest.mark.parametrize("kind", SHAPES)
def test_a_shape_has_its_volume_its_place_and_faces_that_look_outwards(kind):
    size, volume = SHAPES[kind]
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><worldbody><geom type="{kind}" size="{size}" pos="1 2 3" euler="30 40 50"/></worldbody></mujoco>'
    )
    surface = surface_of(model, 0)
    assert 0.93 * volume < _volume(surface) < 1.0001 * volume
    points = surface.points[surface.faces]
    outwards = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    real = np.linalg.norm(outwards, axis=1) > 1e-12  # at a pole a face has no area
    assert ((outwards * surface.normals[surface.faces].sum(axis=1)).sum(axis=1)[real] > 0.0).all()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    local = (surface.points - data.geom_xpos[0]) @ data.geom_xmat[0].reshape(3, 3)
    high = {"sphere": 0.1, "capsule": 0.3, "cylinder": 0.2}.get(kind, 0.3)
    assert local.max(axis=0)[2] == pytest.approx(high) and local.min(axis=0)[2] == pytest.approx(-high)


def test_the_robots_shells_are_those_of_the_model():
    model = compile_scene()
    for geom in np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_MESH)[::13]:
        surface, mesh = surface_of(model, geom), model.geom_dataid[geom]
        assert len(surface.faces) == model.mesh_facenum[mesh]
        turn = np.empty(9)
        mujoco.mju_quat2Mat(turn, model.geom_quat[geom])
        start, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        corners = model.mesh_vert[start : start + count] @ turn.reshape(3, 3).T + model.geom_pos[geom]
        faces = model.mesh_face[model.mesh_faceadr[mesh] : model.mesh_faceadr[mesh] + model.mesh_facenum[mesh]]
        assert np.allclose(surface.points[surface.faces], corners[faces], atol=1e-6)
