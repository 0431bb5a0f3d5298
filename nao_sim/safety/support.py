"""What a robot stands on: its soles, the hull of their corners, and a pose as seen from one of them."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from nao_sim.robot import Array, load_robot
from nao_sim.safety.posed import PosedRobot

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


def inside(point: Point, start: Point, end: Point) -> float:
    """How far (m) a point is to the left of an edge."""
    along = end[0] - start[0], end[1] - start[1]
    left = along[0] * (point[1] - start[1]) - along[1] * (point[0] - start[0])
    return float(left / (along[0] ** 2 + along[1] ** 2) ** 0.5)


def leftward(start: Array, end: Array) -> Array:
    """The unit vector (2,) to the left of an edge."""
    along = end - start
    return np.array([-along[1], along[0]]) / np.linalg.norm(along)


class Ground:
    """One sole of a posed robot, flat on the floor: the pose as put, seen from it.

    Places are in the sole's frame: its origin in the middle of the sole, z up
    from the floor.

    Args:
        posed: the robot; `mujoco.mj_comPos` must have followed its `put`.
        side: 0 left, 1 right.

    Attributes:
        corners: (4, 3) m of this sole, counter-clockwise.
        joints: (6,) indices of the leg's joints in the joint vector, hip first.
    """

    def __init__(self, posed: PosedRobot, side: int) -> None:
        self._posed, model, data, robot = posed, posed.model, posed.data, load_robot()
        geom, other = (model.geom(SOLES[i]).id for i in (side, 1 - side))
        self._body, self._other_body = model.geom_bodyid[geom], model.geom_bodyid[other]
        self._origin, self._turn = data.geom_xpos[geom], data.geom_xmat[geom].reshape(3, 3)
        self._height = model.geom_size[geom, 2]
        self.corners = corners_in_geom(model, SOLES[side]) + np.array([0.0, 0.0, self._height])
        self._other_in_geom = corners_in_geom(model, SOLES[1 - side])
        self._other_origin, self._other_turn = data.geom_xpos[other], data.geom_xmat[other].reshape(3, 3)
        self.joints = robot.limbs[("LLeg", "RLeg")[side]]
        leg = np.array([model.joint(robot.joint_names[i]).id for i in self.joints])
        links = model.jnt_bodyid[leg]
        self._axes, self._anchors = data.xaxis[_run(leg)], data.xanchor[_run(leg)]
        self._link_centres = data.subtree_com[_run(links)]
        self._below = model.body_subtreemass[links][:, None] / model.body_subtreemass[0]
        self._ends = np.where(model.geom_type == mujoco.mjtGeom.mjGEOM_CAPSULE, model.geom_size[:, 1], 0.0)
        self._radii = model.geom_size[:, 0]
        self._shape_axes = data.geom_xmat[:, 2::3]
        unit, zero = np.eye(len(robot.joint_names)), np.zeros(len(robot.joint_names))
        self._by_vector = (posed.map.to_qpos(unit) - posed.map.to_qpos(zero)).T
        self._jacobian = np.zeros((3, model.nv))

    def frame(self) -> tuple[Array, Array]:
        """The sole's axes as columns (3, 3), and the place (3,) m of its middle, in the torso's frame."""
        return self._turn.copy(), self._origin.copy()

    def seen(self, points: Array) -> Array:
        """Points (..., 3) m of the model."""
        places = (points - self._origin) @ self._turn
        places[..., 2] += self._height
        return np.asarray(places)

    def other_corners(self) -> Array:
        """The corners (4, 3) m of the other sole."""
        return self.seen(self._other_origin + self._other_in_geom @ self._other_turn.T)

    def centre(self) -> Array:
        """The robot's centre of mass (3,) m."""
        return self.seen(self._posed.data.subtree_com[0])

    def heights(self) -> Array:
        """How high (shapes,) m the lowest points of spheres and capsules are; of boxes it says nothing."""
        up, data = self._turn[:, 2], self._posed.data
        height = data.geom_xpos @ up - (self._origin @ up - self._height)
        return np.asarray(height - np.abs(self._shape_axes @ up) * self._ends - self._radii)

    def height_moves(self, shape: int) -> Array:
        """How the height of a sphere or capsule changes (26,) m/rad."""
        axis = self._shape_axes[shape]
        end = self._posed.data.geom_xpos[shape] - np.copysign(self._ends[shape], axis @ self._turn[:, 2]) * axis
        return np.asarray(self.moves(self._posed.model.geom_bodyid[shape], end)[2])

    def ankle(self) -> Array:
        """The ankle (3,) m."""
        return self.seen(self._anchors[-1])

    def levers(self) -> Array:
        """Levers (6,) m of the robot's weight about the leg's joints, when this leg carries all of it.

        Each times the robot's weight is the torque that the joint's motor
        must hold: how the centre of mass rises with the joint (virtual work).
        """
        carried = (
            self._posed.data.subtree_com[0] - self._below * self._link_centres - (1.0 - self._below) * self._anchors
        )
        arm, axis = carried @ self._turn, self._axes @ self._turn
        return np.asarray(arm[:, 0] * axis[:, 1] - arm[:, 1] * axis[:, 0])

    def share(self) -> float:
        """Share of the weight on this sole while both stand on the floor: by the distance to the middles of both."""
        (x, y), (other_x, other_y) = self.centre()[:2].tolist(), self.other_middle().tolist()
        return float(min(max(1.0 - (x * other_x + y * other_y) / (other_x**2 + other_y**2), 0.0), 1.0))

    def share_moves(self) -> Array:
        """How the share changes (26,) 1/rad."""
        centre, other = self.centre()[:2], self.other_middle()
        moves = self.moves(self._other_body, self._other_origin)[:2]
        square = other @ other
        nearer = (other @ self.centre_moves()[:2] + centre @ moves) / square
        change = 2.0 * (centre @ other) / square**2 * (other @ moves) - nearer
        return np.asarray(change * (0.0 < self.share() < 1.0))

    def other_middle(self) -> Array:
        """The middle (2,) m of the other sole, seen from above."""
        return np.asarray(((self._other_origin - self._origin) @ self._turn)[:2])

    def centre_moves(self) -> Array:
        """How the centre of mass moves (3, 26) m/rad with the joint vector."""
        model, data = self._posed.model, self._posed.data
        mujoco.mj_jacSubtreeCom(model, data, self._jacobian, 0)
        return self._relative(data.subtree_com[0])

    def corner_moves(self, corner: int) -> Array:
        """How a corner of the other sole moves (3, 26) m/rad."""
        return self.moves(self._other_body, self._other_origin + self._other_turn @ self._other_in_geom[corner])

    def edge_moves(self, point: Point, moves: Array, corners: Sequence[Point], edge: Edge) -> Array:
        """How the distance of a point from an edge changes (26,) m/rad.

        Args:
            point: (2,) m.
            moves: (2, 26) m/rad, of the point.
            corners: (4 or 8, 2) m, of this sole and then of the other one, which moves.
            edge: two of the corners.
        """
        start, end = (np.array(corners[i]) for i in edge)
        along = end - start
        share = float((point - start) @ along / (along @ along))
        for corner, part in zip(edge, (1.0 - share, share), strict=True):
            if corner >= len(self.corners):
                moves = moves - part * self.corner_moves(corner - len(self.corners))[:2]
        return np.asarray(leftward(start, end) @ moves)

    def moves(self, body: int, point: Array) -> Array:
        """How a point (3,) of the model, fixed to a body, moves (3, 26) m/rad."""
        mujoco.mj_jac(self._posed.model, self._posed.data, self._jacobian, None, point, body)
        return self._relative(point)

    def lever_moves(self, row: int) -> Array:
        """How the lever of one of the leg's joints changes (26,) m/rad.

        The centre of mass goes round the axis of each joint, and what a joint
        moves turns with every joint between it and the sole.
        """
        axis, centre, joint = self._axes @ self._turn, self.centre_moves(), self.joints[row]
        change = axis[row, 1] * centre[0] - axis[row, 0] * centre[1]
        nearer = slice(row + 1, None)
        change[self.joints[nearer]] = axis[nearer, 1] * centre[0, joint] - axis[nearer, 0] * centre[1, joint]
        return np.asarray(change)

    def _relative(self, point: Array) -> Array:
        """The motion in the buffer, less that of the same point if it were fixed to the sole."""
        motion = self._jacobian.copy()
        mujoco.mj_jac(self._posed.model, self._posed.data, self._jacobian, None, point, self._body)
        return np.asarray(self._turn.T @ (motion - self._jacobian) @ self._by_vector)


def _run(indices: Array) -> slice:
    """Indices in a row as a slice, which is a view and not a copy."""
    assert (np.diff(indices) == 1).all()
    return slice(indices[0], indices[-1] + 1)
