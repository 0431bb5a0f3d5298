"""The HIERARCHY of a BVH file: which joints there are, and what the values of a row turn and move."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from nao_sim.recordings.rigs.rig import Rig, vector
from nao_sim.recordings.rigs.rig_joints import END
from nao_sim.recordings.source import Line, Source
from nao_sim.robot import Array

CHANNELS = {f"{axis}{kind}": (kind, number) for kind in ("position", "rotation") for number, axis in enumerate("xyz")}
MOST_JOINTS = 2000
_STATEMENT = re.compile(r"[{}]|[^{}]+")


@dataclass(frozen=True, eq=False)
class Hierarchy:
    """The skeleton of a BVH file.

    Attributes:
        rig: its joints, End Sites included.
        channels: (C,) the joint, the kind of channel and the axis of each value of a row.
    """

    rig: Rig
    channels: tuple[tuple[int, str, int], ...]

    @property
    def columns(self) -> list[str]:
        """What each value of a row is, for messages."""
        return [f"{self.rig.names[joint]} {'XYZ'[axis]}{kind}" for joint, kind, axis in self.channels]


@dataclass
class _Parser:
    """The hierarchy read so far."""

    source: Source
    names: list[str] = field(default_factory=list)
    parents: list[int] = field(default_factory=list)
    offsets: list[Array | None] = field(default_factory=list)
    channels: list[tuple[int, str, int]] = field(default_factory=list)
    open: list[int] = field(default_factory=list)  # the joints whose brace is open
    moving: set[int] = field(default_factory=set)  # the joints that have channels
    waiting: bool = False  # for the brace of the last joint

    def take(self, line: int, statement: str) -> None:
        """Read one statement: a brace, or a keyword and what belongs to it."""
        word, *rest = statement.split()
        if self.waiting != (word == "{"):
            raise self.source.error(f"'{word[:40]}'", self._expected(), line)
        match word.upper():
            case "{":
                self.waiting = False
            case "}" if self.open:
                self._close(line)
            case "ROOT" if not self.open:
                self._begin(line, " ".join(rest), -1)
            case "JOINT" if self.open:
                self._begin(line, " ".join(rest), self.open[-1])
            case "END" if self.open:
                self._begin(line, self.names[self.open[-1]] + END, self.open[-1])
            case "OFFSET" if self.open:
                self.offsets[self.open[-1]] = vector(self.source, line, f"{self.names[self.open[-1]]} OFFSET", rest)
            case "CHANNELS" if self.open:
                self._channels(line, rest)
            case _:
                raise self.source.error(f"'{statement[:40]}'", self._expected(), line)

    def finish(self, line: int) -> Hierarchy:
        """The hierarchy, at the line of MOTION."""
        if self.open or self.waiting:
            brace = "'{'" if self.waiting else f"'}}' for joint {self.names[self.open[-1]]}"
            raise self.source.error("MOTION", brace, line)
        if not self.names:
            raise self.source.error("MOTION", "ROOT and a skeleton before it", line)
        if not self.channels:
            raise self.source.error("a skeleton without CHANNELS", "channels, the values of a row", line)
        rig = Rig(tuple(self.names), tuple(self.parents), np.array(self.offsets))
        return Hierarchy(rig, tuple(self.channels))

    def _expected(self) -> str:
        if self.waiting:
            return f"'{{' after joint {self.names[-1]}"
        return "OFFSET, CHANNELS, JOINT, End Site or '}'" if self.open else "ROOT or MOTION"

    def _begin(self, line: int, name: str, parent: int) -> None:
        if not name:
            raise self.source.error("a joint without a name", "a name", line)
        if len(self.names) == MOST_JOINTS:
            raise self.source.error(f"more than {MOST_JOINTS} joints", "a person", line)
        self.open.append(len(self.names))
        self.names.append(name)
        self.parents.append(parent)
        self.offsets.append(None)
        self.waiting = True

    def _close(self, line: int) -> None:
        joint = self.open.pop()
        if self.offsets[joint] is None:
            raise self.source.error(f"joint {self.names[joint]} without OFFSET", "OFFSET x y z before '}'", line)

    def _channels(self, line: int, words: list[str]) -> None:
        joint, count, names = self.open[-1], words[0] if words else "", [word.lower() for word in words[1:]]
        if joint in self.moving:
            raise self.source.error("CHANNELS twice", "once in a joint", line, self.names[joint])
        self.moving.add(joint)
        if count != str(len(names)):
            raise self.source.error(f"'{count[:40]}' and {len(names)} names", "their number and as many names", line)
        for name in names:
            if name not in CHANNELS:
                expected = "Xposition, Yposition, Zposition, Xrotation, Yrotation or Zrotation"
                raise self.source.error(f"unknown channel '{name[:40]}'", expected, line, self.names[joint])
            if names.count(name) > 1:
                raise self.source.error(f"channel '{name}' twice", "each channel once", line, self.names[joint])
            self.channels.append((joint, *CHANNELS[name]))


def hierarchy_of(source: Source, lines: Iterator[Line]) -> tuple[Hierarchy, int]:
    """Read the skeleton, down to and with the line MOTION, whose number is returned too.

    Args:
        source: the file, for messages.
        lines: its lines that are not blank; those after MOTION are left.

    Raises:
        RecordingError: something in it is not as it should be.
    """
    parser, number = _Parser(source), 1
    next(lines)  # HIERARCHY
    for number, text in lines:
        for statement in (part.strip() for part in _STATEMENT.findall(text)):
            if statement.upper() == "MOTION":
                return parser.finish(number), number
            if statement:
                parser.take(number, statement)
    unclosed = f" with joint {parser.names[parser.open[-1]]} open" if parser.open else ""
    raise source.error(f"the file ends in the hierarchy{unclosed}", "'}' for each '{', then MOTION and frames", number)
