"""Everything that is shown over the picture of a film: coloured limbs, captions, titles and the time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.limit_captions import LimitCaptions
from nao_sim.rendering.arrangements import Arrangement, Overlay
from nao_sim.rendering.captions import TENTHS, Script, Title
from nao_sim.rendering.presets import load_safety
from nao_sim.rendering.tint import Tint, Tinted
from nao_sim.robot import Array, Robot
from nao_sim.safety_colours import SafetyColours

if TYPE_CHECKING:
    import mujoco

    from nao_sim.gesture_captions import GestureCaptions
    from nao_sim.safety.change import Intervention
    from nao_sim.simulation.rollout import Rollout


class FilmOverlay:
    """Tells what is shown over each frame of a film.

    Args:
        overlay: what is wanted.
        model: the filmed scene.
        robot: who is filmed.
        gestures: what is recognised, if anything.
        titles: words over parts of the picture.

    Attributes:
        tint: what may take colour and what may be written; None where nothing may.
    """

    def __init__(
        self,
        overlay: Overlay,
        model: mujoco.MjModel,
        robot: Robot,
        gestures: GestureCaptions | None,
        titles: tuple[Title, ...],
    ) -> None:
        self._colours = SafetyColours(model, robot) if overlay.safety else None
        self._limits = LimitCaptions(robot) if overlay.limits else None
        self._gestures = gestures if overlay.gestures else None
        self._clock = overlay.time
        coloured = self._colours.tint if self._colours else Tint()
        labels = (
            *coloured.script.labels,
            *(self._limits.labels if self._limits else ()),
            *(self._gestures.labels if self._gestures else ()),
        )
        script = Script(labels, load_safety().letter, titles, self._clock)
        self.tint = Tint(coloured.parts, coloured.takes, script) if labels or titles or self._clock else None

    def at(self, times: Array, rollout: Rollout, interventions: Sequence[Intervention]) -> Tinted | None:
        """What the frames at times (N,) s of a run show, whose guard intervened (T,) so."""
        if self.tint is None:
            return None
        told = (times - rollout.motion_start) * rollout.speed
        rows = [np.zeros((len(times), 0))]
        if self._colours:
            rows.append(self._colours.at(times, interventions, rollout.time).rows)
        if self._limits:
            rows.append(self._limits.at(times, rollout.command, rollout.time))
        if self._gestures:
            rows.append(self._gestures.at(told))
        if self._clock:
            rows.append(_whole_tenths(told)[:, None])
        return Tinted(self.tint, np.hstack(rows))


def titles_of(arrangement: Arrangement, guarded: bool) -> tuple[Title, ...]:
    """The words over the panes of a picture; `guarded` where all rules of the guard are on."""
    return tuple(
        Title(words, pane.at[0] + pane.at[2] / 2.0, pane.at[1])
        for pane in arrangement.panes
        if (words := pane.title(guarded))
    )


def _whole_tenths(seconds: Array) -> Array:
    """Times (N,) s as a clock tells them: it waits for the recording, and changes ten times a second."""
    return np.asarray(np.floor(np.maximum(seconds, 0.0) * TENTHS + 1e-6) / TENTHS)
