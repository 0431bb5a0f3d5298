"""Which joints of the body a rig has, by their names (`rigs.toml`)."""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from nao_sim.body import SIDES, bones
from nao_sim.recordings.rigs.rig import Rig
from nao_sim.robot import Array

END = "_End"  # what is added to a joint's name for the end of its bone
WANTED = "joint names of a person's rig, such as Hips, LeftArm, LeftForeArm, LeftHand"
FACE = ("left_ear", "right_ear", "left_eye", "right_eye")
FACE_NOTE = "ears and eyes are put on the head as it turns, for a rig has none"
_SIDE_WORDS = {"left": ("left", "l"), "right": ("right", "r")}
_NAMESPACE = re.compile(r"^(.*:)?(mixamorig\d*_?)?", re.IGNORECASE)
_FIRST_WORD = re.compile(r"[^\W_]+[\W_]+")
_SHARED = 0.8  # of the names must begin with the same word for it to say nothing
_EAR, _EYES, _DEPTH = (
    0.2,
    0.08,
    0.25,
)  # of 0.40 m between the shoulders: ears 0.16 m apart, eyes 0.06 m and 0.10 m ahead
_UPPER_ARM = (0.18, 0.42)  # m, of a child of six and of a giant
_ALIGNED, _SQUARE = 0.8, 0.35  # cosines: an upright rest pose has parallel shoulders and hips, square to the neck


def joints_of(rig: Rig, root: int = 0) -> dict[str, int]:
    """The body's joints in a rig.

    Args:
        rig: the tree.
        root: the root of the person, where a file has several.

    Returns:
        The rig's joint by the name that `nao_sim.body` has for it; empty for a
        rig of something else.
    """
    mine = [joint for joint in range(len(rig.names)) if rig.path(joint)[-1] == root]
    names = _bare([rig.names[joint] for joint in mine])
    plain = {_plain(name): joint for joint, name in zip(mine[::-1], names[::-1], strict=True)}  # the first of a name
    found = dict[str, int]()
    for places, spellings in _parts():
        for spelling in spellings:
            here = {place: plain.pop(name) for place, name in zip(places, spelling, strict=True) if name in plain}
            if here:
                found |= here
                break
    return found | _spine(rig, found)


def with_face(rig: Rig, joints: Mapping[str, int]) -> tuple[Rig, dict[str, int]]:
    """The rig with ears and eyes that turn with its head, where its rest pose says which way a head looks.

    A rig knows how its head turns but has no point in the face that shows it.
    The rest pose does where it is that of an upright person: left is from
    shoulder to shoulder, up is from neck to head, ahead is square to both.

    Returns:
        The rig, with the joints of `FACE` added or as it is, and all joints by name.
    """
    axes = _upright(rig, joints)
    if axes is None:
        return rig, dict(joints)
    ahead, left, width = axes
    known = dict(joints)
    for name in FACE:
        sideways = left if name.startswith("left") else -left
        place = _EAR * sideways if name.endswith("ear") else _EYES * sideways + _DEPTH * ahead
        known[name] = len(rig.names)
        rig = rig.with_joint(name, joints["head"], rig.rest[joints["head"]] + width * place)
    return rig, known


def unit_of(rig: Rig, joints: Mapping[str, int]) -> float | None:
    """Metres in one unit of a rig whose joint names tell the database it is from; None for any other.

    A file that was scaled since, whose upper arms would not be a person's, tells nothing.
    """
    for row in _table()["units"]:
        if set(row["joints"]) <= set(rig.names) and {"left_shoulder", "left_elbow"} <= joints.keys():
            length = row["metres"] * np.linalg.norm(rig.rest[joints["left_elbow"]] - rig.rest[joints["left_shoulder"]])
            return float(row["metres"]) if _UPPER_ARM[0] < length < _UPPER_ARM[1] else None
    return None


def _upright(rig: Rig, joints: Mapping[str, int]) -> tuple[Array, Array, float] | None:
    """Ahead and left (3,) of an upright rest pose and the width of its shoulders; None for any other pose."""
    needed = ("left_shoulder", "right_shoulder", "left_hip", "right_hip", "neck", "head")
    if any(name not in joints for name in needed):
        return None
    left_shoulder, right_shoulder, left_hip, right_hip, neck, head = (rig.rest[joints[name]] for name in needed)
    width = float(np.linalg.norm(left_shoulder - right_shoulder))
    left, hips = _unit(left_shoulder - right_shoulder), _unit(left_hip - right_hip)
    up, trunk = _unit(head - neck), _unit(left_shoulder + right_shoulder - left_hip - right_hip)
    ahead = _unit(np.cross(left, trunk))
    toes = [rig.rest[joints[f"{side}_foot"]] - rig.rest[joints[f"{side}_ankle"]]
            for side in SIDES if f"{side}_foot" in joints and f"{side}_ankle" in joints]  # fmt: skip
    upright = left @ hips > _ALIGNED and up @ trunk > _ALIGNED and abs(left @ trunk) < _SQUARE
    return (ahead, left, width) if upright and all(toe @ ahead >= 0.0 for toe in toes) else None


def _spine(rig: Rig, found: Mapping[str, int]) -> dict[str, int]:
    """The joint between pelvis and neck that is nearest to where the body has its spine joint.

    Rigs have one to five joints there, of any name.
    """
    if "neck" not in found or "pelvis" not in found or found["pelvis"] not in (way := rig.path(found["neck"])):
        return {}
    way = way[: way.index(found["pelvis"])][::-1]
    up = np.cumsum([np.linalg.norm(rig.offsets[joint]) for joint in way])
    lengths = {(bone.start, bone.end): bone.length for bone in bones()}
    share = lengths["pelvis", "spine"] / lengths["pelvis", "neck"]
    between = [
        (abs(height / up[-1] - share), joint) for height, joint in zip(up, way, strict=True) if 0.0 < height < up[-1]
    ]
    return {"spine": min(between)[1]} if between else {}


@cache
def _parts() -> tuple[tuple[tuple[str, ...], tuple[tuple[str, ...], ...]], ...]:
    """For each joint, or pair of joints, their names here and, best first, their plain names in rigs."""
    return (*_midline(_table()["midline"]), *_paired(_table()["paired"]))


@cache
def _table() -> Mapping[str, Any]:
    return tomllib.loads(Path(__file__).with_name("rigs.toml").read_text(encoding="utf-8"))


def _midline(table: Mapping[str, Any]) -> Iterator[tuple[tuple[str, ...], tuple[tuple[str, ...], ...]]]:
    for joint, names in table.items():
        yield (joint,), tuple((_plain(centre + name),) for name in names for centre in ("", "c"))  # C_Hips


def _paired(table: Mapping[str, Any]) -> Iterator[tuple[tuple[str, ...], tuple[tuple[str, ...], ...]]]:
    for part, names in table.items():
        spellings = []
        for name in names:
            for words in zip(*_SIDE_WORDS.values(), strict=True):
                stem, end = (name.removesuffix(" end"), "end") if name.endswith(" end") else (name, "")
                spellings.append(tuple(_plain(word + stem) + end for word in words))
                spellings.append(tuple(_plain(stem + word) + end for word in words))
        yield tuple(f"{side}_{part}" for side in SIDES), tuple(spellings)


def _bare(names: Sequence[str]) -> list[str]:
    """Names without a namespace and without the first words that nearly all of them share."""
    bare = [_NAMESPACE.sub("", name) for name in names]
    while True:
        words = Counter(match[0] for name in bare if (match := _FIRST_WORD.match(name)))
        word, count = words.most_common(1)[0] if words else ("", 0)
        if count < max(_SHARED * len(bare), 2):
            return bare
        bare = [name.removeprefix(word) for name in bare]


def _plain(name: str) -> str:
    """Letters and digits; `finger1-1` is not `finger11`."""
    return re.sub(r"[^a-z0-9]", "", re.sub(r"(?<=\d)-(?=\d)", "to", name.lower()))


def _unit(vector: Array) -> Array:
    return np.asarray(vector / max(float(np.linalg.norm(vector)), 1e-12))
