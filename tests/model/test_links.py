"""Masses, centres of mass and inertias of the links are those of facts.json."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nao_sim.robot import facts

from .conftest import Scene

LINKS = {link["name"]: link for link in facts()["links"]}
FINGERS = {f["child_link"] for f in facts()["hand"]["finger_joints"]} | {"l_gripper", "r_gripper"}
TOTAL_KG = {"v4": 5.195, "v5": 5.305, "v6": 5.360}
MIRROR = np.diag([1.0, -1.0, 1.0])


def tensor(row: list[float]) -> np.ndarray:
    """(3, 3) of ixx, iyy, izz, ixy, ixz, iyz."""
    xx, yy, zz, xy, xz, yz = row
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def inertia_about_com(model: mujoco.MjModel, link: str) -> np.ndarray:
    """(3, 3) in link axes, turned back from the principal axes that MuJoCo keeps."""
    turn = Rotation.from_quat(model.body(link).iquat, scalar_first=True).as_matrix()
    return turn @ np.diag(model.body(link).inertia) @ turn.T


def expected(link: str, version: str) -> dict:
    return LINKS[link] | facts()["versions"][version]["links"].get(link, {})


def twin(link: str) -> str:
    return {"L": "R", "l": "r"}[link[0]] + link[1:]


def test_the_model_has_the_links_of_the_table_fingers_and_no_others(free: mujoco.MjModel) -> None:
    assert {free.body(i).name for i in range(1, free.nbody)} == set(LINKS) | FINGERS


@pytest.mark.parametrize("version", ["v4", "v5", "v6"])
@pytest.mark.parametrize("link", LINKS)
def test_a_link_has_the_documented_mass_centre_and_inertia(scene: Scene, version: str, link: str) -> None:
    model, row = scene(version), expected(link, version)
    assert model.body(link).mass[0] == pytest.approx(row["mass_kg"], rel=1e-6)
    np.testing.assert_allclose(model.body(link).ipos, row["com_m"], atol=1e-8)
    wanted = tensor(row["inertia_about_com_kg_m2"])
    np.testing.assert_allclose(inertia_about_com(model, link), wanted, atol=2e-6 * np.trace(wanted))


@pytest.mark.parametrize("link", [name for name in LINKS if name[0] in "Ll"])
def test_a_right_link_is_the_left_one_in_a_mirror(free: mujoco.MjModel, link: str) -> None:
    left, right = free.body(link), free.body(twin(link))
    assert left.mass == right.mass
    np.testing.assert_allclose(right.ipos, MIRROR @ left.ipos, atol=1e-9)
    mirrored = MIRROR @ inertia_about_com(free, link) @ MIRROR
    np.testing.assert_allclose(inertia_about_com(free, twin(link)), mirrored, atol=1e-11)


@pytest.mark.parametrize("link", sorted(FINGERS))
def test_a_finger_weighs_next_to_nothing_because_the_hand_has_its_mass(free: mujoco.MjModel, link: str) -> None:
    assert free.body(link).mass[0] == pytest.approx(facts()["hand"]["finger_mass_kg"])


@pytest.mark.parametrize("version", TOTAL_KG)
def test_the_whole_robot_has_the_documented_mass(scene: Scene, version: str) -> None:
    mass = scene(version).body("torso").subtreemass[0]
    assert mass == pytest.approx(TOTAL_KG[version], abs=1e-3)
    assert mass == pytest.approx(facts()["versions"][version]["total_mass_kg"], abs=1e-3)


@pytest.mark.parametrize("version", ["v4", "v6"])
def test_versions_differ_in_the_links_of_the_table_alone(scene: Scene, free: mujoco.MjModel, version: str) -> None:
    model = scene(version)
    names = [free.body(i).name for i in range(1, free.nbody)]
    differ = {
        name
        for name in names
        if not np.array_equal(model.body(name).mass, free.body(name).mass)
        or not np.array_equal(model.body(name).ipos, free.body(name).ipos)
        or not np.allclose(model.body(name).inertia, free.body(name).inertia, rtol=1e-9)
    }
    assert differ == set(facts()["versions"][version]["links"])


def test_inertia_is_about_the_centre_of_mass_and_not_about_the_joint(free: mujoco.MjModel) -> None:
    """About the joint the thigh's would be three times as large: a mix-up that is in public models."""
    about_com = np.trace(inertia_about_com(free, "LThigh"))
    arm = free.body("LThigh").ipos
    about_joint = about_com + 2 * free.body("LThigh").mass[0] * (arm @ arm)
    assert about_com == pytest.approx(sum(LINKS["LThigh"]["inertia_about_com_kg_m2"][:3]), rel=1e-5)
    assert about_joint > 2.5 * about_com


@pytest.mark.parametrize("link", LINKS)
def test_an_inertia_could_be_that_of_a_body(link: str) -> None:
    principal = np.linalg.eigvalsh(tensor(LINKS[link]["inertia_about_com_kg_m2"]))
    assert principal[0] > 0
    assert principal[0] + principal[1] >= principal[2]
