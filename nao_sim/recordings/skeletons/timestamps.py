"""Times as files write them: the unit that a name tells, and clock times as text."""

from __future__ import annotations

import re
from datetime import datetime

from nao_sim.recordings.skeletons.layout_file import TIMES

# What the end of a column's name says of its unit.
_NAMED = {
    "s": ("s", "sec", "secs", "second", "seconds"),
    "ms": ("ms", "msec", "millis", "millisecond", "milliseconds"),
    "us": ("us", "usec", "micros", "microsecond", "microseconds"),
    "ns": ("ns", "nsec", "nanos", "nanosecond", "nanoseconds"),
    "100ns": ("ticks", "100ns"),
}
_UNIT_OF = {word: unit for unit, words in _NAMED.items() for word in words}
_CLOCK = re.compile(r"(?:(\d+):)?([0-5]?\d):([0-5]?\d(?:\.\d+)?)")


def unit_named(name: str) -> float | None:
    """Seconds in the unit that a column's name ends in (`timestamp_ms`, `Time (Seconds)`, `timeMs`), or None."""
    words = re.findall(r"\d*[a-z]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower())
    unit = _UNIT_OF.get(words[-1]) if words and len(words) + len(words[-1]) > 2 else None  # noqa: PLR2004 (`s`, `t`)
    return None if unit is None else TIMES[unit]


def clock(text: str) -> float | None:
    """Seconds of a clock time (`10:15:30.250`) or a date with one; None where the text is neither."""
    if match := _CLOCK.fullmatch(text.strip()):
        hours, minutes, rest = match.groups()
        return int(hours or 0) * 3600.0 + int(minutes) * 60.0 + float(rest)
    try:
        return datetime.fromisoformat(text.strip()).timestamp()
    except (ValueError, OverflowError, OSError):
        return None
