"""Which gestures were recognised when: a band for each over the time of the recording."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.gestures.poses import NONE
from nao_sim.gestures.recognised import Recognised
from nao_sim.plotting.style import LEFT, MIDDLE, page, save, styled
from nao_sim.recordings import Recording
from nao_sim.robot import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BAND = 0.4  # half the height of a band at full confidence


def save_gestures(found: Recognised, recording: Recording, path: Path) -> None:
    """Draw what was announced in every frame, a band for each gesture that ever was.

    Bands are as high as the confidence; a line runs through all of them where nothing was recognised.

    Args:
        found: what was recognised.
        recording: in what.
        path: a `.png`, `.svg` or `.pdf`.

    Raises:
        UsageError: it cannot be written there.
    """
    names = list(dict.fromkeys(each.label for each in found.segments))
    times = np.array([each.time for each in found.decisions]) - found.decisions[0].time
    with styled():
        figure = page(max(2.2, 0.5 * len(names) + 1.5))
        axes = figure.add_subplot()
        for place, name in enumerate(names):
            _draw_band(
                axes, place, times, np.array([each.confidence * (each.label == name) for each in found.decisions])
            )
        _draw_nothing(axes, times, np.array([each.label == NONE for each in found.decisions]), len(names))
        axes.set_yticks(range(len(names) + 1), [*names, NONE])
        axes.set(xlabel="time after the first frame (s)", ylabel="gesture", ylim=(len(names) + 0.6, -0.6))
        axes.set_xlim(times[0], max(times[-1], times[0] + 1e-3))
        title = f"{recording.path.name}: gestures recognised; a band is as high as the confidence (full: 100 %)"
        figure.suptitle(title, x=0.01, ha="left", fontsize=11)
        save(figure, path)


def _draw_band(axes: Axes, place: int, times: Array, confidence: Array) -> None:
    """A band around `place`, of a gesture that has this confidence, 0 where it is not announced."""
    axes.axhspan(place - BAND, place + BAND, color="#f0f0f0", linewidth=0.0)
    half = BAND * confidence
    axes.fill_between(times, place - half, place + half, step="post", color=LEFT, linewidth=0.0)


def _draw_nothing(axes: Axes, times: Array, nothing: Array, place: int) -> None:
    line = np.where(nothing, float(place), np.nan)
    axes.plot(times, line, color=MIDDLE, linewidth=2.0, drawstyle="steps-post")
