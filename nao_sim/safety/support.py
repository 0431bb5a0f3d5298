"""Soles, and what they span on the floor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from nao_sim.robot import Array

SOLES = ("left_sole", "right_sole")
_SIGNS = np.array([(1, 1, -1), (-1, 1, -1), (-1, -1, -1), (1, -1, -1)])  # counter-clockwise, seen from above

Edge = tuple[int, int]
Point = tuple[float, float]


def corners_in_geom(model: mujoco.MjModel, sole: str) -> Array:
    """The lower corners (4, 3) m of a sole in its own frame, counter-clockwise seen from above."""
    return np.asarray(_SIGNS * model.geom_size[model.geom(sole).id])


def sole_corners(model: mujoco.MjModel, data: mujoco.MjData, sole: str) -> Array:
    """The lower corners (4, 3) m of a sole where the model has it."""
    geom = model.geom(sole).id
    return np.asarray(data.geom_xpos[geom] + corners_in_geom(model, sole) @ data.geom_xmat[geom].reshape(3, 3).T)


@dataclass(frozen=True, eq=False)
class Support:
    """What a robot stands on, seen from above: the hull of its soles' corners.

    Attributes:
        normals: (E, 2) unit vectors inward from the edges.
        offsets: (E,) m; a point is `normals @ point - offsets` inside.
    """

    normals: Array
    offsets: Array

    @classmethod
    def of(cls, corners: Array) -> Support:
        """The hull of corners (N, 2) m."""
        starts, ends = corners[np.array(hull([(x, y) for x, y in corners.tolist()])).T]
        along = ends - starts
        normals = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
        return cls(normals, (normals * starts).sum(axis=1))

    def inside(self, points: Array) -> Array:
        """How far (..., E) m points (..., 2) are inside each edge."""
        return np.asarray(points @ self.normals.T - self.offsets)


def hull(points: Sequence[Point]) -> list[Edge]:
    """The edges of the convex hull of points, counter-clockwise (Andrew's monotone chain, 1979).

    Args:
        points: at least three, not all in a line.

    Returns:
        Indices of both ends of each edge.
    """
    order = sorted(range(len(points)), key=points.__getitem__)
    ring = _half(points, order) + _half(points, order[::-1])
    return list(zip(ring, ring[1:] + ring[:1], strict=True))


def _half(points: Sequence[Point], order: list[int]) -> list[int]:
    """The lower chain of points in their order, without its last one."""
    chain: list[int] = []
    for index in order:
        x, y = points[index]
        while len(chain) > 1:
            (ax, ay), (bx, by) = points[chain[-2]], points[chain[-1]]
            if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0.0:
                break
            chain.pop()
        chain.append(index)
    return chain[:-1]
