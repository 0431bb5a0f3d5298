"""Fewer triangles for the skin of a solid: edges collapse, cheapest first, and stay on the solid.

Unlike a decimation that knows only the mesh, this one asks the solid: a collapsed edge leaves its vertex
on the surface, and a triangle may not turn away from the surface under it, so that shading stays smooth.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix

from .solids import Array, Solid

SHARED = 2  # neighbours that the ends of an edge have in common on a closed surface
FLATNESS = 0.06  # what an edge on a plane costs beside one that bends by as many radians
AGREEMENT = np.linspace(0.65, 0.0, 120)  # least cosine between a triangle and the surface at its corners, by round


def thinned(solid: Solid, points: Array, faces: np.ndarray, triangles: int) -> tuple[Array, np.ndarray]:
    """A closed mesh with about so many triangles.

    Args:
        solid: the body that the mesh covers.
        points: vertices (V, 3) on its surface, m.
        faces: vertex indices (F, 3).
        triangles: how many faces to leave.

    Returns:
        The vertices, some no longer used, and the faces that are left.
    """
    points, normals = points.copy(), solid.normals(points)
    reluctance = np.ones(len(points))
    for turn, agreement in enumerate(AGREEMENT):
        if len(faces) <= triangles:
            break
        if (turn + 1) % 4 == 0:
            faces = _flipped(points, normals, faces)
        if (turn + 1) % 12 == 0:
            points, normals = _relaxed(solid, points, normals, faces)
        edges = _edges(faces)
        chosen = _independent(edges, _costs(points, normals, edges) * reluctance[edges].max(axis=1), len(points))
        chosen = chosen[: max(1, (len(faces) - triangles + 1) // 2)]
        chosen, refused = _collapsible(solid, points, normals, faces, edges, chosen, agreement)
        reluctance[refused] *= 3.0
        heir = np.arange(len(points))
        heir[chosen[:, 1]] = chosen[:, 0]
        faces = heir[faces]
        faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    for _ in range(2):
        faces = _flipped(points, normals, faces)
        points, normals = _relaxed(solid, points, normals, faces)
    return points, faces


def _edges(faces: np.ndarray) -> np.ndarray:
    """The edges (E, 2) of a mesh, each once."""
    sides = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    size = int(sides.max()) + 1
    keys = np.unique(sides[:, 0] * size + sides[:, 1])
    return np.stack([keys // size, keys % size], axis=1)


def _costs(points: Array, normals: Array, edges: np.ndarray) -> Array:
    """What the loss of each edge costs: about its length times the angle that the surface turns on it."""
    a, b = edges.T
    length = np.linalg.norm(points[a] - points[b], axis=1)
    return length * (FLATNESS + np.linalg.norm(normals[a] - normals[b], axis=1))


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


def _collapsible(
    solid: Solid,
    points: Array,
    normals: Array,
    faces: np.ndarray,
    edges: np.ndarray,
    chosen: np.ndarray,
    agreement: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Moves both ends of each edge that may collapse to its middle on the surface.

    Returns:
        The edges (K, 2) that collapse, and the vertices of those that may not.
    """
    pairs = edges[chosen]
    middles = solid.settled(points[pairs].mean(axis=1), steps=3)
    directions = solid.normals(middles)
    good = _share_two_neighbours(edges, pairs, len(points))
    owner = np.full(len(points), -1)
    owner[pairs] = np.arange(len(pairs))[:, None]
    touched = owner[faces]
    mover = touched.max(axis=1)
    stays = (mover >= 0) & ((touched >= 0).sum(axis=1) == 1)
    ring, mover = faces[stays], mover[stays]
    moves = (touched[stays] >= 0)[..., None]
    corners = np.where(moves, middles[mover][:, None], points[ring])
    shades = np.where(moves, directions[mover][:, None], normals[ring])
    good[mover[~_agree(corners, shades, agreement)]] = False
    taken = pairs[good]
    points[taken] = middles[good][:, None]
    normals[taken] = directions[good][:, None]
    return taken, pairs[~good].ravel()


def _flipped(points: Array, normals: Array, faces: np.ndarray) -> np.ndarray:
    """The faces after flips of edges that see more than 180 degrees (Delaunay) and that the surface allows."""
    a, b, c, d, left, right = _diamonds(faces)
    wide = _angle(points, c, a, b) + _angle(points, d, a, b) > np.pi + 0.1
    new = np.stack([np.stack([a, d, c], 1), np.stack([d, b, c], 1)], axis=1)
    old = np.minimum(_facing(points, normals, faces[left]), _facing(points, normals, faces[right]))
    then = _facing(points, normals, new.reshape(-1, 3)).reshape(-1, 2).min(axis=1)
    size = len(points)
    present = np.isin(np.minimum(c, d) * size + np.maximum(c, d), np.minimum(a, b) * size + np.maximum(a, b))
    wanted = np.flatnonzero(wide & (then > np.minimum(0.8, old)) & ~present)
    _, first = np.unique(np.minimum(c, d)[wanted] * size + np.maximum(c, d)[wanted], return_index=True)
    wanted = wanted[np.sort(first)]
    claim = np.full(len(faces), len(a))
    for side in (left, right):
        np.minimum.at(claim, side[wanted], wanted)
    wanted = wanted[(claim[left[wanted]] == wanted) & (claim[right[wanted]] == wanted)]
    faces = faces.copy()
    faces[left[wanted]], faces[right[wanted]] = new[wanted, 0], new[wanted, 1]
    return faces


def _relaxed(solid: Solid, points: Array, normals: Array, faces: np.ndarray) -> tuple[Array, Array]:
    """The vertices drawn towards their neighbours along the surface, save where a face would turn away."""
    a, b = _edges(faces).T
    a, b = np.r_[a, b], np.r_[b, a]
    weight = np.maximum((normals[a] * normals[b]).sum(axis=1), 0.2) ** 6
    total = np.bincount(a, weight, len(points))
    used = total > 0
    mean = np.stack([np.bincount(a, weight * points[b, i], len(points)) for i in range(3)], axis=1)
    moved = points.copy()
    moved[used] = solid.settled(0.6 * points[used] + 0.4 * mean[used] / total[used, None], steps=2)
    shades = normals.copy()
    shades[used] = solid.normals(moved[used])
    for _ in range(3):
        worse = faces[_facing(moved, shades, faces) < np.minimum(0.75, _facing(points, normals, faces) - 1e-3)]
        moved[worse], shades[worse] = points[worse], normals[worse]
    return moved, shades


def _diamonds(faces: np.ndarray) -> tuple[np.ndarray, ...]:
    """The ends a, b of each inner edge, the corners c, d opposite to it, and the faces (a, b, c), (b, a, d)."""
    start, end, apex = faces.ravel(), np.roll(faces, -1, axis=1).ravel(), np.roll(faces, -2, axis=1).ravel()
    face = np.repeat(np.arange(len(faces)), 3)
    size = int(faces.max()) + 1
    forth, back = start * size + end, end * size + start
    order = np.argsort(forth)
    spot = np.searchsorted(forth, back, sorter=order).clip(0, len(order) - 1)
    twin = order[spot]
    inner = np.flatnonzero((forth[twin] == back) & (start < end))
    twin = twin[inner]
    return start[inner], end[inner], apex[inner], apex[twin], face[inner], face[twin]


def _angle(points: Array, apex: np.ndarray, a: np.ndarray, b: np.ndarray) -> Array:
    """The angles (N,) at `apex` between a and b."""
    u, v = points[a] - points[apex], points[b] - points[apex]
    return np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(axis=1))


def _facing(points: Array, normals: Array, faces: np.ndarray) -> Array:
    """The least cosine (F,) between each face and the surface at its corners."""
    sides = points[faces[:, 1:]] - points[faces[:, :1]]
    cross = np.cross(sides[:, 0], sides[:, 1])
    cross /= np.maximum(np.linalg.norm(cross, axis=1, keepdims=True), 1e-15)
    return (normals[faces] * cross[:, None]).sum(axis=2).min(axis=1)


def _agree(corners: Array, shades: Array, agreement: float) -> np.ndarray:
    """Whether triangles (T, 3, 3) are no slivers and face about as the normals (T, 3, 3) at their corners."""
    sides = np.roll(corners, -1, axis=1) - corners
    cross = np.cross(sides[:, 0], sides[:, 1])
    area = np.linalg.norm(cross, axis=1)
    plump = area > 0.12 * (sides**2).sum(axis=2).max(axis=1)
    facing = (shades * (cross / np.maximum(area, 1e-15)[:, None])[:, None]).sum(axis=2).min(axis=1)
    return plump & (facing > agreement)


def _share_two_neighbours(edges: np.ndarray, pairs: np.ndarray, vertices: int) -> np.ndarray:
    """Whether the ends of each pair have exactly two neighbours in common (else a collapse would pinch)."""
    a, b = np.vstack([edges, edges[:, ::-1]]).T
    near = coo_matrix((np.ones(len(a), np.int32), (a, b)), (vertices, vertices)).tocsr()
    return np.asarray(near[pairs[:, 0]].multiply(near[pairs[:, 1]]).sum(axis=1)).ravel() == SHARED
