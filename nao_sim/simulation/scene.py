"""The scene, composed with dm_control.mjcf: the robot on its floor, in any version, free or pinned."""

from __future__ import annotations

from typing import Any, Literal

import mujoco
from dm_control import mjcf

from nao_sim.paths import MODEL
from nao_sim.robot import facts, gains

Base = Literal["free", "pinned"]
PINNED_FLOOR = -0.12  # m; the toes of a straight leg, pointing down, reach to -0.07


def compose(version: str = "v5", base: Base = "free") -> mjcf.RootElement:
    """The scene as an MJCF tree that may be changed further.

    Args:
        version: robot version, `v4`, `v5` or `v6`.
        base: `free` stands on its feet; `pinned` holds the torso in the air.
    """
    root = mjcf.from_path(str(MODEL / "scene.xml"))
    if version != "v5":
        _make_version(root, version)
    if base == "pinned":
        # keyframes hold the base pose too, which a pinned robot does not have
        root.keyframe.remove()
        root.find("joint", "root").remove()
        root.find("geom", "floor").pos = (0.0, 0.0, PINNED_FLOOR)
    return root


def compile_scene(version: str = "v5", base: Base = "free") -> mujoco.MjModel:
    """The compiled scene."""
    return compiled(compose(version, base))


def compiled(scene: mjcf.RootElement) -> mujoco.MjModel:
    """A scene as MuJoCo has it."""
    return mujoco.MjModel.from_xml_string(scene.to_xml_string(), scene.get_assets())


def _make_version(root: mjcf.RootElement, version: str) -> None:
    """Put in the masses, motors and cameras in which this version differs from V5."""
    table = facts()["versions"][version]
    for link, changes in table["links"].items():
        _change_link(root.find("body", link).inertial, changes)
    for camera in facts()["sensors"]["cameras"]:
        root.find("camera", camera).fovy = table["camera_fov_deg"]["vertical"]
    for name, row in gains(version).items():
        joint, actuator = root.find("joint", name), root.find("actuator", name)
        if joint is not None:
            joint.armature = row["armature"]
            joint.damping = (row["damping"], 0.0, row["damping_cubic"])
        if actuator is not None:
            actuator.kp, actuator.kv = row["kp"], row["kv"]
            actuator.forcerange = (-row["force"], row["force"])


def _change_link(inertial: Any, changes: dict[str, Any]) -> None:
    names = {"mass_kg": "mass", "com_m": "pos", "inertia_about_com_kg_m2": "fullinertia"}
    for key, value in changes.items():
        setattr(inertial, names[key], value)
