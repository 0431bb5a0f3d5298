"""A layout's TOML table, checked key by key."""

from __future__ import annotations

import difflib
import math
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from nao_sim.body import joint_called, twin
from nao_sim.errors import RecordingError
from nao_sim.recordings.skeletons.layouts import SKIP, Axes, Layout, Row

LENGTHS = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}  # metres
TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "100ns": 1e-7, "ns": 1e-9, "frame": 0.0}  # seconds
SEPARATORS = {"comma": ",", "semicolon": ";", "tab": "\t", "space": " ", ",": ",", ";": ";", "\t": "\t", " ": " "}
ASIDE = ("time", "frame", "person", "take", "label", SKIP)  # columns that are no joint's
OF_JOINT = ("x", "y", "z", "state", "confidence", SKIP)
SIDES = ("person", "viewer")
_AXES = tuple(sign + axis for axis in "xyz" for sign in ("", "+", "-"))


def read_layout(path: Path, own: bool = True) -> Layout:
    """Read and check a layout.

    Args:
        path: the TOML file.
        own: whether it is the user's, and not one of the built-in ones.

    Returns:
        The layout.

    Raises:
        RecordingError: it cannot be read, or a key or value is not as it should be; the key is the column.
    """
    table = _Table(path, "", _toml(path))
    joints = _joints(table)
    layout = Layout(
        name=table.text("name", path.stem),
        source=table.text("source", ""),
        joints=joints,
        names=_names(table),
        rows=tuple(_row(row, joints) for row in table.tables("row")),
        unit=table.named("unit", LENGTHS, "a number of metres"),
        time_unit=table.named("time_unit", TIMES, "a number of seconds"),
        axes=_axes(table),
        rate=table.positive("rate"),
        header=table.count("header"),
        separator=table.choice("separator", SEPARATORS),
        end=table.text("end", "") or None,
        states=_states(table),
        zeros_missing=table.choice("zeros", {"missing": True, "points": False}, True),
        path=path if own else None,
    )
    table.finish()
    if not layout.joints and not layout.names:
        raise table.error("no joints", "joints = [...] in the file's order, or a table [names] for a file with names")
    return layout


def _toml(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except FileNotFoundError:
        raise RecordingError(path, "no such file", "a layout (TOML)") from None
    except OSError as error:
        raise RecordingError(path, f"cannot be read ({(error.strerror or '').lower()})", "a layout (TOML)") from None
    except UnicodeDecodeError:
        raise RecordingError(path, "bytes that are not UTF-8 text", "a layout (TOML)") from None
    except (tomllib.TOMLDecodeError, ValueError, RecursionError) as error:
        raise RecordingError(path, f"no TOML ({' '.join(str(error).split())})", "a layout (TOML)") from None


class _Table:
    """A TOML table whose keys are taken one by one; what is left over is a mistake."""

    def __init__(self, path: Path, place: str, values: Mapping[str, Any]) -> None:
        self._path, self._place, self._values = path, place, values
        self._known: list[str] = []

    def error(self, found: str, expected: str, key: str | None = None) -> RecordingError:
        place = self._place + key if key else self._place.rstrip(".") or None
        return RecordingError(self._path, found, expected, column=place)

    def take(self, key: str) -> Any:
        self._known.append(key)
        return self._values.get(key)

    def finish(self) -> None:
        """Refuse keys that nobody asked for."""
        for key in self._values:
            if key not in self._known:
                near = difflib.get_close_matches(key, self._known, n=1)
                hint = f" (did you mean {near[0]}?)" if near else ""
                raise self.error(f"unknown key{hint}", ", ".join(sorted(self._known)), key)

    def text(self, key: str, default: str) -> str:
        value = self.take(key)
        if value is None:
            return default
        if not isinstance(value, str) or not value.strip():
            raise self.error(shown(value), "a text", key)
        return " ".join(value.split())

    def texts(self, key: str, default: tuple[str, ...] = ()) -> tuple[str, ...]:
        value = self.take(key)
        if value is None:
            return default
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            raise self.error(shown(value), 'a list of texts, such as ["x", "y", "z"]', key)
        return tuple(value)

    def tables(self, key: str) -> list[_Table]:
        value = self.take(key)
        if value is None:
            return []
        if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
            raise self.error(shown(value), f"tables [[{key}]]", key)
        return [_Table(self._path, f"{key} {number}.", item) for number, item in enumerate(value, start=1)]

    def table(self, key: str) -> _Table | None:
        value = self.take(key)
        if value is not None and not isinstance(value, dict):
            raise self.error(shown(value), f"a table [{key}]", key)
        return None if value is None else _Table(self._path, f"{key}.", value)

    def items(self) -> list[tuple[str, Any]]:
        return list(self._values.items())

    def choice(self, key: str, choices: Mapping[str, Any], default: Any = None) -> Any:
        value = self.take(key)
        if value is None:
            return default
        if not isinstance(value, str) or value not in choices:
            raise self.error(shown(value), " or ".join(name for name in choices if name.isalnum()), key)
        return choices[value]

    def named(self, key: str, names: Mapping[str, float], number: str) -> float | None:
        """A unit by its name or by its size."""
        if isinstance(self._values.get(key), str):
            value = self.take(key)
            if value not in names:
                raise self.error(f"'{value}'", f"{', '.join(names)} or {number}", key)
            return names[value]
        return self.positive(key, f"{', '.join(names)} or {number}")

    def positive(self, key: str, expected: str = "a positive number") -> float | None:
        value = self.take(key)
        if value is None:
            return None
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < math.inf:
            raise self.error(shown(value), expected, key)
        return float(value)

    def count(self, key: str) -> int | None:
        value = self.take(key)
        if value is None:
            return None
        if isinstance(value, bool) or not isinstance(value, int) or value < 0:
            raise self.error(shown(value), "a whole number from 0", key)
        return value


def shown(value: object) -> str:
    """A value as a message shows it."""
    text = repr(value)
    return text if len(text) <= 40 else text[:37] + "..."  # noqa: PLR2004


def _joint(table: _Table, name: str, key: str) -> str:
    joint = joint_called(name)
    if joint is None:
        raise table.error(f"'{name}'", "a joint such as left_elbow (docs/layouts.md lists them) or - to skip one", key)
    return joint


def _joints(table: _Table) -> tuple[str, ...]:
    """The file's order, the person's own left and right."""
    sides = table.choice("sides", {name: name for name in SIDES}, "person")
    names = table.texts("joints")
    found = tuple(SKIP if name == SKIP else _joint(table, name, "joints") for name in names)
    if names and not {"left_shoulder", "right_shoulder"} <= set(found):
        raise table.error("no left_shoulder and right_shoulder", "both, to know the person's sides", "joints")
    return tuple(SKIP if joint == SKIP else twin(joint) for joint in found) if sides == "viewer" else found


def _names(table: _Table) -> dict[str, tuple[str, ...]]:
    named = table.table("names")
    if named is None:
        return {}
    found = {}
    for key, value in named.items():
        joint = _joint(named, key, key)
        names = [value] if isinstance(value, str) else value
        if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
            raise named.error(shown(value), 'a name in the file or several, such as ["LWRA", "LWRB"]', key)
        found[joint] = tuple(names)
    return found


def _axes(table: _Table) -> Axes | None:
    axes = table.table("axes")
    if axes is None:
        return None
    told = {name: axes.choice(name, {axis: axis for axis in _AXES}) for name in ("forward", "left", "up")}
    axes.finish()
    missing = [name for name, axis in told.items() if axis is None]
    if missing:
        raise axes.error(f"no {' and no '.join(missing)}", 'all three, such as forward = "-z"', None)
    signed = tuple(axis if axis[0] in "+-" else "+" + axis for axis in told.values())
    if {axis[1] for axis in signed} != set("xyz"):
        raise axes.error(", ".join(signed), "x, y and z once each", None)
    return signed[0], signed[1], signed[2]


def _states(table: _Table) -> dict[float, float]:
    states = table.table("states")
    found = {}
    for key, value in states.items() if states else []:
        assert states is not None
        try:
            state = float(key)
        except ValueError:
            raise states.error(f"state '{key}'", "a number", key) from None
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 <= value <= 1.0:
            raise states.error(shown(value), "a confidence from 0 to 1", key)
        found[state] = float(value)
    return found


def _row(table: _Table, joints: tuple[str, ...]) -> Row:
    row = Row(
        before=_columns(table, "before", ASIDE),
        joint=_columns(table, "joint", OF_JOINT, ("x", "y", "z")),
        after=_columns(table, "after", ASIDE),
        order=table.choice("order", {"joint": "joint", "axis": "axis"}, "joint"),
        per=table.choice("per", {"frame": "frame", "joint": "joint"}, "frame"),
        between=table.count("between") or 0,
        counted=table.choice("counted", {"yes": True, "no": False}, False),
        header=table.count("header"),
        columns=_every_column(table, joints),
    )
    table.finish()
    for axis in "xy":
        if row.joint.count(axis) != 1:
            raise table.error(f"{row.joint.count(axis)} columns {axis}", "one (z may be missing)", "joint")
    if row.per == "frame" and (row.between or row.counted):
        raise table.error("between or counted lines", 'per = "joint" with them', "per")
    return row


def _every_column(table: _Table, joints: tuple[str, ...]) -> tuple[str, ...]:
    """The columns of a line one by one: `time`, `-`, `10*-`, `head.x` ..."""
    found: list[str] = []
    for word in table.text("columns", "").split():
        times, _, name = word.rpartition("*")
        if times and not times.isdecimal():
            raise table.error(f"'{word}'", "a column, or several alike such as 10*-", "columns")
        joint, dot, axis = name.rpartition(".")
        if dot:
            joint = _joint(table, joint, "columns")
            name = f"{joint}.{axis}"
            if joint not in joints or axis not in OF_JOINT:
                raise table.error(f"'{word}'", f"one of joints with .{', .'.join(OF_JOINT[:-1])}", "columns")
        elif name not in ASIDE:
            raise table.error(f"'{word}'", f"{', '.join(ASIDE)} or a joint's column such as head.x", "columns")
        found += [name] * int(times or 1)
    missing = [f"{joint}.{axis}" for joint in joints for axis in "xy" if found and f"{joint}.{axis}" not in found]
    if missing:
        raise table.error(f"no {missing[0]}", "x and y of each of joints", "columns")
    if twice := next((name for name in found if name != SKIP and found.count(name) > 1), None):
        raise table.error(f"'{twice}' twice", "each once", "columns")
    return tuple(found)


def _columns(table: _Table, key: str, known: tuple[str, ...], default: tuple[str, ...] = ()) -> tuple[str, ...]:
    columns = table.texts(key, default)
    for column in columns:
        if column not in known:
            raise table.error(f"'{column}'", ", ".join(known), key)
        if column != SKIP and columns.count(column) > 1:
            raise table.error(f"'{column}' twice", "each once", key)
    return columns
