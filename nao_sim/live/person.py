"""A sensor's points as a person in the project's unit and axes.

What a layout or the sender does not say, unit, axes and whose left is left, the
first frames tell, by the rules that tell it of a file.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache

import numpy as np

from nao_sim.body import twin
from nao_sim.live.problem import LiveError
from nao_sim.live.protocol import Frame, Hello
from nao_sim.recordings.skeletons.facing import Told
from nao_sim.recordings.skeletons.fitting import Fit
from nao_sim.recordings.skeletons.layouts import FOLDER, Layout, builtin
from nao_sim.recordings.skeletons.points import Points, confidence_of, flattened, positions_of, sample_of
from nao_sim.recordings.skeletons.readings import Reading, by_layout
from nao_sim.robot import Array

FIRST = 10  # frames with somebody in them that tell what the numbers are
OWN = "recording"  # what points that were read from one go by
_IN_METRES = frozenset({"mediapipe_pose"})  # MediaPipe's world landmarks
_MIRROR = np.array([1.0, -1.0, 1.0])


@cache
def layouts() -> Mapping[str, Layout]:
    """Every built-in layout, by the name that clients use."""
    return dict(zip((path.stem for path in sorted(FOLDER.glob("*.toml"))), builtin(), strict=True))


def layout_called(name: str) -> tuple[str, Layout]:
    """A built-in layout, called as its file or by its title.

    Raises:
        LiveError: there is none of that name.
    """
    plain = _plain(name)
    for stem, layout in layouts().items():
        if plain in {stem, _plain(layout.name)}:
            return stem, layout
    raise LiveError("unknown_layout", f"layout {name[:40]!a}; expected one of {', '.join(layouts())}")


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")


class PersonReader:
    """Reads one sensor's frames; it has a state, what the first ones told.

    Args:
        hello: what the sender says of its numbers.
        joints: what the points are, where they are in the project's own unit and axes, as those of a recording
            that was read; those of the hello's layout where None.

    Attributes:
        understood: how the numbers are taken, in words; None while that is not known.
        points: how many a frame has.
    """

    understood: str | None
    _reading: Reading | None

    def __init__(self, hello: Hello, joints: tuple[str, ...] | None = None) -> None:
        name, self._layout = layout_called(hello.layout) if joints is None else (OWN, Layout(OWN, joints))
        self.points = len(self._layout)
        unit = hello.unit or self._layout.unit or (1.0 if name in _IN_METRES else None)
        firm = hello.unit is not None and hello.axes is not None
        axes = hello.axes or self._layout.axes
        self._told = Told(unit, axes, firm=firm, usual=hello.axes is None, planar=hello.planar)
        self._planar, self._mirror = hello.planar, hello.mirror
        self._first: list[Array] = []
        self._reading = None if joints is None else Reading(OWN, self._layout.columns, Fit(joints, 1.0, np.eye(3), 0.0))
        self.understood = None if joints is None else "joints, unit and axes as read from the file"

    @property
    def planar(self) -> bool:
        """Whether depth is unknown."""
        return self._planar

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints of `read`'s rows, once that is known."""
        assert self._reading is not None
        names = self._reading.fit.joints
        return tuple(twin(name) for name in names) if self._mirror else names

    @property
    def columns(self) -> Mapping[str, list[int]]:
        """The points that make up each joint, by the layout."""
        return self._layout.columns

    def mirror(self, on: bool) -> None:
        """Read the person's mirror image from now on, or no longer."""
        self._mirror = on

    def read(self, frame: Frame) -> tuple[Array, Array] | None:
        """The person's joints (J, 3) m and their confidence (J,); None while it is not known what the numbers mean.

        Raises:
            LiveError: the frame has other points, or no person is in the first ones.
        """
        if len(frame.points) != self.points:
            raise LiveError(
                "wrong_size", f"{len(frame.points)} points; expected {self.points}, as {self._layout.name} has"
            )
        if self._reading is None and not self._find_out(frame):
            return None
        assert self._reading is not None
        told = np.nan_to_num(frame.confidence, nan=1.0)[None]
        points = Points(frame.points[None], confidence=told, planar=self._planar, layout=self._layout)
        found = confidence_of(points, self._reading)
        sure = np.zeros((1, len(self._reading.columns))) if found is None else found
        positions = positions_of(points, self._reading, sure, self._planar)[0]
        return (positions * _MIRROR if self._mirror else positions), sure[0]

    def _find_out(self, frame: Frame) -> bool:
        """Gather the first frames; whether they are enough."""
        if np.isfinite(sample_of(frame.points[None], self._layout.zeros_missing)).any():
            self._first.append(frame.points)
        if len(self._first) < FIRST:
            return False
        sample = sample_of(np.stack(self._first), self._layout.zeros_missing)
        self._first = []
        reading = by_layout(flattened(sample) if self._planar else sample, self._layout, self._told)
        if reading.fit.problems:
            problem = "; ".join(reading.fit.problems)
            raise LiveError("no_person", f"no body by {self._layout.name}: {problem}; expected a person, whole in view")
        self._reading = reading
        self.understood = "; ".join((reading.name, *reading.fit.reasons, *reading.fit.notes))
        return True
