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
_MILLISECONDS = re.compile(r"(?<=\d:[0-5]\d:[0-5]\d)(?::(?=\d{3}$)|,(?=\d+$))")  # 10:15:30:250 and 10:15:30,250
_HALF = re.compile(r"\s*([ap])\.?m\.?$", re.IGNORECASE)
# The day first where points stand between (31.12.2020), the month first where slashes do, unless there is none such.
_DATE = re.compile(r"(\d\d?)([./-])(\d\d?)\2(\d{4})(?:,?\s+(.*))?")


def unit_named(name: str) -> float | None:
    """Seconds in the unit that a column's name ends in (`timestamp_ms`, `Time (Seconds)`, `timeMs`), or None."""
    words = re.findall(r"\d*[a-z]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower())
    unit = _UNIT_OF.get(words[-1]) if words and len(words) + len(words[-1]) > 2 else None  # noqa: PLR2004 (`s`, `t`)
    return None if unit is None else TIMES[unit]


def clock(text: str) -> float | None:
    """Seconds of a clock time (`10:15:30.250`, `03:15:30 PM`) or a date with one; None where the text is neither."""
    text = text.strip()
    if half := _HALF.search(text):
        text = text[: half.start()]
    text = _MILLISECONDS.sub(".", text)
    date = _DATE.fullmatch(text)
    day = _day(*date.groups()[:4]) if date else 0.0
    seconds = _hours(date[5] or "0:0", half[1] if half else None) if date else _hours(text, half[1] if half else None)
    if day is not None and seconds is not None:
        return day + seconds
    try:
        return None if half else datetime.fromisoformat(text).timestamp()
    except (ValueError, OverflowError, OSError):
        return None


def _hours(text: str, half: str | None) -> float | None:
    """Seconds since midnight, by a clock of 12 hours where `half` is a (before noon) or p."""
    match = _CLOCK.fullmatch(text.strip())
    if match is None:
        return None
    hours, minutes, rest = match.groups()
    if half is None:
        return int(hours or 0) * 3600.0 + int(minutes) * 60.0 + float(rest)
    if hours is None or not 1 <= int(hours) <= 12:  # noqa: PLR2004
        return None
    return (int(hours) % 12 + 12 * (half in "pP")) * 3600.0 + int(minutes) * 60.0 + float(rest)


def _day(first: str, mark: str, second: str, year: str) -> float | None:
    """Seconds of a day such as 31.12.2020 or 12/31/2020."""
    day, month = (int(first), int(second)) if mark == "." else (int(second), int(first))
    if month > 12:  # noqa: PLR2004
        day, month = month, day
    try:
        return (datetime(int(year), month, day) - datetime(1970, 1, 1)).total_seconds()
    except ValueError:
        return None
