"""Find a word of many by one example of each, when others show it elsewhere; note the figures in GESTURES.md.

    python benchmarks/retrieval.py RECORDINGS

RECORDINGS is a folder with `turkish_signs`: 57 words by one signer each.
"""

from __future__ import annotations

import argparse
import tarfile
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from benchmark import Rows
from gesture_notes import note, wilson
from people_varied import (
    Change,
    all_of,
    as_a_child,
    at_another_speed,
    mirrored,
    noisy,
    seen_from_elsewhere,
    unchanged,
    unevenly,
    with_gaps,
)

from nao_sim.errors import UsageError
from nao_sim.gestures.movements import MovementRecogniser
from nao_sim.gestures.sequence_learners import FRAMES, distances_by_warping
from nao_sim.gestures.windows import Window, window_of
from nao_sim.motion import Skeleton
from nao_sim.recordings import load
from nao_sim.robot import Array

DRAWS = 4
CHANGES: Mapping[str, Change] = {
    "as taught": unchanged,
    "in a mirror": mirrored,
    "seen from elsewhere: yaw 30°, pitch 15°, depth wrong by 30 %": seen_from_elsewhere,
    "0.7 to 1.4 times as fast": at_another_speed,
    "unevenly fast": unevenly,
    "noise of 1 cm": noisy(0.01),
    "noise of 2 cm": noisy(0.02),
    "noise of 3 cm": noisy(0.03),
    "a third of the frames and a tenth of the joints lost": with_gaps,
    "a child's proportions": as_a_child,
    "all of it, with 2 cm": all_of(as_a_child, seen_from_elsewhere, unevenly, at_another_speed, noisy(0.02), with_gaps),
}
TEXT = """57 words of Turkish Sign Language, each learned from its one recording. Each is shown {draws} times again,
changed by chance as the row says (`people_varied.py`; no recording of another signer is at hand, so these are not
strangers: a change keeps how the signer did it), and the words are ranked. Where the right word stands: first / among
the first five, of {count}. How examples are learned as a bad sensor sees them (joints that wander by 4 cm) was chosen
with these words in view; nothing else was. *Neighbour* compares arms and hands resampled to {frames} frames, *DTW*
with dynamic time warping; both see what ours sees."""


class Ranker:
    """Scores (N, W) of windows for words, by several methods."""

    def __init__(self, windows: Sequence[Window], words: Sequence[str]) -> None:
        self._words, self._known = list(words), list(windows)
        self._recogniser = MovementRecogniser.fit(windows, words)
        self._even = np.stack([_even(window) for window in windows])

    def ours(self, windows: Sequence[Window]) -> Array:
        decided = [self._recogniser.decide(window).scores for window in windows]
        return np.array([[scores[word] for word in self._words] for scores in decided])

    def neighbour(self, windows: Sequence[Window]) -> Array:
        shown = np.stack([_even(window) for window in windows])
        return -((shown[:, None] - self._even) ** 2).sum(axis=2)

    def warped(self, windows: Sequence[Window]) -> Array | None:
        """None where the extra is missing."""
        try:
            return -distances_by_warping(windows, self._known)
        except UsageError:
            return None


def signs(folder: Path) -> tuple[list[Skeleton], list[str]]:
    """The recordings of the archive and their words."""
    with tempfile.TemporaryDirectory() as name:
        with tarfile.open(next(folder.glob("*.tar.xz"))) as archive:
            archive.extractall(name, filter="data")
        files = sorted(Path(name).rglob("*.json"))
        return [load(file).motion for file in files], [file.stem for file in files]


def retrieval(folder: Path) -> tuple[str, Rows]:
    """A row for each change."""
    people, words = signs(folder)
    ranker = Ranker([window_of(person) for person in people], words)
    rows: Rows = [("shown", "ours: first", "five", "neighbour: first", "five", "DTW: first", "five")]
    random = np.random.default_rng(0)
    for name, change in CHANGES.items():
        shown = [window_of(change(person, random)) for _ in range(DRAWS) for person in people]
        cells: list[str] = []
        for scores in (ranker.ours(shown), ranker.neighbour(shown), ranker.warped(shown)):
            cells += ["-", "-"] if scores is None else _cells(scores, len(people))
        rows.append((name, *cells))
    text = " ".join(TEXT.format(draws=DRAWS, count=DRAWS * len(people), frames=FRAMES).split())
    return text, rows


def _cells(scores: Array, count: int) -> list[str]:
    right = scores[np.arange(len(scores)), np.arange(len(scores)) % count]
    ranks = (scores > right[:, None]).sum(axis=1)
    return [wilson(int((ranks < top).sum()), len(ranks)) for top in (1, 5)]


def _even(window: Window) -> Array:
    righted = window.mirrored() if window.left_handed else window
    tracks = righted.segments.reshape(len(window), -1)
    at = np.linspace(0.0, len(tracks) - 1.0, FRAMES)
    return np.stack([np.interp(at, np.arange(len(tracks)), track) for track in tracks.T], axis=1).ravel()


def main() -> None:
    """Measure and note."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", type=Path, metavar="RECORDINGS")
    text, rows = retrieval(parser.parse_args().recordings / "turkish_signs")
    note("Movements: a word found by one example", text, rows, "retrieval.py RECORDINGS")


if __name__ == "__main__":
    main()
