"""Triangle meshes: their OBJ text, and the skins of solids."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from skimage.measure import marching_cubes

from .solids import Array, Solid
from .thinning import HIDDEN, thinned

SMOOTH = np.cos(0.75)  # normals at one vertex that agree by so much are one
INWARDS = 0.06  # how far from the corner towards its middle a triangle asks the solid for its normal


@dataclass(frozen=True)
class Mesh:
    """Triangles with one normal a vertex; an edge is hard where vertices are doubled.

    Attributes:
        points: vertices (V, 3), m, in the frame of the link.
        normals: outward unit normals (V, 3).
        faces: vertex indices (F, 3), counter-clockwise seen from outside.
    """

    points: Array
    normals: Array
    faces: np.ndarray

    def __add__(self, other: Mesh) -> Mesh:
        return Mesh(
            np.vstack([self.points, other.points]),
            np.vstack([self.normals, other.normals]),
            np.vstack([self.faces, other.faces + len(self.points)]),
        )

    def mirrored(self) -> Mesh:
        """The image in the plane y = 0."""
        flip = np.array([1.0, -1.0, 1.0])
        return Mesh(self.points * flip, self.normals * flip, self.faces[:, ::-1])

    def both_sides(self) -> Mesh:
        """The mesh together with its image in the plane y = 0."""
        return self + self.mirrored()

    def stretched(self, by: ArrayLike) -> Mesh:
        """The mesh stretched along x, y and z."""
        factors = np.asarray(by, float)
        normals = self.normals / factors
        return Mesh(self.points * factors, normals / np.linalg.norm(normals, axis=1, keepdims=True), self.faces)

    def moved(self, by: ArrayLike) -> Mesh:
        """The mesh moved by a vector."""
        return Mesh(self.points + np.asarray(by, float), self.normals, self.faces)

    def obj(self) -> str:
        """The mesh as Wavefront OBJ: points to 0.01 mm, normals to 0.01."""
        points = np.round(self.points, 5) + 0.0
        normals = np.round(self.normals, 2) + 0.0
        shades, shade = np.unique(normals, axis=0, return_inverse=True)
        lines = [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in points]
        lines += [f"vn {x:g} {y:g} {z:g}" for x, y, z in shades]
        shade = shade.ravel() + 1
        lines += ["f " + " ".join(f"{i + 1}//{shade[i]}" for i in face) for face in self.faces]
        return "\n".join(lines) + "\n"


def skin(solid: Solid, triangles: int, cell: float = 0.0016, hidden: Solid | None = None) -> Mesh:
    """The surface of a solid in about so many triangles: marching cubes, then thinning.

    Args:
        solid: the body.
        triangles: how many triangles to leave.
        cell: side of the cubes, m.
        hidden: where nobody can look; triangles inside are left out in the end.
    """
    lo, hi = solid.lo - 2 * cell, solid.hi + 2 * cell
    axes = [np.arange(a, b, cell) for a, b in zip(lo, hi, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    values = solid.distance(grid.reshape(-1, 3)).reshape(grid.shape[:3])
    points, faces, _, _ = marching_cubes(values, 0.0, spacing=(cell,) * 3, gradient_direction="descent")
    points, faces = _evened(solid, points + lo, faces), faces.astype(np.int64)
    seen = np.ones(len(faces))
    if hidden is not None:
        seen[hidden.distance(points[faces].mean(axis=1)) < 0] = HIDDEN
    points, faces = thinned(solid, points, faces, triangles, seen)
    if hidden is not None:
        faces = faces[(hidden.distance(points)[faces] >= 0).any(axis=1)]
    return tidy(_shaded(solid, points, faces))


def facing(points: Array, normals: Array, faces: np.ndarray) -> np.ndarray:
    """The faces, each wound so that its own normal agrees with those of its vertices."""
    a, b, c = (points[faces[:, i]] for i in range(3))
    wrong = (np.cross(b - a, c - a) * normals[faces].sum(axis=1)).sum(axis=1) < 0
    return np.where(wrong[:, None], faces[:, ::-1], faces)


def tidy(mesh: Mesh) -> Mesh:
    """The mesh without triangles that vanish at 0.01 mm and without unused vertices."""
    _, group = np.unique(np.round(mesh.points, 5), axis=0, return_inverse=True)
    corner = group.ravel()[mesh.faces]
    whole = (corner != np.roll(corner, 1, axis=1)).all(axis=1)
    used, faces = np.unique(mesh.faces[whole], return_inverse=True)
    return Mesh(mesh.points[used], mesh.normals[used], faces.reshape(-1, 3))


def _shaded(solid: Solid, points: Array, faces: np.ndarray) -> Mesh:
    """The mesh with the normals of the solid; a vertex on a sharp edge is doubled, one for each side of it."""
    corners = points[faces]
    beside = corners + INWARDS * (corners.mean(axis=1, keepdims=True) - corners)
    normals = solid.normals(solid.settled(beside.reshape(-1, 3), steps=2))
    owner = faces.ravel()
    new_points, new_normals, new = [], [], np.empty(len(owner), np.int64)
    order = np.argsort(owner, kind="stable")
    for group in np.split(order, np.flatnonzero(np.diff(owner[order])) + 1):
        left = group
        while len(left):
            mean = normals[left[0]]
            for _ in range(3):
                near = normals[left] @ mean > SMOOTH
                near[0] = True
                mean = normals[left[near]].sum(axis=0)
                mean = mean / np.linalg.norm(mean)
            new[left[near]] = len(new_points)
            new_points.append(points[owner[left[0]]])
            new_normals.append(mean)
            left = left[~near]
    return Mesh(np.array(new_points), np.array(new_normals), new.reshape(-1, 3))


def _evened(solid: Solid, points: Array, faces: np.ndarray, rounds: int = 3, pull: float = 0.5) -> Array:
    """The vertices drawn towards their neighbours and settled back, so that no sliver remains."""
    sides = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    a, b = np.vstack([sides, sides[:, ::-1]]).T
    count = np.bincount(a, minlength=len(points))
    for _ in range(rounds):
        mean = np.stack([np.bincount(a, points[b, i], len(points)) for i in range(3)], axis=1) / count[:, None]
        points = solid.settled(points + pull * (mean - points), steps=1)
    return np.round(points, 6)
