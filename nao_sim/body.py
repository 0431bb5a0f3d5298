"""The person's joints and bones, read from `body.toml`.

A joint's name is `head`, `nose`, `neck`, `chest` (between the shoulders),
`spine` (half way down), `pelvis` (between the hips), or `left_`/`right_` with
`shoulder`, `elbow`, `wrist`, `hand` (palm), `hand_tip`, `hip`, `knee`, `ankle`,
`heel`, `foot` (toes), `eye`, `ear` or a finger joint (`index_mcp`).  Left and
right are the person's own.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import chain
from pathlib import Path
from types import MappingProxyType
from typing import Any

SIDES = ("left", "right")
_SIDE_WORDS = {"left": ("left", "l"), "right": ("right", "r")}


@dataclass(frozen=True)
class Bone:
    """A stretch of the body that keeps its length.

    Attributes:
        start: the joint it begins at.
        end: the joint it ends at.
        length: typical length in heights of the body.
    """

    start: str
    end: str
    length: float


def twin(joint: str) -> str:
    """The joint of the same name on the other side (a midline joint is its own)."""
    if joint.startswith("left_"):
        return "right_" + joint.removeprefix("left_")
    return "left_" + joint.removeprefix("right_") if joint.startswith("right_") else joint


@cache
def joints() -> tuple[str, ...]:
    """Every joint's name."""
    paired = tuple(f"{side}_{name}" for side in SIDES for name in _table()["paired"])
    return (*_table()["midline"], *paired)


@cache
def bones() -> tuple[Bone, ...]:
    """Every bone, those of both sides included."""
    found = []
    for row in _table()["bones"]:
        for side in SIDES if "{side}" in row["from"] else ("",):
            found.append(Bone(row["from"].format(side=side), row["to"].format(side=side), row["length"]))
    return tuple(found)


def joint_called(name: str) -> str | None:
    """The joint that a file means by `name`: `ShoulderLeft`, `l_shoulder`, `mixamorig:LeftHand` …, or None."""
    return _aliases().get(_bare(name))


def joints_called(names: Sequence[str]) -> tuple[str | None, ...]:
    """The joints that a file means by its names, taken together.

    Where there is a forearm, names are those of a rig's bones, each at the
    joint where it begins: `LeftArm` is the shoulder, `LeftHand` the wrist, and
    `LeftShoulder` the collarbone.
    """
    plain = [_bare(name) for name in names]
    bones = _spelled(_table()["rig"])
    if not any(bones.get(name, "").endswith("_elbow") for name in plain):
        return tuple(joint_called(name) for name in names)
    shoulders = ("left_shoulder", "right_shoulder")
    return tuple(bones.get(name) or (None if (joint := _aliases().get(name)) in shoulders else joint) for name in plain)


@cache
def _aliases() -> Mapping[str, str]:
    """Joints by every plain spelling of every name of theirs."""
    known = {_plain(alias): joint for joint, names in _table()["midline"].items() for alias in (joint, *names)}
    return MappingProxyType(known | _spelled(_table()["paired"], own=True))


def _spelled(parts: Mapping[str, list[str]], own: bool = False) -> dict[str, str]:
    """Joints of both sides by every plain spelling of the names of their parts (and of their `own`)."""
    bare = {_plain(name) for name in (*parts, *chain.from_iterable(parts.values()))}  # "heel" is no "hee" of the left
    return {
        _plain(spelling): f"{side}_{part}"
        for part, names in parts.items()
        for side, words in _SIDE_WORDS.items()
        for alias in (*names, *(part,) * own)
        for word in words
        for spelling in (word + alias, alias + word)
        if _plain(spelling) not in bare
    }


def _bare(name: str) -> str:
    """A plain name without a namespace or an enumeration's name before it (`JointType.Head`, `K4ABT_JOINT_HEAD`)."""
    plain = _plain(name.rpartition(":")[2])
    return next((plain.removeprefix(prefix) for prefix in _prefixes() if plain.startswith(prefix)), plain)


@cache
def _prefixes() -> tuple[str, ...]:
    return tuple(sorted(map(_plain, _table()["enumerations"]["prefixes"]), key=len, reverse=True))


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())


@cache
def _table() -> Mapping[str, Any]:
    return tomllib.loads((Path(__file__).parent / "body.toml").read_text(encoding="utf-8"))
