"""Ways to take points as joints, and which of them makes a body."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from nao_sim.body import joints_called
from nao_sim.recordings.skeletons.facing import Told
from nao_sim.recordings.skeletons.fitting import Fit, fit
from nao_sim.recordings.skeletons.layouts import Layout, builtin
from nao_sim.recordings.source import Source
from nao_sim.robot import Array

CLEAR = (1.5, 0.25)  # times the best cost, and more, that another skeleton's must be
SAME = 0.02  # m, between joints of two skeletons that are one
SHOWN = 8  # names in a message
_ORDER_OF = "joints in the order of "
_STANDS_FOR = {"hand": "wrist", "foot": "ankle"}  # the end of a limb, whatever a layout calls it


@dataclass(frozen=True, eq=False)
class Reading:
    """One way to take the points.

    Attributes:
        name: what it goes by, for the user.
        columns: the points that make up each joint.
        fit: the body that they make.
        layout: where the order is from; None for points with names.
        notes: what a user should know of it.
    """

    name: str
    columns: Mapping[str, Sequence[int]]
    fit: Fit
    layout: Layout | None = None
    notes: tuple[str, ...] = ()


def gather(columns: Mapping[str, Sequence[int]], values: Array) -> Array:
    """The points (N, K, 3) of K joints, each the mean of its columns."""
    chosen = list(columns.values())
    if all(len(points) == 1 for points in chosen):
        return values[:, [points[0] for points in chosen]]
    return np.stack([values[:, list(points)].mean(axis=1) for points in chosen], axis=1)


def by_layout(sample: Array, layout: Layout, told: Told) -> Reading:
    """The points (S, J, 3) in a layout's order."""
    found = fit(tuple(layout.columns), gather(layout.columns, sample), told)
    return Reading(_ORDER_OF + layout.name, layout.columns, found, layout)


def by_own(source: Source, sample: Array, names: Sequence[str] | None, layout: Layout, told: Told) -> Reading:
    """The points as the user's own layout has them, against all appearances.

    Raises:
        RecordingError: it has other points than the file, or they are nobody's.
    """
    if layout.names and names is not None:
        columns = _named_columns(source, names, layout)
        found = fit(tuple(columns), gather(columns, sample), told)
        reading = Reading(f"joints by the names in layout {layout.name}", columns, found, layout)
    elif len(layout) == sample.shape[1]:
        reading = by_layout(sample, layout, told)
    else:
        raise source.error(f"{sample.shape[1]} points", f"{len(layout)}, as in layout {layout.path}")
    return _against_appearances(source, reading)


def _named_columns(source: Source, names: Sequence[str], layout: Layout) -> dict[str, list[int]]:
    places = {name.lower(): place for place, name in enumerate(names)}
    for joint, wanted in layout.names.items():
        if absent := [name for name in wanted if name.lower() not in places]:
            raise source.error(f"no points named {listed(absent)}", f"{joint} as layout {layout.path} has it")
    return {joint: [places[name.lower()] for name in wanted] for joint, wanted in layout.names.items()}


def by_name(source: Source, sample: Array, names: Sequence[str], told: Told) -> Reading:
    """The points by the file's names for them.

    Raises:
        RecordingError: no name is a joint's, or the joints are no person's.
    """
    columns: dict[str, list[int]] = {}
    unknown, twice = list[str](), list[str]()
    for point, (name, joint) in enumerate(zip(names, joints_called(names), strict=True)):
        if joint is None:
            unknown.append(name)
        elif joint in columns:
            twice.append(name)
        else:
            columns[joint] = [point]
    if not columns:
        expected = "names of joints, or a layout with a table [names] (--layout)"
        raise source.error(f"points named {listed(names)}", expected)
    notes = (f"left out, their names are not known: {listed(unknown)}",) * bool(unknown)
    notes += (f"left out, another point is that joint: {listed(twice)}",) * bool(twice)
    found = fit(tuple(columns), gather(columns, sample), told)
    return _against_appearances(source, Reading(f"{len(columns)} joints by name", columns, found, None, notes))


def _against_appearances(source: Source, reading: Reading) -> Reading:
    """A reading that holds even if it makes no good body."""
    if not np.isfinite(reading.fit.cost):
        raise source.error(f"{reading.fit.problems[0]} among {listed(list(reading.columns))}", "a person's skeleton")
    notes = tuple(f"unlike a body: {problem}" for problem in reading.fit.problems)
    return replace(reading, notes=(*reading.notes, *notes))


def best(
    source: Source, readings: Sequence[Reading], samples: Sequence[Array], what: str, own: Layout | None = None
) -> Reading:
    """The one way to take points that makes a body.

    Args:
        source: the file.
        readings: the ways, the likelier first among equals.
        samples: for each the points (S, J, 3) that it was fitted to.
        what: what there is to take, for messages.
        own: the user's layout, if it leaves these ways open.

    Raises:
        RecordingError: none makes a body, or several make different ones.
    """
    if not readings:
        sizes = ", ".join(map(str, sorted({len(layout) for layout in builtin()})))
        expected = f"{sizes} points (nao-sim formats lists the layouts), or a layout of your own (--layout)"
        raise source.error(f"{what} of no known layout", expected)
    order = sorted(range(len(readings)), key=lambda i: (bool(readings[i].fit.problems), round(readings[i].fit.cost, 6)))
    first, sample = readings[order[0]], samples[order[0]]
    if first.fit.problems:
        tried = listed(list(dict.fromkeys(_short(reading) for reading in readings)))
        why = "; ".join(first.fit.problems)
        by = "by any layout" if own is None else "in any plain shape of row"
        hint = "a layout of your own (--layout)" if own is None else f"a [[row]] in layout {own.path}"
        raise source.error(
            f"{what} that are no body {by} (tried {tried}; best {_short(first)}: {why})", f"a person, or {hint}"
        )
    clear = CLEAR[0] * first.fit.cost + CLEAR[1]
    close = [i for i in order[1:] if not readings[i].fit.problems and readings[i].fit.cost < clear]
    rivals = [_short(readings[i]) for i in close if not same(first, sample, readings[i], samples[i])]
    if rivals:
        names = listed(list(dict.fromkeys([_short(first), *rivals])))
        raise source.error(f"{what} that fit several layouts: {names}", "to be told which by --layout")
    return first


def _short(reading: Reading) -> str:
    return reading.name.removeprefix(_ORDER_OF)


def same(one: Reading, sample: Array, other: Reading, other_sample: Array) -> bool:
    """Whether two ways to take points give the same skeleton."""
    here, there = _positions(one, sample), _positions(other, other_sample)
    shared = [joint for joint in here if joint in there]
    if len(shared) < min(len(here), len(there)):
        return False
    apart = np.array([np.linalg.norm(here[joint] - there[joint], axis=1) for joint in shared])
    return not (np.nan_to_num(apart) > SAME).any()


def _positions(reading: Reading, sample: Array) -> dict[str, Array]:
    positions = reading.fit.apply(gather(reading.columns, sample))
    names = reading.fit.joints
    found = {}
    for place, joint in enumerate(names):
        side, _, part = joint.partition("_")
        other = f"{side}_{_STANDS_FOR[part]}" if part in _STANDS_FOR else joint
        found[joint if other in names else other] = positions[:, place]
    return found


def listed(names: Sequence[str]) -> str:
    """Some names, and how many more."""
    more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    return ", ".join(names[:SHOWN]) + more
