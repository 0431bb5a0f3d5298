"""Several people in one file: who is who from frame to frame, and which one is meant."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from nao_sim.recordings.landmarks.landmark_shapes import Seen
from nao_sim.recordings.source import Source

Places = Mapping[str | int, tuple[float, ...]]
SHOWN = 8  # people named in a message


def choose(source: Source, tracked: Mapping[str, int]) -> tuple[str, tuple[str, ...]]:
    """One of several people: the caller's, or the one tracked longest (of equals the first).

    Args:
        source: the file, with the caller's choice.
        tracked: frames in which each person is there, by id; at least one.

    Returns:
        The id, and what the user should know of the choice.

    Raises:
        RecordingError: the caller's choice is not there.
    """
    frames = [f"{name} ({count} frames)" for name, count in list(tracked.items())[:SHOWN]]
    everyone = ", ".join(frames) + (f" and {len(tracked) - SHOWN} more" if len(tracked) > SHOWN else "")
    if source.person is not None:
        if source.person not in tracked:
            raise source.error(f"no person '{source.person}'", f"one of {everyone}")
        return source.person, ()
    best = max(tracked, key=lambda name: tracked[name])
    if len(tracked) == 1:
        return best, ()
    return best, (f"several people: {everyone}; person {best}, tracked longest, is read",)


def one_of(source: Source, crowd: Sequence[Sequence[Seen]]) -> tuple[list[Seen | None], tuple[str, ...]]:
    """One person through all frames.

    Args:
        source: the file, with the caller's choice.
        crowd: (T,) who is in each frame, with the file's own ids or without.

    Returns:
        (T,) the person, None where not there; and what the user should know of the choice.

    Raises:
        RecordingError: the caller's choice is not there.
    """
    if source.person is None and not any(len(people) > 1 for people in crowd):
        return [people[0] if people else None for people in crowd], ()
    if not any(person.id for people in crowd for person in people):
        who = linked([[_places(person) for person in people] for people in crowd])
        for people, numbers in zip(crowd, who, strict=True):
            for person, number in zip(people, numbers, strict=True):
                person.id = str(number)
    frames = [{person.id: person for person in people if person.id} for people in crowd]
    everyone = dict.fromkeys(name for frame in frames for name in frame)
    chosen, notes = choose(source, {name: sum(name in frame for frame in frames) for name in everyone})
    return [frame.get(chosen) for frame in frames], notes


def _places(person: Seen) -> Places:
    """Where the points of a person are, in the picture."""
    points = next(iter(person.parts.values()), {})
    return {key: point[:2] for key, point in points.items() if all(map(math.isfinite, point[:2]))}


def linked(frames: Sequence[Sequence[Places]]) -> list[list[int]]:
    """Who is who, where a file has no ids: each person is the nearest of those seen before.

    Pairs are made from the nearest on; one further away than a body is large,
    from where anybody was seen last, is somebody new.

    Args:
        frames: for each frame where each person's points are, by name or number.

    Returns:
        For each frame the number of each person, counted from 1 in order of appearance.
    """
    last: dict[int, Places] = {}
    found = []
    for people in frames:
        numbers: dict[int, int] = {}
        for _, person, number in _pairs(people, last):
            if person not in numbers and number not in numbers.values():
                numbers[person] = number
        for person, places in enumerate(people):
            number = numbers.setdefault(person, len(last) + 1)
            last[number] = {**last.get(number, {}), **places}
        found.append([numbers[person] for person in range(len(people))])
    return found


def _pairs(people: Sequence[Places], last: Mapping[int, Places]) -> list[tuple[float, int, int]]:
    """(distance, person, number) of those near enough to be the same, nearest first."""
    pairs = []
    for person, places in enumerate(people):
        for number, before in last.items():
            shared = [math.dist(place, before[key]) for key, place in places.items() if key in before]
            if shared and (distance := sum(shared) / len(shared)) <= _size(before):
                pairs.append((distance, person, number))
    return sorted(pairs)


def _size(places: Places) -> float:
    """The longest side (the file's unit) of the box around the points."""
    return max(max(side) - min(side) for side in zip(*places.values(), strict=True))
