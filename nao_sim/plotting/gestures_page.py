"""Which gestures were recognised when: a band for each over the time of the recording."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.gestures.poses import NONE
from nao_sim.gestures.recognised import Recognised
from nao_sim.plotting.lines import draw_over_time, is_long, stretches
from nao_sim.plotting.palette import LEFT, MIDDLE, SHADE
from nao_sim.plotting.style import Block, narrow, save_page, shortened
from nao_sim.recordings import Recording
from nao_sim.robot import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from nao_sim.plotting.style import Canvas

BAND = 0.4  # half the height of a band at full confidence
_LONGEST, _LONGEST_NARROW = 30, 14  # characters of a name
_WORDS = "gestures recognised; a band is as high as the confidence (full: 100 %)"


def save_gestures(found: Recognised, recording: Recording, path: Path, size: str | None = None) -> None:
    """Draw what was announced in every frame.

    Args:
        found: what was recognised.
        recording: in what.
        path: a `.png`, `.svg` or `.pdf`.
        size: a name of `SIZES`; what suits the kind of file where None.

    Raises:
        UsageError: it cannot be written there.
    """
    save_page([gestures_block(found)], path, f"{recording.path.name}: {_WORDS}", size=size)


def gestures_block(found: Recognised) -> Block:
    """A band for each gesture that ever was announced, as high as the confidence, and a line where nothing was."""
    names = list(dict.fromkeys(each.label for each in found.segments))
    times = np.array([each.time for each in found.decisions]) - found.decisions[0].time
    labels = np.array([each.label for each in found.decisions])
    confidence = np.array([each.confidence for each in found.decisions])

    def draw(canvas: Canvas) -> None:
        axes = canvas.add_subplot()
        for place, name in enumerate(names):
            _draw_band(axes, place, times, np.where(labels == name, confidence, 0.0))
        _draw_nothing(axes, times, labels == NONE, len(names))
        longest = _LONGEST_NARROW if narrow() else _LONGEST
        axes.set_yticks(range(len(names) + 1), [shortened(name, longest) for name in (*names, NONE)])
        axes.set(xlabel="time after the first frame (s)", ylabel="gesture", ylim=(len(names) + 0.6, -0.6))
        axes.set_xlim(times[0], max(times[-1], times[0] + 1e-3))

    return Block("gestures over time", draw, lambda _: max(2.2, 0.5 * len(names) + 1.5))


def _draw_band(axes: Axes, place: int, times: Array, confidence: Array) -> None:
    """A band around `place`, of a gesture that has this confidence, 0 where it is not announced."""
    axes.axhspan(place - BAND, place + BAND, color=SHADE, linewidth=0.0)
    if is_long(times):
        parts = stretches(times, confidence)
        times, confidence = parts.times, parts.highest
    half = BAND * confidence
    axes.fill_between(times, place - half, place + half, step="post", color=LEFT, linewidth=0.0)
    if len(times) == 1 and confidence[0] > 0.0:  # a frame has no width
        axes.vlines(times[0], place - half[0], place + half[0], color=LEFT, linewidth=4.0)


def _draw_nothing(axes: Axes, times: Array, nothing: Array, place: int) -> None:
    line = np.where(nothing, float(place), np.nan)
    draw_over_time(axes, times, line, color=MIDDLE, linewidth=2.0, drawstyle="steps-post")
