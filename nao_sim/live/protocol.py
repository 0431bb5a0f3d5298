"""What clients may say: JSON texts and binary frames, checked and turned into values.

docs/live.md shows each message.  Whatever else comes is a `LiveError` that says
what was found and what was expected; nothing of it reaches the robot.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeVar

import numpy as np

from nao_sim.errors import RecordingError
from nao_sim.live.problem import LiveError
from nao_sim.recordings.landmarks.landmark_points import Numbers, quick
from nao_sim.recordings.skeletons.layouts import Axes
from nao_sim.recordings.source import Source
from nao_sim.robot import Array

VERSION = 1
MOST_POINTS = 256
FARTHEST = 1e6  # in the sender's unit; nobody stands there
LARGEST = 64 * 1024  # bytes of a message; 33 points of full precision take 3 kB
ROLES = ("person", "observer", "robot")
MODES = ("one-to-one", "gestures")
RATES = (50, 25)  # states a second
BINARY = struct.Struct("<2sBBId")  # magic, version, numbers a point, points, time
MAGIC = b"NF"
_SOURCE = Source(Path("frame"))
_WORDS = {str: "a text", bool: "true or false", int: "a whole number", list: "a list"}
_T = TypeVar("_T")
Role = Literal["person", "observer", "robot"]
Mode = Literal["one-to-one", "gestures"]


@dataclass(frozen=True, eq=False)
class Frame:
    """One person at an instant, as a sensor sees it.

    Attributes:
        time: s, of the sender's clock.
        points: (P, 3) in the sender's unit and axes; nan where missing.
        confidence: (P,) from 0 to 1, nan where not told.
    """

    time: float
    points: Array
    confidence: Array


@dataclass(frozen=True, eq=False)
class Angles:
    """A robot's joint angles at an instant, of a recording that holds those.

    Attributes:
        time: s, of the sender's clock.
        positions: (26,); not finite where nothing is asked.
    """

    time: float
    positions: Array


@dataclass(frozen=True)
class Hello:
    """Who a client is and what it wants; the first message of each.

    Attributes:
        role: `person` sends frames, `observer` sees states, `robot` gets commands alone.
        session: which robot; a new one for a person, the server's own for others, where None.
        layout: what the points are, a built-in layout's name.
        mode: whether every frame is imitated, or gestures are recognised and played.
        mirror: whether the robot is the person's mirror image.
        unit: metres in one unit of the points, where told.
        axes: the person's (forward, left, up) as signed axes of the points, where told.
        planar: whether the third coordinate is unknown.
        rate: states a second.
        token: what a server that is open to others asks for.
    """

    role: Role = "person"
    session: str | None = None
    layout: str = "mediapipe_pose"
    mode: Mode = "one-to-one"
    mirror: bool = False
    unit: float | None = None
    axes: Axes | None = None
    planar: bool = False
    rate: int = RATES[0]
    token: str | None = None


@dataclass(frozen=True)
class Order:
    """Something that a person may ask for while connected.

    Attributes:
        what: `config`, `pause`, `record`, `replay`, `download`, `reset`, `ping` or `bye`.
        on: whether it begins or ends.
        mode: for `config`, the new one.
        mirror: for `config`, the new one.
        echo: for `ping`, what comes back.
    """

    what: str
    on: bool = True
    mode: Mode | None = None
    mirror: bool | None = None
    echo: float | None = None


SIGNED_AXES = tuple(sign + axis for sign in "+-" for axis in "xyz")
ORDERS = ("config", "pause", "record", "replay", "download", "reset", "ping", "bye")
TYPES = ("hello", "frame", *ORDERS)
Message = Hello | Frame | Order


def parse(data: str | bytes) -> Message:
    """The message in a text or a binary.

    Raises:
        LiveError: it is none.
    """
    if len(data) > LARGEST:
        raise LiveError("too_large", f"a message of {len(data)} bytes; expected at most {LARGEST}")
    if isinstance(data, bytes):
        return binary_frame(data)
    message = _table(data)
    kind = message.get("type", "frame" if "points" in message else None)
    if kind == "frame":
        return _frame(message)
    if kind == "hello":
        return _hello(message)
    if kind in ORDERS:
        return _order(str(kind), message)
    raise LiveError("unknown_type", f"type {_shown(kind)}; expected one of {', '.join(TYPES)}")


def binary_frame(data: bytes) -> Frame:
    """The frame in a binary message: a header of 16 bytes, then little-endian float32.

    Raises:
        LiveError: it is none.
    """
    if len(data) < BINARY.size or data[:2] != MAGIC:
        raise LiveError("bad_binary", f"{len(data)} bytes that begin with {data[:2]!r}; expected a frame, b'NF'")
    _, version, width, count, time = BINARY.unpack_from(data)
    if version != VERSION or width not in {3, 4} or not 0 < count <= MOST_POINTS:
        found = f"version {version}, {width} numbers a point, {count} points"
        raise LiveError("bad_binary", f"{found}; expected {VERSION}, 3 or 4, and 1 to {MOST_POINTS}")
    expected = BINARY.size + 4 * width * count
    if len(data) != expected:
        raise LiveError("bad_binary", f"{len(data)} bytes; expected {expected} for {count} points of {width} numbers")
    rows = np.frombuffer(data, "<f4", offset=BINARY.size).reshape(count, width).astype(float)
    return _checked(time, rows)


def pack(frame: Frame) -> bytes:
    """A frame as a binary message."""
    rows = np.column_stack([frame.points, frame.confidence]).astype("<f4")
    return BINARY.pack(MAGIC, VERSION, rows.shape[1], len(rows), frame.time) + rows.tobytes()


def _table(text: str) -> Mapping[str, Any]:
    try:
        message = json.loads(text)
    except (ValueError, RecursionError):
        raise LiveError("bad_json", f"no JSON in {_shown(text)}; expected an object with a type") from None
    if not isinstance(message, dict):
        raise LiveError("bad_json", f"JSON {_shown(message)}; expected an object with a type")
    return message


def _frame(message: Mapping[str, Any]) -> Frame:
    time, node = message.get("time"), message.get("points")
    if isinstance(time, bool) or not isinstance(time, int | float):
        raise LiveError("bad_frame", f"time {_shown(time)}; expected seconds, a number")
    if not isinstance(node, list) or not 0 < len(node) <= MOST_POINTS:
        found = f"{len(node)} points" if isinstance(node, list) else f"points {_shown(node)}"
        raise LiveError("bad_frame", f"{found}; expected a list of 1 to {MOST_POINTS} points")
    try:
        numbers = Numbers(_SOURCE)
        rows = quick(node) or [numbers.point(point, key) for key, point in enumerate(node)]
        return _checked(float(time), np.array(rows, float))
    except RecordingError as error:
        raise LiveError("bad_frame", f"{error.found}; expected {error.expected}") from None
    except (OverflowError, RecursionError, TypeError, ValueError):
        raise LiveError(
            "bad_frame", "points that are no numbers; expected [x, y, z] or [x, y, z, visibility]"
        ) from None


def _checked(time: float, rows: Array) -> Frame:
    if not math.isfinite(time):
        raise LiveError("bad_frame", f"time {time}; expected a finite number of seconds")
    with np.errstate(invalid="ignore"):
        points = np.where(np.isfinite(rows[:, :3]) & (np.abs(rows[:, :3]) < FARTHEST), rows[:, :3], np.nan)
    sure = rows[:, 3] if rows.shape[1] > 3 else np.full(len(rows), np.nan)  # noqa: PLR2004
    return Frame(time, points, np.clip(sure, 0.0, 1.0))


def _hello(message: Mapping[str, Any]) -> Hello:
    version = _get(message, "protocol", int, VERSION)
    if version != VERSION:
        raise LiveError("bad_version", f"protocol {version}; expected {VERSION}")
    return Hello(
        role=_one_of(message, "role", ROLES, "person"),
        session=_get(message, "session", str, None),
        layout=_get(message, "layout", str, Hello.layout),
        mode=_one_of(message, "mode", MODES, Hello.mode),
        mirror=_get(message, "mirror", bool, False),
        unit=_unit(message.get("unit")),
        axes=_axes(_get(message, "axes", list, None)),
        planar=_get(message, "planar", bool, False),
        rate=_one_of(message, "rate", RATES, Hello.rate),
        token=_get(message, "token", str, None),
    )


def _order(what: str, message: Mapping[str, Any]) -> Order:
    echo = message.get("echo")
    return Order(
        what,
        on=_get(message, "on", bool, True),
        mode=_one_of(message, "mode", MODES, None),
        mirror=_get(message, "mirror", bool, None),
        echo=float(echo) if isinstance(echo, int | float) and abs(echo) < FARTHEST**2 else None,
    )


def _get(message: Mapping[str, Any], key: str, kind: type[_T], default: Any) -> Any:
    value = message.get(key)
    if value is None:
        return default
    if type(value) is not kind:
        raise LiveError("bad_message", f"{key} {_shown(value)}; expected {_WORDS[kind]}")
    return value


def _one_of(message: Mapping[str, Any], key: str, known: tuple[Any, ...], default: Any) -> Any:
    value = message.get(key)
    if value is None:
        return default
    if isinstance(value, bool) or not isinstance(value, str | int) or value not in known:
        raise LiveError("bad_message", f"{key} {_shown(value)}; expected one of {', '.join(map(str, known))}")
    return value


def _unit(value: Any) -> float | None:
    from nao_sim.recordings.skeletons.layout_file import LENGTHS

    if value is None:
        return None
    if isinstance(value, str) and value in LENGTHS:
        return float(LENGTHS[value])
    raise LiveError("bad_message", f"unit {_shown(value)}; expected one of {', '.join(LENGTHS)}")


def _axes(value: list[Any] | None) -> Axes | None:
    if value is None:
        return None
    signed = [each for each in value if each in SIGNED_AXES]
    if len(value) != len(signed) or len({axis[1] for axis in signed}) != len("xyz"):
        raise LiveError("bad_message", f'axes {_shown(value)}; expected the person\'s, such as ["-z", "+x", "-y"]')
    return signed[0], signed[1], signed[2]


def _shown(value: Any) -> str:
    """A value in a message, not too long."""
    text = ascii(value)
    return text if len(text) <= 60 else f"{text[:57]}..."  # noqa: PLR2004
