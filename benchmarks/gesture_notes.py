"""What the benchmarks of gestures share: sections of GESTURES.md and intervals of shares."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Sequence
from datetime import date
from pathlib import Path

import numpy as np
from benchmark import Rows, machine, table

from nao_sim.gestures.shares import Share, between_groups, percent
from nao_sim.motion import Skeleton

NOTES = Path(__file__).resolve().parent / "GESTURES.md"
RATE = 30.0  # Hz, to which faster recordings are thinned
HEAD = """# Gestures recognised

Poses and movements of people whom the recogniser was not trained on. Intervals are 95 % ones.
"""


def note(title: str, text: str, rows: Rows, command: str) -> None:
    """Print a section, and put it into GESTURES.md in place of the one with the same title."""
    body = f"## {title}\n\n{date.today()}, {machine()}. `python benchmarks/{command}`\n\n{text}\n\n{table(rows)}\n"
    print(body)
    old = NOTES.read_text(encoding="utf-8") if NOTES.is_file() else HEAD
    kept = re.sub(rf"\n## {re.escape(title)}\n.*?(?=\n## |\Z)", "", old, flags=re.DOTALL)
    NOTES.write_text(f"{kept.rstrip()}\n\n{body}", encoding="utf-8")


def wilson(right: int, count: int) -> str:
    """`99.1 % (98.6-99.4)`: a share with Wilson's interval."""
    return str(Share(right, count))


def reliability(sure: np.ndarray, right: np.ndarray, groups: int = 5) -> Rows:
    """Mean confidence beside the share right, in groups of equally many from unsure to sure, and the expected error."""
    rows: Rows = [("confidence", "decisions", "mean confidence", "right")]
    error = 0.0
    for group in np.array_split(np.argsort(sure, kind="stable"), groups):
        said, true = sure[group], right[group]
        error += abs(said.mean() - true.mean()) * len(group) / len(sure)
        cells = (f"{said.min():.2f} to {said.max():.2f}", str(len(group)), f"{said.mean():.2f}")
        rows.append((*cells, wilson(int(true.sum()), len(true))))
    total = wilson(int(right.sum()), len(right))
    rows.append(
        (f"all; expected calibration error {100 * error:.1f} points", str(len(sure)), f"{sure.mean():.2f}", total)
    )
    return rows


def grouped(right: np.ndarray, groups: np.ndarray) -> str:
    """A share with the interval of a bootstrap over groups of frames that belong together."""
    return percent(right.mean(), between_groups(right, groups))


def median_ms(run: Callable[[object], object], inputs: Sequence[object]) -> float:
    """Median milliseconds of a call, the first ten not counted."""
    took = []
    for each in inputs:
        began = time.perf_counter()
        run(each)
        took.append(time.perf_counter() - began)
    return 1e3 * float(np.median(took[10:]))


def thinned(person: Skeleton) -> Skeleton:
    """About `RATE` frames a second of a faster recording."""
    step = max(1, round(1.0 / RATE / float(np.median(np.diff(person.times)))))
    return Skeleton(person.times[::step], person.positions[::step], person.joints, person.confidence[::step])
