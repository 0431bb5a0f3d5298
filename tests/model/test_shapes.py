"""Collision shapes: simple, apart from what is only seen, about as large as the links, and what may touch what."""

from __future__ import annotations

import importlib
import json
from collections.abc import Iterator
from types import ModuleType

import mujoco
import numpy as np
import pytest

from nao_sim.mujoco_model import JointMap, robot_alone_spec
from nao_sim.paths import MODEL
from nao_sim.robot import facts, load_robot

SHELLS = facts()["shells"]
VISUAL, COLLISION = 2, 3
SPHERE, CAPSULE, BOX, MESH = (int(getattr(mujoco.mjtGeom, f"mjGEOM_{x}")) for x in ("SPHERE", "CAPSULE", "BOX", "MESH"))
# Links that are covered by others, and only in parts filled; small links, where a capsule bulges over a thin shell.
INNER = {"Neck": (0.0, 0.0), "LPelvis": (0.65, 0.75), "LShoulder": (3.0, 3.1)}  # a ball round the shoulder's disc
BULGING = 1.6
CELLS = 120_000
# How far shapes stick out of the link's documented bounds, m.  Some do so inside a neighbour: the disc of the shoulder
# in torso and arm, the elbow's and knee's ends, the hubs of hip and ankle in thigh and shank.
STICKING_OUT = 0.0055
INTO_A_NEIGHBOUR = {"LShoulder": 0.020, "LBicep": 0.009, "LForeArm": 0.006, "LPelvis": 0.006, "LHip": 0.014}
INTO_A_NEIGHBOUR |= {"LTibia": 0.009, "LAnklePitch": 0.013}
SCRIPTS = MODEL / "scripts"
OUTSIDE = 0.003  # m, that a surface may be outside the shapes
# The vendor's Crouch has the drawn heels 6 mm inside each other: there the shapes stand back.
HEEL = {"l_ankle": 0.007}


@pytest.fixture(scope="module")
def robot_geoms(free: mujoco.MjModel) -> np.ndarray:
    return np.flatnonzero(free.geom_bodyid > 0)


def test_shells_are_seen_and_never_touch(free: mujoco.MjModel, robot_geoms: np.ndarray) -> None:
    for geom in robot_geoms:
        mesh = free.geom_type[geom] == MESH
        assert free.geom_group[geom] == (VISUAL if mesh else COLLISION)
        assert mesh == (free.geom_contype[geom] == free.geom_conaffinity[geom] == 0)


def test_what_touches_is_a_sphere_a_capsule_or_a_box(free: mujoco.MjModel, robot_geoms: np.ndarray) -> None:
    kinds = {free.geom_type[geom] for geom in robot_geoms if free.geom_group[geom] == COLLISION}
    assert kinds <= {SPHERE, CAPSULE, BOX}
    boxes = {free.geom(g).name for g in robot_geoms if free.geom_type[g] == BOX}
    assert boxes == {"left_sole", "right_sole"}


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_sole_is_the_documented_box_at_the_documented_height(free: mujoco.MjModel, side: str) -> None:
    sole, box = free.geom(f"{side}_sole"), facts()["foot"][f"box_{side}_m"]
    assert free.body(sole.bodyid[0]).name == f"{side[0]}_ankle"
    for axis, (low, high) in enumerate((box["x"], box["y"])):
        np.testing.assert_allclose(sole.pos[axis] + sole.size[axis] * np.array([-1, 1]), (low, high), atol=1e-9)
    assert sole.pos[2] - sole.size[2] == pytest.approx(-facts()["foot_height_m"], abs=1e-9)


def test_nothing_of_a_foot_is_lower_than_its_sole(alone: mujoco.MjModel) -> None:
    foot = alone.body("l_ankle").id
    for geom in np.flatnonzero(alone.geom_bodyid == foot):
        if alone.geom_type[geom] == CAPSULE:
            turn = np.empty(9)
            mujoco.mju_quat2Mat(turn, alone.geom_quat[geom])
            reach = abs(turn[8]) * alone.geom_size[geom, 1] + alone.geom_size[geom, 0]
            assert alone.geom_pos[geom, 2] - reach > -facts()["foot_height_m"]


def test_right_shapes_are_the_left_ones_in_a_mirror(alone: mujoco.MjModel) -> None:
    for geom in range(alone.ngeom):
        name = alone.geom(geom).name
        if name[0] in "Ll" and "sole" not in name:
            twin = alone.geom({"L": "R", "l": "r"}[name[0]] + name[1:])
            np.testing.assert_allclose(twin.pos, alone.geom_pos[geom] * [1, -1, 1], atol=1e-9)
            np.testing.assert_allclose(twin.size, alone.geom_size[geom], atol=1e-9)


def filled(model: mujoco.MjModel, link: str) -> float:
    """Volume (m3) of the union of a link's capsules and spheres, counted on a grid."""
    geoms = [g for g in np.flatnonzero(model.geom_bodyid == model.body(link).id) if "sole" not in model.geom(g).name]
    low, high = np.array(SHELLS["bounds_m"][link]) + np.array([[-0.01], [0.01]])
    cell = (np.prod(high - low) / CELLS) ** (1 / 3)
    grid = np.stack(np.meshgrid(*(np.arange(a, b, cell) for a, b in zip(low, high, strict=True))), -1).reshape(-1, 3)
    inside = np.zeros(len(grid), bool)
    for geom in geoms:
        turn = np.empty(9)
        mujoco.mju_quat2Mat(turn, model.geom_quat[geom])
        local = (grid - model.geom_pos[geom]) @ turn.reshape(3, 3)
        radius, half = model.geom_size[geom, 0], model.geom_size[geom, 1]
        local[:, 2] -= np.clip(local[:, 2], -half, half)
        inside |= (local**2).sum(axis=1) < radius**2
    return float(inside.sum() * cell**3)


@pytest.mark.parametrize("link", [name for name in SHELLS["hull_volume_m3"] if name[0] not in "Rr"])
def test_shapes_fill_about_the_volume_of_the_links_hull(alone: mujoco.MjModel, link: str) -> None:
    share = filled(alone, link) / SHELLS["hull_volume_m3"][link]
    finger = "Finger" in link or "Thumb" in link
    low, high = INNER.get(link, (0.6, BULGING if finger else 1.4))
    assert low <= share <= high, f"{share:.2f} of the hull's volume"


def sticking_out(model: mujoco.MjModel, geom: int, link: str) -> float:
    """How far a capsule or sphere reaches beyond the documented bounds of its link, m."""
    turn = np.empty(9)
    mujoco.mju_quat2Mat(turn, model.geom_quat[geom])
    half = model.geom_size[geom, 0] + np.abs(turn.reshape(3, 3)[:, 2]) * model.geom_size[geom, 1]
    low, high = np.array(SHELLS["bounds_m"][link])
    return float(max((low - model.geom_pos[geom] + half).max(), (model.geom_pos[geom] + half - high).max()))


@pytest.mark.parametrize("link", [x for x in SHELLS["hull_volume_m3"] if x[0] not in "Rr" and "Thumb" not in x])
def test_no_shape_sticks_out_of_the_documented_bounds_of_its_link(alone: mujoco.MjModel, link: str) -> None:
    geoms = [g for g in np.flatnonzero(alone.geom_bodyid == alone.body(link).id) if "sole" not in alone.geom(g).name]
    assert all(sticking_out(alone, g, link) <= INTO_A_NEIGHBOUR.get(link, STICKING_OUT) for g in geoms)


@pytest.fixture(scope="module")
def coverage() -> Iterator[ModuleType]:
    """The model's own script that measures shapes against shells."""
    if not SCRIPTS.is_dir():
        pytest.skip("an installed wheel carries the model, not what measures it")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(SCRIPTS))
        yield importlib.import_module("coverage_of_shapes")


@pytest.fixture(scope="module")
def outside(coverage: ModuleType) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Points on the surface of each link, and how far each is outside the shapes in the worst of poses."""
    return {link: coverage.outside(link, density=1e5)[:2] for link in coverage.links()}


def test_no_surface_is_more_than_3_millimetres_outside_the_shapes(
    outside: dict[str, tuple[np.ndarray, np.ndarray]],
) -> None:
    for link, (_, depth) in outside.items():
        assert depth.max() <= HEEL.get(link, OUTSIDE), f"{link}: {1000 * depth.max():.2f} mm"


def test_a_foot_is_more_than_3_millimetres_outside_only_at_the_inner_side_of_its_heel(
    outside: dict[str, tuple[np.ndarray, np.ndarray]],
) -> None:
    points, depth = outside["l_ankle"]
    bare = points[depth > OUTSIDE]
    assert (bare[:, 0] < 0.015).all()
    assert (bare[:, 1] < -0.0165).all()


def test_a_shape_that_shrinks_lets_surface_out(coverage: ModuleType) -> None:
    """The measure sees what it should: a millimetre less of a ball is a millimetre more outside."""
    points = coverage.surface("Head", 1e4)
    whole, thin = ([["sphere", radius, [0.0, 0.0, 0.057]]] for radius in (0.060, 0.059))
    np.testing.assert_allclose(coverage.depth(points, thin) - coverage.depth(points, whole), 0.001, atol=1e-12)


def test_the_measure_agrees_with_mujocos_own_distances(alone: mujoco.MjModel, coverage: ModuleType) -> None:
    """A point's depth in a link's shapes, against the distance of a tiny ball that MuJoCo measures."""
    points = np.random.default_rng(0).uniform(-0.1, 0.1, (20, 3))
    spec = robot_alone_spec()
    for i, point in enumerate(points):
        spec.body("LTibia").add_geom(name=f"probe{i}", type=SPHERE, size=[1e-6, 0, 0], pos=point)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    own = [model.geom(f"LTibia_collision_{i}").id for i in range(len(coverage.shapes("LTibia")))]
    for i, depth in enumerate(coverage.depth(points, coverage.shapes("LTibia"))):
        probe = model.geom(f"probe{i}").id
        assert min(mujoco.mj_geomDistance(model, data, g, probe, 1.0, None) for g in own) == pytest.approx(
            depth, abs=1e-5
        )


def kind(name: str) -> str:
    if "sole" in name or name == "floor":
        return "sole" if "sole" in name else "floor"
    if "Finger" in name or "Thumb" in name:
        return f"finger {name[0]}"
    return "body"


MAY_TOUCH = {
    frozenset({"floor", "sole"}), frozenset({"floor", "body"}), frozenset({"floor", "finger L"}),
    frozenset({"floor", "finger R"}), frozenset({"body"}), frozenset({"body", "finger L"}),
    frozenset({"body", "finger R"}), frozenset({"finger L", "finger R"}),
}  # fmt: skip


def test_the_contact_bits_allow_what_the_table_in_the_readme_says(free: mujoco.MjModel) -> None:
    geoms = np.flatnonzero(free.geom_contype | free.geom_conaffinity)
    for a in geoms:
        for b in geoms[geoms > a]:
            bits = free.geom_contype[a] & free.geom_conaffinity[b] | free.geom_contype[b] & free.geom_conaffinity[a]
            pair = frozenset({kind(free.geom(a).name), kind(free.geom(b).name)})
            assert bool(bits) == (pair in MAY_TOUCH), pair


def test_an_object_with_default_bits_touches_every_shape(free: mujoco.MjModel) -> None:
    geoms = np.flatnonzero(free.geom_group == COLLISION)
    assert (free.geom_contype[geoms] & 1).all()


def test_the_documented_foot_boxes_overlap_in_the_vendors_crouch(alone: mujoco.MjModel) -> None:
    """Why soles touch the world alone: in Crouch the boxes of both feet overlap by 16.5 mm, the feet do not."""
    data = mujoco.MjData(alone)
    data.qpos[:] = JointMap(alone).to_qpos(load_robot().postures["Crouch"])
    mujoco.mj_kinematics(alone, data)
    soles = (alone.geom("left_sole").id, alone.geom("right_sole").id)
    assert mujoco.mj_geomDistance(alone, data, *soles, 0.1, None) == pytest.approx(-0.0165, abs=0.0005)
    feet = [
        [g for g in np.flatnonzero(alone.geom_bodyid == alone.body(foot).id) if g not in soles]
        for foot in ("l_ankle", "r_ankle")
    ]
    assert min(mujoco.mj_geomDistance(alone, data, a, b, 0.1, None) for a in feet[0] for b in feet[1]) > 0.005


def test_every_shape_of_the_table_is_in_the_model(alone: mujoco.MjModel) -> None:
    table = json.loads((MODEL / "collision.json").read_text(encoding="utf-8"))
    wanted = {f"{link}_collision_{i}" for link, shapes in table["shapes"].items() for i in range(len(shapes))}
    found = {alone.geom(g).name for g in range(alone.ngeom) if "collision" in alone.geom(g).name}
    assert wanted <= found
    assert all(name[0] in "Rr" for name in found - wanted)
