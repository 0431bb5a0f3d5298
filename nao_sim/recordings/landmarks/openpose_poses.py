"""Tables of single BODY_25 poses, as pose-classification-kit keeps them to train classifiers.

`{"info": {"label": "T", "BODY25_Mapping": {...}, ...}, "data": [{"x": [25], "y": [25], "a": [25],
"detection_accuracy": 21.6}, ...]}` with y up and coordinates in sizes of the person; `a` is the confidence of each
keypoint and the accuracy their sum.  The poses are of many people and no motion, so one a second is shown.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from nao_sim.recordings.landmarks.json_text import Json, documents, looks_like_json
from nao_sim.recordings.landmarks.landmark_parts import ordered, part_of
from nao_sim.recordings.landmarks.landmark_points import shown
from nao_sim.recordings.landmarks.landmark_shapes import Set, Shapes
from nao_sim.recordings.landmarks.marks import BODY_25, order_of
from nao_sim.recordings.recording import Recording, label_of_all
from nao_sim.recordings.skeletons.points import understand
from nao_sim.recordings.source import Source

NAME = "table of BODY_25 poses"
LOOKS = '{"info": {"BODY25_Mapping": {...}}, "data": [{"x": [...], "y": [...]}, ...]}'
MAPPING = "BODY25_Mapping"
RATE = 1.0  # Hz, one pose a second
AXES = ("+z", "+x", "+y")  # forward, left, up: y is up already, and depth unknown


def recognise(source: Source) -> str | None:
    """Why the file is a table of poses, or None."""
    return f"a {MAPPING}" if looks_like_json(source) and f'"{MAPPING}"'.encode() in source.start else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file, with the caller's rate.
        reason: why it is taken for this format.

    Returns:
        The recording: a frame a pose, planar, and one label where the file names the pose.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    table = documents(source)[0][1]
    info, data = (table.get("info"), table.get("data")) if isinstance(table, dict) else (None, None)
    if not isinstance(info, dict) or not isinstance(data, list) or not data:
        raise source.error(f"{shown(data)} as data", LOOKS)
    poses = [_pose(source, pose, number) for number, pose in enumerate(data, start=1)]
    part = part_of(source, "body", poses)
    if part is None or not np.isfinite(part.values).any():
        raise source.error("poses that are all zero", "x and y of keypoints")
    points, notes = ordered({"body": part}, BODY_25)
    understood = understand(source, replace(points, axes=AXES, rate=RATE))
    labels = label_of_all(info.get("label"), float(understood.skeleton.times[-1]))
    return understood.recording(source, NAME, reason, len(data), ("single poses, no motion", *notes), labels)


def _pose(source: Source, pose: Json, number: int) -> Set:
    """The 25 keypoints of a pose."""
    shapes, count = Shapes(source), len(order_of(BODY_25))
    shapes.frame = number
    if not isinstance(pose, dict):
        raise shapes.error(shown(pose), "a table with x and y")
    columns = {}
    for key in "xya":
        column = pose.get(key, [None] * count if key == "a" else None)
        if not isinstance(column, list) or len(column) != count:
            raise shapes.error(f"{key} is {shown(column)}", f"a list of {count}")
        columns[key] = [shapes.number(value, key) for value in column]
    overall = _overall(shapes, pose, count)
    rows = zip(columns["x"], columns["y"], columns["a"], strict=True)
    return {place: (x, y, np.nan, overall if np.isnan(sure) else sure) for place, (x, y, sure) in enumerate(rows)}


def _overall(shapes: Shapes, pose: Mapping[str, Json], count: int) -> float:
    """The mean confidence of a pose's keypoints."""
    return shapes.number(pose.get("detection_accuracy"), "detection_accuracy") / count
