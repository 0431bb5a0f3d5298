"""The floor under both soles of a posed robot: the pose as put, seen from it."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from nao_sim.robot import Array
from nao_sim.safety.posed import PosedRobot
from nao_sim.safety.support import SOLES, corners_in_geom


class Floor:
    """A frame between the soles, in which a mirrored pose is seen mirrored.

    Its origin is midway between the lower faces of both soles, z the mean of
    their normals, x halves the angle between their headings.  What moves is
    told relative to it: soles that both stand do not.

    Args:
        posed: the robot; `update` must follow each `put`.

    Attributes:
        turn: (3, 3) its axes as columns, in the torso's frame.
        origin: (3,) m in the torso's frame.
        centre: (3,) m, the robot's centre of mass seen from it.
        between: (3,) m, the way from the left sole's middle to the right one's.
        half_length: m, of a sole.
    """

    def __init__(self, posed: PosedRobot) -> None:
        self._posed, model, data = posed, posed.model, posed.data
        self._geoms = geoms = [model.geom(sole).id for sole in SOLES]
        self._bodies = model.geom_bodyid[geoms]
        self._middles = [data.geom_xpos[geom] for geom in geoms]  # views, which follow the data
        self._turns = [data.geom_xmat[geom].reshape(3, 3) for geom in geoms]
        self._corners = [corners_in_geom(model, sole) for sole in SOLES]
        self.half_length, _, self._thickness = model.geom_size[geoms[0]].tolist()
        self._links = model.jnt_bodyid
        self._share = model.body_subtreemass[self._links] / model.body_subtreemass[0]
        self._soles = posed.movers[self._bodies]
        self._stands = self._soles.mean(axis=0)
        self.turn, self.origin = np.eye(3), np.zeros(3)
        self.centre, self.between = np.zeros(3), np.zeros(3)
        self._found: tuple[bytes, ...] = ()  # places and turns of the soles whose floor it is

    def update(self) -> None:
        """Find the floor of the pose as put, and the centre of mass over it."""
        data = self._posed.data
        mujoco.mj_comPos(self._posed.model, data)
        soles = tuple(view.tobytes() for view in (*self._middles, *self._turns))
        if soles != self._found:
            self._find()
            self._found = soles
        self.centre = self.seen(data.subtree_com[0])

    def _find(self) -> None:
        (left, right), (first, second) = self._turns, self._middles
        up = _unit(left[:, 2] + right[:, 2])
        ahead = left[:, 0] + right[:, 0]
        ahead = _unit(ahead - up * (up @ ahead))
        self.turn[:, 0], self.turn[:, 1], self.turn[:, 2] = ahead, _cross(up, ahead), up
        self.origin = (first + second) / 2.0 - self._thickness * up
        self.between = (second - first) @ self.turn

    def seen(self, points: Array) -> Array:
        """Points (..., 3) m of the torso's frame, seen from the floor."""
        return np.asarray((points - self.origin) @ self.turn)

    def corners(self) -> Array:
        """The lower corners (8, 3) m of both soles, those of the left one first."""
        parts = zip(self._corners, self._middles, self._turns, strict=True)
        return self.seen(np.concatenate([middle + corners @ turn.T for corners, middle, turn in parts]))

    def placement(self) -> Array:
        """Where the right sole is, seen from the left one: (6,) m along the floor's axes, and rad about them."""
        left, right = self._turns
        tilt = _cross(left[:, 2], right[:, 2])
        yaw = np.arctan2(_cross(left[:, 0], right[:, 0]) @ self.turn[:, 2], left[:, 0] @ right[:, 0])
        x, y, _ = (tilt @ self.turn).tolist()
        return np.array([*self.between.tolist(), x, y, yaw])

    def placement_moves(self) -> Array:
        """How the placement changes (6, 26) with the joint vector."""
        left, right = self.moves(self._bodies, np.array(self._middles))
        turned = self._posed.data.xaxis.T * (self._soles[1] - self._soles[0])
        return np.concatenate([right - left, self.turn.T @ turned @ self._posed.by_vector])

    def moves(self, bodies: NDArray[np.int_], points: Array) -> Array:
        """How points (N, 3) of the torso's frame, fixed to bodies (N,), move (N, 3, 26) m/rad on the floor."""
        movers = self._posed.movers[bodies] - self._stands
        return self._turning((points[:, None] - self._posed.data.xanchor) * movers[..., None] + self._turned_apart())

    def centre_moves(self) -> Array:
        """How the centre of mass moves (3, 26) m/rad."""
        return self._turning(self._centre_arms(self._stands) + self._turned_apart())

    def centre_moves_on(self, side: int) -> Array:
        """How the centre of mass moves (3, 26) m/rad over one sole alone: 0 left, 1 right."""
        return self._turning(self._centre_arms(self._soles[side]))

    def _centre_arms(self, stands: Array) -> Array:
        """Arms (joints, 3) m of the centre of mass, where `stands` (joints,) tells the joints that move what stands."""
        data = self._posed.data
        links = (data.subtree_com[self._links] - data.xanchor) * self._share[:, None]
        return np.asarray(links - (data.subtree_com[0] - data.xanchor) * stands[:, None])

    def _turned_apart(self) -> Array:
        """Arms (joints, 3) m that add what soles do that turn apart: each turns about its own middle."""
        first, second = self._middles
        return (self._soles[0] - self._soles[1])[:, None] * ((second - first) / 4.0)

    def _turning(self, arms: Array) -> Array:
        """How the ends of arms (..., joints, 3) that turn about the joints' axes move (..., 3, 26) m/rad."""
        x, y, z = arms[..., 0], arms[..., 1], arms[..., 2]
        u, v, w = self._posed.data.xaxis.T
        motion = np.stack([v * z - w * y, w * x - u * z, u * y - v * x], axis=-2)
        return np.asarray(self.turn.T @ (motion @ self._posed.by_vector))


def _unit(a: Array) -> Array:
    return np.asarray(a / (a @ a) ** 0.5)


def _cross(a: Array, b: Array) -> Array:
    """Of two vectors (3,); `np.cross` takes longer than all the rest."""
    (x, y, z), (u, v, w) = a.tolist(), b.tolist()
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])
