"""The person as a stick figure beside the robot.

The figure is a part of the scene that is filmed and of no other: each of its
bones is a translucent capsule that a pose puts where it belongs, so that
everything about painting a robot holds for it as well.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.body import SIDES, Bone, bones
from nao_sim.imitation.person import first_known, middle, shoulder_centre, wrist
from nao_sim.motion import Skeleton
from nao_sim.recordings.skeletons.anatomy import Body
from nao_sim.rendering.preset_kinds import FigureLooks
from nao_sim.rendering.presets import load_figure
from nao_sim.robot import Array

if TYPE_CHECKING:
    from dm_control import mjcf

HIDDEN = (0.0, 0.0, -0.2)  # m; a bone that is not tracked lies under the floor
SHOULDER_HEIGHT = 0.82  # of a standing person's height (Drillis and Contini 1966), where no feet are tracked


@dataclass(frozen=True, eq=False)
class Figure:
    """A person drawn beside the robot.

    Attributes:
        lengths: m as drawn, by bone.
        poses: (T, 7 * bones) where they are, as free joints have it.
        times: (T,) s.
    """

    lengths: Mapping[str, float]
    poses: Array
    times: Array

    def at(self, times: Array) -> Array:
        """Poses (N, 7 * bones) at `times` (N,) s: those of the nearest frame."""
        between = (self.times[1:] + self.times[:-1]) / 2.0
        return self.poses[np.searchsorted(between, times)]


def figure_of(person: Skeleton, where: str = "beside") -> Figure | None:
    """The person at the presets' size and place (`where` in the table), or None where nothing of them can be drawn."""
    if not np.isfinite(shoulder_centre(person)).any():
        return None
    ends = _drawn_bones(person)
    lengths = {name: float(np.nanmedian(np.linalg.norm(end - start, axis=1))) for name, (start, end) in ends.items()}
    tall = Body(person.joints, person.positions).height
    looks = load_figure(where)
    scale = looks.height / (tall if np.isfinite(tall) else 1.0)
    shift = _place(person, scale, looks)
    poses = [_capsule_poses(scale * start + shift, scale * end + shift) for start, end in ends.values()]
    drawn = {name: scale * length for name, length in lengths.items()}
    return Figure(drawn, np.concatenate(poses, axis=1), person.times - person.times[0])


def add_figure(scene: mjcf.RootElement, figure: Figure) -> None:
    """Put the figure into a scene; a pose of it is then the scene's `qpos` before, and the figure's behind it."""
    looks = load_figure()
    for name, length in figure.lengths.items():
        body = scene.worldbody.add("body", name=f"person_{name}", pos=HIDDEN)
        body.add("freejoint")
        radius = looks.head_radius if name == "head" else looks.radius
        body.add(
            "geom",
            type="capsule",
            size=(radius, length / 2.0),
            rgba=(*looks.colour(name), looks.opacity),
            mass=0.001,
            contype=0,
            conaffinity=0,
            group=1,
        )
    if scene.keyframe is not None:
        scene.keyframe.remove(affect_attachments=True)  # its poses have no figure


def _drawn_bones(person: Skeleton) -> dict[str, tuple[Array, Array]]:
    """Start and end (T, 3) of each bone that is ever tracked, named for the colours."""
    drawn = {f"{bone.start}-{bone.end}": (person.track(bone.start), person.track(bone.end)) for bone in _edges(person)}
    shoulders, hips = shoulder_centre(person), first_known([middle(person, "hip"), person.track("pelvis")])
    head = first_known([person.track("head"), middle(person, "ear"), person.track("nose")])
    drawn |= {"neck": (shoulders, head), "head": (head, head + 1e-3), "trunk": (shoulders, hips)}
    for side in SIDES:
        tips = (person.track(f"{side}_{joint}") for joint in ("hand_tip", "middle_mcp", "index_mcp", "hand"))
        drawn[f"{side}_hand"] = (wrist(person, side), first_known(list(tips)))
    return {name: ends for name, ends in drawn.items() if np.isfinite(ends[1] - ends[0]).all(axis=1).any()}


def _edges(person: Skeleton) -> list[Bone]:
    """The bones of arms and legs, and the lines across shoulders and hips."""
    wanted = ("shoulder", "elbow", "hip", "knee", "ankle")
    return [
        bone
        for bone in bones()
        if bone.start.endswith(wanted) and (bone.start.split("_")[-1], bone.end.split("_")[-1]) != ("shoulder", "hip")
    ]


def _place(person: Skeleton, scale: float, looks: FigureLooks) -> Array:
    """Where (T, 3) m the scaled person is moved: on the spot, feet on the floor."""
    anchor = scale * first_known([middle(person, "hip"), person.track("pelvis"), shoulder_centre(person)])
    known = np.isfinite(anchor).all(axis=1)
    anchor[~known] = np.median(anchor[known], axis=0) if known.any() else 0.0
    feet = [person.track(f"{side}_{joint}")[:, 2] for side in SIDES for joint in ("foot", "ankle")]
    heights = np.concatenate(feet)
    heights = heights[np.isfinite(heights)]
    if len(heights):
        rise = looks.radius - scale * float(np.percentile(heights, 2.0))
    else:
        rise = SHOULDER_HEIGHT * looks.height - float(np.nanmedian(scale * shoulder_centre(person)[:, 2]))
    return np.column_stack([np.asarray(looks.place) - anchor[:, :2], np.full(len(person), rise)])


def _capsule_poses(start: Array, end: Array) -> Array:
    """Free-joint poses (T, 7) that lay a capsule from start to end (T, 3); under the floor where not tracked."""
    along = end - start
    length = np.linalg.norm(along, axis=1)
    known = np.isfinite(length) & (length > 0.0)
    x, y, z = np.where(known[:, None], along / np.where(known, length, 1.0)[:, None], (0.0, 0.0, 1.0)).T
    # the shortest turn from z to (x, y, z); straight down is half a turn about x
    down = z < -1.0 + 1e-9
    quaternion = np.stack([np.where(down, 0.0, 1.0 + z), np.where(down, 1.0, -y), x, np.zeros_like(x)], axis=1)
    quaternion /= np.linalg.norm(quaternion, axis=1, keepdims=True)
    return np.hstack([np.where(known[:, None], (start + end) / 2.0, HIDDEN), quaternion])
