"""What is recognised, written into the film: the gesture's name and how sure it is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nao_sim.gestures.poses import NONE
from nao_sim.gestures.recognised import Recognised
from nao_sim.gestures.streaming import Decision
from nao_sim.rendering.captions import Label
from nao_sim.rendering.presets import load_gestures
from nao_sim.robot import Array


class GestureCaptions:
    """Tells which words stand in which frame of a film.

    Args:
        recognised: what was recognised, and when.

    Attributes:
        labels: every caption that occurs.
    """

    def __init__(self, recognised: Recognised) -> None:
        looks = load_gestures()
        poses = set(recognised.vocabulary.pose_names)
        self._times = np.array([each.time for each in recognised.decisions])
        words = [_words(each, recognised) for each in _steady(recognised.decisions, looks.steady)]
        kinds = {word: each.label in poses for word, each in zip(words, recognised.decisions, strict=True) if word}
        colours = {word: looks.pose if is_pose else looks.movement for word, is_pose in kinds.items()}
        self.labels = tuple(Label(word, colour) for word, colour in colours.items())
        order = [label.word for label in self.labels]
        self._shown = np.array([order.index(word) if word else -1 for word in words])

    def at(self, times: Array) -> Array:
        """Opacities (N, labels) at times (N,) s after the recording's first frame, that of the latest frame."""
        latest = np.searchsorted(self._times - self._times[0], times + 1e-6, side="right") - 1
        over = times > self._times[-1] - self._times[0] + 1e-6
        shown = np.where((latest < 0) | over, -1, self._shown[np.clip(latest, 0, None)])
        return (shown[:, None] == np.arange(len(self.labels))).astype(np.float64)


def _steady(decisions: Sequence[Decision], every: float) -> list[Decision]:
    """The decisions with numbers that stay for a while: a number that flickers cannot be read."""
    found: list[Decision] = []
    said = decisions[0]
    for decision in decisions:
        if decision.label != said.label or decision.time - said.time >= every:
            said = decision
        found.append(said)
    return found


def _words(decision: Decision, recognised: Recognised) -> str:
    """What the caption says, to 5 percent; nothing where there is no gesture."""
    if decision.label == NONE:
        return ""
    waits = "" if recognised.has_motion(decision.label) else " (no motion)"
    return f"{decision.label}  {5 * round(20 * decision.confidence)} %{waits}"
