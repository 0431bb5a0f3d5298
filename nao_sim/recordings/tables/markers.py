"""Markers of optical motion capture as joints, by a table of marker sets (`marker_sets.toml`)."""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from nao_sim.body import SIDES
from nao_sim.recordings.landmarks.landmark_words import plain
from nao_sim.recordings.skeletons.points import Points

NEEDED = ("left_shoulder", "right_shoulder", "left_elbow", "right_elbow")  # of a set that is one of a person
SHARED = 0.8  # of the names begin with the same word: it says nothing
_WORD = re.compile(r"[^_]*_")


def joints_of(names: Sequence[str]) -> dict[str, list[int]]:
    """The joints that markers tell.

    Args:
        names: (M,) what the file calls the markers.

    Returns:
        For each joint the markers whose mean it is; empty where the names are of no known marker set.
    """
    bare = {plain(name): place for place, name in reversed(list(enumerate(_bare(names))))}
    found = {}
    for joint, choices in _table().items():
        places = next((markers for markers in choices if all(marker in bare for marker in markers)), None)
        if places is not None:
            found[joint] = [bare[marker] for marker in places]
    return found if all(joint in found for joint in NEEDED) else {}


def as_joints(points: Points) -> tuple[Points, tuple[str, ...]]:
    """Markers of a known set as the joints they tell; other points as they are.

    A joint of several markers is missing where one of them is, rather than to jump to the others.

    Returns:
        The points, and what a user should know.
    """
    names = points.names or ()
    joints = joints_of(names)
    if not joints:
        return points, ()
    there = np.asarray(np.isfinite(points.values).all(axis=2) & points.values.any(axis=2))
    values = np.where(there[:, :, None], points.values, np.nan)
    means = np.stack([values[:, places].mean(axis=1) for places in joints.values()], axis=1)
    trust = points.confidence
    least = None if trust is None else np.stack([trust[:, places].min(axis=1) for places in joints.values()], axis=1)
    return replace(points, values=means, names=tuple(joints), confidence=least), (_note(names, joints),)


def _note(names: Sequence[str], joints: Mapping[str, Sequence[int]]) -> str:
    """Which joints are means of which markers, in words."""
    bare = _bare(names)
    means = [f"{joint.replace('_', ' ')} of {', '.join(bare[place] for place in places)}"
             for joint, places in joints.items() if len(places) > 1 and not joint.startswith("right_")]  # fmt: skip
    told = f", some in the middle of several ({'; '.join(means)})" if means else ""
    return f"joints are where the markers on the skin are{told}"


def _bare(names: Sequence[str]) -> list[str]:
    """Names without a subject's (`Sub1:LSHO`) and without a first word that nearly all share (`Q_HeadL`)."""
    own = [name.rpartition(":")[2] for name in names]
    words = Counter(word[0] for name in own if (word := _WORD.match(name)))
    shared, count = words.most_common(1)[0] if words else ("", 0)
    return [name.removeprefix(shared) for name in own] if count > SHARED * len(own) else own


@cache
def _table() -> Mapping[str, tuple[tuple[str, ...], ...]]:
    """For each joint its lists of markers, by plain names."""
    table = tomllib.loads(Path(__file__).with_name("marker_sets.toml").read_text(encoding="utf-8"))
    found = {
        joint: tuple(tuple(map(plain, choice)) for choice in choices) for joint, choices in table["midline"].items()
    }
    for part, choices in table["paired"].items():
        for side in SIDES:
            named = [[marker.replace("{S}", side[0]) for marker in choice] for choice in choices]
            found[f"{side}_{part}"] = tuple(tuple(map(plain, choice)) for choice in named)
    return found
