"""The way round: a search for a free path where the straight one is barred.

RRT-Connect (Kuffner and LaValle, RRT-Connect: An Efficient Approach to
Single-Query Path Planning, ICRA 2000): two trees, one from either end, grow
toward the same targets and try to meet.  What is added here:

- The first targets are postures in which an arm has nothing around it.
- Many targets move one limb only, and trees are joined limb by limb: arms that
  bar each other's way mostly pass one after the other.
- The smaller tree grows, so that the end that is harder to leave gets the most tries.
- The path is shortened in time by straight short cuts (Geraerts and Overmars,
  Creating High-quality Paths for Motion Planning, IJRR 2007).

Of a problem and its mirror image always the same one is solved.  One that is its
own mirror image is first searched for paths that are their own, too.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from nao_sim.robot import Array, Mask, Robot
from nao_sim.safety.route import coarse_first, looks, places, short_cut, travel_time

Search = Generator[None, None, "Array | None"]
LIMIT = 60_000  # poses; then there is no way, or none that is worth waiting for
_SYMMETRIC_LIMIT = 10_000  # of them, for paths that are their own mirror image
_SHORTENING = 1_000  # poses looked at for short cuts, at most about
_SHORT_CUTS = 80  # tried
_STRIDE = 0.3  # rad between a tree's poses
_TOGETHER = 8  # poses that are looked at in one go
_TIED = 0.01  # rad; poses nearer than this to their mirror image count as their own
_NEARBY = 0.3  # rad, how far targets near a tree are from it, which leave narrow places
_NEARBY_SHARE, _ALL_SHARE = 0.2, 0.4  # of the targets: near the tree; for all limbs at once
_NOTICEABLE = 1e-9  # s saved
_LIGHT = {"WristYaw": 0.3, "Hand": 0.2, "ElbowYaw": 0.6}  # joints that count less for which pose is near
# Left arm, degrees: spread sideways, stretched forward, hanging away from the legs; the head is straight.
_OPEN_DEG = (
    {"ShoulderPitch": 20.0, "ShoulderRoll": 70.0, "ElbowYaw": 0.0, "ElbowRoll": -15.0},
    {"ShoulderPitch": 0.0, "ShoulderRoll": 15.0, "ElbowYaw": 0.0, "ElbowRoll": -5.0},
    {"ShoulderPitch": 75.0, "ShoulderRoll": 45.0, "ElbowYaw": -45.0, "ElbowRoll": -15.0},
)


class Detour:
    """A search for a free path, a little at a time.

    What it finds depends on the problem alone, not on how the work is sliced.

    Args:
        robot: whose limbs they are.
        free: whether all of poses (N, 26) obey every rule; the only thing that takes long.
        start: (26,) a free pose, which may touch what bars the way.
        goal: (26,) where to go; it differs from `start` only in `joints`.
        joints: (26,) which joints may move, of the arms and the head.
        bounds: lowest and highest angles, each (26,), that the search tries.

    Attributes:
        state: `searching`, then `found` or, after `LIMIT` poses or where the goal is not free, `failed`.
        path: (K, 26) from start to goal once it is found: corners of a way whose poses,
            at most `SAMPLING` rad apart, were all looked at; the start itself is not.
        looked: poses looked at so far.

    Raises:
        ValueError: start and goal differ in a joint that may not move.
    """

    def __init__(
        self,
        robot: Robot,
        free: Callable[[Array], bool],
        start: Array,
        goal: Array,
        joints: Mask,
        bounds: tuple[Array, Array],
    ) -> None:
        if (start != goal)[~joints].any():
            raise ValueError("start and goal differ in a joint that may not move")
        self.state: Literal["searching", "found", "failed"] = "searching"
        self.path: Array | None = None
        self.looked = 0
        self._granted = 0
        self._robot, self._free = robot, free
        lower, upper = (np.where(joints, bound, start) for bound in bounds)
        self._problem = self._settle(_Problem(start.copy(), goal.copy(), joints.copy(), lower, upper))
        self._search = self._searched()

    def _settle(self, asked: _Problem) -> _Problem:
        """This problem or its mirror image, whichever is to be solved of the two."""
        mirrored = asked.mirrored(self._robot)
        difference = asked.flat() - mirrored.flat()
        clear = difference[np.abs(difference) > _TIED]
        self._own_image = not len(clear)
        decisive = clear if len(clear) else difference[difference != 0.0]
        self._turned = bool(len(decisive) and decisive[0] < 0.0)
        return mirrored if self._turned else asked

    def work(self, poses: int) -> None:
        """Look at about so many more poses, a few more or fewer, unless the search is over before."""
        self._granted += poses
        while self.state == "searching" and self.looked < self._granted:
            try:
                next(self._search)
            except StopIteration as stop:
                self.state = "failed" if stop.value is None else "found"
                self.path = self._seen(stop.value) if stop.value is not None else None

    def _seen(self, poses: Array) -> Array:
        """Poses (N, 26) of the problem that is solved, as they are in the one that was asked, or back."""
        return self._robot.mirror(poses) if self._turned else poses

    def _clear(self, poses: Array) -> Generator[None, None, bool]:
        """Whether poses (N, 26) are free; the search may pause after each few."""
        for first in range(0, len(poses), _TOGETHER):
            few = poses[first : first + _TOGETHER]
            self.looked += len(few)
            free = self._free(self._seen(few))
            yield
            if not free:
                return False
        return True

    def _searched(self) -> Search:
        random = np.random.default_rng(0)
        if not (yield from self._clear(self._problem.goal[None])):
            return None
        path = None
        if self._own_image:
            path = yield from self._connected(random, _Limbs(self._robot, self._problem.joints, True), _SYMMETRIC_LIMIT)
        if path is None:
            path = yield from self._connected(random, _Limbs(self._robot, self._problem.joints, False), LIMIT)
        return None if path is None else (yield from self._shortened(random, path))

    def _connected(self, random: np.random.Generator, limbs: _Limbs, limit: int) -> Search:
        """A path by two trees, or none before `limit` poses have been looked at."""
        trees = _Tree(self._problem.start), _Tree(self._problem.goal)
        for order in limbs.orders:
            met = yield from self._joined(trees[0], 0, self._problem.goal, order)
            if met is not None:
                return trees[0].branch(met)
        openings = iter(limbs.openings(self._problem))
        for _ in range(limit):
            if self.looked >= limit:
                break
            grows, follows = trees if trees[0].size <= trees[1].size else trees[::-1]
            target, moving = next(openings, None) or self._target(random, limbs, grows)
            node = grows.nearest(target, limbs.weights * moving)
            reached = yield from self._extended(grows, node, np.where(moving, target, grows.poses[node]))
            if reached == node:
                continue
            pose = grows.poses[reached]
            nearest = follows.nearest(pose, limbs.weights)
            met = yield from self._joined(follows, nearest, pose, limbs.order(random, moving))
            if met is not None:
                path = np.concatenate([grows.branch(reached), follows.branch(met)[-2::-1]])
                return path if grows is trees[0] else path[::-1]
        return None

    def _target(self, random: np.random.Generator, limbs: _Limbs, tree: _Tree) -> tuple[Array, Mask]:
        """Where a tree should grow next, and which joints it should move there."""
        moving = limbs.some(random)
        if random.random() < _NEARBY_SHARE:
            near = tree.poses[random.integers(tree.size)]
            target = near + random.uniform(-_NEARBY, _NEARBY, len(near))
        else:
            target = random.uniform(self._problem.lower, self._problem.upper)
        return limbs.imaged(np.clip(target, self._problem.lower, self._problem.upper)), moving

    def _extended(self, tree: _Tree, node: int, target: Array) -> Generator[None, None, int]:
        """Grow straight from a node toward a target; the last node that is free to go to."""
        start = tree.poses[node]
        pieces = int(np.ceil(np.abs(target - start).max() / _STRIDE))
        for piece in range(1, pieces + 1):
            pose = target if piece == pieces else start + (target - start) * (piece / pieces)
            if not (yield from self._clear(looks(tree.poses[node], pose))):
                break
            node = tree.add(pose, node)
        return node

    def _joined(
        self, tree: _Tree, node: int, target: Array, order: tuple[Mask, ...]
    ) -> Generator[None, None, int | None]:
        """Grow to a target, some joints after the others; the node there, or none."""
        for moving in order:
            node = yield from self._extended(tree, node, np.where(moving, target, tree.poses[node]))
        return node if (tree.poses[node] == target).all() else None

    def _shortened(self, random: np.random.Generator, path: Array) -> Search:
        """The path with short cuts wherever they save time."""
        limits = self._robot.max_speed, self._robot.max_acceleration
        until = self.looked + _SHORTENING
        time = float(travel_time(np.diff(path, axis=0), *limits).sum())
        for number in range(_SHORT_CUTS):
            if self.looked >= until:
                break
            ends = np.sort(places(path, random.random(2)))
            before, cut, after = short_cut(path, *(ends if number % 2 else np.round(ends)))
            shorter = np.concatenate([before, cut, after])
            saved = time - float(travel_time(np.diff(shorter, axis=0), *limits).sum())
            if saved > _NOTICEABLE and (yield from self._clear(coarse_first(np.concatenate([cut[:1], looks(*cut)])))):
                path, time = shorter, time - saved
        return path


@dataclass(frozen=True, eq=False)
class _Problem:
    """What a detour is asked for; see there."""

    start: Array
    goal: Array
    joints: Mask
    lower: Array
    upper: Array

    def mirrored(self, robot: Robot) -> _Problem:
        """The same, seen in a mirror."""
        ends = robot.mirror(self.lower), robot.mirror(self.upper)
        start, goal, joints = robot.mirror(self.start), robot.mirror(self.goal), self.joints[robot.mirror_of]
        return _Problem(start, goal, joints, np.minimum(*ends), np.maximum(*ends))

    def flat(self) -> Array:
        """All its numbers in a row."""
        return np.concatenate([self.start, self.goal, self.joints.astype(float), self.lower, self.upper])


class _Limbs:
    """Which joints move together.

    Args:
        robot: whose limbs they are.
        joints: (26,) which may move.
        own_image: whether poses are to be their own mirror image; then both arms are one limb.

    Attributes:
        orders: sequences of limbs, all of which move once in each.
        weights: (26,) what a joint counts for which pose is near.
    """

    def __init__(self, robot: Robot, joints: Mask, own_image: bool) -> None:
        self._robot, self._joints, self._own_image = robot, joints, own_image
        names = [name for name in robot.limbs if not own_image or not name.startswith("R")]
        limbs = [joints & robot.joints_of(name) for name in names]
        if own_image:
            limbs = [limb | limb[robot.mirror_of] for limb in limbs]
        self._limbs = tuple(limb for limb in limbs if limb.any())
        self.orders = (joints,), self._limbs, self._limbs[::-1]
        self.weights = joints * np.array([_LIGHT.get(name.lstrip("LR"), 1.0) for name in robot.joint_names])

    def some(self, random: np.random.Generator) -> Mask:
        """All joints that may move, or those of one limb."""
        if random.random() < _ALL_SHARE:
            return self._joints
        return self._limbs[random.integers(len(self._limbs))]

    def order(self, random: np.random.Generator, first: Mask) -> tuple[Mask, ...]:
        """One of the orders, or one that begins with the limb that moved first."""
        return self.orders[random.integers(len(self.orders))] if first is self._joints else (first, *self._limbs)

    def imaged(self, pose: Array) -> Array:
        """The pose (26,) as it is, or made its own mirror image after its left side."""
        if not self._own_image:
            return pose
        pose = np.where(np.arange(len(pose)) > self._robot.mirror_of, self._robot.mirror(pose), pose)
        return (pose + self._robot.mirror(pose)) / 2.0

    def openings(self, problem: _Problem) -> Iterator[tuple[Array, Mask]]:
        """Postures with nothing around an arm, and which joints move there: all, then one limb alone."""
        robot = self._robot
        for table in _OPEN_DEG:
            pose = problem.start.copy()
            pose[robot.limbs["Head"]] = 0.0
            for name, angle in table.items():
                pose[robot.index[f"L{name}"]] = np.radians(angle)
            pose = np.where(np.arange(len(pose)) > robot.mirror_of, robot.mirror(pose), pose)
            for moving in (self._joints, *self._limbs):
                yield np.clip(pose, problem.lower, problem.upper), moving


class _Tree:
    """Poses that are reached from a root, each by a free straight way from its parent.

    Attributes:
        size: how many.
        poses: (size or more, 26).
    """

    def __init__(self, root: Array) -> None:
        self.poses = np.repeat(root[None], 256, axis=0)
        self.size = 1
        self._parents = [0]

    def add(self, pose: Array, parent: int) -> int:
        """The index of the new pose."""
        if self.size == len(self.poses):
            self.poses = np.concatenate([self.poses, self.poses])
        self.poses[self.size] = pose
        self._parents.append(parent)
        self.size += 1
        return self.size - 1

    def nearest(self, pose: Array, weights: Array) -> int:
        """The index of the pose that is nearest to another, by weighted (26,) joints."""
        gaps = (self.poses[: self.size] - pose) * weights
        return int(np.einsum("ij,ij->i", gaps, gaps).argmin())

    def branch(self, node: int) -> Array:
        """Poses (K, 26) from the root to a node."""
        nodes = [node]
        while nodes[-1]:
            nodes.append(self._parents[nodes[-1]])
        return self.poses[nodes[::-1]]
