"""The shells: few triangles, small files, the size of the robot, and one material for all coloured plates."""

from __future__ import annotations

import copy
import json

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nao_sim.paths import MODEL
from nao_sim.robot import facts

ASSETS = MODEL / "assets"
TABLE = json.loads((ASSETS / "shells.json").read_text(encoding="utf-8"))
BOUNDS = facts()["shells"]["bounds_m"]
MIRROR = np.array([1.0, -1.0, 1.0])
# The published thumbs lie along another axis of their frame than the one that they bend about leaves room for.
SIDEWAYS = ("LThumb1_link", "LThumb2_link")


@pytest.fixture(scope="module")
def points(free: mujoco.MjModel) -> dict[str, np.ndarray]:
    """Vertices (V, 3) of all shells that each link wears, in its frame, as compiled."""
    found: dict[str, list[np.ndarray]] = {}
    for geom in np.flatnonzero(free.geom_type == mujoco.mjtGeom.mjGEOM_MESH):
        mesh = free.mesh(free.geom_dataid[geom])
        corners = free.mesh_vert[mesh.vertadr[0] : mesh.vertadr[0] + mesh.vertnum[0]]
        turn = Rotation.from_quat(free.geom_quat[geom], scalar_first=True)
        found.setdefault(free.body(free.geom_bodyid[geom]).name, []).append(turn.apply(corners) + free.geom_pos[geom])
    return {link: np.vstack(meshes) for link, meshes in found.items()}


def file_vertices(file: str) -> np.ndarray:
    """(V, 3) of an OBJ file."""
    lines = (ASSETS / file).read_text(encoding="utf-8").splitlines()
    return np.array([line.split()[1:4] for line in lines if line.startswith("v ")], float)


def test_the_robot_is_drawn_with_at_most_30000_triangles(free: mujoco.MjModel) -> None:
    meshes = free.geom_dataid[free.geom_type == mujoco.mjtGeom.mjGEOM_MESH]
    assert 10_000 < free.mesh_facenum[meshes].sum() <= 30_000


def test_all_shells_together_take_at_most_3_megabytes() -> None:
    assert sum(path.stat().st_size for path in ASSETS.glob("*.obj")) <= 3_000_000


def test_every_file_is_used_and_every_used_file_is_there() -> None:
    assert {shell["file"] for shell in TABLE["shells"]} == {path.name for path in ASSETS.glob("*.obj")}


def documented(link: str) -> np.ndarray:
    """(2, 3) documented bounds; a right finger's are the left one's in a mirror."""
    if link in BOUNDS:
        return np.array(BOUNDS[link])
    return np.sort(np.array(BOUNDS["L" + link[1:]]) * MIRROR, axis=0)


@pytest.mark.parametrize("link", [link for link in BOUNDS if link not in SIDEWAYS])
def test_a_shell_has_the_documented_bounds_within_4_millimetres(points: dict[str, np.ndarray], link: str) -> None:
    found = np.stack([points[link].min(axis=0), points[link].max(axis=0)])
    np.testing.assert_allclose(found, documented(link), atol=0.004)


@pytest.mark.parametrize("link", SIDEWAYS)
def test_a_thumb_lies_along_its_frame_as_the_fingers_do(points: dict[str, np.ndarray], link: str) -> None:
    np.testing.assert_allclose(points[link].max(axis=0), documented("LFinger11_link")[1], atol=0.004)


def test_links_wear_the_files_of_the_table_the_right_ones_mirrored(points: dict[str, np.ndarray]) -> None:
    wanted: dict[str, list[np.ndarray]] = {}
    for shell in TABLE["shells"]:
        mesh = file_vertices(shell["file"])
        wanted.setdefault(shell["link"], []).append(mesh)
        if shell["mirror_to"]:
            wanted.setdefault(shell["mirror_to"], []).append(mesh * MIRROR)
    assert set(wanted) == set(points)
    for link, meshes in wanted.items():
        corners = np.vstack(meshes)
        for end in (np.min, np.max, np.mean):
            np.testing.assert_allclose(end(points[link], axis=0), end(corners, axis=0), atol=3e-4)


def test_a_shell_wears_the_material_of_the_table(free: mujoco.MjModel) -> None:
    wanted = {
        f"{link}_{shell['material']}": shell["material"]
        for shell in TABLE["shells"]
        for link in (shell["link"], shell["mirror_to"])
        if link
    }
    geoms = np.flatnonzero(free.geom_type == mujoco.mjtGeom.mjGEOM_MESH)
    assert {free.mesh(free.geom_dataid[g]).name: free.mat(free.geom_matid[g]).name for g in geoms} == wanted


def test_one_material_recolours_all_coloured_plates(free: mujoco.MjModel) -> None:
    """Geoms have no colour of their own over their material's: what the scene draws follows the material."""
    model = copy.copy(free)
    before = drawn(model)
    model.mat_rgba[model.mat("panel").id] = 0.1, 0.2, 0.9, 1.0
    after = drawn(model)
    panels = {
        f"{link}_panel"
        for s in TABLE["shells"]
        if s["material"] == "panel"
        for link in (s["link"], s["mirror_to"])
        if link
    }
    assert {name for name in before if before[name] != after[name]} == panels
    assert len(panels) >= 10


def drawn(model: mujoco.MjModel) -> dict[str, tuple[float, ...]]:
    """The colour in which each mesh is handed to the renderer."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    scene = mujoco.MjvScene(model, maxgeom=2000)
    mujoco.mjv_updateScene(model, data, mujoco.MjvOption(), None, mujoco.MjvCamera(), mujoco.mjtCatBit.mjCAT_ALL, scene)
    shown = [g for g in scene.geoms[: scene.ngeom] if g.type == mujoco.mjtGeom.mjGEOM_MESH]
    return {model.mesh(model.geom_dataid[g.objid]).name: tuple(float(x) for x in g.rgba) for g in shown}
