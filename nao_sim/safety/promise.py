"""The promise of every command: a full stop from here breaks no rule on poses."""

from __future__ import annotations

from collections.abc import Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

from nao_sim.robot import LEGS, Array, Robot
from nao_sim.safety.balance import Balance
from nao_sim.safety.coupling import CouplingRule
from nao_sim.safety.margins import Finding
from nao_sim.safety.posed import PosedRobot
from nao_sim.safety.rules import Rules
from nao_sim.safety.self_collision import ALLOWED, WIDEST, Links, SelfCollisionRule, clearance
from nao_sim.safety.standing import Standing

AIM = 0.0005  # m or rad; a way that slides along a rule keeps this much off it, for what is bent is not straight
STRIDE = 0.02  # m; between two looks no two parts of the robot move farther past each other


class Promise:
    """Looks along ways for the rules on poses that they break.

    Args:
        robot: whose rules hold.
        start: (26,) the posture that the robot is in.
        standing: whether it stands free on its feet.
        rules: which rules hold.
    """

    def __init__(self, robot: Robot, start: Array, standing: bool, rules: Rules) -> None:
        self._posed = PosedRobot(WIDEST + AIM, robot.version)
        self._coupling = CouplingRule(robot, standing) if rules.holds("coupling") else None
        self._collision = SelfCollisionRule(self._posed) if rules.holds("self_collision") else None
        self._lever = _levers(robot, self._posed)
        self._standing: Standing | None = None
        if standing and rules.holds("balance"):
            self._posed.put(self._posed.map.to_qpos(start))
            self._standing = Standing(Balance(robot, self._posed), self._posed, robot.joints_of(*LEGS), start)

    def coupled(self, pose: Array) -> Array:
        """The pose (26,) with each coupled joint inside the limits that the other one sets."""
        return self._coupling.nearest(pose) if self._coupling else pose

    def moved(self, position: Array, dt: float) -> None:
        """A command (26,) has been taken, `dt` (s) after the one before."""
        if self._standing:
            self._standing.moved(position, dt)

    def kept(self, line: Array, dt: float, rounding: float, allowed: Mapping[Links, float] = ALLOWED) -> bool:
        """Whether straight lines between poses (N, 26), the first left out, break no rule by more than `rounding`.

        Args:
            line: where the robot is, and where it would be after each step of `dt` (s).
            dt: s.
            rounding: m or rad.
            allowed: smaller clearances (m) of single pairs of links.
        """
        if self._coupling and self._coupling.broken(line, rounding):
            return False
        if self._standing and not self._standing.kept(line, dt, rounding):
            return False
        if self._collision:
            for qpos in self._posed.map.to_qpos(self._looks(line)[0]):
                self._posed.put(qpos)
                if self._collision.near(-rounding, allowed):
                    return False
        return True

    def allowed(self, poses: Array) -> bool:
        """Whether each of poses (N, 26) breaks no rule; what is between them is not looked at."""
        if self._coupling and any(self._coupling.broken(pose[None], 0.0) for pose in poses):
            return False
        for qpos in self._posed.map.to_qpos(poses):
            self._posed.put(qpos)
            if self._collision and self._collision.near(0.0):
                return False
            if self._standing and not self._standing.holds():
                return False
        return True

    def findings(
        self, line: Array, reach: Array, dt: float, within: float, allowed: Mapping[Links, float] = ALLOWED
    ) -> list[Finding]:
        """What straight lines between poses come nearer to than `within`: the worst of each rule and pair of links.

        Args:
            line: (N, 26); the first pose is where the way starts and not looked at.
            reach: (N, 26) s, derivatives of the poses by the speeds of the next step.
            dt: s, between them.
            within: m or rad.
            allowed: smaller clearances (m) of single pairs of links.
        """
        found = self._standing.findings(line, reach, dt) if self._standing else []
        if self._coupling:
            found += [Finding(m, m.gradient * there) for m, there in self._coupling.margins(line, reach, within)]
        return found + (self._collisions(self._collision, line, reach, within, allowed) if self._collision else [])

    def _collisions(
        self, rule: SelfCollisionRule, line: Array, reach: Array, within: float, allowed: Mapping[Links, float]
    ) -> list[Finding]:
        """The worst of each pair of links; slopes are only taken there."""
        poses, segment, share = self._looks(line)
        configurations = self._posed.map.to_qpos(poses)
        worst: dict[Links, tuple[float, int]] = {}
        for look, qpos in enumerate(configurations):
            self._posed.put(qpos)
            for value, links, _ in rule.near(within, allowed):
                worst[links] = min(worst.get(links, (np.inf, 0)), (value, look))
        found = []
        for look in sorted({look for _, look in worst.values()}):
            self._posed.put(configurations[look])
            before, part = segment[look], share[look]
            there = (1.0 - part) * reach[before] + part * reach[before + 1]
            for value, links, contact in rule.near(within, allowed):
                if worst.get(links) == (value, look):
                    margin = rule.margin(value, links, contact)
                    found.append(Finding(margin, margin.gradient * there))
        return found

    def distances(self, position: Array) -> dict[Links, float]:
        """The pairs of links of a pose (26,) that are nearer than the clearance, and how near (m)."""
        if not self._collision:
            return {}
        self._posed.put(self._posed.map.to_qpos(position))
        near: dict[Links, float] = {}
        for value, links, _ in self._collision.near(0.0):
            near[links] = min(near.get(links, np.inf), value + clearance(links))
        return near

    def _looks(self, line: Array) -> tuple[Array, NDArray[np.int_], Array]:
        """Points of a line, its start left out, between which no two limbs pass each other by more than the stride.

        Returns:
            Poses (M, 26), the segments that they are on (M,) and how far along them (M,), more than 0 to 1.
        """
        limbs = np.sort(np.abs(line[1:] - line[:-1]) @ self._lever, axis=1)
        travels = limbs[:, -1] + limbs[:, -2]
        segments = len(travels)
        if travels.max() <= STRIDE:
            return line[1:], np.arange(segments), np.ones(segments)
        pieces = np.maximum(np.ceil(travels / STRIDE).astype(int), 1)
        ends = np.cumsum(pieces)
        segment = np.repeat(np.arange(segments), pieces)
        share = (np.arange(ends[-1]) - (ends - pieces)[segment] + 1) / pieces[segment]
        return line[segment] * (1.0 - share[:, None]) + line[segment + 1] * share[:, None], segment, share


def _levers(robot: Robot, posed: PosedRobot) -> Array:
    """(26, limbs) m/rad: how far each joint moves the farthest point of its limb at most."""
    model = posed.model
    bodies = [int(model.jnt_bodyid[model.joint(name).id]) for name in robot.joint_names]
    carriers = [  # fingers hang on the wrist, as the hand's joint does
        model.body_parentid[b] if hand else b for b, hand in zip(bodies, robot.is_hand, strict=True)
    ]
    sizes = np.array([_size(model, int(body)) for body in carriers])
    return np.stack([np.where(robot.joints_of(limb), sizes, 0.0) for limb in robot.limbs], axis=1)


def _size(model: mujoco.MjModel, body: int) -> float:
    """Farthest (m) that anything a body carries can be from its origin."""
    shapes = np.flatnonzero(model.geom_bodyid == body)
    own = max((float(np.linalg.norm(model.geom_pos[i]) + model.geom_rbound[i]) for i in shapes), default=0.0)
    children = np.flatnonzero(model.body_parentid == body)
    return max([own, *(float(np.linalg.norm(model.body_pos[i])) + _size(model, int(i)) for i in children if i != body)])
