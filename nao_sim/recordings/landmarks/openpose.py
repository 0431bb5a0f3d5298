"""OpenPose's JSON: BODY_25 (or COCO) keypoints of the people in a picture, one file a frame or all in one.

A frame is `{"version": 1.3, "people": [{"person_id": [-1], "pose_keypoints_2d": [x0, y0, c0, ...],
"hand_left_keypoints_2d": [...], ...}]}` (OpenPose documentation, "Output"), x and y in pixels, y down, 0 0 0 where a
keypoint was not found.  Depth is not known, so the person is lifted to the frontal plane, unless the file has
`pose_keypoints_3d`.  `openpose_poses` reads tables of single poses.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from nao_sim.recordings.landmarks.json_text import Json, documents, looks_like_json
from nao_sim.recordings.landmarks.landmark_parts import ordered, parts_of
from nao_sim.recordings.landmarks.landmark_points import shown
from nao_sim.recordings.landmarks.landmark_shapes import Seen, Set, Shapes, identity
from nao_sim.recordings.landmarks.marks import RATE, as_points, order_of
from nao_sim.recordings.landmarks.people import one_of
from nao_sim.recordings.recording import Recording
from nao_sim.recordings.skeletons.points import Points, understand
from nao_sim.recordings.source import Source

NAME = "OpenPose keypoints"
LOOKS = '{"version": 1.3, "people": [{"pose_keypoints_2d": [...]}]}'
ORDERS = {25: "OpenPose BODY_25", 18: "OpenPose COCO"}  # by number of keypoints
KEYPOINTS = "pose_keypoints"
_PARTS = {f"{KEYPOINTS}_2d": ("body", 3), f"{KEYPOINTS}_3d": ("world", 4), KEYPOINTS: ("body", 3),
          "hand_left_keypoints_2d": ("left", 3), "hand_right_keypoints_2d": ("right", 3)}  # fmt: skip


def recognise(source: Source) -> str | None:
    """Why the file holds OpenPose's keypoints, or None."""
    if not looks_like_json(source) or b'"people"' not in source.start:
        return None
    if KEYPOINTS.encode() in source.start:
        return f"people with {KEYPOINTS}"
    return "people and a version" if b'"version"' in source.start else None


def read(source: Source, reason: str) -> Recording:
    """Read a file with one frame, or with a list of frames.

    Args:
        source: the file, with the caller's rate and person.
        reason: why it is taken for this format.

    Returns:
        The recording: one person, planar where depth is not known.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    found = documents(source)
    frames = found[0][1] if len(found) == 1 and isinstance(found[0][1], list) else [frame for _, frame in found]
    crowd = [people_in(source, frame, number) for number, frame in enumerate(frames, start=1)]
    return recording(source, reason, crowd)


def recording(source: Source, reason: str, crowd: Sequence[Sequence[Seen]], numbers: Sequence[int] = ()) -> Recording:
    """One person of a crowd.

    Args:
        source: the file or folder, with the caller's rate and person.
        reason: why it is taken for this format.
        crowd: (T,) who is in each frame.
        numbers: (T,) the frames' own numbers; none where they follow each other.

    Raises:
        RecordingError: nobody is in any frame, or the caller's choice is not.
    """
    if not any(crowd):
        raise source.error("frames without people", f"people with {KEYPOINTS}_2d")
    points, who = points_of(source, crowd)
    if len(numbers) > 1:
        points = replace(points, times=np.array(numbers, float), time_unit=0.0)
    return understand(source, points).recording(source, NAME, reason, len(crowd), who)


def points_of(source: Source, crowd: Sequence[Sequence[Seen]]) -> tuple[Points, tuple[str, ...]]:
    """The points of one person, without times, and what a user should know."""
    seen, who = one_of(source, crowd)
    parts = parts_of(source, seen)
    if "world" in parts:
        solid = parts["world"].in_order(order_of(ORDERS[len(parts["world"].keys)]))
        return as_points(solid, axes=None, rate=RATE), (*who, "3D keypoints: unit and axes by the body")
    if "body" not in parts:
        raise source.error("keypoints that are all zero", "a person")
    points, notes = ordered(parts, ORDERS[len(parts["body"].keys)])
    return points, (*who, *notes)


def people_in(source: Source, frame: Json, number: int) -> list[Seen]:
    """Who is in a frame.

    Raises:
        RecordingError: the frame is not as OpenPose writes it.
    """
    shapes = Shapes(source)
    shapes.frame = number
    people = frame.get("people") if isinstance(frame, dict) else None
    if not isinstance(people, list):
        raise shapes.error(f"{shown(frame)} without people", LOOKS)
    return [_person(shapes, person, place) for place, person in enumerate(people, start=1)]


def _person(shapes: Shapes, person: Json, place: int) -> Seen:
    if not isinstance(person, dict):
        raise shapes.error(f"person {place} is {shown(person)}", f"a table with {KEYPOINTS}_2d")
    found = Seen(id=identity(person.get("person_id")))
    for key, (part, width) in _PARTS.items():
        if numbers := person.get(key):
            found.parts[part] = _keypoints(shapes, f"person {place}, {key}", numbers, width)
    return found


def _keypoints(shapes: Shapes, what: str, numbers: Json, width: int) -> Set:
    """Keypoints by number: three numbers (or four) each, the last a confidence, all zero for one not found."""
    if not isinstance(numbers, list) or len(numbers) % width:
        raise shapes.error(f"{what}: {shown(numbers)}", f"a list of {width} numbers for each keypoint")
    if "hand" not in what and len(numbers) // width not in ORDERS:
        expected = ", ".join(map(str, ORDERS))
        raise shapes.error(f"{what}: {len(numbers) // width} keypoints", f"one of {expected}")
    found: Set = {}
    for place in range(len(numbers) // width):
        values = [shapes.number(value, what) for value in numbers[place * width : (place + 1) * width]]
        x, y, z, sure = (*values[:2], *(values[2:3] if width > 3 else [math.nan]), values[-1])  # noqa: PLR2004
        found[place] = (x, y, z, sure) if sure > 0.0 else (math.nan,) * 4
    return found
