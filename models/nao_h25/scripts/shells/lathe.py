"""Parts with clean rings of triangles: turned around an axis, or stacked over an outline."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from .meshes import Mesh, facing, tidy
from .solids import Array, unit


def turned(
    profile: Sequence[tuple[float, float]], origin: ArrayLike, axis: ArrayLike, sides: int = 24, soft: bool = False
) -> Mesh:
    """A part turned on a lathe.

    Args:
        profile: (radius, height) pairs, m, from the axis outwards on the seen side.
        origin: where height 0 lies, (3,) m.
        axis: the direction of height, (3,).
        sides: corners of the circle.
        soft: shade across the profile's corners instead of leaving them hard.
    """
    w = unit(axis)
    u = unit(np.cross(w, (0, 0, 1) if abs(w[2]) < abs(w[1]) + abs(w[0]) else (1, 0, 0)))
    turn = np.arange(sides) * 2 * np.pi / sides
    spokes = np.cos(turn)[:, None] * u + np.sin(turn)[:, None] * np.cross(w, u)
    bands = [_band(a, b, spokes, w) for a, b in pairwise(profile)]
    mesh = bands[0]
    for band in bands[1:]:
        mesh = mesh + band
    mesh = Mesh(mesh.points + np.asarray(origin), mesh.normals, mesh.faces)
    return tidy(_softened(mesh) if soft else mesh)


def stacked(outline: Array, layers: Sequence[tuple[float, float]]) -> Mesh:
    """A flat body with hard edges over an outline (N, 2) in x, y that its middle can see all of.

    Args:
        outline: the outline, counter-clockwise.
        layers: (inset, z) pairs, m, from the lower face, which is closed, to the upper, which is open;
            insets move the outline inwards.
    """
    along = np.roll(outline, -1, axis=0) - np.roll(outline, 1, axis=0)
    inwards = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.linalg.norm(along, axis=1, keepdims=True)
    rings = [np.column_stack([outline + inset * inwards, np.full(len(outline), z)]) for inset, z in layers]
    middle = np.append(outline.mean(axis=0), layers[0][1])
    rings = [np.tile(middle, (len(outline), 1)), *rings]
    mesh = _strip(rings[0], rings[1])
    for lower, upper in pairwise(rings[1:]):
        mesh = mesh + _strip(lower, upper)
    return tidy(mesh)


def _strip(lower: Array, upper: Array) -> Mesh:
    """The ring of triangles between two closed rings (N, 3), counter-clockwise seen from above."""
    n = len(lower)
    normals = np.cross(
        np.roll(lower, -1, axis=0) - np.roll(lower, 1, axis=0) + np.roll(upper, -1, axis=0) - np.roll(upper, 1, axis=0),
        upper - lower,
    )
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    i, j = np.arange(n), np.roll(np.arange(n), -1)
    faces = np.vstack([np.stack([i, j, n + i], 1), np.stack([j, n + j, n + i], 1)])
    return Mesh(np.vstack([lower, upper]), np.vstack([normals, normals]), faces)


def _band(a: tuple[float, float], b: tuple[float, float], spokes: Array, w: Array) -> Mesh:
    """One ring of a turned part, between two points of its profile."""
    n = len(spokes)
    points = np.vstack([a[0] * spokes + a[1] * w, b[0] * spokes + b[1] * w])
    slope = unit([a[1] - b[1], b[0] - a[0]])
    normals = np.tile(slope[0] * spokes + slope[1] * w, (2, 1))
    i, j = np.arange(n), np.roll(np.arange(n), -1)
    faces = np.vstack([np.stack([i, n + i, n + j], 1), np.stack([i, n + j, j], 1)])
    return Mesh(points, normals, facing(points, normals, faces))


def _softened(mesh: Mesh) -> Mesh:
    """The mesh with one shared normal wherever vertices coincide."""
    _, group = np.unique(np.round(mesh.points, 6), axis=0, return_inverse=True)
    group = group.ravel()
    total = np.zeros((group.max() + 1, 3))
    np.add.at(total, group, mesh.normals)
    shared = total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-9)
    return Mesh(mesh.points, shared[group], mesh.faces)
