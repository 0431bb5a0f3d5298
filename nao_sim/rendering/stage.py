"""What is set up once before a model is painted: quality, upload, camera, and what of the picture can change.

What a frame costs with Mesa's software OpenGL, and what is done about it:

* MuJoCo draws an infinite floor as 200 x 200 quads, more triangles than the robot has, and draws it three times
  where there is a shadow.  Here its display list is compiled as four quads; shading and texture stay the same
  because lights from afar shade a plane evenly.
* The shadow map covers the robot's surroundings instead of the whole model extent, so that a small one does.
* While nothing but the robot moves, only the rectangle that it and its shadow can touch is rendered anew.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from nao_sim.errors import UsageError
from nao_sim.rendering.preset_kinds import Camera, Quality, Shadow
from nao_sim.rendering.region import Array, Region, View, region_of, shadow_spheres

PLANE = mujoco.mjtGeom.mjGEOM_PLANE.value
DIRECTIONAL = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL.value
_FIXED = mujoco.mjtCamLight.mjCAMLIGHT_FIXED.value
_STEEP = -0.2  # z of a light's direction; a lower sun casts shadows too long to be worth a rectangle


def apply_quality(model: mujoco.MjModel, size: tuple[int, int], quality: Quality, shadow: Shadow) -> None:
    """Change `model` so that a context made of it renders `size` pixels at `quality`."""
    model.vis.global_.offwidth, model.vis.global_.offheight = size
    model.vis.quality.offsamples = quality.msaa
    model.vis.quality.shadowsize = quality.shadow_map
    model.vis.map.shadowclip = shadow.reach / model.stat.extent
    casting = np.flatnonzero(model.light_castshadow)
    model.light_castshadow[casting[quality.shadow_lights :]] = 0
    if not quality.reflection:
        model.mat_reflectance[:] = 0.0


def make_context(model: mujoco.MjModel) -> mujoco.MjrContext:
    """Upload the model, with each infinite plane as four quads that reach beyond the far clipping plane."""
    infinite = (model.geom_type == PLANE) & (model.geom_size[:, 0] == 0) & (model.geom_size[:, 1] == 0)
    sizes = model.geom_size[infinite].copy()
    model.geom_size[infinite] = 1.05 * model.vis.map.zfar * model.stat.extent
    context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_50.value)
    model.geom_size[infinite] = sizes
    mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, context)
    return context


def make_camera(model: mujoco.MjModel, preset: Camera, size: tuple[int, int]) -> mujoco.MjvCamera:
    """MuJoCo's camera for a preset.

    Raises:
        UsageError: the model has no camera of the preset's name.
    """
    camera = mujoco.MjvCamera()
    if preset.model_camera is None:
        model.vis.global_.fovy = preset.fovy_deg
        camera.type = mujoco.mjtCamera.mjCAMERA_FREE.value
        camera.lookat[:], camera.distance = preset.lookat, _distance(preset, size)
        camera.azimuth, camera.elevation = preset.azimuth_deg, preset.elevation_deg
        return camera
    number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_CAMERA.value, preset.model_camera)
    if number < 0:
        raise UsageError(f"camera '{preset.name}' needs a model with a camera named {preset.model_camera}")
    camera.type, camera.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED.value, number
    return camera


def view_of(preset: Camera, size: tuple[int, int]) -> View:
    """The view of a preset that is no camera of the model."""
    azimuth, elevation = np.radians((preset.azimuth_deg, preset.elevation_deg))
    along, across = np.array([np.cos(azimuth), np.sin(azimuth), 0.0]), np.array([0.0, 0.0, 1.0])
    forward = np.cos(elevation) * along + np.sin(elevation) * across
    up = np.cos(elevation) * across - np.sin(elevation) * along
    position = np.array(preset.lookat) - _distance(preset, size) * forward
    return View(position, forward, up, float(np.tan(np.radians(preset.fovy_deg) / 2)), size)


@dataclass(frozen=True, eq=False)
class Movers:
    """The visible geoms that can move, and where their shadows fall.

    Attributes:
        view: the camera, at rest.
        geoms: (N,) indices of the geoms.
        radii: (model.ngeom,) m, radii of the spheres around all geoms.
        lights: (3,) each, the directions of the lights that cast shadows.
        floor: m, the height on which the shadows fall.
        furnished: whether something besides floors stands still.
    """

    view: View
    geoms: NDArray[np.int_]
    radii: Array
    lights: tuple[Array, ...]
    floor: float
    furnished: bool

    def region(self, positions: Array, coloured: NDArray[np.int_]) -> Region | None:
        """The part of the picture that changes, None for all of it.

        Args:
            positions: (model.ngeom, 3) m, where the geoms are.
            coloured: (N,) geoms that are not of their own colour, at rest or not.
        """
        geoms = np.concatenate([self.geoms, coloured])
        here, reach = positions[geoms], self.radii[geoms]
        shadows = [shadow_spheres(here, reach, light, self.floor) for light in self.lights]
        centres, radii = zip((here, reach), *shadows, strict=True)
        return region_of(self.view, np.concatenate(centres), np.concatenate(radii))


def find_movers(
    model: mujoco.MjModel, camera: Camera, size: tuple[int, int], quality: Quality, groups: NDArray[np.uint8]
) -> Movers | None:
    """What can move in the picture, or None where that says little: all of it may change with every pose.

    Args:
        model: after `apply_quality`.
        camera: where the pictures are taken from.
        size: (width, height) in pixels.
        quality: what is drawn.
        groups: (6,) whether each geom and site group is drawn.
    """
    casting = np.flatnonzero(model.light_castshadow) if quality.shadow_map else np.array([], int)
    planes = np.flatnonzero(model.geom_type == PLANE)
    known = (
        camera.stands
        and not quality.reflection
        and np.all(model.light_bodyid == 0)
        and np.all(model.light_mode == _FIXED)
        and np.all(model.light_type[casting] == DIRECTIONAL)
        and np.all(model.light_dir[casting, 2] < _STEEP)
        and np.all(model.geom_quat[planes] == [1, 0, 0, 0])
        and np.all(model.geom_bodyid[planes] == 0)
        and model.nskin + model.nflex + model.ntendon == 0
        and not groups[model.site_group].any()
    )
    if not known:
        return None
    moves = model.body_weldid[model.geom_bodyid] != 0
    visible = groups[model.geom_group].astype(bool)
    geoms = np.flatnonzero(moves & visible)
    furnished = bool(np.any(visible & ~moves & (model.geom_type != PLANE)))
    lights = tuple(np.array(direction) for direction in model.light_dir[casting])
    floor = float(model.geom_pos[planes, 2].min(initial=0.0))
    return Movers(view_of(camera, size), geoms, model.geom_rbound.copy(), lights, floor, furnished)


def _distance(preset: Camera, size: tuple[int, int]) -> float:
    """In a portrait picture the camera steps back, so that the arms stay inside."""
    return preset.distance * max(1.0, size[1] / size[0])
