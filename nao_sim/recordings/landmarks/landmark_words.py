"""What files of landmarks call what they hold (`landmarks.toml`), compared without case, spaces and punctuation."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Mapping
from functools import cache, lru_cache
from pathlib import Path

from nao_sim.recordings.landmarks.json_text import Json


def plain(key: str) -> str:
    """A key without case, spaces and punctuation."""
    return re.sub(r"[^a-z0-9]", "", key.lower())


@cache
def words(group: str) -> Mapping[str, int]:
    """The plain names of what `landmarks.toml` has under `group`, with their rank."""
    names = next(table[group] for table in _table().values() if group in table)
    return {plain(name): rank for rank, name in reversed(list(enumerate(names)))}


@cache
def _table() -> Mapping[str, Mapping[str, list[str]]]:
    return tomllib.loads(Path(__file__).with_name("landmarks.toml").read_text(encoding="utf-8"))


@cache
def _parts() -> Mapping[str, str]:
    return {plain(name): part for part, names in _table()["parts"].items() for name in names}


def part_of(key: str) -> str | None:
    """Which part of a person a key names, or None."""
    return _parts().get(plain(key))


def keys_of(node: Iterable[str], group: str) -> tuple[str, ...]:
    """The keys of a table that are in a group, best first."""
    return _keys_of(tuple(node), group)


@lru_cache(maxsize=8192)
def _keys_of(keys: tuple[str, ...], group: str) -> tuple[str, ...]:
    known = words(group)
    found = [(known[name], key) for key in keys if (name := plain(key)) in known]
    return tuple(key for _, key in sorted(found, key=lambda pair: pair[0]))


def take(node: Mapping[str, Json], group: str) -> Json:
    """The value under the best key of a group that has one, or None."""
    return next((node[key] for key in keys_of(node, group) if node[key] is not None), None)
