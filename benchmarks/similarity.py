"""Let the robot imitate every recording of a folder and write the scores side by side into SIMILARITY.md.

    python benchmarks/similarity.py RECORDINGS [--match hands] [--body whole] [--raw] [--only WORD]

Each recording is played as `nao-sim play` does, without a video, free-standing;
the scores are the report's (docs/report.md).  A file without times that asks
for a frame rate gets 30 Hz.  Files that cannot be played are listed with the
reason.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

from benchmark import machine

from nao_sim.errors import NaoSimError
from nao_sim.recordings import Source
from nao_sim.replay import Orders, replay

HERE = Path(__file__).resolve().parent
TABLE = HERE / "SIMILARITY.md"
ASSUMED_RATE = 30.0  # Hz
NO_RECORDINGS = ("LICENSE*", "*.md", "*.key", "*.tar*", "truelabels")
COLUMNS = {  # heading: path in the report, digits, factor
    "format": ("format", None, 1.0),
    "s": ("duration_s", 1, 1.0),
    "left arm seen (%)": ("similarity coverage left", 0, 100.0),
    "right (%)": ("similarity coverage right", 0, 100.0),
    "nearest (°)": ("similarity limits_deg all mean", 1, 1.0),
    "asked (°)": ("similarity stages requested direction_error_deg all mean", 1, 1.0),
    "beyond nearest (°)": ("similarity stages requested excess_deg mean", 2, 1.0),
    "commanded (°)": ("similarity stages commanded direction_error_deg all mean", 1, 1.0),
    "simulated (°)": ("similarity stages simulated direction_error_deg all mean", 1, 1.0),
    "median": ("similarity stages simulated direction_error_deg all median", 1, 1.0),
    "95 %": ("similarity stages simulated direction_error_deg all p95", 1, 1.0),
    "hands (arm lengths)": ("similarity stages simulated hand_error_arm_lengths all mean", 3, 1.0),
    "WBF": ("similarity stages simulated wbf mean", 3, 1.0),
    "LLF": ("similarity stages simulated llf mean", 3, 1.0),
    "delay (ms)": ("similarity stages simulated lag_ms", 0, 1.0),
    "self-collisions": ("simulated self_collision_frames", 0, 1.0),
    "fell": ("simulated fell", None, 1.0),
}
INTRODUCTION = """# Similarity on real recordings

What `nao-sim play` makes of each recording, free-standing; docs/report.md says what the columns mean. Angles are means
over the upper arms and forearms of both sides, between the robot and the person: of NAO's nearest pose (its joint
limits alone), as asked (before safety), as commanded (after the guard) and as simulated. "Beyond nearest" is asked
minus nearest. Hands, WBF, LLF and delay are the simulated robot's.
"""


@dataclass(frozen=True)
class Tried:
    """What came of one recording: its report, or why there is none."""

    name: str
    report: Mapping[str, Any] | None
    note: str = ""


def recordings_in(folder: Path) -> Iterator[Path]:
    """Every file that could be a recording, in order."""
    for path in sorted(folder.rglob("*")):
        about = path.relative_to(folder)
        if path.is_file() and not any(Path(part).match(word) for part in about.parts for word in NO_RECORDINGS):
            yield path


def tried(path: Path, name: str, options: Mapping[str, Any]) -> Tried:
    """Play a recording; once more at a usual frame rate where it asks for one."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        try:
            return Tried(name, replay(Orders(Source(path), report, **options)).report)
        except NaoSimError as error:
            reason = str(error).replace(str(path), "").lstrip(":, ")
        try:
            report = replay(Orders(Source(path, rate=ASSUMED_RATE), report, **options)).report
            return Tried(name, report, f"at {ASSUMED_RATE:g} Hz")
        except NaoSimError:
            return Tried(name, None, reason)


def row(result: Tried) -> list[str]:
    """The cells of a recording that was played."""
    cells = [f"{result.name} ({result.note})" if result.note else result.name]
    for path, digits, factor in COLUMNS.values():
        value: Any = result.report
        for key in path.split():
            value = value[key]
        if digits is None:
            cells.append({True: "yes", False: "no"}.get(value, str(value)))
        else:
            cells.append("-" if value is None else f"{factor * value:.{digits}f}")
    return cells


def table(results: Sequence[Tried]) -> str:
    """The Markdown of all that was tried."""
    played = [row(result) for result in results if result.report]
    head = ["recording", *COLUMNS]
    lines = ["| " + " | ".join(cells) + " |" for cells in (head, ["---"] * len(head), *played)]
    failed = [f"- {result.name}: {result.note}" for result in results if not result.report]
    return "\n".join([*lines, "", f"Played: {len(played)}. Not played: {len(failed)}.", "", *failed]).rstrip() + "\n"


def main(words: Sequence[str] | None = None) -> None:
    """Play everything and write the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="RECORDINGS")
    parser.add_argument("--match", choices=("directions", "hands"), default="directions")
    parser.add_argument("--body", choices=("arms", "whole"), default="arms")
    parser.add_argument("--raw", action="store_true", help="leave out the filters")
    parser.add_argument("--only", default="", metavar="WORD", help="only recordings whose path holds this")
    parser.add_argument("--out", type=Path, default=TABLE, help=f"default {TABLE.name} beside this script")
    args = parser.parse_args(words)
    where = machine()
    options = {"match": args.match, "body": args.body, "raw": args.raw}
    results = []
    for path in recordings_in(args.folder):
        name = path.relative_to(args.folder).as_posix()
        if args.only in name:
            results.append(tried(path, name, options))
            print(name, "played" if results[-1].report else results[-1].note, file=sys.stderr)
    command = (
        f"`python benchmarks/similarity.py RECORDINGS --match {args.match} --body {args.body}{' --raw' * args.raw}`"
    )
    args.out.write_text(f"{INTRODUCTION}\n{date.today()}, {where}. {command}\n\n{table(results)}", encoding="utf-8")


if __name__ == "__main__":
    main()
