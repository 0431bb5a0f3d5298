"""How true the collision shapes are: how far the robot's surface is outside them, and how much air they hold.

The surface is that of the shells in `assets/`, drawn to the published bounds; the published bounds themselves are
looked at besides.  A point of a link is covered by the link's own shapes, or by those of links that it never touches
(`collision.json`, "exclusions") if they cover it in every pose: an axle inside a hip, a disc inside a shoulder.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from mjcf import _both_sides, exclusions
from numpy.typing import NDArray
from scipy.spatial import ConvexHull
from tables import MODEL, table

from nao_sim.mujoco_model import JointMap, robot_alone
from nao_sim.robot import facts, load_robot

Array = NDArray[np.float64]
Shape = Sequence[Any]  # a row of collision.json
MEASURED = ("Neck",)  # has a shell, no shapes: torso and head are all round it
POSES, AT_THE_LIMITS = 120, 0.4  # random poses, share of joints that stand at an end of their range
CAST = 40_000  # points of the Monte Carlo that finds a volume
TOLERANCE = 0.003  # m, that a surface may be outside the shapes
NEARLY = 0.002  # m; points that own shapes leave farther outside are looked for in the neighbours' shapes


@dataclass(frozen=True)
class Coverage:
    """How well the shapes of a link fit it.

    Attributes:
        alone: m, farthest point of the surface outside the link's own shapes.
        farthest: m, the same where neighbours cover in every pose: what the rule of 3 mm is about.
        place: (3,) m, where that is in the link's frame.
        outside: share of the surface that is more than 3 mm outside.
        air: volume of the shapes that is outside the hull of the link and, in some pose, outside the neighbours'
            shapes, over the published hull volume.
        thickness: m, that volume over the area of the hull.
        deepest: m, the farthest that any of this air is from the hull.
        short: m, by how much the published bounds reach beyond the shapes.
    """

    alone: float
    farthest: float
    place: Array
    outside: float
    air: float
    thickness: float
    deepest: float
    short: float


def links() -> list[str]:
    """Links of the left side and the middle that have a shell."""
    return list(dict.fromkeys(shell["link"] for shell in table("assets/shells.json")["shells"]))


def measure(link: str, density: float = 2e6, cast: int = CAST) -> Coverage:
    """Measure one link.

    Args:
        link: of the left side or the middle.
        density: samples a m2 of surface; the corners of all triangles are looked at besides.
        cast: points that find the volume of air.
    """
    points, covered, alone = outside(link, density)
    # the corners of small triangles are many: they say how far, samples by area say how much
    by_area = covered[: len(points) - len(corners(link))]
    worst = int(covered.argmax())
    volume, deepest = air(link, cast)
    return Coverage(
        alone=float(alone.max()),
        farthest=float(covered[worst]),
        place=points[worst],
        outside=float((by_area > TOLERANCE).mean()),
        air=volume / facts()["shells"]["hull_volume_m3"][link],
        thickness=volume / ConvexHull(corners(link)).area,
        deepest=deepest,
        short=short_of_bounds(link),
    )


def outside(link: str, density: float) -> tuple[Array, Array, Array]:
    """Points (N, 3) m of a link's surface, how far (N,) m they are outside all shapes in the worst of poses, and
    how far outside the link's own.
    """
    points = surface(link, density)
    alone = depth(points, shapes(link))
    covered, unsure = alone.copy(), alone > NEARLY
    covered[unsure] = np.minimum(alone[unsure], covered_by_neighbours(link, points[unsure]))
    return points, covered, alone


def surface(link: str, density: float) -> Array:
    """(N, 3) m: points of the link's shells, spread by area, and then all corners of their triangles."""
    rng, found = np.random.default_rng(0), []
    for vertices, triangles in _meshes(link):
        a, b, c = vertices[triangles].swapaxes(0, 1)
        areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
        chosen = rng.choice(len(areas), int(areas.sum() * density), p=areas / areas.sum())
        root, share = np.sqrt(rng.random((len(chosen), 1))), rng.random((len(chosen), 1))
        found.append((1 - root) * a[chosen] + root * ((1 - share) * b[chosen] + share * c[chosen]))
    return np.vstack([*found, corners(link)])


def corners(link: str) -> Array:
    """(N, 3) m: the corners of all triangles of the link's shells."""
    return np.vstack([vertices for vertices, _ in _meshes(link)])


def shapes(link: str) -> list[Shape]:
    """The link's rows of collision.json, the right side's mirrored; soles are not among them."""
    return list(_tables().get(link, ()))


def depth(points: Array, rows: Sequence[Shape]) -> Array:
    """(N,) m: how far points (N, 3) are outside the nearest of some shapes, negative inside; inf without shapes."""
    least = np.full(len(points), np.inf)
    for _, radius, *ends in rows:
        start, end = np.array(ends[0]), np.array(ends[-1])
        axis = end - start
        along = np.clip((points - start) @ axis / max(axis @ axis, 1e-18), 0.0, 1.0)
        least = np.minimum(least, np.linalg.norm(points - start - along[:, None] * axis, axis=1) - radius)
    return least


def covered_by_neighbours(link: str, points: Array) -> Array:
    """(N,) m: how far points of the link are outside its neighbours' shapes, in the pose where that is most."""
    worst = np.full(len(points), -np.inf)
    for moved in seen_by(link, points):
        least = np.full(len(points), np.inf)
        for other, local in moved:
            least = np.minimum(least, depth(local, shapes(other)))
        worst = np.maximum(worst, least)
    return worst


def air(link: str, cast: int) -> tuple[float, float]:
    """Volume (m3) of the shapes' air, and how far (m) from the hull it goes."""
    own = shapes(link)
    if not own:
        return 0.0, 0.0
    low, high = bounds_of(own)
    points = np.random.default_rng(0).uniform(low, high, (cast, 3))
    inside = points[depth(points, own) < 0]
    beyond = outside_hull(inside, link)
    empty = beyond > 0
    exposed = covered_by_neighbours(link, inside[empty]) > 0
    return float(exposed.sum() / cast * np.prod(high - low)), float(beyond[empty][exposed].max(initial=0.0))


def outside_hull(points: Array, link: str) -> Array:
    """(N,) m: how far points (N, 3) are beyond the worst of the planes of the hull of the link's shells."""
    planes = ConvexHull(corners(link)).equations
    return np.asarray((points @ planes[:, :3].T + planes[:, 3]).max(axis=1, initial=-np.inf))


def bounds_of(rows: Sequence[Shape]) -> tuple[Array, Array]:
    """Least and greatest coordinates (3,) m of shapes."""
    ends = [(np.array(end), radius) for _, radius, *points in rows for end in points]
    return np.min([p - r for p, r in ends], axis=0), np.max([p + r for p, r in ends], axis=0)


def short_of_bounds(link: str) -> float:
    """By how much (m) the published bounds of a link reach beyond its own shapes."""
    if not (own := shapes(link)):
        return float("nan")
    (low, high), (lowest, highest) = np.array(facts()["shells"]["bounds_m"][link]), bounds_of(own)
    return float(max((lowest - low).max(), (high - highest).max()))


def neighbours(link: str) -> list[str]:
    """Links that the link never touches, those of them that have a shell."""
    if link in MEASURED:
        return ["torso", "Head"]
    pairs = exclusions(table("collision.json"))
    return sorted({other for pair in pairs if link in pair for other in pair if other != link})


def seen_by(link: str, points: Array) -> Iterator[list[tuple[str, Array]]]:
    """In one pose after the other: points (N, 3) of the link, in the frame of each neighbour."""
    places, turns, index = _frames()
    here, others = index[link], neighbours(link)
    for place, turn in zip(places, turns, strict=True):
        world = points @ turn[here].T + place[here]
        yield [(other, (world - place[index[other]]) @ turn[index[other]]) for other in others]


def hand(opening: float, density: float = 2e6) -> Array:
    """(N,) m: how far the surface of the left hand, 0 closed to 1 open, is outside the shapes of all its parts."""
    model, robot = robot_alone(), load_robot()
    data, pose = mujoco.MjData(model), np.zeros(len(robot.joint_names))
    pose[robot.index["LHand"]] = opening
    data.qpos[:] = JointMap(model).to_qpos(pose)
    mujoco.mj_kinematics(model, data)
    names = ["l_wrist", *neighbours("l_wrist")]
    parts = [data.body(name) for name in names if name != "LForeArm"]
    world = np.vstack([surface(part.name, density) @ part.xmat.reshape(3, 3).T + part.xpos for part in parts])
    local = [(shapes(part.name), (world - part.xpos) @ part.xmat.reshape(3, 3)) for part in parts]
    return np.asarray(np.min([depth(points, rows) for rows, points in local], axis=0))


def with_sole(density: float = 2e6) -> Array:
    """(N,) m: how far the surface of the left foot is outside its shapes and the box of its sole, whose world it is."""
    points, foot = surface("l_ankle", density), facts()["foot"]
    low = np.array([*(foot["box_left_m"][axis][0] for axis in "xy"), -facts()["foot_height_m"]])
    high = np.array(
        [*(foot["box_left_m"][axis][1] for axis in "xy"), low[2] + table("collision.json")["sole_thickness_m"]]
    )
    box = np.maximum(np.maximum(low - points, points - high), 0.0)
    return np.asarray(np.minimum(np.linalg.norm(box, axis=1), depth(points, shapes("l_ankle"))))


@functools.cache
def _frames() -> tuple[Array, Array, dict[str, int]]:
    """(poses, bodies, 3) places and (poses, bodies, 3, 3) axes of all links in poses all over the joints' ranges."""
    robot, rng = load_robot(), np.random.default_rng(0)
    shares = rng.random((POSES, len(robot.joint_names)))
    shares = np.where(rng.random(shares.shape) < AT_THE_LIMITS, shares.round(), shares)
    poses = robot.lower + shares * (robot.upper - robot.lower)
    poses[:, robot.index["RHipYawPitch"]] = poses[:, robot.index["LHipYawPitch"]]
    model = robot_alone()
    data, places, turns = mujoco.MjData(model), [], []
    for qpos in JointMap(model).to_qpos(poses):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        places.append(data.xpos.copy())
        turns.append(data.xmat.reshape(-1, 3, 3).copy())
    return np.array(places), np.array(turns), {model.body(i).name: i for i in range(model.nbody)}


@functools.cache
def _tables() -> dict[str, Any]:
    return dict(_both_sides(table("collision.json")["shapes"]))


@functools.cache
def _meshes(link: str) -> list[tuple[Array, NDArray[np.int_]]]:
    files = [shell["file"] for shell in table("assets/shells.json")["shells"] if shell["link"] == link]
    return [_obj(file) for file in files]


def _obj(file: str) -> tuple[Array, NDArray[np.int_]]:
    """Vertices (V, 3) m and triangles (T, 3) of an OBJ file of triangles."""
    lines = [line.split() for line in (MODEL / "assets" / file).read_text(encoding="utf-8").splitlines()]
    vertices = [words[1:4] for words in lines if words[:1] == ["v"]]
    triangles = [[word.split("/")[0] for word in words[1:4]] for words in lines if words[:1] == ["f"]]
    return np.array(vertices, float), np.array(triangles, int) - 1
