"""Servo gains from the joint-space inertia; the README explains the choices.

For each joint j, with M the joint-space inertia matrix:

    armature   a  = J_rotor * ratio^2               rotor inertia through the gear
    inertia    I  = max over poses of M_jj + a      the largest load that it must move
    carried    C  = max over standing postures of   half of the robot above a fixed foot
    stiffness  kp = max(I * omega^2, C * omega_c^2, load / sag)     fast and stiff enough
    damping    kv = 2 * zeta * sqrt(kp * max(I, C))
    back-EMF   d3 = (F + load) / (overspeed * speed)^3     no torque is left to go faster
    reach      alpha = (F - G) / I                  acceleration it has in every pose, against gravity G

F is the motor's greatest torque, `load` the largest bias torque (gravity, and
in motion centrifugal and Coriolis torque) over the poses and `speed` the motor's no-load speed.  A leg both swings from the torso
and carries half of the robot; carrying, it is slower (omega_c), because a servo
that is as fast with the robot on it would throw its own foot about.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import mujoco
import numpy as np
from mjcf import build
from tables import MODEL, mirrored, table

POSES = 2000
STANDING = ("Stand", "StandInit", "StandZero", "Crouch")
Load = tuple[float, float, float, float]  # inertia moved and carried (kg m^2), bias and gravity torque (N m)


def gains(version: str) -> dict[str, dict[str, float]]:
    """Rows of gains by joint name, and one row `finger` for all finger joints."""
    facts, servo = table("facts.json"), table("servo.json")
    loads = _loads(facts)
    rows = {j["name"]: _row(j, version, servo, loads[j["name"]]) for j in facts["joints"]}
    rows["finger"] = {"damping": servo["finger_damping"], "damping_cubic": 0.0, "armature": servo["finger_armature"]}
    return rows


def _row(joint: Mapping[str, Any], version: str, servo: Mapping[str, Any], needs: Load) -> dict[str, float]:
    inertia, carried, load, gravity = needs
    force, speed = joint["max_torque_Nm"][version], joint["no_load_speed"][version]
    armature = servo["rotor_inertia_kg_m2"][str(joint["motor_type"][version])] * joint["motor_ratio"] ** 2
    inertia += armature
    moving, carrying = servo["omega_rad_per_s"], servo["carry_omega_rad_per_s"]
    kp = max(inertia * moving**2, carried * carrying**2, load / servo["sag_rad"])
    kv = 2.0 * servo["zeta"] * np.sqrt(kp * max(inertia, carried))
    cubic = (force + load) / (servo["overspeed"] * speed) ** 3
    row = {"kp": kp, "kv": kv, "force": force, "damping": 0.0, "damping_cubic": cubic, "armature": armature}
    row["acceleration"] = (force - gravity) / inertia
    return {key: float(f"{value:.4g}") for key, value in row.items()}


def _loads(facts: Mapping[str, Any]) -> dict[str, Load]:
    """Largest load of each joint, the same on both sides."""
    model = _bare_model(facts)
    data = mujoco.MjData(model)
    found: dict[str, np.ndarray] = {j["name"]: np.zeros(4) for j in facts["joints"]}
    for gravity in _random_motions(model, data, facts):
        full = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, full)
        for name in found:
            dof = model.joint(name).dofadr[0]
            need = (full[dof, dof], 0.0, abs(data.qfrc_bias[dof]), abs(gravity[dof]))
            found[name] = np.maximum(found[name], need)
    for _ in _standing_poses(model, data, facts):
        for name in (n for n in found if n[1:].startswith(("Hip", "Knee", "Ankle"))):
            found[name] = np.maximum(found[name], _carried(model, data, name))
    for left, right in ((name, mirrored(name)) for name in list(found)):
        found[left] = found[right] = np.maximum(found[left], found[right])
    for driver in (j["driven_by"] for j in facts["joints"] if "driven_by" in j):
        found[driver] = 2 * found[driver]  # one motor turns both legs
    return {name: (float(n[0]), float(n[1]), float(n[2]), float(n[3])) for name, n in found.items()}


def _bare_model(facts: Mapping[str, Any]) -> mujoco.MjModel:
    """The robot without gains: its links, joints and masses are all that is needed."""
    none = dict.fromkeys(("kp", "kv", "damping", "damping_cubic", "armature"), 0.0) | {"force": 1.0}
    xml = build({**{j["name"]: none for j in facts["joints"]}, "finger": none | {"armature": 1e-6}})
    return mujoco.MjModel.from_xml_string(xml, mesh_assets())


def mesh_assets() -> dict[str, bytes]:
    """The meshes by the path that the MJCF names them with."""
    return {f"assets/{path.name}": path.read_bytes() for path in (MODEL / "assets").glob("*.obj")}


def _random_motions(model: mujoco.MjModel, data: mujoco.MjData, facts: Mapping[str, Any]) -> Iterator[np.ndarray]:
    """Upright torso, every joint anywhere in its range and at any speed of its motor; yields gravity torques (nv,)."""
    random = np.random.default_rng(0)
    low, high = model.jnt_range[1:].T
    dofs = [model.joint(j["name"]).dofadr[0] for j in facts["joints"]]
    speeds = np.array([j["no_load_speed"]["v5"] for j in facts["joints"]])
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


def _carried(model: mujoco.MjModel, data: mujoco.MjData, joint: str) -> Load:
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
    return 0.0, float(inertia) / 2, abs(float(torque)) / 2, 0.0


def _subtree(model: mujoco.MjModel, root: int) -> set[int]:
    inside = {root}
    for body in range(root + 1, model.nbody):
        if model.body_parentid[body] in inside:
            inside.add(body)
    return inside
