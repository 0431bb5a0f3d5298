"""Landmarks in JSON: MediaPipe's in the many shapes that programs store them in, and joints by name.

One frame, a list of frames, a list within other tables (`{"fps": 30, "frames": [...]}`), one list of frames for each
part of the body, or one frame a line (JSON lines): `film` finds the frames, `landmark_shapes` the people in them, and
`landmark_parts` makes them arrays.  World landmarks are preferred over those in the picture.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from nao_sim.recordings.landmarks.film import WANTED, Film, film_of, size_of, times_of
from nao_sim.recordings.landmarks.json_text import looks_like_json
from nao_sim.recordings.landmarks.landmark_parts import BODIES, Part, as_they_are, body_of, parts_of
from nao_sim.recordings.landmarks.landmark_words import take
from nao_sim.recordings.landmarks.people import one_of
from nao_sim.recordings.recording import Recording, label_of_all
from nao_sim.recordings.skeletons.points import Points, understand
from nao_sim.recordings.source import Source

NAME = "landmarks (JSON)"
LOOKS = 'JSON with frames of landmarks, such as [{"pose_landmarks": [{"x": 0.5, "y": 0.4, "z": -0.1}, ...]}, ...]'


def recognise(source: Source) -> str | None:
    """Why the file may hold landmarks, or None."""
    return "JSON" if looks_like_json(source) else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file, with the caller's rate and person.
        reason: why it is taken for this format.

    Returns:
        The recording: one person; a label where the file names what is shown.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    film = film_of(source)
    points, what, notes = points_of(source, film)
    understood = understand(source, points)
    labels = label_of_all(take(film.about, "label"), float(understood.skeleton.times[-1]))
    return understood.recording(source, NAME, f"{reason} with {what}", len(film.frames), notes, labels)


def points_of(source: Source, film: Film) -> tuple[Points, str, tuple[str, ...]]:
    """The points of one person of a film.

    Returns:
        The points, what they are in words, and what a user should know.

    Raises:
        RecordingError: frames do not have the same points, or nothing is there.
    """
    seen, notes = one_of(source, film.people)
    parts = parts_of(source, seen)
    if not any(name in parts for name in BODIES):
        found = f"only {_words(parts)}" if parts else "landmarks that are all missing"
        raise source.error(found, f"landmarks of the body; {WANTED}")
    own = source.layout is not None
    points, told = (as_they_are(parts.get("world") or parts["body"]), ()) if own else body_of(parts, size_of(film))
    times, unit = times_of(source, film)
    return replace(points, times=times, time_unit=unit, lines=film.lines), _words(parts), (*notes, *told)


def _words(parts: Mapping[str, Part]) -> str:
    return " and ".join(f"{len(part.keys)} landmarks ({name.replace('_', ' ')})" for name, part in parts.items())
