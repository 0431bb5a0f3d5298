"""Write `nao_h25.urdf`, the twin of the MJCF for ROS and yourdfpy, from the compiled model."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import mujoco
import numpy as np
from tables import MODEL, numbers, table


def build() -> str:
    """The URDF: links with inertia, shells and collision shapes; joints with limits and mimics."""
    model = mujoco.MjModel.from_xml_path(str(MODEL / "nao_h25.xml"))
    robot = ET.Element("robot", name="nao_h25")
    robot.append(ET.Comment(" Written by scripts/build.py from nao_h25.xml; change the tables, not this file. "))
    for material in range(model.nmat):
        colour = ET.SubElement(robot, "material", name=model.mat(material).name)
        ET.SubElement(colour, "color", rgba=numbers(model.mat_rgba[material], 4))
    meshes = _mesh_files()
    for body in range(1, model.nbody):
        _link(robot, model, body, meshes)
    for joint in range(model.njnt):
        if model.jnt_type[joint] != mujoco.mjtJoint.mjJNT_FREE:
            _joint(robot, model, joint)
    for i in range(model.nsite):
        _frame(robot, model.site(i).name, model, model.site_bodyid[i], model.site_pos[i], model.site_quat[i])
    for i in range(model.ncam):
        _frame(robot, model.cam(i).name, model, model.cam_bodyid[i], model.cam_pos[i], model.cam_quat[i])
    ET.indent(robot)
    return '<?xml version="1.0"?>\n' + ET.tostring(robot, encoding="unicode") + "\n"


def _mesh_files() -> dict[str, tuple[str, str | None]]:
    """File and scale of each mesh asset of the MJCF."""
    root = ET.parse(MODEL / "nao_h25.xml").getroot()
    return {m.attrib["name"]: (m.attrib["file"], m.get("scale")) for m in root.iterfind("asset/mesh")}


def _link(robot: ET.Element, model: mujoco.MjModel, body: int, meshes: dict[str, tuple[str, str | None]]) -> None:
    link = ET.SubElement(robot, "link", name=model.body(body).name)
    inertial = ET.SubElement(link, "inertial")
    _origin(inertial, model.body_ipos[body], model.body_iquat[body])
    ET.SubElement(inertial, "mass", value=numbers(model.body_mass[body]))
    principal = model.body_inertia[body]
    tensor = dict(zip(("ixx", "iyy", "izz"), (numbers(x, 12) for x in principal), strict=True))
    ET.SubElement(inertial, "inertia", tensor | {"ixy": "0", "ixz": "0", "iyz": "0"})
    for geom in np.flatnonzero(model.geom_bodyid == body):
        _geometry(link, model, int(geom), meshes)


def _geometry(link: ET.Element, model: mujoco.MjModel, geom: int, meshes: dict[str, tuple[str, str | None]]) -> None:
    kind, size = model.geom_type[geom], model.geom_size[geom]
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        # MuJoCo moves a mesh to its own centre and axes; the file's frame is the link's
        file, scale = meshes[model.mesh(model.geom_dataid[geom]).name]
        visual = ET.SubElement(link, "visual")
        _origin(visual, np.zeros(3), np.array([1.0, 0, 0, 0]))
        ET.SubElement(ET.SubElement(visual, "geometry"), "mesh", {"filename": f"assets/{file}", **_scale(scale)})
        ET.SubElement(visual, "material", name=model.mat(model.geom_matid[geom]).name)
        return
    ends = [0.0]
    if kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        # URDF has no capsule: a cylinder with a sphere at each end is one
        _solid(link, model, geom, "cylinder", {"radius": numbers(size[0]), "length": numbers(2 * size[1])})
        ends = [-size[1], size[1]]
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        _solid(link, model, geom, "box", {"size": numbers(2 * size)})
        return
    for along in ends:
        _solid(link, model, geom, "sphere", {"radius": numbers(size[0])}, along)


def _scale(scale: str | None) -> dict[str, str]:
    return {"scale": scale} if scale else {}


def _solid(
    link: ET.Element, model: mujoco.MjModel, geom: int, kind: str, size: dict[str, str], along: float = 0.0
) -> None:
    collision = ET.SubElement(link, "collision")
    offset = np.empty(3)
    mujoco.mju_rotVecQuat(offset, np.array([0.0, 0.0, along]), model.geom_quat[geom])
    _origin(collision, model.geom_pos[geom] + offset, model.geom_quat[geom])
    ET.SubElement(ET.SubElement(collision, "geometry"), kind, size)


def _joint(robot: ET.Element, model: mujoco.MjModel, joint: int) -> None:
    name, body = model.joint(joint).name, model.jnt_bodyid[joint]
    element = ET.SubElement(robot, "joint", name=name, type="revolute")
    _origin(element, model.body_pos[body], model.body_quat[body])
    ET.SubElement(element, "parent", link=model.body(model.body_parentid[body]).name)
    ET.SubElement(element, "child", link=model.body(body).name)
    ET.SubElement(element, "axis", xyz=numbers(model.jnt_axis[joint]))
    facts = {j["name"]: j for j in table("facts.json")["joints"]}
    driver, ratio = _driver(model, joint)
    motor = facts.get(name) or facts[driver]
    low, high = model.jnt_range[joint]
    limits = {"lower": numbers(low), "upper": numbers(high)}
    limits["effort"] = numbers(motor["max_torque_Nm"]["v5"])
    limits["velocity"] = numbers(motor["no_load_speed"]["v5"])
    ET.SubElement(element, "limit", limits)
    if driver:
        ET.SubElement(element, "mimic", joint=driver, multiplier=numbers(ratio), offset="0")


def _driver(model: mujoco.MjModel, joint: int) -> tuple[str, float]:
    for equality in range(model.neq):
        if model.eq_obj1id[equality] == joint:
            return model.joint(model.eq_obj2id[equality]).name, float(model.eq_data[equality, 1])
    return "", 1.0


def _frame(robot: ET.Element, name: str, model: mujoco.MjModel, body: int, pos: np.ndarray, quat: np.ndarray) -> None:
    """A massless link fixed to `body`: how URDF knows sensors and effectors."""
    link = f"{name}_frame"
    ET.SubElement(robot, "link", name=link)
    joint = ET.SubElement(robot, "joint", name=f"{link}_joint", type="fixed")
    _origin(joint, pos, quat)
    ET.SubElement(joint, "parent", link=model.body(body).name)
    ET.SubElement(joint, "child", link=link)


def _origin(element: ET.Element, pos: np.ndarray, quat: np.ndarray) -> None:
    ET.SubElement(element, "origin", xyz=numbers(pos), rpy=numbers(_rpy(quat), 12))


def _rpy(quat: np.ndarray) -> np.ndarray:
    """Roll, pitch, yaw of a unit quaternion, R = Rz Ry Rx."""
    m = np.empty(9)
    mujoco.mju_quat2Mat(m, quat)
    m = m.reshape(3, 3)
    across = np.hypot(m[0, 0], m[1, 0])
    pitch = np.arctan2(-m[2, 0], across)
    if np.isclose(across, 0.0, atol=1e-9):  # roll and yaw turn about the same axis: give it all to roll
        return np.array([np.arctan2(-m[1, 2], m[1, 1]), pitch, 0.0])
    return np.array([np.arctan2(m[2, 1], m[2, 2]), pitch, np.arctan2(m[1, 0], m[0, 0])])
