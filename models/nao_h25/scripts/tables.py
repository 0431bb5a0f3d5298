"""The tables that the model's scripts read and the folder they stand in."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

MODEL = Path(__file__).resolve().parent.parent


def table(name: str) -> dict[str, Any]:
    """A JSON table of the model folder."""
    return json.loads((MODEL / name).read_text(encoding="utf-8"))


def numbers(values: Any, digits: int = 9) -> str:
    """Numbers as XML likes them: blank-separated, no noise, no negative zero."""
    array = np.round(np.atleast_1d(np.asarray(values, float)), digits) + 0.0
    return " ".join(f"{x:.{digits}g}" for x in array)


def mirrored(name: str) -> str:
    """The right side's twin of a left link, joint or site name (middle names are their own)."""
    swaps = {"L": "R", "l_": "r_"}
    for left, right in swaps.items():
        if name.startswith(left):
            return right + name.removeprefix(left)
    return name


def rotation(rpy: Any) -> np.ndarray:
    """Rotation matrix of URDF roll, pitch, yaw (rad): Rz(yaw) Ry(pitch) Rx(roll)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy), np.sin(rpy)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def quaternion(matrix: np.ndarray) -> np.ndarray:
    """Unit quaternion (w, x, y, z), w >= 0, of a rotation matrix."""
    import mujoco

    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, np.ascontiguousarray(matrix).ravel())
    return quat if quat[0] >= 0 else -quat
