"""Cameras and qualities, read from `render/presets.toml` and typed nowhere else."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

from nao_sim.errors import UsageError
from nao_sim.paths import PRESETS
from nao_sim.rendering.preset_kinds import (
    Camera,
    FigureLooks,
    GestureLooks,
    Look,
    Quality,
    ReasonLooks,
    SafetyLooks,
    SecondLooks,
    Shadow,
    Theme,
    Thing,
)

WITH = " with "  # in the name of a camera's preset, before whoever is shown beside the robot
WITH_TWO = f"{WITH}two"  # for a film of two robots


@cache
def _table() -> Mapping[str, Any]:
    return MappingProxyType(tomllib.loads((PRESETS / "presets.toml").read_text(encoding="utf-8")))


def camera_names() -> tuple[str, ...]:
    """The camera presets that a user may name, in the table's order."""
    return tuple(name for name in _table()["camera"] if WITH not in name)


def quality_names() -> tuple[str, ...]:
    """The quality presets, from fast to beautiful."""
    return tuple(_table()["quality"])


def load_camera(name: str) -> Camera:
    """The camera preset `name`.

    Raises:
        UsageError: no such preset.
    """
    row = dict(table_row("camera", name))
    if "lookat" in row:
        row["lookat"] = tuple(row["lookat"])
    return Camera(name=name, **row)


def load_quality(name: str) -> Quality:
    """The quality preset `name`.

    Raises:
        UsageError: no such preset.
    """
    return Quality(name=name, **table_row("quality", name))


def look_names() -> tuple[str, ...]:
    """The surroundings, in the table's order."""
    return tuple(_table()["look"])


def theme_names() -> tuple[str, ...]:
    """The colour themes, in the table's order."""
    return tuple(_table()["theme"])


def load_look(name: str) -> Look:
    """The surroundings `name`.

    Raises:
        UsageError: no such preset.
    """
    row = dict(table_row("look", name))
    things = tuple(Thing(**{key: _tuple(value) for key, value in thing.items()}) for thing in row.pop("things", ()))
    return Look(name=name, things=things, **row)


def load_theme(name: str) -> Theme:
    """The colour theme `name`.

    Raises:
        UsageError: no such preset.
    """
    return Theme(name, {material: tuple(colour) for material, colour in table_row("theme", name).items()})


def load_figure(where: str = "beside") -> FigureLooks:
    """How the recorded person is drawn, `where` being a place of the table.

    Raises:
        UsageError: no such place.
    """
    row = dict(_table()["figure"])
    places = row.pop("at")
    if where not in places:
        raise UsageError(f"place '{where}' of the person is not known; expected one of {', '.join(places)}")
    return FigureLooks(**{key: _tuple(value) for key, value in (row | places[where]).items()})


def load_safety() -> SafetyLooks:
    """How what the guard changed is shown."""
    row = dict(_table()["safety"])
    colours = {name: tuple(colour) for name, colour in row.pop("colours").items()}
    reasons = {name: _reason(reason) for name, reason in row.pop("reasons").items()}
    return SafetyLooks(**row, colours=MappingProxyType(colours), reasons=MappingProxyType(reasons))


def load_gestures() -> GestureLooks:
    """How what is recognised is shown."""
    row = _table()["gestures"]
    return GestureLooks(row["steady"], tuple(row["pose"]), tuple(row["movement"]))


def load_second() -> SecondLooks:
    """Where a second robot is."""
    return SecondLooks(tuple(_table()["second"]["place"]))


def load_shadow() -> Shadow:
    """The square that has shadows."""
    return Shadow(**_table()["shadow"])


def _reason(row: Mapping[str, Any]) -> ReasonLooks:
    return ReasonLooks(**{key: _tuple(value) for key, value in row.items()})


def _tuple(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else value


def rows_of_table(kind: str) -> Mapping[str, Any]:
    """All that the table holds of a kind, in its order."""
    rows: Mapping[str, Any] = _table()[kind]
    return rows


def table_row(kind: str, name: str) -> Mapping[str, Any]:
    """The preset `name` of a kind, as the table has it.

    Raises:
        UsageError: no such preset.
    """
    rows = _table()[kind]
    if name not in rows:
        raise UsageError(f"{kind} '{name}' is not known; expected one of {', '.join(rows)}")
    return rows[name]
