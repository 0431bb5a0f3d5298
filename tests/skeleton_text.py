"""Writes made-up people as text of numbers, in any shape of row."""

from __future__ import annotations

import numpy as np

from nao_sim.recordings.skeletons.layouts import Row


def text_of(
    values: np.ndarray,
    row: Row,
    asides: dict[str, np.ndarray] | None = None,
    trust: np.ndarray | float = 2.0,
    separator: str = " ",
    trailing: bool = False,
) -> str:
    """The text of a file.

    Args:
        values: (T, J, 3) the numbers of each point.
        row: the shape.
        asides: (T,) the numbers of each column beside the joints; 7 where missing.
        trust: (T, J) or one state or confidence for all.
        separator: between two numbers.
        trailing: whether one stands after the last number, too.
    """
    frames, points = values.shape[:2]
    trust = np.broadcast_to(trust, (frames, points))
    parts = {"x": values[:, :, 0], "y": values[:, :, 1], "z": values[:, :, 2], "state": trust, "confidence": trust,
             "-": np.full((frames, points), -3.5)}  # fmt: skip
    joints = np.stack([parts[name] for name in row.joint], axis=2)  # (T, J, k)
    if row.order == "axis":
        joints = joints.swapaxes(1, 2)
    told = asides or {}

    def beside(names: tuple[str, ...]) -> np.ndarray:
        return np.array([told.get(name, np.full(frames, 7.0)) for name in names]).reshape(len(names), frames).T

    if row.per == "frame":
        lines = np.hstack([beside(row.before), joints.reshape(frames, -1), beside(row.after)])
    else:
        before, after = (np.repeat(beside(names), points, axis=0) for names in (row.before, row.after))
        lines = np.hstack([before, joints.reshape(frames * points, -1), after])
    end = (separator if trailing else "") + "\n"
    return "".join(separator.join(f"{number:.10g}" for number in line) + end for line in lines)
