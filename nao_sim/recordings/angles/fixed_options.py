"""Options that a format leaves no room for."""

from __future__ import annotations

from nao_sim.recordings.source import Source, Unit

WORDS: dict[Unit, str] = {"deg": "degrees", "rad": "radians"}


def refuse_options(source: Source, format_: str, unit: Unit, why_no_rate: str = "has times of its own") -> None:
    """Refuse a unit that the format does not have, and a rate.

    Args:
        source: the file and what the caller says of it.
        format_: what the format is called, with its article.
        unit: the one unit of its angles.
        why_no_rate: what about it makes a rate wrong.

    Raises:
        RecordingError: the caller's unit or rate contradicts the format.
    """
    if source.unit not in (None, unit):
        raise source.error(f"unit '{source.unit}' by unit option", f"{WORDS[unit]}: {format_} has no other unit")
    if source.rate is not None:
        raise source.error(f"a rate of {source.rate:g} Hz", f"no rate: {format_} {why_no_rate}")
