"""Which number of a line is what: by a layout's row shapes, or by every plain shape of the right length."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from nao_sim.recordings.skeletons.layouts import SKIP, Layout, Row
from nao_sim.robot import Array

MOST_ASIDE, MOST_OF_JOINT = 6, 8  # columns beside the joints, and of one, that a plain shape may have
FEW = 8  # people or labels; more different numbers are no ids
MOSTLY = 0.98  # of a sample's states: one that none knows is a mistake, many are no states
TICKS = 0.2  # of the lines: how often a clock goes on, with five people line by line at the least
OFTEN = 0.25  # of the lines: how often an id changes where people stand line by line
_AXES = ("x", "y", "z")
_TRUST = ("state", "confidence")
_SCALES = ({0.0: 0.0, 1.0: 0.5, 2.0: 1.0}, {0.0: 0.0, 1.0: 0.33, 2.0: 0.67, 3.0: 1.0})  # Kinect; Azure Kinect


@dataclass(frozen=True, eq=False)
class Plan:
    """What each number of a frame is, its lines put one after the other.

    Attributes:
        layout: which joints they are.
        row: the row shape.
        aside: where `time`, `person` and the like stand.
        places: (J, 3) where each point's x, y, z stand; -1 for a z that is not there.
        trust: (J,) where each point's state or confidence stands; None without.
        states: confidence by state; empty for a confidence.
    """

    layout: Layout
    row: Row
    aside: Mapping[str, int]
    places: Array
    trust: Array | None = None
    states: Mapping[float, float] = field(default_factory=dict)

    @property
    def lines(self) -> int:
        """Lines a frame."""
        return len(self.layout) if self.row.per == "joint" else 1

    @property
    def planar(self) -> bool:
        """Whether there is no z."""
        return bool((self.places[:, 2] < 0).any())

    @property
    def columns(self) -> tuple[str, ...]:
        """What the columns of a line are, for messages."""
        names = enumerate(_names(self.row, self.layout), start=1)
        return tuple(f"{number} ({name})" if name != SKIP else f"{number}" for number, name in names)

    @property
    def unexplained(self) -> float:
        """Share of the numbers of a frame that say nothing."""
        known = (self.places >= 0).sum() + (0 if self.trust is None else len(self.trust)) + len(self.aside)
        return 1.0 - float(known) / (len(_names(self.row, self.layout)) * self.lines)

    def points(self, numbers: Array) -> Array:
        """The points (N, J, 3) in frames of numbers (N, C)."""
        found = numbers[:, self.places]
        if self.planar:
            found[:, :, 2] = 0.0
        return found

    def confidence(self, numbers: Array) -> Array | None:
        """The confidence (N, J) of the points in frames of numbers (N, C), nan where a state is none that is known."""
        if self.trust is None:
            return None
        told = numbers[:, self.trust]
        if not self.states:
            return np.where((told >= 0.0) & (told <= 1.0), told, np.nan)
        found = np.full(told.shape, np.nan)
        for state, confidence in self.states.items():
            found[told == state] = confidence
        return found


def plan(layout: Layout, row: Row) -> Plan:
    """What each number is by a row shape."""
    names = _names(row, layout)
    aside = {name: place for place, name in enumerate(names) if name in ("time", "frame", "person", "take", "label")}
    places = np.array([[_place(row, layout, joint, axis) for axis in _AXES] for joint in range(len(layout))])
    kind = next((kind for kind in _TRUST if _place(row, layout, 0, kind) >= 0), None)
    trust = None if kind is None else np.array([_place(row, layout, joint, kind) for joint in range(len(layout))])
    states = layout.states or _SCALES[0] if kind == "state" else {}
    return Plan(layout, row, aside, places, trust, states)


def _names(row: Row, layout: Layout) -> tuple[str, ...]:
    """What the columns of a line are, by role and joint."""
    if row.columns:
        return row.columns
    if row.per == "joint":
        return (*row.before, *row.joint, *row.after)
    points = range(len(layout))
    if row.order == "axis":
        middle = [f"{_called(layout, point)}.{name}" for name in row.joint for point in points]
    else:
        middle = [f"{_called(layout, point)}.{name}" for point in points for name in row.joint]
    return (*row.before, *middle, *row.after)


def _called(layout: Layout, point: int) -> str:
    joint = layout.joints[point]
    return f"point {point + 1}" if joint == SKIP else joint


def _place(row: Row, layout: Layout, point: int, name: str) -> int:
    """Where a point's number stands in a frame; -1 where it has none."""
    if row.columns:
        wanted = f"{layout.joints[point]}.{name}"
        return row.columns.index(wanted) if wanted in row.columns else -1
    if name not in row.joint:
        return -1
    place, size = row.joint.index(name), len(row.joint)
    if row.per == "joint":
        return point * row.width(1) + len(row.before) + place
    return len(row.before) + (place * len(layout) + point if row.order == "axis" else point * size + place)


def fits(found: Plan, numbers: Array) -> bool:
    """Whether a sample of numbers (S, C) can be what the plan says they are."""
    if numbers.shape[1] <= found.places.max() or (found.trust is not None and numbers.shape[1] <= found.trust.max()):
        return False
    if found.trust is None:
        return True
    told, known = numbers[:, found.trust], found.confidence(numbers)
    assert known is not None
    return bool(np.isfinite(known).sum() > MOSTLY * np.isfinite(told).sum())


def plain_rows(width: int, points: int) -> Iterator[Row]:
    """Every plain shape of a line of so many numbers, the likelier first."""
    for size in range(len(_AXES), MOST_OF_JOINT + 1):
        rest = width - size * points
        for after in range(rest + 1) if rest <= MOST_ASIDE else ():
            for lead in range(min(size - len(_AXES), 1) + 1):
                joint = (*(SKIP,) * lead, *_AXES, *(SKIP,) * (size - len(_AXES) - lead))
                for order in ("joint", "axis"):
                    yield Row((SKIP,) * (rest - after), joint, (SKIP,) * after, order)


def plain_joint_rows(width: int) -> Iterator[Row]:
    """Every plain shape of a line that has one joint in so many numbers."""
    for before in range(width - 2):
        rest = width - 3 - before
        yield Row(before=(SKIP,) * before, joint=(*_AXES, *(SKIP,) * rest), per="joint")


def with_roles(found: Plan, numbers: Array, head: Array) -> Plan:
    """Say what the columns are that a plain shape leaves open, as far as their numbers tell.

    Args:
        found: a plan of a plain shape.
        numbers: (S, C) a sample of frames.
        head: (H, C) the first frames, one after the other.
    """
    trust, states = found.trust, found.states
    for place, name in enumerate(found.row.joint):
        if name == SKIP and trust is None:
            column = _shifted(found, place)
            scale = _scale(numbers[:, column], found.layout.states)
            if scale is not None:
                trust, states = column, scale
    row, layout = found.row, found.layout
    width = len(_names(row, layout))
    beside = [*range(len(row.before)), *range(width - len(row.after), width)]
    return replace(found, trust=trust, states=states, aside=_roles(head, beside))


def _shifted(found: Plan, place: int) -> Array:
    """Where the points' numbers at `place` of a joint's columns stand."""
    row = found.row
    step = len(found.layout) if row.order == "axis" else 1
    columns: Array = found.places[:, 0] + (place - row.joint.index("x")) * step
    return columns


def _scale(told: Array, states: Mapping[float, float]) -> Mapping[float, float] | None:
    """What tracking states or confidences mean; None for other numbers."""
    known = told[np.isfinite(told)]
    if not len(known) or known.min() < 0.0:
        return None
    if known.max() <= 1.0 and known.max() > 0.0:
        return {}
    scales = (states, *_SCALES) if states else _SCALES
    return next((scale for scale in scales if np.isin(known, list(scale)).mean() > MOSTLY and known.max() > 0.0), None)


def _roles(head: Array, beside: list[int]) -> dict[str, int]:
    """Which of the columns beside the joints is the time, and which says whose line it is."""
    roles: dict[str, int] = {}
    clocks = [column for column in beside if _ascends(head[:, column])]
    fine = [column for column in clocks if not _counts(head[:, column])]
    if clocks:
        roles["time"] = (fine or clocks)[0]
    repeats = np.diff(head[:, clocks[0]]) == 0.0 if clocks else np.ones(len(head) - 1, bool)
    for column in beside:
        if column not in clocks and _tells_people(head[:, column], repeats):
            roles["person"] = column
    return roles


def _ascends(column: Array) -> bool:
    """Whether a column goes up as a clock does, the same time for several lines included."""
    step = np.diff(column)
    return bool(len(step) and np.isfinite(column).all() and (step >= 0.0).all() and (step > 0.0).mean() > TICKS)


def _counts(column: Array) -> bool:
    """Whether a column counts frames."""
    return bool(np.equal(column, np.round(column)).all() and np.median(np.diff(np.unique(column))) == 1.0)


def _tells_people(column: Array, repeats: Array) -> bool:
    """Whether a column holds ids that change while the time does not, or all the time."""
    if not np.isfinite(column).all() or not np.equal(column, np.round(column)).all():
        return False
    changes = np.diff(column) != 0.0
    return bool(1 < len(np.unique(column)) <= FEW and changes[repeats].any() and changes.mean() > OFTEN)
