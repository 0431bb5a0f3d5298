"""What was recognised in a recording, as CSV, as JSON and on the terminal."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Sequence
from pathlib import Path

from nao_sim.gestures.recognised import Recognised
from nao_sim.recordings import Recording
from nao_sim.sections import Section, print_sections

SCHEMA = 1
COLUMNS = ("time", "label", "confidence", "since")


def csv_text(found: Recognised) -> str:
    """A row for each frame: when after the first one, the label, its probability, and since when it is announced."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(COLUMNS)
    first = found.decisions[0].time
    for each in found.decisions:
        times = f"{each.time - first:.6g}", f"{each.since - first:.6g}"
        rows.writerow([times[0], each.label, f"{each.confidence:.4f}", times[1]])
    return text.getvalue()


def json_text(recording: Recording, found: Recognised) -> str:
    """The gestures, and how the recording was understood."""
    about = {
        "schema": SCHEMA, "recording": str(recording.path), "format": recording.format, "notes": list(recording.notes),
        "frames": len(found.person), "duration_s": round(found.person.duration, 6),
    }  # fmt: skip
    return json.dumps(about | found.as_report(), indent=2) + "\n"


def print_recognised(recording: Recording, found: Recognised, written: Sequence[Path]) -> None:
    """Print the gestures, and where the files are."""
    frames = "1 frame" if len(found.person) == 1 else f"{len(found.person)} frames"
    title = f"{recording.path}: {recording.format}, {frames} in {found.person.duration:.1f} s"
    print_sections([gestures_section(recording, found, title)], written)


def gestures_section(recording: Recording, found: Recognised, title: str) -> Section:
    """The gestures and when they were announced, with what a user should know of the recording."""
    first = found.decisions[0].time
    rows = [
        (f"{each.start - first:.2f} s", f"{each.end - first:.2f} s", each.label, f"{100 * each.confidence:.0f} %")
        for each in found.segments
    ]
    words = [f"note: {each}" for each in recording.notes]
    words += [] if rows else [f"none recognised of {', '.join(found.vocabulary.names)}"]
    return Section(title, ("from", "to", "gesture", "confidence"), rows, tuple(words))
