"""Points as a file has them, and how they become a skeleton.

Every reader of people ends here: it hands over the numbers in the file's own
order, unit and axes, with the names or the layout that it knows of, and the
rules of this one place find out, or check, what they mean.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from nao_sim.motion import Skeleton
from nao_sim.recordings.source import Source
from nao_sim.robot import Array


@dataclass(frozen=True, eq=False)
class Points:
    """One person's points.

    Attributes:
        values: (T, J, 3) in the file's unit and axes; nan where missing.
        names: (J,) what the file calls them; None for points that are known by their order only.
        times: (T,) s as the file has them; None where it has none.
        confidence: (T, J) from 0 to 1, or None.
        lines: (T,) line or frame numbers, for messages; None where counting from 1 says it.
        planar: whether the third coordinate is unknown.
        unit: metres in one unit of the file, where the format says so.
        axes: the person's (forward, left, up) as signed axes of the file, e.g. ("-z", "-x", "+y"), where the format
            says so.
        rate: Hz, the usual rate of such files, where they have no times.
        frozen_is_missing: whether points at exactly (0, 0, 0) mean "not tracked".
    """

    values: Array
    names: tuple[str, ...] | None = None
    times: Array | None = None
    confidence: Array | None = None
    lines: tuple[int, ...] | None = None
    planar: bool = False
    unit: float | None = None
    axes: tuple[str, str, str] | None = None
    rate: float | None = None
    frozen_is_missing: bool = True


@dataclass(frozen=True, eq=False)
class Understood:
    """Points made sense of.

    Attributes:
        skeleton: the person.
        reason: which layout, unit and axes, and what told so, in a few words for the user.
        notes: what a user should know besides (sides swapped, scaled, frames dropped, names not known).
    """

    skeleton: Skeleton
    reason: str
    notes: tuple[str, ...] = field(default=())


def understand(source: Source, points: Points) -> Understood:
    """Find out which joints the points are, in what unit and axes, and bring them to the project's.

    Raises:
        RecordingError: no layout fits, or several do (they are named), or times are wrong.
    """
    raise NotImplementedError
