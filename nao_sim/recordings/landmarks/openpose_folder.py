"""A folder with one OpenPose file a frame, as OpenPose's `--write_json` makes it.

The files are called `NAME_000000000042_keypoints.json`; the number is the frame's.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

from nao_sim.recordings.landmarks.json_text import documents
from nao_sim.recordings.landmarks.openpose import people_in, recording
from nao_sim.recordings.recording import Recording
from nao_sim.recordings.source import Source

NAME = "folder of OpenPose keypoints"
LOOKS = "a folder of OpenPose's *_keypoints.json"
KIND = "folder"
_FRAME = re.compile(r"(.*?)(\d*)_keypoints\.json(\.gz|\.bz2|\.xz)?")


def recognise(source: Source) -> str | None:
    """Why the folder holds OpenPose's frames, or None."""
    files = _files(source)
    return f"{len(files)} files *_keypoints.json" if files else None


def read(source: Source, reason: str) -> Recording:
    """Read the folder's frames in the order of their numbers.

    Args:
        source: the folder, with the caller's rate and person.
        reason: why it is taken for this format.

    Returns:
        The recording: one person, planar; frames whose files are missing are gaps.

    Raises:
        RecordingError: a file is not as it should be; the message names it.
    """
    numbers: list[int] = []
    crowd = []
    for name, number, path in _files(source):
        file = replace(source, path=path)
        file.kind()  # refuses what cannot be read
        if numbers and number <= numbers[-1]:
            raise source.error(f"a second frame {number}, {path.name}", f"the frames of one film, as {name}...")
        found = documents(file)
        if len(found) != 1:
            raise file.error(f"{len(found)} JSON documents", "one frame")
        numbers.append(number)
        crowd.append(people_in(file, found[0][1], number))
    return recording(source, reason, crowd, numbers)


def _files(source: Source) -> list[tuple[str, int, Path]]:
    """Name, frame number and path of each frame, in order."""
    try:
        paths = sorted(source.path.iterdir())
    except OSError as error:
        raise source.error(f"cannot be read ({(error.strerror or '').lower()})", "a readable folder") from None
    matches = [(match, path) for path in paths if (match := _FRAME.fullmatch(path.name))]
    found = [(match[1], int(match[2] or 0), path) for match, path in matches]
    return sorted(found, key=lambda file: file[1])
