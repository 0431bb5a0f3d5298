"""Requests through guard and physics, and how far inside every safety law the simulated robot stayed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from nao_sim.robot import START_POSTURE, Array, Coupling, load_robot
from nao_sim.safety.change import Intervention
from nao_sim.safety.guard import Guard
from nao_sim.safety.trajectory_distance import smallest_distances
from nao_sim.simulation import measures
from nao_sim.simulation.rollout import Rollout
from nao_sim.simulation.scene import Base
from nao_sim.simulation.simulator import CONTROL_STEP, Simulator, State
from nao_sim.verdict import COUPLING_DEG, NEAREST_M

Step = Callable[[Array, float], tuple[Array, Intervention]]
TOUCHING = -1.0  # mm, at least, where links touched between two looks


@dataclass(frozen=True)
class Law:
    """What must hold after every request.

    Attributes:
        title: what is measured; more is better.
        unit: of it.
        least: a smaller value breaks the law.
    """

    title: str
    unit: str
    least: float


LAWS: Mapping[str, Law] = {
    "limit": Law("inside documented limits", "°", -float(np.degrees(measures.LIMIT_TOLERANCE))),
    "coupling": Law("inside limits set by another joint", "°", -COUPLING_DEG),
    "motor": Law("one command for one motor", "°", 0.0),
    "speed": Law("below no-load speed", "%", 0.0),
    "command": Law("self-distance of commands", "mm", 1e3 * NEAREST_M),
    "touch": Law("not touching, simulated", "mm", 0.0),
    "distance": Law("self-distance, simulated", "mm", 1e3 * NEAREST_M),
    "balance": Law("centre of mass inside the feet", "mm", 0.0),
    "fell": Law("tilt of the soles left before a fall", "°", 0.0),
}


@dataclass(frozen=True, eq=False)
class Trial:
    """What came of T requests.

    Attributes:
        commands: (T, 26) what the guard let through.
        interventions: what it changed.
        measured: (T,) for each law that applies, in its unit.
        warnings: how often the physics engine complained.
    """

    commands: Array
    interventions: list[Intervention]
    measured: Mapping[str, Array]
    warnings: int

    def violations(self, law: str) -> int:
        """Requests after which a law was broken."""
        return int((~(self.measured[law] >= LAWS[law].least)).sum())  # not a number breaks it, too

    @property
    def broken(self) -> dict[str, float]:
        """The laws that were broken, and the worst that was measured."""
        return {law: float(values.min()) for law, values in self.measured.items() if self.violations(law)}


def play(requests: Array, simulator: Simulator, step: Step | None = None) -> Trial:
    """Each of requests (T, 26) at 50 Hz, without any approach, from the start posture.

    Args:
        requests: as a file has them, gaps and all.
        simulator: whose robot is asked; it is reset.
        step: makes a command of each; a guard's if not given.
    """
    simulator.reset()
    robot = simulator.robot
    step = step or Guard(robot, robot.postures[START_POSTURE], standing=simulator.map.free).step
    commands, interventions, states = [], [], []
    for request in np.asarray(requests, np.float64):
        command, intervention = step(request, CONTROL_STEP)
        commands.append(command)
        interventions.append(intervention)
        states.append(simulator.step(command))
    time = CONTROL_STEP * np.arange(1.0, len(requests) + 1.0)
    rollout = Rollout.of(time, requests, commands, states)
    warnings = sum(warning.number for warning in simulator.data.warning)
    return Trial(rollout.command, interventions, measured(simulator, rollout, states), warnings)


def measured(simulator: Simulator, rollout: Rollout, states: list[State]) -> dict[str, Array]:
    """How far inside each law that applies the robot was in each control step, (T,) in its unit."""
    robot, done = simulator.robot, rollout.joint_positions
    lowest, highest, fastest = (np.array([getattr(s, n) for s in states]) for n in ("lowest", "highest", "fastest"))
    inside = np.minimum(lowest - robot.lower, robot.upper - highest)[:, ~robot.is_hand].min(axis=1)
    apart = 1e3 * smallest_distances(done)
    touching = np.array([bool(state.touching) for state in states])
    hips = rollout.command[:, [robot.index["LHipYawPitch"], robot.index["RHipYawPitch"]]]
    values = {
        "limit": np.degrees(inside),
        "motor": -np.degrees(np.abs(hips[:, 0] - hips[:, 1])),
        "coupling": -np.degrees(np.max([_beyond(coupling, done) for coupling in robot.couplings], axis=0)),
        "speed": 100.0 * (1.0 - (fastest / robot.no_load_speed).max(axis=1)),
        "command": 1e3 * smallest_distances(rollout.command),
        "touch": np.where(touching, np.minimum(apart, TOUCHING), apart),
        "distance": apart,
    }
    if simulator.map.free:
        stood = measures.stance(simulator.model, rollout)
        values |= {"balance": 1e3 * stood.margin, "fell": np.degrees(measures.FALLEN_TILT - stood.tilt)}
    return values


def _beyond(coupling: Coupling, positions: Array) -> Array:
    """How far (T,) rad a coupled joint is beyond its limits, negative inside."""
    lower, upper = coupling.bounds(positions[:, coupling.by])
    angle = positions[:, coupling.joint]
    return np.maximum(lower - angle, angle - upper)


@dataclass(frozen=True, eq=False)
class Case:
    """Requests that came nearest to breaking a law, kept so that they never will.

    Attributes:
        requests: (T, 26).
        base: how the robot is held.
        version: of the robot.
    """

    requests: Array
    base: Base
    version: str

    def save(self, path: Path) -> None:
        """Write the NPZ."""
        np.savez_compressed(path, requests=self.requests.astype(np.float32), base=self.base, version=self.version)

    @classmethod
    def load(cls, path: Path) -> Case:
        """Read what `save` wrote."""
        with np.load(path) as file:
            return cls(file["requests"].astype(np.float64), str(file["base"]), str(file["version"]))  # type: ignore[arg-type]

    def simulator(self) -> Simulator:
        """The robot that it is asked of."""
        return Simulator(load_robot(self.version), self.base)
