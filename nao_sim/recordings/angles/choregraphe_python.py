"""The lists `names`, `times` and `keys` that Choregraphe exports as Python.

A joint has a list of times (s) and a list of keys: angles (rad, hands 0..1),
or `[angle, [type, s, rad], [type, s, rad]]` with the handles before and after
(ALMotion.angleInterpolationBezier; the types are `keyframes.Kind`).  The file
is read, never run.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.motion import JointTrajectory
from nao_sim.recordings.angles.fixed_options import refuse_options
from nao_sim.recordings.angles.keyframes import AFTER, BEFORE, RATE, Curve, Kind, trajectory
from nao_sim.recordings.angles.python_lists import Literal, Statement, list_statements, literal
from nao_sim.recordings.recording import Label, Recording
from nao_sim.recordings.source import Source
from nao_sim.robot import load_robot

NAME = "Choregraphe Python lists"
LOOKS = "Python with lists names, times and keys"
ROLES = {"names": "names", "jointNames": "names", "times": "times", "timeLists": "times",
         "keys": "keys", "angleLists": "keys"}  # fmt: skip
KINDS = frozenset(float(kind) for kind in Kind)
LARGEST = 1 << 28  # bytes
LISTED = 5  # motions named in a note
HEAD = """\
# Joint angles as Choregraphe exports them: seconds, radians, hands 0 (closed) to 1 (open), straight between keys.
# On a NAO: motion.angleInterpolationBezier(names, times, keys).  Its first posture must be near and no time 0:
# add to all times what it may take to get there.
"""
_LIST = re.compile(rf"(?P<before>\w+_)?(?P<what>{'|'.join(ROLES)})(?P<after>\d+|_\w+)?")
_SIGN = re.compile(
    rf"^\s*(?:self\.)?(?:\w+_)?(?:{'|'.join(ROLES)})(?:\d+|_\w+)?\s*(?:=(?!=)|\.\s*append\s*\()", re.MULTILINE
)
_PYTHON = re.compile(r"^\s*(?:#.*python|#.*coding|import\s+\w|from\s+[\w.]+\s+import|def\s+\w+\s*\(|class\s+\w+)",
                     re.MULTILINE | re.IGNORECASE)  # fmt: skip
_RELATIVE = re.compile(
    r"^[^#\n]*(?:\bangleInterpolation\s*\([^()]*\bFalse\s*\)|\bisAbsolute\s*=\s*False\b)", re.MULTILINE
)


@dataclass(frozen=True)
class _Lists:
    """The statements that fill one motion's lists, by role."""

    by_role: dict[str, list[Statement]] = field(default_factory=dict)

    @property
    def first(self) -> Statement:
        return self.by_role["names"][0]

    @property
    def name(self) -> str:
        inside = f" in {self.first.function}()" if self.first.function else ""
        return f"line {self.first.line}{inside}"


def recognise(source: Source) -> str | None:
    """Why the file is such Python, or None."""
    start = source.start.decode("utf-8", "replace")
    if _SIGN.search(start):
        return "it fills lists called names, times and keys"
    if not _PYTHON.search(start):
        return None
    filled = any(_SIGN.match(text) for _, text in source.lines())
    return "Python that fills lists called names, times and keys" if filled else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file.
        reason: why it is taken for this format.

    Returns:
        The recording: the longest motion in it, at its keys, and sampled at
        `RATE` where it is not straight between them.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    refuse_options(source, "a Choregraphe Python list", "rad")
    text = _text(source)
    _refuse_relative(source, text)
    motions = [(lists, _curves(source, lists)) for lists in _motions(text)]
    if not motions:
        raise source.error("no list of all three kinds", "lists called names, times and keys")
    lists, curves = max(motions, key=lambda motion: max(curve.times[-1] for curve in motion[1]))
    motion = trajectory(source, curves)
    keys = np.unique(np.concatenate([curve.times for curve in curves]))
    label = Label(lists.first.function or source.path.stem, float(motion.times[0]), float(motion.times[-1]))
    notes = _notes(lists, [other for other, _ in motions], curves, len(motion) > len(keys))
    return Recording(source.path, NAME, reason, motion, len(keys), notes, (label,))


def _text(source: Source) -> str:
    """The file's text; other encodings stand in comments and strings only, so they do no harm."""
    with source.open() as stream:
        content = stream.read(LARGEST + 1)
    if len(content) > LARGEST:
        raise source.error(f"more than {LARGEST >> 20} MB of Python", "lists of key frames")
    return "\n".join(content.decode("utf-8-sig", "replace").splitlines())


def _refuse_relative(source: Source, text: str) -> None:
    if match := _RELATIVE.search(text):
        line = text.count("\n", 0, match.start()) + 1
        raise source.error("angles relative to the robot's (isAbsolute False)", "absolute angles", line)


def _motions(text: str) -> Iterator[_Lists]:
    """The motions in a program; assigning a list anew starts the next."""
    current: dict[tuple[str | None, str | None], _Lists] = {}
    complete: list[_Lists] = []
    for statement in list_statements(text):
        if not (match := _LIST.fullmatch(statement.name)):
            continue
        which, role = (match["before"], match["after"]), ROLES[match["what"]]
        lists = current.setdefault(which, _Lists())
        if statement.how == "=" and role in lists.by_role:
            complete.append(lists)
            lists = current[which] = _Lists()
        lists.by_role.setdefault(role, []).append(statement)
    for lists in sorted((*complete, *current.values()), key=_line):
        if len(lists.by_role) == len(set(ROLES.values())) and not _only_empty(lists):
            yield lists


def _line(lists: _Lists) -> int:
    return min(statements[0].line for statements in lists.by_role.values())


def _only_empty(lists: _Lists) -> bool:
    """Whether a motion is no more than `names = list()` and so on."""
    return all(statement.value.strip() in ("[]", "list()") for statement in itertools.chain(*lists.by_role.values()))


def _filled(source: Source, statements: Sequence[Statement]) -> list[tuple[int, Literal]]:
    """A list's items with the lines of the statements that they came from."""
    items: list[tuple[int, Literal]] = []
    for statement in statements:
        value = literal(source, statement)
        if statement.how == "append":
            items.append((statement.line, value))
        elif isinstance(value, list):
            items += [(statement.line, item) for item in value]
        else:
            raise source.error(f"{value!r}", "a list", statement.line, statement.name)
    return items


def _curves(source: Source, lists: _Lists) -> list[Curve]:
    """The curves of a motion's joints."""
    names, times, keys = (_filled(source, lists.by_role[role]) for role in ("names", "times", "keys"))
    if not len(names) == len(times) == len(keys):
        found = f"{len(names)} names, {len(times)} lists of times and {len(keys)} of keys"
        raise source.error(found, "one list of times and one of keys for each name", lists.first.line)
    seen = set[str]()
    for line, name in names:
        if not isinstance(name, str) or name not in load_robot().index:
            raise source.error("unknown joint", "a NAOqi joint name", line, str(name))
        if name in seen:
            raise source.error("another list", "each joint once", line, name)
        seen.add(name)
    if not names:
        raise source.error("no joints", "names of joints", lists.first.line)
    rows = zip(names, times, keys, strict=True)
    return [_curve(source, str(name), *when, *what) for (_, name), when, what in rows]


def _curve(source: Source, joint: str, times_line: int, times: Literal, line: int, keys: Literal) -> Curve:
    """One joint's curve."""
    if not (isinstance(times, list) and isinstance(keys, list) and len(times) == len(keys) > 0):
        counts = [f"{len(values)}" if isinstance(values, list) else "no list of" for values in (times, keys)]
        raise source.error(f"{counts[0]} times and {counts[1]} keys", "a time for each key", line, joint)
    seconds = np.array([_number(source, times_line, joint, time) for time in times])
    if (wrong := np.diff(seconds, prepend=-1e-300) <= 0.0).any():
        first = int(wrong.argmax())
        expected = f"a time after {seconds[first - 1]:g} s" if first else "times from 0 s on"
        raise source.error(f"a time of {seconds[first]:g} s", expected, times_line, joint)
    rows = [_key(source, line, joint, key) for key in keys]
    values, handles, held = (np.array(column) for column in zip(*rows, strict=True))
    return Curve(load_robot().index[joint], seconds, values, handles, held)


def _key(source: Source, line: int, joint: str, key: Literal) -> tuple[float, list[list[float]], bool]:
    """A key's value, its handles (2, 2), nan where automatic, and whether the value holds until the next key."""
    if not isinstance(key, list):
        return _number(source, line, joint, key), [[np.nan, np.nan]] * 2, False
    value, *tangents = key or [None]
    if len(tangents) not in (0, 2) or not all(isinstance(item, list) and len(item) == 3 for item in tangents):  # noqa: PLR2004
        raise source.error(f"key {key}"[:60], "an angle or [angle, [type, s, rad], [type, s, rad]]", line, joint)
    handles, held = [[np.nan, np.nan], [np.nan, np.nan]], False
    for side, tangent in zip((BEFORE, AFTER), tangents, strict=False):
        kind, way, rise = (_number(source, line, joint, item) for item in tangent)
        if kind not in KINDS:
            raise source.error(f"a handle of type {kind:g}", "0, 1, 2 or 3", line, joint)
        if kind in (Kind.CONSTANT, Kind.LINEAR):
            way = rise = 0.0
        if (way if side == BEFORE else -way) > 0.0:
            raise source.error(f"a handle of {way:g} s", "one that points away from its key", line, joint)
        handles[side] = [way, rise]
        held = side == AFTER and kind == Kind.CONSTANT
    return _number(source, line, joint, value), handles, held


def _number(source: Source, line: int, joint: str, value: Literal) -> float:
    if not (isinstance(value, float) and math.isfinite(value)):
        raise source.error(f"{value!r}"[:60], "a finite number", line, joint)
    return value


def _notes(lists: _Lists, motions: Sequence[_Lists], curves: Sequence[Curve], bent: bool) -> tuple[str, ...]:
    others = [other.name for other in motions if other is not lists]
    starts = {float(curve.times[0]) for curve in curves}
    listed = ", ".join(others[:LISTED]) + (f" and {len(others) - LISTED} more" if len(others) > LISTED else "")
    notes = {
        f"the longest of {len(motions)} motions, {lists.name}; not read: {listed}": others,
        f"curves between keys sampled at {RATE:g} Hz": bent,
        "joints hold their first key until its time": len(starts) > 1,
    }
    return tuple(note for note, holds in notes.items() if holds)


def python_text(motion: JointTrajectory) -> str:
    """A trajectory as such lists, exact to the last bit; a value that is not finite is no key.

    Raises:
        UsageError: it asks nothing of any joint.
    """
    finite = np.isfinite(motion.positions) & motion.given
    if not finite.any():
        raise UsageError("the motion asks nothing of any joint; expected an angle for the keys of Python lists")
    parts = [HEAD, "names = list()\ntimes = list()\nkeys = list()\n"]
    for joint in np.flatnonzero(finite.any(axis=0)):
        frames = finite[:, joint]
        times = [repr(time) for time in motion.times[frames].tolist()]
        keys = [f"[{value!r}, [1, 0, 0], [1, 0, 0]]" for value in motion.positions[frames, joint].tolist()]
        parts.append(f'\nnames.append("{load_robot().joint_names[joint]}")\n')
        parts.append(f"times.append([{_rows(times, 10)}])\nkeys.append([{_rows(keys, 3)}])\n")
    return "".join(parts)


def _rows(items: Sequence[str], width: int) -> str:
    """Items of a list, `width` a line."""
    return ",\n    ".join(", ".join(items[i : i + width]) for i in range(0, len(items), width))
