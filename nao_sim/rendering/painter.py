"""One OpenGL context that paints poses; lives in a worker process."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from nao_sim.rendering.preset_kinds import Camera, Quality, Shadow
from nao_sim.rendering.region import Region
from nao_sim.rendering.stage import DIRECTIONAL, PLANE, apply_quality, find_movers, make_camera, make_context
from nao_sim.rendering.tint import Tint, Tinter

_ALL = mujoco.mjtCatBit.mjCAT_ALL.value
_STATIC = mujoco.mjtCatBit.mjCAT_STATIC.value
_DECOR = mujoco.mjtCatBit.mjCAT_DECOR.value
_SHADOW, _REFLECTION = mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION
_MAX_GEOMS = 2000

Picture = NDArray[np.uint8]


class Painter:
    """Paints poses of one model; holds an OpenGL context, so one a process and on one thread.

    Args:
        model: is changed to suit the quality; hand over one of your own.
        size: (width, height) in pixels of what is painted, supersampling included.
        camera: where the pictures are taken from.
        quality: what is drawn.
        shadow: the square that has shadows.
        whole: render every picture whole, also where only a part can change.
        tint: what may take colour, if anything.

    Raises:
        UsageError: the model has no camera of that name.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        size: tuple[int, int],
        camera: Camera,
        quality: Quality,
        shadow: Shadow,
        whole: bool = False,
        tint: Tint | None = None,
    ) -> None:
        apply_quality(model, size, quality, shadow)
        self._model, self._data, self._size, self._shadow = model, mujoco.MjData(model), size, shadow
        self._preset = camera
        self._camera, self._options = make_camera(model, camera, size), mujoco.MjvOption()
        groups = self._options.geomgroup | self._options.sitegroup
        self._movers = None if whole else find_movers(model, camera, size, quality, groups)
        self._tinter = Tinter(model, tint or Tint())
        self._scene = mujoco.MjvScene(model, _MAX_GEOMS)
        self._scene.flags[_SHADOW], self._scene.flags[_REFLECTION] = quality.shadow_map > 0, quality.reflection
        self._everything = Region(0, 0, *size)
        self._buffer = np.empty(size[0] * size[1] * 3, np.uint8)
        self._centre, self._background = np.zeros(3), np.empty((size[1], size[0], 3), np.uint8)
        self._background_key: bytes | None = None
        self._gl = mujoco.GLContext(*size)
        self._gl.make_current()
        self._context = make_context(model)
        self._warm_up()

    def paint(self, row: NDArray[np.float64], out: Picture) -> None:
        """Paint a row into `out` (height, width, 3), top row first: a pose (nq,), the camera's numbers, the covers."""
        self._gl.make_current()
        qpos, turned, tint = np.split(row, np.cumsum((self._model.nq, self._preset.width)))
        self._pose(qpos)
        self._move_camera(turned)
        coloured = self._tinter.colour(tint)
        region = self._movers.region(self._data.geom_xpos, coloured) if self._movers is not None else None
        if region is not None:
            self._refresh_background(tint)
            np.copyto(out, self._background)
        self._update_scene(_ALL)
        self._render(region or self._everything, out)

    def _warm_up(self) -> None:
        """Render and forget: the first picture of a context comes out in a slightly different shade."""
        self._update_scene(_ALL)
        self._render(Region(0, 0, min(64, self._size[0]), min(64, self._size[1])), self._background)

    def _pose(self, qpos: NDArray[np.float64]) -> None:
        self._data.qpos[:] = qpos
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_camlight(self._model, self._data)
        self._centre[:2] = np.round(self._data.subtree_com[0, :2] / self._shadow.step) * self._shadow.step + 0.0

    def _move_camera(self, turned: NDArray[np.float64]) -> None:
        preset = self._preset
        if preset.follows:
            self._camera.lookat[:2] = np.add(preset.lookat[:2], self._data.xpos[min(1, self._model.nbody - 1), :2])
        if len(turned):
            self._camera.azimuth = preset.azimuth_deg + turned[0]

    def _refresh_background(self, tint: NDArray[np.float64]) -> None:
        """Render the picture without what moves: once, or where things at rest cast shadows, with their square."""
        key = self._centre.tobytes() if self._movers is not None and self._movers.furnished else b""
        if self._background_key != key:
            self._tinter.clear()
            self._update_scene(_STATIC)
            self._render(self._everything, self._background)
            self._background_key = key
            self._tinter.colour(tint)

    def _update_scene(self, categories: int) -> None:
        scene = self._scene
        # first, for the floor is laid around where the camera was before
        mujoco.mjv_updateCamera(self._model, self._data, self._camera, scene)
        mujoco.mjv_updateScene(self._model, self._data, self._options, None, self._camera, categories, scene)
        for geom in scene.geoms[: scene.ngeom]:
            if geom.type == PLANE:
                geom.category = _DECOR  # a floor casts no shadow, and MuJoCo leaves decoration out of the map
        for light in scene.lights[: scene.nlight]:
            if light.castshadow and light.type == DIRECTIONAL:  # its position only says what its shadow map covers
                light.pos[:] = self._centre - 2.0 * self._shadow.reach * np.asarray(light.dir)

    def _render(self, region: Region, out: Picture) -> None:
        """Render one rectangle of the picture, with the camera's frustum cut to it."""
        if region != self._everything:
            self._cut_frustum(region)
        rect = mujoco.MjrRect(region.left, region.bottom, region.width, region.height)
        pixels = self._buffer[: region.width * region.height * 3].reshape(region.height, region.width, 3)
        mujoco.mjr_render(rect, self._scene, self._context)
        mujoco.mjr_readPixels(pixels, None, rect, self._context)
        top_row = self._size[1] - region.bottom - region.height
        rows = out[top_row : top_row + region.height]
        rows[:, region.left : region.left + region.width] = pixels[::-1]

    def _cut_frustum(self, region: Region) -> None:
        width, height = self._size
        for eye in self._scene.camera:
            bottom, pixel = eye.frustum_bottom, (eye.frustum_top - eye.frustum_bottom) / height
            eye.frustum_bottom = bottom + pixel * region.bottom
            eye.frustum_top = bottom + pixel * (region.bottom + region.height)
            eye.frustum_center += pixel * (region.left + (region.width - width) / 2)
