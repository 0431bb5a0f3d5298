"""Solids as signed distance functions: negative inside, metres, composed with smooth blends.

The blends are the quadratic polynomial ones of Inigo Quilez (https://iquilezles.org/articles/smin/):
`k` is the width of the blend, so that a joint of two surfaces looks like a fillet of about that size.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline, PchipInterpolator

Array = NDArray[np.float64]
Distance = Callable[[Array], Array]

TINY = 1e-9  # m, in place of a zero that would divide


@dataclass(frozen=True)
class Solid:
    """A body in space.

    Attributes:
        distance: maps points (N, 3) m to signed distances (N,) m, exact near the surface or nearly so.
        lo: corner (3,) of a box that holds the surface.
        hi: the opposite corner.
    """

    distance: Distance
    lo: Array
    hi: Array

    def join(self, other: Solid, k: float = 0.0) -> Solid:
        """The union, its crease filled over the width `k`."""
        return Solid(
            lambda p: _smooth_min(self.distance(p), other.distance(p), k),
            np.minimum(self.lo, other.lo),
            np.maximum(self.hi, other.hi),
        )

    def meet(self, other: Solid, k: float = 0.0) -> Solid:
        """The intersection, its edge rounded over the width `k`."""
        return Solid(
            lambda p: -_smooth_min(-self.distance(p), -other.distance(p), k),
            np.maximum(self.lo, other.lo),
            np.minimum(self.hi, other.hi),
        )

    def cut(self, other: Solid, k: float = 0.0) -> Solid:
        """This solid without the other, the rim rounded over the width `k`."""
        return Solid(lambda p: -_smooth_min(-self.distance(p), other.distance(p), k), self.lo, self.hi)

    def normals(self, points: Array, step: float = 2e-4) -> Array:
        """Outward unit normals (N, 3) at points (N, 3), by central differences."""
        gradient = self._gradient(points, step)
        return gradient / np.maximum(np.linalg.norm(gradient, axis=1, keepdims=True), 1e-12)

    def settled(self, points: Array, steps: int = 4) -> Array:
        """Points (N, 3) near the surface moved onto it along the gradient (Newton)."""
        for _ in range(steps):
            gradient = self._gradient(points, 2e-4)
            slope = np.maximum((gradient**2).sum(axis=1), 1e-3)
            move = np.clip(self.distance(points) / slope, -1e-3, 1e-3)
            points = points - move[:, None] * gradient
        return points

    def _gradient(self, points: Array, step: float) -> Array:
        shifts = np.eye(3) * step
        columns = [self.distance(points + s) - self.distance(points - s) for s in shifts]
        return np.stack(columns, axis=1) / (2 * step)


def ellipsoid(center: ArrayLike, radii: ArrayLike) -> Solid:
    """An ellipsoid with semi-axes `radii` along x, y, z."""
    c, r = np.asarray(center, float), np.broadcast_to(np.asarray(radii, float), (3,))

    def distance(p: Array) -> Array:
        q = p - c
        k0, k1 = np.linalg.norm(q / r, axis=1), np.linalg.norm(q / r**2, axis=1)
        return k0 * (k0 - 1) / np.maximum(k1, 1e-9)

    return Solid(distance, c - r, c + r)


def box(lo: ArrayLike, hi: ArrayLike, radius: float = 0.0) -> Solid:
    """A box between two corners with edges rounded by `radius`."""
    a, b = np.asarray(lo, float), np.asarray(hi, float)
    center, half = (a + b) / 2, (b - a) / 2 - radius

    def distance(p: Array) -> Array:
        q = np.abs(p - center) - half
        outside = np.linalg.norm(np.maximum(q, 0), axis=1)
        return outside + np.minimum(q.max(axis=1), 0) - radius

    return Solid(distance, a, b)


def cylinder(start: ArrayLike, end: ArrayLike, radius: float, edge: float = 0.0) -> Solid:
    """A cylinder between the centres of its two faces, with rims rounded by `edge`."""
    a, b = np.asarray(start, float), np.asarray(end, float)
    length = float(np.linalg.norm(b - a))
    axis = (b - a) / length
    reach = radius * np.sqrt(np.maximum(1 - axis**2, 0))

    def distance(p: Array) -> Array:
        along = (p - a) @ axis
        across = np.linalg.norm(p - a - along[:, None] * axis, axis=1)
        q = np.stack([across - radius, np.abs(along - length / 2) - length / 2], axis=1) + edge
        return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0) - edge

    return Solid(distance, np.minimum(a, b) - reach, np.maximum(a, b) + reach)


def loft(axis: int, stations: Sequence[Sequence[float]], edge: float = 0.004) -> Solid:
    """A skin over superellipse sections, the workhorse of the drawing.

    Args:
        axis: the direction along which the sections are stacked: 0, 1 or 2 for x, y or z.
        stations: rows `(t, u_lo, u_hi, v_lo, v_hi, n)` with t rising along the axis; u and v are the
            two other axes in their cyclic order of x, y, z without `axis`; n is the exponent of the
            section |u|^n + |v|^n = 1: 2 is an ellipse, 4 almost a rectangle.
        edge: rounding of the two end faces, m.

    Returns:
        The solid. Squared half widths are interpolated (monotone cubic), so that sections that shrink
        towards an end close like a dome and no width exceeds the table.
    """
    table = np.asarray(stations, float)
    t, n = table[:, 0], table[:, 5]
    center = (table[:, 1:4:2] + table[:, 2:5:2]) / 2
    half = (table[:, 2:5:2] - table[:, 1:4:2]) / 2
    middle_at, half2_at, n_at = (PchipInterpolator(t, y) for y in (center, half**2, n))
    middle_slope, half2_slope = middle_at.derivative(), half2_at.derivative()
    others = [i for i in range(3) if i != axis]

    def distance(p: Array) -> Array:
        s = np.clip(p[:, axis], t[0], t[-1])
        half2 = np.maximum(half2_at(s), 1e-8)
        q, exponent = p[:, others] - middle_at(s), n_at(s)[:, None]
        power = (np.abs(q) / np.sqrt(half2)) ** exponent
        total = np.maximum(power.sum(axis=1, keepdims=True), 1e-12)
        ratio = total ** (1 / exponent)
        share = ratio * power / total
        across = share / np.where(q == 0, TINY, q)
        along = -(share * half2_slope(s) / (2 * half2) + across * middle_slope(s)).sum(axis=1)
        slope = np.sqrt((across**2).sum(axis=1) + along**2)
        side = (ratio[:, 0] - 1) / np.maximum(slope, 1.0)
        return -_smooth_min(-side, -np.maximum(t[0] - p[:, axis], p[:, axis] - t[-1]), edge)

    lo, hi = np.empty(3), np.empty(3)
    lo[axis], hi[axis] = t[0], t[-1]
    lo[others], hi[others] = table[:, 1:4:2].min(axis=0), table[:, 2:5:2].max(axis=0)
    return Solid(distance, lo, hi)


def half_space(point: ArrayLike, outward: ArrayLike) -> Solid:
    """Everything behind the plane through `point` whose normal is `outward`."""
    origin, normal = np.asarray(point, float), unit(outward)
    return Solid(lambda p: (p - origin) @ normal, np.full(3, -1.0), np.full(3, 1.0))


def both_sides(solid: Solid) -> Solid:
    """The solid and its mirror image in the plane y = 0, as one."""
    flip = np.array([1.0, -1.0, 1.0])
    lo, hi = solid.lo * flip, solid.hi * flip
    return solid.join(Solid(lambda p: solid.distance(p * flip), np.minimum(lo, hi), np.maximum(lo, hi)))


def smooth_outline(points: ArrayLike, count: int = 96) -> Array:
    """A closed periodic cubic spline (count, 2) through the points (N, 2), even in length."""
    knots = np.asarray(points, float)
    knots = np.vstack([knots, knots[:1]])
    chord = np.r_[0, np.cumsum(np.linalg.norm(np.diff(knots, axis=0), axis=1) ** 0.5)]
    dense = CubicSpline(chord, knots, bc_type="periodic")(np.linspace(0, chord[-1], 16 * count + 1))
    return resampled(dense, count)


def resampled(path: Array, count: int) -> Array:
    """`count` points at even distances along the closed path (N, 2) whose last point is its first."""
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))]
    at = np.linspace(0, length[-1], count, endpoint=False)
    return np.stack([np.interp(at, length, column) for column in path.T], axis=1)


def outline_distance(outline: Array, points: Array) -> Array:
    """Signed distances (N,) from points (N, 2) to a closed outline (M, 2), negative inside."""
    nearest = np.full(len(points), np.inf)
    inside = np.zeros(len(points), bool)
    for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        edge, q = b - a, points - a
        share = np.clip(q @ edge / (edge @ edge), 0, 1)
        nearest = np.minimum(nearest, ((q - share[:, None] * edge) ** 2).sum(axis=1))
        crosses = (a[1] > points[:, 1]) != (b[1] > points[:, 1])
        if a[1] != b[1]:
            inside ^= crosses & (q[:, 0] < (points[:, 1] - a[1]) * edge[0] / edge[1])
    return np.where(inside, -1, 1) * np.sqrt(nearest)


def unit(vector: ArrayLike) -> Array:
    """The vector scaled to length one."""
    v = np.asarray(vector, float)
    return v / np.linalg.norm(v)


def _smooth_min(a: Array, b: Array, k: float) -> Array:
    if k <= 0:
        return np.minimum(a, b)
    h = np.maximum(k - np.abs(a - b), 0) / k
    return np.minimum(a, b) - h * h * k / 4
