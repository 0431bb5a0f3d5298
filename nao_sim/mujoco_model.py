"""Where the joint vector is in a compiled MuJoCo model of the robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nao_sim.paths import MODEL
from nao_sim.robot import Array, facts, load_robot, read_only

if TYPE_CHECKING:
    import mujoco


class JointMap:
    """Translates between the 26-joint vector and a model's `qpos`, `qvel` and `ctrl`.

    The eight finger joints of a hand follow its opening; the free base, where
    the model has one, comes first in `qpos`.

    Args:
        model: a compiled model that holds one NAO under its own names.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        names = load_robot().joint_names
        fingers = facts()["hand"]["finger_joints"]
        self.nq = model.nq
        self.free = model.nq > len(names) + len(fingers)
        self.qpos = read_only([model.joint(name).qposadr[0] for name in names], np.int_)
        self.dofs = read_only([model.joint(name).dofadr[0] for name in names], np.int_)
        self._finger_qpos = read_only([model.joint(finger["name"]).qposadr[0] for finger in fingers], np.int_)
        self._finger_hand = read_only([names.index(finger["driven_by"]) for finger in fingers], np.int_)
        self._finger_ratio = read_only([finger["multiplier"] for finger in fingers])
        actuators = [model.actuator(i).name for i in range(model.nu)]
        self._ctrl_joint = read_only([names.index(name) for name in actuators], np.int_)

    def to_qpos(self, positions: Array, base_pose: Array | None = None) -> Array:
        """Configurations (..., nq) of joint positions (..., 26) and base poses (..., 7; x y z, qw qx qy qz)."""
        qpos = np.zeros((*positions.shape[:-1], self.nq))
        if self.free:
            qpos[..., :7] = (0, 0, 0, 1, 0, 0, 0) if base_pose is None else base_pose
        qpos[..., self.qpos] = positions
        qpos[..., self._finger_qpos] = positions[..., self._finger_hand] * self._finger_ratio
        return qpos

    def to_ctrl(self, command: Array) -> Array:
        """Actuator targets (nu,) of a command (26,)."""
        return command[self._ctrl_joint]


def robot_alone(margin: float = 0.0, version: str = "v5") -> mujoco.MjModel:
    """The robot without floor and shells, its torso fixed: for questions about poses.

    Args:
        margin: m; shapes nearer than this make a contact.  It must be known
            here: MuJoCo keeps the largest margin of each body for its first,
            coarse look, and does not notice when the shapes' margins change later.
        version: whose masses it has; the shapes are those of all.
    """
    return robot_alone_spec(margin, version).compile()


def robot_alone_spec(margin: float = 0.0, version: str = "v5") -> mujoco.MjSpec:
    """`robot_alone` before it is compiled, for those who add to it."""
    import mujoco

    spec = mujoco.MjSpec.from_file(str(MODEL / "nao_h25.xml"))
    for key in list(spec.keys):
        spec.delete(key)
    spec.delete(spec.joint("root"))
    for geom in list(spec.geoms):
        if geom.type == mujoco.mjtGeom.mjGEOM_MESH:
            spec.delete(geom)
        else:
            geom.margin = margin / 2.0  # MuJoCo adds the margins of both shapes
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_MIDPHASE  # a few shapes a link: trees of them only cost
    for mesh in list(spec.meshes):
        spec.delete(mesh)
    for link, changes in facts()["versions"][version]["links"].items():
        body = spec.body(link)
        body.mass, body.ipos = changes.get("mass_kg", body.mass), changes.get("com_m", body.ipos)
    return spec
