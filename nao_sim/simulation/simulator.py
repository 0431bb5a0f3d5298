"""The stepper: commands in at 50 Hz, what the simulated robot did out."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from nao_sim.mujoco_model import JointMap
from nao_sim.robot import START_POSTURE, Array, Robot, load_robot, read_only
from nao_sim.simulation.scene import Base, compile_scene

CONTROL_STEP = 0.02  # s, the period of the robot's own motion controller


@dataclass(frozen=True, eq=False)
class State:
    """What the robot did during one control step.

    Attributes:
        positions: (26,) at the end of the step, rad (hands 0..1).
        velocities: (26,) rad/s there.
        base_pose: (7,) of the torso, m and unit quaternion (x, y, z, qw, qx, qy, qz).
        lowest: (26,) smallest position of any physics step in it.
        highest: (26,) largest one.
        fastest: (26,) largest speed.
        touching: pairs of the robot's own links in contact at any time in it.
    """

    positions: Array
    velocities: Array
    base_pose: Array
    lowest: Array
    highest: Array
    fastest: Array
    touching: frozenset[tuple[str, str]]


class Simulator:
    """A NAO in MuJoCo, driven by its position actuators alone.

    Args:
        robot: which version.
        base: free-standing or pinned in the air.
        posture: vendor posture to start from.
        model: the same robot's scene, compiled already; several robots of one process may share it.
    """

    def __init__(
        self,
        robot: Robot | None = None,
        base: Base = "free",
        posture: str = START_POSTURE,
        model: mujoco.MjModel | None = None,
    ) -> None:
        self.robot = robot or load_robot()
        self.model = model or compile_scene(self.robot.version, base)
        self.data = mujoco.MjData(self.model)
        self.map = JointMap(self.model)
        self._substeps = round(CONTROL_STEP / self.model.opt.timestep)
        self._torso = self.model.body("torso").id
        self.reset(posture)

    def reset(self, posture: str = START_POSTURE) -> None:
        """Stand still in a vendor posture."""
        start = self.robot.postures[posture]
        mujoco.mj_resetData(self.model, self.data)
        if self.map.free:
            mujoco.mj_resetDataKeyframe(self.model, self.data, self.model.key(posture).id)
        else:
            self.data.qpos[:] = self.map.to_qpos(start)
        self.data.ctrl[:] = self.map.to_ctrl(start)
        mujoco.mj_forward(self.model, self.data)

    def step(self, command: Array) -> State:
        """Follow a command (26,) for one control step."""
        self.data.ctrl[:] = self.map.to_ctrl(command)
        track = np.empty((2, self._substeps, len(command)))
        touching: set[tuple[str, str]] = set()
        for i in range(self._substeps):
            mujoco.mj_step(self.model, self.data)
            track[0, i], track[1, i] = self.data.qpos[self.map.qpos], self.data.qvel[self.map.dofs]
            touching.update(self._touching())
        positions, velocities = track
        return State(
            positions=read_only(positions[-1]),
            velocities=read_only(velocities[-1]),
            base_pose=self.base_pose(),
            lowest=positions.min(axis=0),
            highest=positions.max(axis=0),
            fastest=np.abs(velocities).max(axis=0),
            touching=frozenset(touching),
        )

    def advance(self, command: Array) -> Array:
        """Follow a command (26,) for one control step as `step` does, noting only where the joints (26,) then are."""
        self.data.ctrl[:] = self.map.to_ctrl(command)
        mujoco.mj_step(self.model, self.data, self._substeps)
        return read_only(self.data.qpos[self.map.qpos])

    def base_pose(self) -> Array:
        """Pose (7,) of the torso."""
        return read_only(np.concatenate([self.data.xpos[self._torso], self.data.xquat[self._torso]]))

    def _touching(self) -> list[tuple[str, str]]:
        """Pairs of links in contact, the floor left out."""
        geoms = self.data.contact.geom
        # the floor is the world's only geometry, so it stands first in every pair it is in
        own = self.model.geom_bodyid[geoms[:, 0]] > 0
        if not own.any():
            return []
        bodies = self.model.geom_bodyid[geoms[own & (self.data.contact.dist < 0)]]
        return [(self.model.body(a).name, self.model.body(b).name) for a, b in bodies]
