"""Another robot of the same version in the scene that is filmed, and in no other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nao_sim.rendering.presets import load_second
from nao_sim.robot import Array

if TYPE_CHECKING:
    from dm_control import mjcf

NAME = "second"


def add_second(scene: mjcf.RootElement, other: mjcf.RootElement) -> None:
    """Put the robot of another scene beside that of this one; its `qpos` stands behind it: base, then joints.

    Args:
        scene: the scene to film, which loses its keyframes: their poses have one robot.
        other: a scene of its own, of which only the robot is left.
    """
    other.model = NAME
    for part in (*other.worldbody.geom, *other.worldbody.light, *other.worldbody.camera):
        part.remove()
    for kind, name in (("texture", "sky"), ("material", "floor"), ("texture", "floor")):
        other.find(kind, name).remove()
    if root := other.find("joint", "root"):
        root.remove()
    other.find("body", "torso").pos = (0.0, 0.0, 0.0)
    for tree in (scene, other):
        if tree.keyframe is not None:
            tree.keyframe.remove()
    scene.attach(other).add("freejoint")


def second_poses(joints: Array, base: Array) -> Array:
    """Poses (T, 7 + n) of the second robot from those (T, n) of its joints and (T, 7) of its torso where it acted."""
    shifted = np.array(base)
    shifted[:, :2] += load_second().place
    return np.hstack([shifted, joints])
