"""Layouts: which joint is where in a file that has numbers and no names.

A layout is a small TOML table; the built-in ones are in `layout_tables`, and a
user's own is read by the same code.  What a layout leaves out is found from
the data, or asked for.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Literal

import numpy as np

from nao_sim.body import twin
from nao_sim.robot import Array

FOLDER = Path(__file__).parent / "layout_tables"
SKIP = "-"
Axes = tuple[str, str, str]


@dataclass(frozen=True)
class Row:
    """How the numbers of a frame stand in a file's lines.

    Attributes:
        before: what the columns before the first joint are: `time`, `frame`, `person`, `take`, `label` or `-`.
        joint: what the columns of a joint are: `x`, `y`, `z`, `state`, `confidence` or `-`.
        after: what the columns after the last joint are.
        order: `joint` (all columns of a joint side by side) or `axis` (all x, all y, all z).
        per: whether a line holds a whole `frame` or one `joint`.
        between: lines after each joint's line that say something else of it (only `per` joint).
        counted: whether a line that counts the frame's lines opens each frame (only `per` joint).
        header: lines above the numbers, where files of this shape have others than the layout's.
        columns: what every column of a line is, where no shorter way says it: `time`, `-`, `head.x` ...
    """

    before: tuple[str, ...] = ()
    joint: tuple[str, ...] = ("x", "y", "z")
    after: tuple[str, ...] = ()
    order: Literal["joint", "axis"] = "joint"
    per: Literal["frame", "joint"] = "frame"
    between: int = 0
    counted: bool = False
    header: int | None = None
    columns: tuple[str, ...] = ()

    def width(self, points: int) -> int:
        """Columns of a line, where a frame has so many points."""
        if self.columns:
            return len(self.columns)
        joints = points if self.per == "frame" else 1
        return len(self.before) + joints * len(self.joint) + len(self.after)


@dataclass(frozen=True)
class Layout:
    """What the points of a file are.

    Attributes:
        name: what users call it.
        joints: the joint that each point is, or `-`; the mean counts of points that are the same joint.
        source: where the order is from.
        names: for files with names: the file's names of each joint.
        rows: the row shapes of such files; any plain one where empty.
        unit: metres in one unit of the file.
        time_unit: seconds in one unit of the time column; 0 where it counts frames.
        axes: the person's (forward, left, up) as signed axes of the file.
        rate: Hz, where the file has no times.
        header: lines above the numbers.
        separator: what stands between two numbers; None for any.
        end: the text of a line after which nothing counts.
        states: confidence by tracking state.
        zeros_missing: whether points at exactly zero are missing.
        path: the user's own file; None for a built-in layout.
    """

    name: str
    joints: tuple[str, ...] = ()
    source: str = ""
    names: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    rows: tuple[Row, ...] = ()
    unit: float | None = None
    time_unit: float | None = None
    axes: Axes | None = None
    rate: float | None = None
    header: int | None = None
    separator: str | None = None
    end: str | None = None
    states: Mapping[float, float] = field(default_factory=dict)
    zeros_missing: bool = True
    path: Path | None = None

    def __len__(self) -> int:
        return len(self.joints)

    @property
    def columns(self) -> dict[str, list[int]]:
        """Which points make up each joint, in the layout's order."""
        found: dict[str, list[int]] = {}
        for point, joint in enumerate(self.joints):
            if joint != SKIP:
                found.setdefault(joint, []).append(point)
        return found


@cache
def builtin() -> tuple[Layout, ...]:
    """Every built-in layout, by name."""
    from nao_sim.recordings.skeletons.layout_file import read_layout

    return tuple(read_layout(path, own=False) for path in sorted(FOLDER.glob("*.toml")))


def swapped(joints: tuple[str, ...]) -> tuple[str, ...]:
    """The same joints with left and right exchanged."""
    return tuple(twin(joint) for joint in joints)


def axis(signed: str) -> Array:
    """The unit vector of a signed axis such as `-z`."""
    vector = np.zeros(3)
    vector["xyz".index(signed[1])] = -1.0 if signed[0] == "-" else 1.0
    return vector


def axis_name(vector: Array) -> str:
    """The signed axis of a unit vector."""
    largest = int(np.abs(vector).argmax())
    return ("-" if vector[largest] < 0.0 else "+") + "xyz"[largest]
