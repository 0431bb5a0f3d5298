"""A stage's scene as a page draws it: bodies and how they hang together, triangles, lights, floor and sky."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from nao_sim.mujoco_model import JointMap
from nao_sim.rendering.presets import load_camera
from nao_sim.rendering.stage import DIRECTIONAL, PLANE
from nao_sim.robot import Array
from nao_sim.viewing.meshes import Surface, joined, surface_of
from nao_sim.viewing.packing import Parcel
from nao_sim.viewing.stage import COLLISION_GROUP, PERSON_BODIES, Stage

FINEST = 1e-5  # m, to which points of surfaces are rounded
CAMERAS = ("three-quarter", "front", "side", "top")
_NO_MATERIAL = (0.5, 0.5, 0.0)  # specular, shininess and emission of a geom that has no material
_UNSET = np.array((0.5, 0.5, 0.5, 1.0), np.float32)  # a geom of this colour shows its material's


def pack_scenery(parcel: Parcel, stage: Stage) -> dict[str, Any]:
    """Put the triangles into a parcel, and tell what else there is to know of the scene."""
    model = stage.model
    looks = {geom: (part, take) for part, geoms in enumerate(stage.tinted.tint.parts)
             for geom, take in zip(geoms, stage.tinted.tint.takes[part], strict=True)}  # fmt: skip
    drawn = [geom for geom in range(model.ngeom) if model.geom_type[geom] != PLANE]
    surfaces = [surface_of(model, geom) for geom in drawn]
    _pack_surfaces(parcel, model, drawn, surfaces, looks)
    ranges = _ranges(model, drawn, surfaces)
    return {
        "bodies": [_body(stage, body, ranges[body], looks) for body in range(model.nbody)],
        "lights": [_light(model, light) for light in range(model.nlight)],
        "headlight": {kind: getattr(model.vis.headlight, kind).tolist() for kind in ("ambient", "diffuse", "specular")},
        "floor": _floor(parcel, model),
        "sky": _sky(model),
        "cameras": {name: _camera(f"{name}{' with person' if stage.figure else ''}") for name in CAMERAS},
    }


def _pack_surfaces(
    parcel: Parcel,
    model: mujoco.MjModel,
    geoms: list[int],
    surfaces: list[Surface],
    looks: Mapping[int, tuple[int, float]],
) -> None:
    sizes = [len(surface.points) for surface in surfaces]
    whole = joined(surfaces)
    parcel.add_rounded("points", whole.points, FINEST)
    parcel.add("normals", np.rint(127.0 * whole.normals), np.int8)
    colours = np.array([_colour(model, geom) for geom in geoms])
    shines = np.array([(*_shine(model, geom), looks.get(geom, (0, 0.0))[1]) for geom in geoms])
    parcel.add("colours", np.repeat(np.rint(255.0 * colours), sizes, axis=0), np.uint8)
    parcel.add("shines", np.repeat(np.rint(255.0 * shines), sizes, axis=0), np.uint8)
    parcel.add("faces", whole.faces, np.uint32)


def _ranges(model: mujoco.MjModel, geoms: list[int], surfaces: list[Surface]) -> list[dict[str, list[list[int]]]]:
    """By body and kind, the runs (first, count) of corners in the list of faces."""
    ranges: list[dict[str, list[list[int]]]] = [{"seen": [], "collision": []} for _ in range(model.nbody)]
    first = 0
    for geom, surface in zip(geoms, surfaces, strict=True):
        kind = "collision" if model.geom_group[geom] == COLLISION_GROUP else "seen"
        runs, count = ranges[model.geom_bodyid[geom]][kind], surface.faces.size
        if runs and sum(runs[-1]) == first:
            runs[-1][1] += count
        else:
            runs.append([first, count])
        first += count
    return ranges


def _body(
    stage: Stage, body: int, runs: dict[str, list[list[int]]], looks: Mapping[int, tuple[int, float]]
) -> dict[str, Any]:
    model = stage.model
    name = model.body(body).name
    first, count = model.body_geomadr[body], model.body_geomnum[body]
    parts = [looks[geom][0] for geom in range(first, first + count) if geom in looks]
    person = name.startswith(PERSON_BODIES)
    return {
        "name": name,
        "parent": int(model.body_parentid[body]),
        "place": [*model.body_pos[body].tolist(), *model.body_quat[body].tolist()],
        "of": "person" if person else "robot" if model.body_rootid[body] > 0 else "world",
        "part": parts[0] if parts else None,
        "joint": _joint(stage, body),
        **runs,
    }


def _joint(stage: Stage, body: int) -> dict[str, Any] | None:
    """What moves a body: the robot's base, seven of the person's numbers, or a joint of the vector at a ratio."""
    model, joints = stage.model, stage.performed.simulator.map
    if not model.body_jntnum[body]:
        return None
    joint = int(model.body_jntadr[body])
    address = int(model.jnt_qposadr[joint])
    if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_FREE:
        return {"person": address - joints.nq} if address >= joints.nq else {"base": True}
    ratios = _ratios(joints)[:, address]
    source = int(np.abs(ratios).argmax())
    return {"axis": model.jnt_axis[joint].tolist(), "source": source, "ratio": float(ratios[source])}


def _ratios(joints: JointMap) -> Array:
    """How far (26, nq) each number of a pose moves with each joint of the vector."""
    count = len(joints.qpos)
    return joints.to_qpos(np.eye(count)) - joints.to_qpos(np.zeros((count, count)))


def _colour(model: mujoco.MjModel, geom: int) -> NDArray[np.float32]:
    own, material = model.geom_rgba[geom], model.geom_matid[geom]
    return model.mat_rgba[material] if material >= 0 and (own == _UNSET).all() else own


def _shine(model: mujoco.MjModel, geom: int) -> tuple[float, float, float]:
    material = model.geom_matid[geom]
    if material < 0:
        return _NO_MATERIAL
    return (
        float(model.mat_specular[material]), float(model.mat_shininess[material]), float(model.mat_emission[material])
    )  # fmt: skip


def _light(model: mujoco.MjModel, light: int) -> dict[str, Any]:
    assert model.light_type[light] == DIRECTIONAL
    return {
        "direction": model.light_dir[light].tolist(),
        "diffuse": model.light_diffuse[light].tolist(),
        "specular": model.light_specular[light].tolist(),
        "shadow": bool(model.light_castshadow[light]),
    }


def _floor(parcel: Parcel, model: mujoco.MjModel) -> dict[str, Any]:
    """Where the floor is; its picture goes into the parcel."""
    floor = model.geom("floor").id
    material = model.geom_matid[floor]
    texture = int(model.mat_texid[material][mujoco.mjtTextureRole.mjTEXROLE_RGB])
    parcel.add("floor", _texels(model, texture), np.uint8)
    return {
        "height": float(model.geom_pos[floor, 2]),
        "repeat": model.mat_texrepeat[material].tolist(),
        "haze": model.vis.rgba.haze[:3].tolist(),
    }


def _sky(model: mujoco.MjModel) -> list[list[float]]:
    """Its colours at the zenith and at the horizon: a cube's faces lie one below the other, the third looks up."""
    sky = next(i for i in range(model.ntex) if model.tex_type[i] == mujoco.mjtTexture.mjTEXTURE_SKYBOX)
    texels = _texels(model, sky).astype(np.float64) / 255.0
    side = texels.shape[1]
    return [texels[2 * side + side // 2, side // 2].tolist(), texels[side // 2, side // 2].tolist()]


def _texels(model: mujoco.MjModel, texture: int) -> NDArray[np.uint8]:
    height, width, channels = model.tex_height[texture], model.tex_width[texture], model.tex_nchannel[texture]
    first = model.tex_adr[texture]
    texels: NDArray[np.uint8] = model.tex_data[first : first + height * width * channels]
    return texels.reshape(height, width, channels)[:, :, :3]


def _camera(name: str) -> dict[str, Any]:
    preset = load_camera(name)
    return {
        "lookat": list(preset.lookat),
        "distance": preset.distance,
        "azimuth": preset.azimuth_deg,
        "elevation": preset.elevation_deg,
        "fovy": preset.fovy_deg,
    }
