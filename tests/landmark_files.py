"""Made-up people as landmark detectors see them: numbers as in files, and the skeleton that should come out."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from nao_sim.body import SIDES
from nao_sim.motion import Skeleton
from nao_sim.recordings.landmarks.marks import AXES, HAND, MEDIAPIPE, order_of
from tests.people import in_file, person

BODY = tuple("nose" if joint == "-" else joint for joint in order_of(MEDIAPIPE))
HANDS = {side: tuple(f"{side}_{joint}" for joint in HAND) for side in SIDES}
PICTURE = (640.0, 480.0)  # pixels
NEAR = 0.4  # of the picture's height for a metre


def centred(skeleton: Skeleton) -> Skeleton:
    """The person moved so that the middle of the hips stays at zero."""
    hips = (skeleton.track("left_hip") + skeleton.track("right_hip")) / 2
    return replace(skeleton, positions=skeleton.positions - hips[:, None])


def seen(frames: int = 20, seed: int = 0, **options: Any) -> Skeleton:
    """Somebody who moves, with hips at zero and confidences."""
    skeleton = centred(person(frames, seed, **options))
    sure = np.random.default_rng(seed).uniform(0.2, 1.0, skeleton.confidence.shape).round(6)
    return replace(skeleton, confidence=sure)


def numbers(skeleton: Skeleton, joints: tuple[str, ...] = BODY) -> np.ndarray:
    """World landmarks (T, J, 4) of some joints: x y z m and visibility."""
    sure = skeleton.confidence[:, [skeleton.joints.index(joint) for joint in joints]]
    return np.dstack([in_file(skeleton, joints, axes=AXES), sure])


def pictured(world: np.ndarray, size: tuple[float, float] = PICTURE, depth: float = 1.0) -> np.ndarray:
    """Points (T, J, 4) as fractions of a picture, depth on the scale of x."""
    width, height = size
    values = np.array(world)
    values[:, :, :3] *= NEAR * np.array([height / width, 1.0, depth * height / width])
    values[:, :, :2] += 0.5
    return values


def same_places(found: Skeleton, expected: Skeleton, joints: Iterable[str], within: float = 1e-9) -> None:
    """The joints are where they should be, in metres."""
    for joint in joints:
        np.testing.assert_allclose(found.track(joint), expected.track(joint), atol=within, err_msg=joint)


def same_directions(found: Skeleton, expected: Skeleton, joints: Iterable[str], within: float = 1e-6) -> None:
    """Alike but for size and place."""
    names = list(joints)
    a, b = (np.stack([skeleton.track(joint) for joint in names], axis=1) for skeleton in (found, expected))
    a, b = a - a.mean(axis=(0, 1)), b - b.mean(axis=(0, 1))
    np.testing.assert_allclose(a / np.linalg.norm(a), b / np.linalg.norm(b), atol=within)


def flat(skeleton: Skeleton) -> Skeleton:
    """The person without depth."""
    return replace(skeleton, positions=skeleton.positions * [0.0, 1.0, 1.0])


def dicts(frame: np.ndarray) -> list[dict[str, float]]:
    """Points (J, 4) as MediaPipe's JSON has them."""
    return [dict(zip(("x", "y", "z", "visibility"), point, strict=True)) for point in frame.tolist()]


def in_lines(documents: list[Any]) -> str:
    return "".join(json.dumps(document) + "\n" for document in documents)


# Ways in which programs store body landmarks (T, 33, 4).
SHAPES: dict[str, Callable[[np.ndarray], str]] = {
    "a list of lists of points": lambda w: json.dumps([dicts(f) for f in w]),
    "lists of four numbers": lambda w: json.dumps(w.tolist()),
    "tables with pose_landmarks": lambda w: json.dumps([{"pose_landmarks": dicts(f), "n": 3} for f in w]),
    "tables with poseLandmarks": lambda w: json.dumps([{"poseLandmarks": dicts(f)} for f in w]),
    "protobuf's landmark": lambda w: json.dumps([{"poseLandmarks": {"landmark": dicts(f)}} for f in w]),
    "people of the tasks API": lambda w: json.dumps([{"pose_landmarks": [dicts(f)]} for f in w]),
    "frames in a table": lambda w: json.dumps({"video": "a.mp4", "frames": [{"pose": dicts(f)} for f in w]}),
    "frames two tables deep": lambda w: json.dumps({"result": {"frames": [{"landmarks": dicts(f)} for f in w]}}),
    "points by number": lambda w: json.dumps(
        {"frames": [{"pose": {str(i): p for i, p in enumerate(f)}} for f in w.tolist()]}
    ),
    "points with numbers inside": lambda w: json.dumps(
        [{"keypoints": [{"id": i} | p for i, p in enumerate(dicts(f))]} for f in w]
    ),
    "one flat list a frame": lambda w: json.dumps({"frames": w.reshape(len(w), -1).tolist()}),
    "a list for each part": lambda w: json.dumps({"pose_landmarks": [dicts(f) for f in w], "n": len(w)}),
    "frames by number": lambda w: json.dumps({f"frame_{i}": {"landmarks": dicts(f)} for i, f in enumerate(w)}),
    "people with ids": lambda w: json.dumps([{"people": [{"person_id": 7, "landmarks": dicts(f)}]} for f in w]),
    "JSON lines": lambda w: in_lines([{"landmarks": dicts(f)} for f in w]),
    "JSON lines after a head": lambda w: in_lines([{"model": "full"}, *({"landmarks": dicts(f)} for f in w)]),
    "pretty-printed": lambda w: json.dumps({"frames": [{"pose": dicts(f)} for f in w]}, indent=2),
}  # fmt: skip
