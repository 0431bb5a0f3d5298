"""What the legs' motors bear while both soles stand: the robot's weight, shared by where it is between them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nao_sim.robot import LEGS, Array, Robot, gains
from nao_sim.safety.floor import Floor
from nao_sim.safety.posed import PosedRobot
from nao_sim.safety.support import SOLES

GRAVITY = 9.81  # m/s^2
# How two legs share what goes sideways, angles do not tell; of these torques the weight may take so much:
STRENGTH = {"HipPitch": 0.75, "KneePitch": 0.65, "AnklePitch": 0.65}


class Bearing:
    """Looks at how much of its motors' strength a standing robot needs.

    Args:
        robot: whose motors.
        posed: the robot that it looks at.
        floor: under it.
    """

    def __init__(self, robot: Robot, posed: PosedRobot, floor: Floor) -> None:
        self._posed, self._floor, model = posed, floor, posed.model
        self._turns = posed.data.geom_xmat.reshape(-1, 3, 3)
        self._soles = [model.geom(sole).id for sole in SOLES]
        weight = float(model.body_subtreemass[0]) * GRAVITY
        names = [side + name for side in "LR" for name in STRENGTH]
        self._joint = np.array([model.joint(name).id for name in names])
        self._index = np.array([robot.index[name] for name in names])
        self._side = [side for side in range(2) for _ in STRENGTH]
        self._strength = np.array([STRENGTH[name[1:]] * gains(robot.version)[name]["force"] for name in names]) / weight
        self._links = model.jnt_bodyid[self._joint]
        self._below = (model.body_subtreemass[self._links] / model.body_subtreemass[0]).tolist()
        self._legs = [robot.limbs[leg] for leg in LEGS]
        self._leg_joints = [np.array([model.joint(robot.joint_names[i]).id for i in leg]) for leg in self._legs]

    def levers(self) -> Array:
        """Levers (6,) m of the whole weight about HipPitch, KneePitch and AnklePitch, left and right.

        Each times the weight is the torque that the motor must hold if its leg
        carries all: how the centre of mass rises with the joint (virtual work).
        """
        data = self._posed.data
        (x, y, z), ups = data.subtree_com[0].tolist(), [self._turns[sole, :, 2].tolist() for sole in self._soles]
        carried, anchors = data.subtree_com[self._links].tolist(), data.xanchor[self._joint].tolist()
        levers = []  # by plain numbers: arrays of three of them cost more to handle than to compute with
        for place, (u, v, w) in enumerate(data.xaxis[self._joint].tolist()):
            (a, b, c), (i, j, k), up, below = anchors[place], carried[place], ups[self._side[place]], self._below[place]
            p, q, r = (i - a) * below - (x - a), (j - b) * below - (y - b), (k - c) * below - (z - c)
            levers.append(up[0] * (v * r - w * q) + up[1] * (w * p - u * r) + up[2] * (u * q - v * p))
        return np.array(levers)

    def margins(self) -> Array:
        """What is left (6,) of the levers that the motors can bear, m."""
        return np.asarray(self._strength - np.repeat(self._shares(), len(STRENGTH)) * np.abs(self.levers()))

    def gradients(self, rows: NDArray[np.int_]) -> Array:
        """How some of them change (N, 26) m/rad."""
        return np.array([self._gradient(int(row)) for row in rows])

    def _gradient(self, row: int) -> Array:
        side, lever = self._side[row], float(self.levers()[row])
        share = self._shares()[side]
        return np.asarray(-np.sign(lever) * share * self._lever_moves(row) - abs(lever) * self._share_moves(side))

    def _share_moves(self, side: int) -> Array:
        """How a share changes (26,) 1/rad."""
        between, centre = self._floor.between[:2], self._floor.centre[:2]
        apart, square = self._floor.placement_moves()[:2], between @ between
        right = (between @ self._floor.centre_moves()[:2] + centre @ apart) / square
        right -= 2.0 * (centre @ between) / square**2 * (between @ apart)
        return np.asarray((-1.0, 1.0)[side] * right * (0.0 < self._shares()[side] < 1.0))

    def _shares(self) -> tuple[float, float]:
        """How much of the weight the left and the right sole carry."""
        (x, y, _), (ahead, aside, _) = self._floor.between.tolist(), self._floor.centre.tolist()
        right = min(max(0.5 + (ahead * x + aside * y) / (x**2 + y**2), 0.0), 1.0)
        return 1.0 - right, right

    def _lever_moves(self, row: int) -> Array:
        """How a lever changes (26,) m/rad.

        The centre of mass goes round the axis of each joint, and what a joint
        moves turns with every joint between it and the sole.
        """
        side, joint = self._side[row], self._index[row]
        leg, turn = self._legs[side], self._turns[self._soles[side]]
        centre = turn.T @ self._floor.turn @ self._floor.centre_moves_on(side)
        axes = self._posed.data.xaxis[self._leg_joints[side]] @ turn
        place = int(np.flatnonzero(leg == joint)[0])
        change = axes[place, 1] * centre[0] - axes[place, 0] * centre[1]
        nearer = slice(place + 1, None)
        change[leg[nearer]] = axes[nearer, 1] * centre[0, joint] - axes[nearer, 0] * centre[1, joint]
        return np.asarray(change)
