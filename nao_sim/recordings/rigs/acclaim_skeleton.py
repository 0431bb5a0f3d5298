"""Acclaim skeleton files (ASF): the bones that an AMC file turns.

A bone has a direction and a length in the skeleton's own axes, an `axis` (the
turn of the frame that its degrees of freedom are about) and its `dof`.  Turns
of several axes are about fixed axes, the first named first.  M. Lander,
"Working with motion capture file formats" (Game Developer, January 1998),
describes the format; the CMU database says that 0.45 for `length` makes a unit
of 1/0.45 inch.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.recordings.rigs.rig import LARGEST, Rig, scalar, vector
from nao_sim.recordings.rigs.rig_joints import END
from nao_sim.recordings.source import Source, is_skipped
from nao_sim.robot import Array

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

ROOT = "root"
CMU_LENGTH = 0.45  # inches of a unit's reciprocal, as CMU's files say
INCH = 0.0254  # m
MOST_BONES = 2000
TYPICAL = Path(__file__).with_name("cmu.asf")
GIVE = "give the right one with --rig FILE.asf"
_COMPRESSED = ("", ".xz", ".gz", ".bz2")
DOFS = {f"{kind}{axis}": (kind, number) for kind in "tr" for number, axis in enumerate("xyz")}


@dataclass(frozen=True, eq=False)
class AcclaimRig:
    """A skeleton, and what the numbers of an AMC file do to it.

    Attributes:
        rig: its joints: the root, where each bone begins, and where the last bones end.
        dofs: by joint, the degrees of freedom in the order of the AMC file's values: kind ("t" or "r") and axis.
        frames: by joint, the turn of the frame that they are about.
        unit: metres in one unit of length; None where the file does not say.
    """

    rig: Rig
    dofs: Mapping[int, tuple[tuple[str, int], ...]]
    frames: Mapping[int, Rotation]
    unit: float | None


def skeleton_of(source: Source) -> AcclaimRig:
    """Read an ASF file.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    if source.kind() != "text":
        raise source.error("a folder or binary data", "an ASF skeleton")
    parser, number = _Parser(source), 1
    for number, text in source.lines():
        if not is_skipped(text):
            parser.take(number, text.split())
    return parser.finish(number)


def skeleton_path(source: Source) -> tuple[Path, tuple[str, ...]]:
    """The ASF file that an AMC file moves, and what to tell the user of it.

    It is the caller's; or the one that is named as the AMC file, or as what
    stands before a `_` in its name (`13.asf` for `13_30.amc.xz`), in the same
    folder, the one above, or a folder `asf` in either; or the typical one.
    """
    if source.rig is not None:
        return source.rig, ()
    stem = re.sub(r"(\.amc)?(\.(xz|gz|bz2))?$", "", source.path.name, flags=re.IGNORECASE)
    subjects = [stem[: mark.start()] for mark in re.finditer(r"(?<=.)([-_. ]|$)", stem)]
    here = source.path.resolve().parent
    for subject in reversed(subjects):
        for folder in (here, here.parent, here / "asf", here.parent / "asf"):
            for ending in (".asf", ".ASF"):
                for packed in _COMPRESSED:
                    path = folder / f"{subject}{ending}{packed}"
                    if path.is_file():
                        return path, (f"skeleton {path.name}, found in {folder.name}/",)
    wanted = f"no skeleton {subjects[0]}.asf nearby" if subjects else "no skeleton nearby"
    return TYPICAL, (f"{wanted}: a typical one of CMU's was taken, so lengths and the trunk are approximate; {GIVE}",)


@dataclass
class _Bone:
    """A bone as far as it was read, and the line it begins on."""

    line: int
    words: dict[str, list[str]] = field(default_factory=dict)
    lines: dict[str, int] = field(default_factory=dict)


@dataclass
class _Parser:
    """The skeleton read so far."""

    source: Source
    section: str = ""
    open: bool = False
    bone: _Bone | None = None
    unit: float | None = None
    degrees: bool = True
    bones: dict[str, _Bone] = field(default_factory=dict)
    children: dict[str, list[str]] = field(default_factory=dict)
    parent: dict[str, str] = field(default_factory=dict)

    def take(self, line: int, words: list[str]) -> None:
        """Read one line."""
        if words[0].startswith(":"):
            self._section(line, words)
        elif not self.section:
            raise self.source.error(f"'{' '.join(words)[:40]}'", "an ASF skeleton, which begins with ':version'", line)
        elif self.section == "units" and len(words) > 1:
            self._units(line, *words[:2])
        elif self.section == "root" and self.bone:
            self._put(self.bone, line, words)
        elif self.section == "bonedata":
            self._bonedata(line, words)
        elif self.section == "hierarchy":
            self._hierarchy(line, words)

    def finish(self, line: int) -> AcclaimRig:
        """The skeleton, at the file's last line."""
        if self.open or self.bone is not self.bones.get(ROOT):
            raise self.source.error("the file ends in a block", "'end'", line)
        if ROOT not in self.bones or len(self.bones) == 1:
            raise self.source.error("no bones" if self.bones else "no :root", ":root, :bonedata and :hierarchy", line)
        if loose := [name for name in self.bones if name != ROOT and name not in self.parent]:
            raise self.source.error(f"bone {loose[0]} without a parent", "its place in :hierarchy", line)
        return self._built()

    def _units(self, line: int, name: str, value: str) -> None:
        if name.lower() == "length":
            length = scalar(self.source, line, name, value)
            self.unit = INCH / CMU_LENGTH if abs(length - CMU_LENGTH) < 1e-6 else None  # noqa: PLR2004
        if name.lower() == "angle":
            if value.lower() not in ("deg", "rad"):
                raise self.source.error(f"'{value[:40]}'", "deg or rad", line, name)
            self.degrees = value.lower() == "deg"

    def _section(self, line: int, words: list[str]) -> None:
        if self.open:
            raise self.source.error(words[0], "'end' before it", line)
        self.section = words[0][1:].lower()
        if self.section == "root":
            self.bone = self.bones[ROOT] = _Bone(line, {"dof": [], "axis": ["0", "0", "0", "XYZ"]})

    def _bonedata(self, line: int, words: list[str]) -> None:
        word = words[0].lower()
        if word in ("begin", "end") and (word == "begin") == self.open:
            raise self.source.error(f"'{word}'", "'end'" if self.open else "'begin'", line)
        if word == "begin":
            self.open, self.bone = True, _Bone(line)
        elif word == "end" and self.bone:
            name = self._word(self.bone, "name")
            if name in self.bones:
                raise self.source.error(f"bone {name} twice", "each bone once", self.bone.line)
            if len(self.bones) > MOST_BONES:
                raise self.source.error(f"more than {MOST_BONES} bones", "a person", line)
            self.bones[name] = self.bone
            self.open, self.bone = False, self.bones.get(ROOT)
        elif self.open and self.bone:
            self._put(self.bone, line, words)
        else:
            raise self.source.error(f"'{' '.join(words)[:40]}'", "'begin' of a bone", line)

    def _put(self, bone: _Bone, line: int, words: list[str]) -> None:
        bone.words[words[0].lower()], bone.lines[words[0].lower()] = words[1:], line

    def _hierarchy(self, line: int, words: list[str]) -> None:
        if words[0].lower() in ("begin", "end"):
            self.open = words[0].lower() == "begin"
            return
        for name in words:
            if name not in self.bones:
                raise self.source.error(f"unknown bone '{name[:40]}'", "a bone of :bonedata, or root", line)
        for name in words[1:]:
            if name in self.parent or name == ROOT:
                raise self.source.error(f"a second parent for {name}", "one parent for each bone", line)
            self.parent[name] = words[0]
            self.children.setdefault(words[0], []).append(name)

    def _built(self) -> AcclaimRig:
        order = list(self._down())
        if lost := [name for name in self.bones if name not in order]:
            raise self.source.error(
                f"bone {lost[0]} hangs on itself", "a way from root to each bone", self.bones[lost[0]].line
            )
        ends = {name: self._end(name) for name in order}
        places = [ends.get(self.parent.get(name, ""), np.zeros(3)) for name in order]
        leaves = [name for name in order if name not in self.children]
        parents = [order.index(self.parent[name]) if name in self.parent else -1 for name in order]
        rig = Rig(
            (*order, *(name + END for name in leaves)),
            (*parents, *(order.index(name) for name in leaves)),
            np.array([*places, *(ends[name] for name in leaves)]),
        )
        dofs = {joint: self._dofs(name) for joint, name in enumerate(order)}
        frames = {joint: self._frame(name) for joint, name in enumerate(order)}
        return AcclaimRig(rig, dofs, frames, self.unit)

    def _down(self) -> Iterator[str]:
        """The bones, each after its parent."""
        waiting = [ROOT]
        while waiting:
            name = waiting.pop()
            yield name
            waiting += reversed(self.children.get(name, []))

    def _word(self, bone: _Bone, key: str) -> str:
        if not bone.words.get(key):
            raise self.source.error(f"a bone without {key}", "name, direction, length and axis", bone.line)
        return bone.words[key][0]

    def _end(self, name: str) -> Array:
        """From where a bone begins to where it ends (3,)."""
        if name == ROOT:
            return np.zeros(3)
        bone = self.bones[name]
        self._word(bone, "direction"), self._word(bone, "length")
        direction = vector(self.source, bone.lines["direction"], f"{name} direction", bone.words["direction"])
        length = scalar(self.source, bone.lines["length"], f"{name} length", " ".join(bone.words["length"]))
        size = float(np.linalg.norm(direction))
        if not (size > 0.0 and 0.0 <= length < LARGEST):
            expected = f"a direction, and a length from 0 to {LARGEST:g}"
            raise self.source.error(f"length {length:g} along {direction}", expected, bone.line, name)
        return direction / size * length

    def _dofs(self, name: str) -> tuple[tuple[str, int], ...]:
        bone = self.bones[name]
        words = [word.lower() for word in bone.words.get("order" if name == ROOT else "dof", [])]
        allowed = [word for word in DOFS if name == ROOT or word.startswith("r")]
        for word in words:
            if word not in allowed or words.count(word) > 1:
                line = bone.lines["order" if name == ROOT else "dof"]
                raise self.source.error(f"'{word[:40]}'", f"{', '.join(allowed)}, each once", line, name)
        return tuple(DOFS[word] for word in words)

    def _frame(self, name: str) -> Rotation:
        from scipy.spatial.transform import Rotation

        bone = self.bones[name]
        self._word(bone, "axis")
        words, line = bone.words["axis"], bone.lines.get("axis", bone.line)
        if name == ROOT:
            words = [*bone.words.get("orientation", ["0", "0", "0"])[:3], words[-1]]
        if sorted(words[-1].upper()) != ["X", "Y", "Z"]:
            raise self.source.error(
                f"axis '{' '.join(words)[:40]}'", "three angles and an order such as XYZ", line, name
            )
        angles = vector(self.source, line, f"{name} axis", words[:-1])
        return Rotation.from_euler(words[-1].lower(), angles, degrees=self.degrees)


def channels(skeleton: AcclaimRig, joint: int) -> Sequence[str]:
    """What the values of a bone are, for messages: `lhumerus rx` …."""
    return [f"{skeleton.rig.names[joint]} {kind}{'xyz'[axis]}" for kind, axis in skeleton.dofs[joint]]
