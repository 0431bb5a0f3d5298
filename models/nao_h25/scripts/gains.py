"""Servo gains from the joint-space inertia; the README explains the choices.

For each joint j, with M the joint-space inertia matrix:

    armature   a  = J_rotor * ratio^2                 rotor inertia through the gear
    inertia    I  = max over poses of M_jj + a        what it swings
    carried    C  = max over standing postures of half of the robot above a fixed foot
    stiffness  kp = max(I * omega^2, C * omega_c^2, load / sag)
    damping    kv = kp * 2 * zeta / omega
    back-EMF   d3 = (F + load) / (overspeed * speed)^3      no torque is left to go faster
    speed      v  = ((F - G) / 2 d3)^(1/3)             fastest command; at it half the torque is left
    reach      alpha = s * min((F - G) / I, v / rise)       greatest acceleration of a command

F is the motor's greatest torque, `load` the largest bias torque (gravity, and
in motion centrifugal and Coriolis torque) over the poses, G its gravity part
and `speed` the motor's no-load speed.  One omega and one ratio kv / kp for all
joints: each follows its command with the same delay 2 zeta / omega, so the
robot follows the commanded path, only later.  Carrying the robot a leg is slower
(omega_c): stiffer, it would rattle its foot on the floor.  s, one number a limb, is the
largest at which all its joints can accelerate at once:
sum over k of max |M_jk| alpha_k <= F_j - G_j.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from mjcf import build
from tables import MODEL, mirrored, table

POSES = 2000
STANDING = ("Stand", "StandInit", "StandZero", "Crouch")


@dataclass
class Load:
    """What a joint has to move: inertias in kg m^2, torques in N m, each the largest over the poses."""

    inertia: float = 0.0
    carried: float = 0.0
    bias: float = 0.0
    gravity: float = 0.0

    def raise_to(self, **values: float) -> None:
        """Keep the larger of each."""
        for name, value in values.items():
            setattr(self, name, max(getattr(self, name), float(value)))


def gains(version: str) -> dict[str, dict[str, float]]:
    """Rows of gains by joint name, and one row `finger` for all finger joints."""
    facts, servo = table("facts.json"), table("servo.json")
    loads, coupled = _loads(facts, version)
    rows = {j["name"]: _row(j, version, servo, loads[j["name"]]) for j in facts["joints"]}
    _share_reach(rows, loads, coupled, facts)
    rows["finger"] = {"damping": servo["finger_damping"], "damping_cubic": 0.0, "armature": servo["finger_armature"]}
    return rows


def _row(joint: Mapping[str, Any], version: str, servo: Mapping[str, Any], load: Load) -> dict[str, float]:
    force, speed = joint["max_torque_Nm"][version], joint["no_load_speed"][version]
    armature = servo["rotor_inertia_kg_m2"][str(joint["motor_type"][version])] * joint["motor_ratio"] ** 2
    inertia, omega = load.inertia + armature, servo["omega_rad_per_s"]
    carry = servo["carry_omega_rad_per_s"]
    kp = max(inertia * omega**2, load.carried * carry**2, load.bias / servo["sag_rad"])
    kv = kp * 2.0 * servo["zeta"] / omega
    cubic = (force + load.bias) / (servo["overspeed"] * speed) ** 3
    spare = force - load.gravity
    command_speed = (spare / 2 / cubic) ** (1 / 3)
    reach = min(spare / inertia, command_speed / servo["rise_s"])
    row = {"kp": kp, "kv": kv, "force": force, "damping": 0.0, "damping_cubic": cubic, "armature": armature}
    row |= {"speed": command_speed, "acceleration": reach}
    return {key: float(f"{value:.4g}") for key, value in row.items()}


def _share_reach(
    rows: dict[str, dict[str, float]], loads: Mapping[str, Load], coupled: Mapping[str, np.ndarray], facts: Any
) -> None:
    """Scale the accelerations of each limb so that all its joints can have theirs at once."""
    names = [j["name"] for j in facts["joints"]]
    first = [j["name"] for j in facts["joints"] if j["parent"] == "torso"]
    for limb in np.split(names, [names.index(name) for name in first[1:]]):
        reach = {name: rows[name]["acceleration"] for name in limb}
        shares = []
        for name in limb:
            others = {k: coupled[name][names.index(k)] for k in limb if k != name}
            torque = (rows[name]["armature"] + loads[name].inertia) * reach[name]
            torque += sum(m * reach[k] for k, m in others.items())
            shares.append((rows[name]["force"] - loads[name].gravity) / torque)
        for name in limb:
            rows[name]["acceleration"] = float(f"{min(1.0, *shares) * reach[name]:.4g}")
    for left in names:  # the right leg hangs on the same hip motor as the left
        rows[mirrored(left)] |= {key: rows[left][key] for key in ("speed", "acceleration")}


def _loads(facts: Mapping[str, Any], version: str) -> tuple[dict[str, Load], dict[str, np.ndarray]]:
    """Largest load of each joint, the same on both sides, and the largest |M_jk| (26,) of its row of M.

    The masses are those of V5: V4 is 2 % lighter in all, V6 has a head 9 % heavier.
    """
    model = _bare_model(facts)
    data = mujoco.MjData(model)
    names = [j["name"] for j in facts["joints"]]
    dofs = [model.joint(name).dofadr[0] for name in names]
    found, coupled, full = {name: Load() for name in names}, np.zeros((26, 26)), np.zeros((model.nv, model.nv))
    for gravity in _random_motions(model, data, facts, version):
        mujoco.mj_fullM(model, data, full)
        coupled = np.maximum(coupled, np.abs(full[np.ix_(dofs, dofs)]))
        for name, dof in zip(names, dofs, strict=True):
            bias = abs(data.qfrc_bias[dof])
            found[name].raise_to(inertia=full[dof, dof], bias=bias, gravity=abs(gravity[dof]))
    for _ in _standing_poses(model, data, facts):
        for name in (n for n in names if n[1:].startswith(("Hip", "Knee", "Ankle"))):
            carried, torque = _carried(model, data, name)
            found[name].raise_to(carried=carried, bias=torque)
    for left, right in ((name, mirrored(name)) for name in names):
        found[left].raise_to(**vars(found[right]))
        found[right].raise_to(**vars(found[left]))
    for driver in (j["driven_by"] for j in facts["joints"] if "driven_by" in j):
        found[driver] = Load(**{key: 2.0 * value for key, value in vars(found[driver]).items()})  # turns both legs
    left = {mirrored(name): name for name in names if mirrored(name) != name}
    twins = [names.index(left.get(name, mirrored(name))) for name in names]
    coupled = np.maximum(coupled, coupled[np.ix_(twins, twins)])
    return found, dict(zip(names, coupled, strict=True))


def _bare_model(facts: Mapping[str, Any]) -> mujoco.MjModel:
    """The robot without gains: its links, joints and masses are all that is needed."""
    none = dict.fromkeys(("kp", "kv", "damping", "damping_cubic", "armature"), 0.0) | {"force": 1.0}
    xml = build({**{j["name"]: none for j in facts["joints"]}, "finger": none | {"armature": 1e-6}})
    return mujoco.MjModel.from_xml_string(xml, mesh_assets())


def mesh_assets() -> dict[str, bytes]:
    """The meshes by the path that the MJCF names them with."""
    return {f"assets/{path.name}": path.read_bytes() for path in (MODEL / "assets").glob("*.obj")}


def _random_motions(
    model: mujoco.MjModel, data: mujoco.MjData, facts: Mapping[str, Any], version: str
) -> Iterator[np.ndarray]:
    """Upright torso, every joint anywhere in its range and at any speed of its motor; yields gravity torques (nv,)."""
    random = np.random.default_rng(0)
    low, high = model.jnt_range[1:].T
    dofs = [model.joint(j["name"]).dofadr[0] for j in facts["joints"]]
    speeds = np.array([j["no_load_speed"][version] for j in facts["joints"]])
    for _ in range(POSES):
        data.qpos[7:] = random.uniform(low, high)
        data.qvel[:] = 0.0
        mujoco.mj_forward(model, data)
        gravity = data.qfrc_bias.copy()
        data.qvel[dofs] = random.uniform(-speeds, speeds)
        mujoco.mj_forward(model, data)
        yield gravity


def _standing_poses(model: mujoco.MjModel, data: mujoco.MjData, facts: Mapping[str, Any]) -> Iterator[None]:
    for posture in STANDING:
        mujoco.mj_resetData(model, data)
        for name, angle in facts["postures"][posture].items():
            data.joint(name).qpos[0] = angle
        mujoco.mj_forward(model, data)
        yield


def _carried(model: mujoco.MjModel, data: mujoco.MjData, joint: str) -> tuple[float, float]:
    """Its half of the inertia and gravity torque of all that stands on it when its foot is fixed."""
    beyond = _subtree(model, model.joint(joint).bodyid[0])
    axis, anchor = data.joint(joint).xaxis, data.joint(joint).xanchor
    inertia = torque = 0.0
    for body in range(1, model.nbody):
        if body in beyond:
            continue
        arm = data.xipos[body] - anchor
        turn = data.ximat[body].reshape(3, 3).T @ axis
        mass = model.body_mass[body]
        inertia += turn**2 @ model.body_inertia[body] + mass * (arm @ arm - (arm @ axis) ** 2)
        torque += axis @ np.cross(arm, mass * model.opt.gravity)
    return float(inertia) / 2, abs(float(torque)) / 2


def _subtree(model: mujoco.MjModel, root: int) -> set[int]:
    inside = {root}
    for body in range(root + 1, model.nbody):
        if model.body_parentid[body] in inside:
            inside.add(body)
    return inside
