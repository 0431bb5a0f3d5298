"""Which way a person faces, and with it which axes are forward and left, and whose left and right the names are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nao_sim.recordings.skeletons.anatomy import Body, ahead, median, middle, unit
from nao_sim.recordings.skeletons.layouts import Axes, axis, axis_name, swapped
from nao_sim.robot import Array

# What tells the person's front without knowing left from right: (weight, heights of the body at which it is sure).
# Toes and noses never point backwards; knees, elbows and hands may, if seldom.
FRONT = {"toes": (1.5, 0.05), "nose": (1.5, 0.03), "knees": (0.7, 0.10), "elbows": (0.5, 0.04), "hands": (0.5, 0.10)}
SURE = 0.75  # of what they say together: one sure part, or two fairly sure ones
FACING = 0.5  # cosine: within 60 degrees
AWAY = 0.8  # what a back turned to the sensor weighs
BESIDE = 0.5  # what the origin weighs, where it is beside the person as a sensor would be


@dataclass(frozen=True)
class Told:
    """What is known of the numbers before looking at them.

    Attributes:
        unit: metres in one unit.
        axes: the person's (forward, left, up).
        firm: whether the user says so, against all appearances.
        usual: whether it is only what such files usually have.
        planar: whether depth is unknown.
    """

    unit: float | None = None
    axes: Axes | None = None
    firm: bool = False
    usual: bool = False
    planar: bool = False


def _nearest(vector: Array, without: Array | None = None) -> Array:
    """The signed axis nearest to a vector, `without` one of them."""
    return axis(axis_name(vector if without is None else vector * (without == 0.0)))


Orientation = tuple[Array, tuple[str, ...], tuple[str, ...]]


def orientation(body: Body, up: Array, told: Told) -> Orientation:
    """Find out, or check, which axes of the file are the person's.

    Args:
        body: a sample.
        up: (3,) from pelvis to head.
        told: what is known of the axes.

    Returns:
        Axes (3, 3), rows forward, left, up; the joints with their true sides; notes.
    """
    if told.axes is None:
        return _found_axes(body, _nearest(up), told)
    axes = np.array([axis(signed) for signed in told.axes])
    if axes[2] @ up >= FACING or told.firm:
        return _found_axes(body, axes[2], told) if told.planar else _told_axes(body, axes, told)
    note = f"up is not {told.axes[2]} but {axis_name(up)}, from pelvis to head"
    found, joints, notes = _found_axes(body, _nearest(up), told)
    return found, joints, notes if told.usual else (note, *notes)


def _told_axes(body: Body, axes: Array, told: Told) -> Orientation:
    """Axes that are told, with sides that agree with them."""
    handed = np.linalg.det(axes)
    front = unit(handed * np.cross(body.leftward, axes[2]))
    facing = float(axes[0] @ middle(front))
    score = sum(front_told(body, front).values())
    if told.usual and score <= -SURE and facing > FACING:  # who faces as usual but walks backwards: not the usual axes
        return _found_axes(body, axes[2], told)
    notes: tuple[str, ...] = ()
    joints = body.joints
    if score - AWAY * (told.usual and facing < -FACING) <= -SURE:
        joints, front, facing = swapped(joints), -front, -facing
        notes = ("left and right are named as the viewer sees them: exchanged",)
    if told.usual and facing < FACING:
        forward = _nearest(middle(front), without=axes[2])
        axes = np.array([forward, handed * np.cross(axes[2], forward), axes[2]])
    elif facing < -FACING:
        notes = (*notes, f"the person faces away from {axis_name(axes[0])}")
    return axes, joints, notes


def _found_axes(body: Body, up: Array, told: Told) -> Orientation:
    """Axes by the body alone: the names of its sides hold."""
    front = unit(np.cross(body.leftward, up))
    handed, notes = 1.0, tuple[str, ...]()
    if not told.planar and sum(front_told(body, front).values()) + _beside(body, front, up) <= -SURE:
        handed, front = -1.0, -front
        notes = ("the file's axes are left-handed (or its left and right exchanged): mirrored",)
    forward = _nearest(middle(front), without=up)
    return np.array([forward, handed * np.cross(up, forward), up]), body.joints, notes


def _beside(body: Body, front: Array, up: Array) -> float:
    """How much the front is towards the origin, where that is beside the person."""
    where = middle(body.shoulders)
    where = where - (where @ up) * up
    distance = float(np.linalg.norm(where))
    if not distance > body.height / 2:
        return 0.0
    return BESIDE * float(np.nan_to_num(-where @ middle(front)) / distance)


def front_told(body: Body, forward: Array) -> dict[str, float]:
    """What body parts say of where the front is.

    Args:
        forward: (S, 3) of length 1, the supposed front in each frame.

    Returns:
        For each part of `FRONT` from -weight, the other way, over 0, nothing to say, to its weight.
    """
    told = {}
    for part, ways in _fronts(body).items():
        weight, sure = FRONT[part]
        amount = median(np.concatenate([ahead(way, forward) for way in ways]) / body.height)
        told[part] = weight * float(np.tanh(amount / sure)) if np.isfinite(amount) else 0.0
    return told


def _fronts(body: Body) -> dict[str, list[Array]]:
    found: dict[str, list[Array]] = {"nose": [_nose(body)], "toes": [], "knees": [], "elbows": [], "hands": []}
    for side in ("left_", "right_"):
        hip, knee, ankle = (body.limb(side + name) for name in ("hip", "knee", "ankle"))
        shoulder, elbow = body.track(side + "shoulder"), body.track(side + "elbow")
        wrist = body.limb(side + "wrist")
        heel = body.first((side + "heel",), (side + "ankle",))
        found["toes"].append(body.track(side + "foot") - heel)
        found["knees"].append(knee - (hip + ankle) / 2)
        found["elbows"].append((shoulder + wrist) / 2 - elbow)
        found["hands"].append(wrist - shoulder)
    return found


def _nose(body: Body) -> Array:
    face = body.first(("nose",), ("left_eye", "right_eye"))
    back = body.first(("left_ear", "right_ear"), ("head",))
    return np.where(np.isclose(face, back), np.nan, face - back)


def evidence(body: Body, axes: Array) -> str:
    """What tells the front, in words: the parts that say so, if any does."""
    front = unit(np.linalg.det(axes) * np.cross(body.leftward, axes[2]))
    parts = [part for part, amount in front_told(body, front).items() if amount > SURE / 3]
    return f"front by {' and '.join(parts)}" if parts else "front by left and right only"
