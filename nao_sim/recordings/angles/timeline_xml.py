"""The timelines in Choregraphe's XML, as they stand there.

Motion stands in `Timeline` elements of a behaviour (.xar) or in one `Animation`
element (.qianim): an `ActuatorCurve` a joint, a `Key` a key frame and a
`Tangent` a handle.  A project (.pml) names behaviours.  Everything else is
passed over; document type declarations, and with them entities, are refused.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from xml.parsers import expat

from nao_sim.recordings.source import Source
from nao_sim.recordings.table import number

CHUNK = 1 << 16  # bytes
Attributes = Mapping[str, str]


@dataclass(frozen=True)
class Tangent:
    """A handle: its type (`bezier`, `linear`, `constant`) and its offset in frames and in the curve's unit."""

    kind: str
    frames: float
    value: float


@dataclass(frozen=True)
class Key:
    """A key frame: where it stands in the file, its frame and value, and its tangents by side."""

    line: int
    frame: float
    value: float
    tangents: dict[str, Tangent] = field(default_factory=dict)


@dataclass(frozen=True)
class ActuatorCurve:
    """The keys of one actuator, in the unit that the file says (empty where it says none)."""

    line: int
    actuator: str
    unit: str
    muted: bool
    fps: float | None
    keys: list[Key] = field(default_factory=list)


@dataclass(frozen=True)
class Timeline:
    """A timeline or animation: the box it is in, and its curves.

    Attributes:
        line: where it stands in the file.
        box: the box's name, empty for a file that is one timeline.
        fps: frames a second, where it says so.
        start: the frame that time 0 is at.
        end: the frame that stops it; below 1 where the last key does.
        enabled: whether Choregraphe would play it.
        curves: one an actuator.
    """

    line: int
    box: str
    fps: float | None
    start: float
    end: float
    enabled: bool
    curves: list[ActuatorCurve] = field(default_factory=list)


@dataclass(frozen=True)
class Behaviour:
    """A behaviour that a project names: the line, and the path of its .xar from the project's folder."""

    line: int
    path: str


@dataclass(frozen=True)
class Document:
    """What is in a file."""

    timelines: list[Timeline] = field(default_factory=list)
    behaviours: list[Behaviour] = field(default_factory=list)


def parse(source: Source) -> Document:
    """Read a file's timelines and the behaviours that it names.

    Raises:
        RecordingError: no well-formed XML, a document type declaration, or an
            attribute that is missing or no number.
    """
    reader = _Reader(source)
    parser = reader.parser
    try:
        with source.open() as stream:
            while chunk := stream.read(CHUNK):
                parser.Parse(chunk)
            parser.Parse(b"", True)
    except expat.ExpatError as error:
        raise source.error(expat.ErrorString(error.code), "well-formed XML", error.lineno, error.offset + 1) from None
    except LookupError as error:  # from the declaration's encoding
        raise source.error(str(error), "XML in UTF-8", 1) from None
    return reader.document


class _Reader:
    """Takes the parser's events; holds the timelines that are still open."""

    def __init__(self, source: Source) -> None:
        self.document = Document()
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.StartDoctypeDeclHandler = self._refuse_doctype
        self._source = source
        self._boxes: list[str] = []
        self._open: list[Timeline] = []
        self._elements: Mapping[str, Callable[[Attributes], None]] = {
            "Box": self._box,
            "Timeline": self._timeline,
            "Animation": self._animation,
            "ActuatorCurve": self._curve,
            "Key": self._key,
            "Tangent": self._tangent,
            "BehaviorDescription": self._behaviour,
        }

    def _start(self, name: str, attributes: Attributes) -> None:
        if handler := self._elements.get(name):
            handler(attributes)

    def _end(self, name: str) -> None:
        if name == "Box":
            self._boxes.pop()
        elif name in ("Timeline", "Animation"):
            self.document.timelines.append(self._open.pop())

    def _refuse_doctype(self, *_declaration: object) -> None:
        raise self._source.error("a document type declaration", "XML without one", self._line)

    @property
    def _line(self) -> int:
        return int(self.parser.CurrentLineNumber)

    def _box(self, attributes: Attributes) -> None:
        self._boxes.append(attributes.get("name", ""))

    def _timeline(self, attributes: Attributes, first: float = 1.0) -> None:
        get = self._number
        self._open.append(
            Timeline(
                line=self._line,
                box=self._boxes[-1] if self._boxes else "",
                fps=get(attributes, "fps") if "fps" in attributes else None,
                start=get(attributes, "start_frame") if "start_frame" in attributes else first,
                end=get(attributes, "end_frame") if "end_frame" in attributes else -1.0,
                enabled=attributes.get("enable") not in ("0", "false"),
            )
        )

    def _animation(self, attributes: Attributes) -> None:
        """Version 1 counts frames from 1 as a timeline does, version 2 from 0 (libalmath, qianim/surgeon.h)."""
        self._timeline(attributes, 0.0 if attributes.get("typeVersion", "").startswith("2") else 1.0)

    def _curve(self, attributes: Attributes) -> None:
        if not self._open:
            raise self._source.error("an ActuatorCurve outside", "a Timeline or Animation around it", self._line)
        curve = ActuatorCurve(
            line=self._line,
            actuator=attributes.get("actuator", ""),
            unit=attributes.get("unit", ""),
            muted=attributes.get("mute") in ("1", "true"),
            fps=self._number(attributes, "fps") if "fps" in attributes else None,
        )
        self._open[-1].curves.append(curve)

    def _key(self, attributes: Attributes) -> None:
        if not (self._open and self._open[-1].curves):
            raise self._source.error("a Key outside", "an ActuatorCurve around it", self._line)
        curve = self._open[-1].curves[-1]
        frame, value = (self._number(attributes, name, curve.actuator) for name in ("frame", "value"))
        curve.keys.append(Key(self._line, frame, value))

    def _tangent(self, attributes: Attributes) -> None:
        keys = self._open[-1].curves[-1].keys if self._open and self._open[-1].curves else None
        if not keys:
            raise self._source.error("a Tangent outside", "a Key around it", self._line)
        actuator, side = self._open[-1].curves[-1].actuator, attributes.get("side")
        if side not in ("left", "right"):
            raise self._source.error(f"a Tangent with side '{side}'", "left or right", self._line, actuator)
        frames, value = (
            self._number(attributes, name, actuator) if name in attributes else 0.0
            for name in ("abscissaParam", "ordinateParam")
        )
        keys[-1].tangents[side] = Tangent(attributes.get("interpType", "bezier"), frames, value)

    def _behaviour(self, attributes: Attributes) -> None:
        parts = (attributes.get("src", ""), attributes.get("xar", ""))
        self.document.behaviours.append(Behaviour(self._line, "/".join(part for part in parts if part)))

    def _number(self, attributes: Attributes, name: str, actuator: str = "") -> float:
        column = f"{actuator} {name}".strip()
        value = number(self._source, self._line, column, attributes.get(name, ""))
        if not math.isfinite(value):
            found = f"'{attributes[name]}'" if name in attributes else f"no {name}"
            raise self._source.error(found, "a finite number", self._line, column)
        return value
