"""What the benchmarks of gestures share: sections of GESTURES.md and intervals of shares."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable, Sequence
from datetime import date
from pathlib import Path

import numpy as np
from benchmark import Rows, machine, table

NOTES = Path(__file__).resolve().parent / "GESTURES.md"
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
    """`99.1 % (98.6-99.4)`: a share with Wilson's interval (1927)."""
    z, share = 1.96, right / count
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z / (1 + z * z / count) * math.sqrt(share * (1 - share) / count + z * z / (4 * count * count))
    return f"{100 * share:.1f} % ({100 * (middle - half):.1f}-{100 * min(middle + half, 1.0):.1f})"


def grouped(right: np.ndarray, groups: np.ndarray, draws: int = 2000) -> str:
    """A share with the interval of a bootstrap over groups of frames that belong together."""
    random, names = np.random.default_rng(0), np.unique(groups)
    sums = np.array([right[groups == name].sum() for name in names])
    counts = np.array([(groups == name).sum() for name in names])
    drawn = random.integers(len(names), size=(draws, len(names)))
    shares = sums[drawn].sum(axis=1) / counts[drawn].sum(axis=1)
    low, high = np.quantile(shares, [0.025, 0.975])
    return f"{100 * right.mean():.1f} % ({100 * low:.1f}-{100 * high:.1f})"


def median_ms(run: Callable[[object], object], inputs: Sequence[object]) -> float:
    """Median milliseconds of a call, the first ten not counted."""
    took = []
    for each in inputs:
        began = time.perf_counter()
        run(each)
        took.append(time.perf_counter() - began)
    return 1e3 * float(np.median(took[10:]))
