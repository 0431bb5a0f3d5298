"""What is laid on a solid: coloured plates, seams, and the spots where small parts sit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import Delaunay

from .meshes import Mesh, facing, tidy
from .solids import Array, Solid, outline_distance, resampled, unit


@dataclass(frozen=True)
class Plane:
    """Lays drawings on a solid by parallel projection.

    Attributes:
        origin: where (u, v) = (0, 0) is, (3,) m.
        outward: the direction towards the onlooker, (3,).
        right: the direction of u, (3,); v completes the right-handed frame (u, v, outward).
    """

    origin: ArrayLike
    outward: ArrayLike
    right: ArrayLike

    def rays(self, drawing: Array) -> tuple[Array, Array]:
        """Starts and directions (N, 3) of the rays through the points (N, 2) of a drawing, m."""
        w, u = unit(self.outward), unit(self.right)
        v = np.cross(w, u)
        starts = np.asarray(self.origin) + drawing @ np.stack([u, v]) + 0.2 * w
        return starts, np.broadcast_to(-w, starts.shape)


@dataclass(frozen=True)
class Drum:
    """Lays drawings on a solid from all around an axis: u is arc length at `radius`, v runs along it.

    Attributes:
        origin: a point of the axis, v = 0 there, (3,) m.
        axis: the direction of v, (3,).
        front: the direction in which u = 0 looks, (3,), square to the axis.
        radius: the radius at which u is measured, m.
    """

    origin: ArrayLike
    axis: ArrayLike
    front: ArrayLike
    radius: float

    def rays(self, drawing: Array) -> tuple[Array, Array]:
        """Starts and directions (N, 3) of the rays through the points (N, 2) of a drawing, m."""
        w, a = unit(self.axis), unit(self.front)
        turn = drawing[:, :1] / self.radius
        out = np.cos(turn) * a + np.sin(turn) * np.cross(w, a)
        return np.asarray(self.origin) + drawing[:, 1:] * w + 0.2 * out, -out


Chart = Plane | Drum


def panel(
    solid: Solid, chart: Chart, outline: ArrayLike, lift: float = 6e-4, grain: float = 0.007, rim: float = 0.0015
) -> Mesh:
    """A plate of even thickness on a solid, cut to an outline drawn on a chart.

    Args:
        solid: what the plate lies on.
        chart: how the drawing is projected.
        outline: closed outline (N, 2), m, counter-clockwise or not.
        lift: height of the plate over the surface, m.
        grain: side of its triangles, m.
        rim: depth of its side walls, m.
    """
    border = np.asarray(outline, float)
    length = np.linalg.norm(border - np.roll(border, -1, axis=0), axis=1).sum()
    border = resampled(np.vstack([border, border[:1]]), max(8, round(length / grain * 1.3)))
    drawing = np.vstack([border, _filling(border, grain)])
    faces = Delaunay(drawing).simplices
    faces = faces[outline_distance(border, drawing[faces].mean(axis=1)) < 0]
    points, normals = _cast(solid, chart, drawing, lift)
    top = tidy(Mesh(points, normals, facing(points, normals, faces)))
    return top + _wall(points[: len(border)], normals[: len(border)], rim) if rim else top


def seam(solid: Solid, chart: Chart, path: ArrayLike, width: float = 9e-4, lift: float = 2.5e-4) -> Mesh:
    """A thin line along a path (N, 2) m on a chart: the gap between two plastic parts."""
    line = np.asarray(path, float)
    along = np.gradient(line, axis=0)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    across *= width / 2 / np.linalg.norm(across, axis=1, keepdims=True)
    points, normals = _cast(solid, chart, np.vstack([line + across, line - across]), lift)
    n = len(line)
    i = np.arange(n - 1)
    faces = np.vstack([np.stack([i, n + i, i + 1], 1), np.stack([i + 1, n + i, n + i + 1], 1)])
    return Mesh(points, normals, facing(points, normals, faces))


def spot(solid: Solid, chart: Chart, at: tuple[float, float]) -> tuple[Array, Array]:
    """The point (3,) of a solid under the point `at` of a chart, and the outward normal (3,) there."""
    points, normals = _cast(solid, chart, np.array([at], float), 0.0)
    return points[0], normals[0]


def _filling(border: Array, grain: float) -> Array:
    """Points (N, 2) of a triangular grid inside a border, not too near to it."""
    lo, hi = border.min(axis=0), border.max(axis=0)
    rows = np.arange(lo[1], hi[1], grain * np.sqrt(3) / 2)
    columns = np.arange(lo[0] - grain, hi[0], grain)
    grid = np.array([(x + grain / 2 * (i % 2), y) for i, y in enumerate(rows) for x in columns])
    return grid[outline_distance(border, grid) < -0.55 * grain]


def _cast(solid: Solid, chart: Chart, drawing: Array, lift: float) -> tuple[Array, Array]:
    """Where the rays of a drawing first meet the solid, lifted, and the normals there."""
    points, direction = chart.rays(drawing)
    for _ in range(120):
        points = points + 0.8 * np.clip(solid.distance(points), -0.01, 0.02)[:, None] * direction
    normals = solid.normals(points)
    return points + lift * normals, normals


def _wall(rim: Array, normals: Array, depth: float) -> Mesh:
    """The side walls that a closed rim (N, 3) leaves when it sinks by `depth` against its normals."""
    n, foot = len(rim), rim - depth * normals
    along = np.roll(rim, -1, axis=0) - np.roll(rim, 1, axis=0)
    side = np.cross(along, normals)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    side *= np.sign((side * (rim - rim.mean(axis=0))).sum())
    i, j = np.arange(n), np.roll(np.arange(n), -1)
    faces = np.vstack([np.stack([i, n + i, n + j], 1), np.stack([i, n + j, j], 1)])
    points, sides = np.vstack([rim, foot]), np.vstack([side, side])
    return Mesh(points, sides, facing(points, sides, faces))
