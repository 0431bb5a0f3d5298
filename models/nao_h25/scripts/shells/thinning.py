"""Fewer triangles for the skin of a solid: edges collapse, cheapest first, measured on the solid itself.

The cost of a collapse is the quadric error of Garland and Heckbert (SIGGRAPH 1997). Its planes are taken
from the solid, not from the mesh, so that vertices slide onto the sharp edges that marching cubes rounded.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix

from .solids import Array, Solid

SHARED = 2  # neighbours that the ends of an edge have in common on a closed surface
SHARE = 0.3  # part of the edges that are cheap enough to collapse in one round
ROUNDS = 400
EVENNESS = 2e-3  # how much a vertex holds to its place beside how much it holds to its planes
STRAIGHTNESS = 0.2  # least cosine between a triangle before and after a collapse
PLUMPNESS = 0.06  # least area of a triangle, beside its longest side squared
HIDDEN = 0.02  # weight of what nobody sees


def thinned(solid: Solid, points: Array, faces: np.ndarray, triangles: int, seen: Array) -> tuple[Array, np.ndarray]:
    """A closed mesh with about so many triangles.

    Args:
        solid: the body that the mesh covers.
        points: vertices (V, 3) on its surface, m.
        faces: vertex indices (F, 3).
        triangles: how many faces to leave.
        seen: how much each face (F,) counts, 0 to 1.

    Returns:
        The vertices, some no longer used, and the faces that are left.
    """
    points = points.copy()
    quadrics = _quadrics(solid, points, faces, seen)
    reluctance = np.ones(len(points))
    for _ in range(ROUNDS):
        if len(faces) <= triangles:
            break
        edges = _edges(faces)
        places, costs = _best(quadrics, points, edges)
        costs *= reluctance[edges].max(axis=1)
        chosen = _independent(edges, costs, len(points))
        chosen = chosen[costs[chosen] <= np.quantile(costs, SHARE)][: max(1, (len(faces) - triangles + 1) // 2)]
        good = _collapsible(points, faces, edges, edges[chosen], places[chosen])
        reluctance[edges[chosen[~good]]] *= 8.0
        chosen = chosen[good]
        keep, lose = edges[chosen].T
        points[keep] = places[chosen]
        quadrics[keep] += quadrics[lose]
        reluctance[keep] = 1.0
        heir = np.arange(len(points))
        heir[lose] = keep
        faces = heir[faces]
        faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    return solid.settled(points, steps=2), faces


def _quadrics(solid: Solid, points: Array, faces: np.ndarray, seen: Array) -> Array:
    """For each vertex the sum (V, 4, 4) of the squared distances to the planes of the faces around it."""
    corners = points[faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2 * seen
    middles = np.round(solid.settled(corners.mean(axis=1), steps=2), 7)  # rounded: the same on every machine
    normals = np.round(solid.normals(middles), 6)
    plane = np.column_stack([normals, -(normals * middles).sum(axis=1)])
    planes = plane[:, :, None] * plane[:, None, :] * area[:, None, None]
    quadrics, weight = np.zeros((len(points), 4, 4)), np.zeros(len(points))
    for corner in faces.T:
        np.add.at(quadrics, corner, planes)
        np.add.at(weight, corner, area)
    place = np.zeros((len(points), 4, 4))
    place[:, [0, 1, 2], [0, 1, 2]] = 1.0
    place[:, :3, 3] = place[:, 3, :3] = -points
    place[:, 3, 3] = (points**2).sum(axis=1)
    return quadrics + EVENNESS * weight[:, None, None] * place


def _best(quadrics: Array, points: Array, edges: np.ndarray) -> tuple[Array, Array]:
    """Where each edge had best collapse to (E, 3), and what that costs (E,)."""
    total = quadrics[edges[:, 0]] + quadrics[edges[:, 1]]
    middle = points[edges].mean(axis=1)
    firm = total[:, :3, :3]
    hold = 1e-3 * (firm[:, 0, 0] + firm[:, 1, 1] + firm[:, 2, 2]) + 1e-18
    place = _solved(firm + hold[:, None, None] * np.eye(3), hold[:, None] * middle - total[:, :3, 3])
    length = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1, keepdims=True)
    step = place - middle
    step *= np.minimum(1.0, length / np.maximum(np.linalg.norm(step, axis=1, keepdims=True), 1e-12))
    place = middle + step
    full = np.column_stack([place, np.ones(len(place))])
    return place, np.maximum((full[:, :, None] * total * full[:, None, :]).sum(axis=(1, 2)), 0.0)


def _solved(matrices: Array, right: Array) -> Array:
    """x (E, 3) in M x = right for symmetric M (E, 3, 3), by Cramer's rule."""
    a, b, c = matrices[:, 0], matrices[:, 1], matrices[:, 2]
    across = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1)
    return (right[:, :, None] * across).sum(axis=1) / (a * across[:, 0]).sum(axis=1)[:, None]


def _edges(faces: np.ndarray) -> np.ndarray:
    """The edges (E, 2) of a mesh, each once."""
    sides = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    size = int(sides.max()) + 1
    keys = np.unique(sides[:, 0] * size + sides[:, 1])
    return np.stack([keys // size, keys % size], axis=1)


def _independent(edges: np.ndarray, costs: Array, vertices: int) -> np.ndarray:
    """Edges so far apart that they can collapse together: none is next to a cheaper one. Cheapest first."""
    rank = np.empty(len(edges), np.int64)
    rank[np.argsort(costs, kind="stable")] = np.arange(len(edges))
    best = np.full(vertices, len(edges))
    for ends in edges.T:
        np.minimum.at(best, ends, rank)
    around = best.copy()
    for here, there in (edges.T, edges.T[::-1]):
        np.minimum.at(around, here, best[there])
    free = np.flatnonzero((rank == around[edges[:, 0]]) & (rank == around[edges[:, 1]]))
    return free[np.argsort(rank[free])]


def _collapsible(points: Array, faces: np.ndarray, edges: np.ndarray, pairs: np.ndarray, places: Array) -> np.ndarray:
    """Which of the edges `pairs` (K, 2) may collapse to `places` (K, 3): no triangle may flip or turn a sliver."""
    good = _share_two_neighbours(edges, pairs, len(points))
    owner = np.full(len(points), -1)
    owner[pairs] = np.arange(len(pairs))[:, None]
    touched = owner[faces]
    mover = touched.max(axis=1)
    stays = (mover >= 0) & ((touched >= 0).sum(axis=1) == 1)
    ring, mover = points[faces[stays]], mover[stays]
    moved = np.where((touched[stays] >= 0)[..., None], places[mover][:, None], ring)
    before, plump_before = _spread(ring)
    after, plump = _spread(moved)
    fine = ((before * after).sum(axis=1) > STRAIGHTNESS) & (plump > np.minimum(PLUMPNESS, 0.99 * plump_before))
    good[mover[~fine]] = False
    return good


def _spread(corners: Array) -> tuple[Array, Array]:
    """The unit normals (T, 3) of triangles (T, 3, 3), and their area beside the longest side squared (T,)."""
    sides = np.roll(corners, -1, axis=1) - corners
    cross = np.cross(sides[:, 0], sides[:, 1])
    double = np.linalg.norm(cross, axis=1)
    longest = (sides**2).sum(axis=2).max(axis=1)
    return cross / np.maximum(double, 1e-15)[:, None], double / 2 / np.maximum(longest, 1e-15)


def _share_two_neighbours(edges: np.ndarray, pairs: np.ndarray, vertices: int) -> np.ndarray:
    """Whether the ends of each pair have exactly two neighbours in common (else a collapse would pinch)."""
    a, b = np.vstack([edges, edges[:, ::-1]]).T
    near = coo_matrix((np.ones(len(a), np.int32), (a, b)), (vertices, vertices)).tocsr()
    return np.asarray(near[pairs[:, 0]].multiply(near[pairs[:, 1]]).sum(axis=1)).ravel() == SHARED
