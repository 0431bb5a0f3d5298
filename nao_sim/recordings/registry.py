"""Every format that can be read, and the one function that reads it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from nao_sim.errors import RecordingError, UsageError
from nao_sim.recordings.angles import (
    choregraphe_python,
    choregraphe_timeline,
    joint_csv,
    joint_npz,
    thesis_table,
    webots_motion,
)
from nao_sim.recordings.landmarks import landmarks_json, openpose, openpose_folder, openpose_poses, pose_file
from nao_sim.recordings.recording import Recording
from nao_sim.recordings.rigs import acclaim, bvh
from nao_sim.recordings.source import Kind, Source, Unit, not_text
from nao_sim.recordings.table import header_of
from nao_sim.recordings.tables import (
    hand_table,
    matlab,
    mocap_csv,
    named_columns,
    ntu,
    numpy_points,
    skeleton_rows,
    tidy_table,
)

KNOWN = "a format that nao-sim formats lists"
KNOWN_TEXT = f"{KNOWN}, or a layout of your own (--layout)"


@dataclass(frozen=True)
class Format:
    """A kind of file.

    Attributes:
        name: what users call it.
        looks: what such a file starts with.
        kind: text, binary, or a folder of files.
        recognise: why a file is of this kind, or None where it is not.
        read: read a file of this kind, given that reason.
    """

    name: str
    looks: str
    kind: Kind
    recognise: Callable[[Source], str | None]
    read: Callable[[Source, str], Recording]


FORMATS = tuple(
    Format(module.NAME, module.LOOKS, getattr(module, "KIND", "text"), module.recognise, module.read)
    for module in (
        openpose,
        openpose_poses,
        openpose_folder,
        landmarks_json,
        mocap_csv,
        matlab,
        pose_file,
        choregraphe_timeline,
        numpy_points,
        joint_npz,
        choregraphe_python,
        acclaim,
        bvh,
        webots_motion,
        thesis_table,
        hand_table,
        named_columns,
        tidy_table,
        joint_csv,
        ntu,
        skeleton_rows,  # last: with a layout it takes any text
    )
)


def load(  # each is something that a file may not say
    path: str | Path,
    unit: Unit | None = None,
    rate: float | None = None,
    *,
    layout: str | Path | None = None,
    person: str | int | None = None,
    rig: str | Path | None = None,
) -> Recording:
    """Read a recording of any known format, told by its content.

    Args:
        path: the file; for OpenPose also the folder of its frames.
        unit: `deg` or `rad`, for angles whose unit the file does not say.
        rate: frames a second (Hz), for a file without times.
        layout: a TOML table that says how a skeleton stands in the file.
        person: which of several people, by the file's own id; the one tracked
            longest where None.
        rig: the ASF file of an AMC file.

    Returns:
        As `read`.

    Raises:
        RecordingError: the file cannot be read; the message names the place.
        UsageError: `unit` or `rate` is no unit or rate.
    """
    person = None if person is None else str(person)
    layout, rig = (None if file is None else Path(file) for file in (layout, rig))
    return read(Source(Path(path), unit, rate, layout, person, rig))


def read(source: Source) -> Recording:
    """Read a file of any known format, told by its content.

    Args:
        source: the file, and what the caller says about it.

    Returns:
        The recording: a joint trajectory or a skeleton, the format, and the
        reason it was taken for that format.

    Raises:
        RecordingError: the file cannot be read; the message names the place.
        UsageError: the source's unit or rate is no unit or rate.
    """
    unit, rate = source.unit, source.rate
    if unit not in (None, "deg", "rad"):
        raise UsageError(f"unit '{unit}' is not known; expected deg or rad")
    if rate is not None and not (math.isfinite(rate) and rate > 0.0):
        raise UsageError(f"rate {rate:g} is no frame rate; expected a positive number of frames a second (Hz)")
    what = source.kind()
    for format_ in FORMATS:
        if format_.kind == what and (reason := format_.recognise(source)):
            return format_.read(source, reason)
    raise _unrecognised(source, what)


def _unrecognised(source: Source, what: Kind) -> RecordingError:
    """Say what the file starts with and what it could start with."""
    if what == "folder":
        return source.error("a folder", "a file, or a folder of the frames of OpenPose")
    if what == "binary":
        return source.error(not_text(source.start) or "binary data", KNOWN)
    line = source.header()
    if line is None:
        return source.error("only blank lines and comments", KNOWN)
    number, text = line
    if all(_is_number(cell) for cell in header_of(line).columns):
        return source.error("numbers without a header", KNOWN_TEXT, number)
    shown = text.strip() if len(text.strip()) <= 60 else text.strip()[:57] + "..."  # noqa: PLR2004
    return source.error(f"'{shown}', which no reader knows", KNOWN_TEXT, number)


def _is_number(cell: str) -> bool:
    try:
        float(cell or "nan")
    except ValueError:
        return False
    return True
