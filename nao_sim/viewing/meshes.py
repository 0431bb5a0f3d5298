"""The surfaces of a model's shapes as triangles."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from nao_sim.robot import Array

_ROUND, _RINGS = 20, 6  # corners of a circle, and rings from a sphere's equator to its pole
_KIND = mujoco.mjtGeom


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles with smooth shading.

    Attributes:
        points: (N, 3) m.
        normals: (N, 3) of length one, outwards.
        faces: (F, 3) indices of points, counterclockwise from outside.
    """

    points: Array
    normals: Array
    faces: NDArray[np.int_]

    def moved(self, position: Array, quaternion: Array) -> Surface:
        """Turned by a unit quaternion (4,), then moved (3,)."""
        turn = np.empty(9)
        mujoco.mju_quat2Mat(turn, np.asarray(quaternion, np.float64))
        matrix = turn.reshape(3, 3).T
        return Surface(self.points @ matrix + position, self.normals @ matrix, self.faces)


def joined(surfaces: Iterable[Surface]) -> Surface:
    """Several as one, in their order."""
    many = list(surfaces) or [Surface(np.empty((0, 3)), np.empty((0, 3)), np.empty((0, 3), int))]
    before = np.cumsum([0, *(len(each.points) for each in many[:-1])])
    return Surface(
        np.concatenate([each.points for each in many]),
        np.concatenate([each.normals for each in many]),
        np.concatenate([each.faces + first for each, first in zip(many, before, strict=True)]),
    )


def surface_of(model: mujoco.MjModel, geom: int) -> Surface:
    """The surface of a geom in the frame of its body.

    Raises:
        ValueError: it has none of a size, as an infinite plane.
    """
    kind, size = _KIND(int(model.geom_type[geom])), model.geom_size[geom]
    if kind == _KIND.mjGEOM_MESH:
        shape = _mesh(model, int(model.geom_dataid[geom]))
    elif kind == _KIND.mjGEOM_BOX:
        shape = _box(size)
    elif kind == _KIND.mjGEOM_CYLINDER:
        shape = _cylinder(float(size[0]), float(size[1]))
    elif kind in (_KIND.mjGEOM_SPHERE, _KIND.mjGEOM_CAPSULE, _KIND.mjGEOM_ELLIPSOID):
        shape = _round(*_radii_and_half(kind, size))
    else:
        raise ValueError(f"geom {geom}: no surface of a {kind.name}")
    return shape.moved(model.geom_pos[geom], model.geom_quat[geom])


def _mesh(model: mujoco.MjModel, mesh: int) -> Surface:
    """A point for each pair of corner and normal that occurs."""
    start, count = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
    corners = model.mesh_face[start : start + count].ravel()
    normals = model.mesh_facenormal[start : start + count].ravel()
    pairs, faces = np.unique(np.stack([corners, normals], axis=1), axis=0, return_inverse=True)
    return Surface(
        model.mesh_vert[model.mesh_vertadr[mesh] + pairs[:, 0]].astype(np.float64),
        model.mesh_normal[model.mesh_normaladr[mesh] + pairs[:, 1]].astype(np.float64),
        faces.reshape(-1, 3),
    )


def _radii_and_half(kind: mujoco.mjtGeom, size: Array) -> tuple[Array, float]:
    if kind == _KIND.mjGEOM_ELLIPSOID:
        return np.array(size, np.float64), 0.0
    return np.full(3, size[0]), float(size[1]) if kind == _KIND.mjGEOM_CAPSULE else 0.0


def _round(radii: Array, half: float) -> Surface:
    """An ellipsoid, cut at its equator and drawn out along z by `half` to both sides."""
    up = np.linspace(0.0, np.pi / 2.0, _RINGS + 1)
    latitudes = np.concatenate([-up[::-1], up])
    round_ = np.linspace(0.0, 2.0 * np.pi, _ROUND + 1)
    units = np.stack(
        [np.outer(np.cos(latitudes), np.cos(round_)), np.outer(np.cos(latitudes), np.sin(round_)),
         np.outer(np.sin(latitudes), np.ones_like(round_))], axis=-1
    )  # fmt: skip
    points = units * radii
    points[: _RINGS + 1, :, 2] -= half
    points[_RINGS + 1 :, :, 2] += half
    normals = units / radii
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return Surface(points.reshape(-1, 3), normals.reshape(-1, 3), _grid(len(latitudes), _ROUND + 1))


def _cylinder(radius: float, half: float) -> Surface:
    round_ = np.linspace(0.0, 2.0 * np.pi, _ROUND + 1)
    out = np.stack([np.cos(round_), np.sin(round_), np.zeros_like(round_)], axis=-1)
    side = np.concatenate([radius * out - (0.0, 0.0, half), radius * out + (0.0, 0.0, half)])
    parts = [Surface(side, np.tile(out, (2, 1)), _grid(2, _ROUND + 1))]
    for up, order in ((1.0, (0, 1, 2)), (-1.0, (0, 2, 1))):
        fan = np.stack([np.zeros(_ROUND, int), np.arange(1, _ROUND + 1), np.arange(2, _ROUND + 2)], axis=1)[:, order]
        points = np.concatenate([[[0.0, 0.0, up * half]], radius * out + (0.0, 0.0, up * half)])
        parts.append(Surface(points, np.tile((0.0, 0.0, up), (len(points), 1)), fan))
    return joined(parts)


def _box(half: Sequence[float] | Array) -> Surface:
    parts = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            normal, across, along = _axes(axis, sign)
            points = np.array([normal + a * across + b * along for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]) * half
            parts.append(Surface(points, np.tile(normal, (4, 1)), np.array([[0, 1, 2], [0, 2, 3]])))
    return joined(parts)


def _axes(axis: int, sign: float) -> tuple[Array, Array, Array]:
    """A side's normal and the two directions along it, right-handed."""
    normal, across = sign * np.eye(3)[axis], np.eye(3)[(axis + 1) % 3]
    return normal, across, np.cross(normal, across)


def _grid(rows: int, columns: int) -> NDArray[np.int_]:
    """Triangles of a net of points, row by row from below, columns counterclockwise from above."""
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    right, above = corner + 1, corner + columns
    return np.concatenate([np.stack([corner, right, above + 1], 1), np.stack([corner, above + 1, above], 1)])
