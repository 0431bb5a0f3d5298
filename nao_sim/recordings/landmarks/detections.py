"""Lists of people instead of frames: each has the picture, or the frame, that it was seen in (COCO, AlphaPose).

COCO's keypoint annotations have an `image_id` and an `id` of their own, AlphaPose's results an `image_id` such as
`12.jpg` and, where people were tracked, an `idx` (their documentation, "Data format" and "Output format").
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import numpy as np

from nao_sim.recordings.landmarks.json_text import Json
from nao_sim.recordings.landmarks.landmark_shapes import identity
from nao_sim.recordings.landmarks.landmark_words import keys_of, plain

_NUMBER = re.compile(r"(\d+)\D*$")
_PERSON = "person id"  # of the keys of people the one that counts first
Table = Mapping[str, Json]


def by_picture(found: Sequence[Json]) -> tuple[list[Json], list[int]]:
    """Put people of one picture, frame or time together.

    Args:
        found: (N,) what a file lists.

    Returns:
        (T,) frames, each with its people where any has several, and the place in `found` where each begins.
    """
    everything = list(range(len(found)))
    tables = [table for table in found if isinstance(table, dict)]
    if len(tables) < len(found) or not tables:
        return list(found), everything
    places = _places(tables)
    if places is None:
        return list(found), everything
    people = _named(tables)
    groups: dict[str, list[int]] = {}
    for number, place in enumerate(places):
        groups.setdefault(place, []).append(number)
    firsts = [group[0] for group in groups.values()]
    frames = [_about(tables[group[0]]) | {"people": [people[one] for one in group]} for group in groups.values()]
    counted = None if keys_of(tables[0], "time") or keys_of(tables[0], "frame") else _numbers(list(groups))
    for frame, number in zip(frames, counted or (), strict=False):
        frame["frame"] = number
    return list(frames), firsts


def _places(tables: Sequence[Table]) -> list[str] | None:
    """What each person was seen in, if several were seen in one or pictures were left out; None else."""
    for group in ("picture", "frame", "time"):
        for key in keys_of(tables[0], group):
            told = [table.get(key) for table in tables]
            if not all(isinstance(value, str | int | float) for value in told):
                continue
            places = [str(value) for value in told]
            if len(set(places)) < len(places) and (group != "time" or _differ(tables, places)):
                return places
            if group == "picture" and _numbers(places) is not None:
                return places
    return None


def _differ(tables: Sequence[Table], places: Sequence[str]) -> bool:
    """Whether people at one time have different ids, as those of a clock that stands still have not."""
    ids = [person.get(_PERSON) for person in _named(tables)]
    return None not in ids and len(set(zip(places, map(str, ids), strict=True))) == len(places)


def _named(tables: Sequence[Table]) -> list[Table]:
    """The people with the ids of those who were tracked; an id that each has for itself is none."""
    for key in (*keys_of(tables[0], "id"), *(key for key in tables[0] if plain(key) == "idx")):
        told = [identity(table.get(key)) for table in tables]
        if len(set(told) - {None}) < len([value for value in told if value]):
            return [{**_without_ids(table), _PERSON: value} for table, value in zip(tables, told, strict=True)]
    return [_without_ids(table) for table in tables]


def _without_ids(table: Table) -> dict[str, Json]:
    ids = keys_of(table, "id")
    return {key: value for key, value in table.items() if key not in ids}


def _numbers(places: Sequence[str]) -> list[int] | None:
    """The numbers at the end of pictures' names, if they count frames; None else."""
    found = [int(match[1]) for place in places if (match := _NUMBER.search(place.rpartition("/")[2]))]
    if len(found) < len(places) or len(found) < 2 or max(found) >= 1 << 31:  # noqa: PLR2004
        return None
    steps = np.diff(found)
    return found if (steps > 0).all() and np.median(steps) == 1.0 and steps.max() > 1 else None


def _about(table: Table) -> dict[str, Json]:
    """What a table says besides whom it shows."""
    return {key: value for key, value in table.items() if not isinstance(value, list | dict)}
