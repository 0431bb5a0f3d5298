"""Which moment of a performance is shown, and what of it: a player's buttons without a screen."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum

SPEEDS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0)  # times as fast as it happened


class Layer(StrEnum):
    """What may be shown besides the robot."""

    person = "person"
    collision = "collision shapes"
    contacts = "contacts"
    safety = "safety colours"
    requested = "requested pose"


class Playback:
    """A player's state, which buttons and the passing of time change.

    Args:
        duration: s, how long there is something to show.
        shown: the layers shown at the start.
        playing: whether it plays at the start.

    Attributes:
        duration: s.
        time: s, the moment that is shown, from 0 to `duration`.
        playing: whether time passes.
        speed: times as fast as it happened, one of `SPEEDS`.
        shown: the layers that are shown.
    """

    def __init__(self, duration: float, shown: Iterable[Layer] = (), *, playing: bool = True) -> None:
        self.duration, self.time, self.playing, self.speed = duration, 0.0, playing, 1.0
        self.shown = frozenset(shown)

    def advance(self, elapsed: float) -> None:
        """`elapsed` seconds of the spectator's have passed; the end is held."""
        if not self.playing:
            return
        self.seek(self.time + self.speed * elapsed)
        self.playing = self.time < self.duration

    def toggle(self) -> None:
        """Pause or go on; from the end begin again."""
        if not self.playing and self.time >= self.duration:
            self.time = 0.0
        self.playing = not self.playing

    def seek(self, time: float) -> None:
        """Show the moment nearest to `time` (s) that there is."""
        self.time = min(max(time, 0.0), self.duration)

    def jump(self, seconds: float) -> None:
        """Go forward, or back where negative, and stay there."""
        self.seek(self.time + seconds)
        self.playing = False

    def faster(self) -> None:
        """The next speed, if there is one."""
        self._change_speed(1)

    def slower(self) -> None:
        """The speed before, if there is one."""
        self._change_speed(-1)

    def show(self, layer: Layer) -> None:
        """Show a layer, or hide it where it is shown."""
        self.shown ^= {layer}

    def _change_speed(self, places: int) -> None:
        place = SPEEDS.index(self.speed) + places
        self.speed = SPEEDS[min(max(place, 0), len(SPEEDS) - 1)]
