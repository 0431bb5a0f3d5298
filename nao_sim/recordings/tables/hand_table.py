"""Tables of two hands and nothing else, as NiTE's hand tracker gives them: `class,leftX,leftY,leftZ,rightX,...`.

They are read, to be looked at; no robot can be moved by them, since they say nothing of shoulders and elbows.
"""

from __future__ import annotations

import numpy as np

from nao_sim.body import SIDES
from nao_sim.motion import Skeleton
from nao_sim.recordings.landmarks.landmark_words import plain
from nao_sim.recordings.recording import Recording
from nao_sim.recordings.skeletons.layout_file import LENGTHS
from nao_sim.recordings.skeletons.layouts import axis
from nao_sim.recordings.skeletons.timing import seconds
from nao_sim.recordings.source import Source
from nao_sim.recordings.tables.column_names import Columns, columns_of
from nao_sim.recordings.tables.named_rows import header_line
from nao_sim.recordings.tables.named_table import check, coordinates, labels_of, left_out, read_rows, times_of, unit_of

NAME = "table of two hands"
LOOKS = "a header of two hands such as leftX,leftY,leftZ,rightX,rightY,rightZ"
HANDS = {"left", "lefthand", "handleft", "lhand"}, {"right", "righthand", "handright", "rhand"}
AXES = ("-z", "-x", "+y")  # forward, left, up of who faces an OpenNI sensor (its picture is mirrored)
FAR = 10.0  # no hand is that many metres from its sensor: it is millimetres


def recognise(source: Source) -> str | None:
    """Why the file is a table of two hands, or None."""
    header = header_line(source)
    columns = columns_of(header.columns) if header else None
    if columns is None or columns.planar or source.layout is not None or len(_joints(columns)) != len(columns.points):
        return None
    return f"columns of two hands, {' and '.join(columns.points)}" if len(columns.points) == len(SIDES) else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file, with the caller's rate and person.
        reason: why it is taken for this format.

    Returns:
        The recording: a skeleton of `left_hand` and `right_hand`, and a label for each stretch of rows with one.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    header = header_line(source)
    assert header is not None, "recognise() has seen a header"
    columns = columns_of(header.columns)
    check(source, header, columns)
    rows = read_rows(source, header, columns)
    values = coordinates(columns, rows)
    values[~values.any(axis=2)] = np.nan
    known = np.abs(values[np.isfinite(values)])
    if not len(known):
        raise source.error("no tracked hand", "places of two hands")
    told = unit_of(source, header, columns)
    unit = told or ("mm" if np.median(known) > FAR else "m")
    times, time_unit, rate = times_of(source, header, columns, rows)
    when, time_notes = seconds(source, times, len(values), rate, time_unit, rows.lines)
    kept = np.isfinite(when)
    turned = values[kept] @ np.array([axis(signed) for signed in AXES]).T * LENGTHS[unit]
    skeleton = Skeleton(when[kept] - when[kept][0], turned, _joints(columns))
    notes = ("two hands and no body: no robot can be moved by them", *rows.notes, *left_out(columns), *time_notes)
    why = f"{reason}; {unit} by {'name' if told else 'size'}; forward -z, left -x, up +y, as OpenNI sensors have it"
    return Recording(source.path, NAME, why, skeleton, len(rows.lines), notes, labels_of(rows.labels, skeleton.times))


def _joints(columns: Columns) -> tuple[str, ...]:
    """Which hands the points are."""
    sides = dict(zip(SIDES, HANDS, strict=True))
    names = [plain(name) for name in columns.points]
    return tuple(f"{side}_hand" for name in names for side, words in sides.items() if name in words)
