"""What `nao-sim inspect` finds out, as the JSON has it."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from nao_sim import health
from nao_sim.imitation.filters import clean
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.recordings import Recording
from nao_sim.robot import Robot, load_robot

SCHEMA = 1
Report = dict[str, Any]


def inspection(recording: Recording, robot: Robot | None = None) -> Report:
    """Everything about a recording.

    Args:
        recording: a person's or a robot's.
        robot: whose limits and speeds count; NAO v5 where None.

    Returns:
        Plain values with the unit in the name: shares from 0 to 1, None for what a recording cannot tell.
    """
    motion = recording.motion
    part = _person(motion) if isinstance(motion, Skeleton) else _robot(motion, robot or load_robot())
    return {
        "schema": SCHEMA,
        "recording": str(recording.path),
        "format": recording.format,
        "format_reason": recording.reason,
        "notes": list(recording.notes),
        "labels": [asdict(label) for label in recording.labels],
        **_clock(motion),
        **part,
    }


def _clock(motion: Skeleton | JointTrajectory) -> Report:
    clock = health.clock(motion)
    return {
        "frames": clock.frames,
        "duration_s": _rounded(clock.duration, 6),
        "rate_hz": _rounded(clock.rate, 3),
        "interval_spread": _rounded(clock.unevenness),
        "interval_gaps": clock.gaps,
        "longest_interval_s": _rounded(clock.longest, 6),
        "repeated_frames": clock.repeated,
    }


def _person(skeleton: Skeleton) -> Report:
    cleaned, cleaning = clean(skeleton, smooth=None)
    return {
        "holds": "person",
        "planar": skeleton.planar,
        "joints": [_joint(joint) for joint in health.joint_health(skeleton, cleaned)],
        "joints_absent": [joint for joint in health.expected_joints() if np.isnan(skeleton.track(joint)).all()],
        "bones": [_bone(bone) for bone in health.bone_health(skeleton)],
        "cleaning": asdict(cleaning) | {"notes": list(cleaning.notes())},
    }


def _joint(joint: health.JointHealth) -> Report:
    return {
        "joint": joint.joint,
        "seen": _rounded(joint.seen),
        "gaps": joint.gaps,
        "longest_gap_s": _rounded(joint.longest_gap),
        "confidence": _rounded(joint.confidence),
        "jitter_mm": _rounded(joint.jitter, 3, 1000.0),
    }


def _bone(bone: health.BoneHealth) -> Report:
    return {
        "start": bone.start,
        "end": bone.end,
        "length_m": _rounded(bone.length),
        "spread": _rounded(bone.spread),
        "longer_than_other_side": _rounded(bone.longer),
    }


def _robot(motion: JointTrajectory, robot: Robot) -> Report:
    asked = health.angle_health(motion, robot)
    named = {angle.joint for angle in asked}
    return {
        "holds": "robot",
        "robot": robot.version,
        "joints": [_angle(angle, robot) for angle in asked],
        "joints_absent": [name for name in robot.joint_names if name not in named],
    }


def _angle(angle: health.AngleHealth, robot: Robot) -> Report:
    index = robot.index[angle.joint]
    unit, factor = "" if robot.is_hand[index] else "_deg", robot.report_unit(index)
    return {
        "joint": angle.joint,
        "seen": _rounded(angle.seen),
        f"lowest{unit}": _rounded(angle.lowest, 3, factor),
        f"highest{unit}": _rounded(angle.highest, 3, factor),
        f"lower_limit{unit}": _rounded(angle.lower, 3, factor),
        f"upper_limit{unit}": _rounded(angle.upper, 3, factor),
        "beyond_limits": _rounded(angle.beyond),
        f"top_speed{unit}_per_s": _rounded(angle.speed, 1, factor),
        "top_speed_ratio": _rounded(angle.speed_ratio),
    }


def _rounded(value: float | None, digits: int = 4, factor: float = 1.0) -> float | None:
    return None if value is None or not np.isfinite(value) else round(float(value * factor), digits)
