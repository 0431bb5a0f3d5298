"""The filters one after the other, as `play` and `retarget` use them on a file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from nao_sim.imitation.filters.gaps import Fill
from nao_sim.imitation.filters.rejection import Reject, without
from nao_sim.imitation.filters.smoothing import Smooth
from nao_sim.motion import Skeleton

_REJECT, _FILL, _SMOOTH = Reject(), Fill(), Smooth()


class Filter(Protocol):
    """What every filter can do, the causal one included."""

    def filter(self, skeleton: Skeleton) -> Skeleton:
        """The skeleton of the same times and joints, filtered."""


@dataclass(frozen=True)
class Cleaning:
    """What cleaning did, in frames of single joints; nothing unless said.

    Attributes:
        points: frames times joints.
        rejected: frames by reason and joint.
        filled: frames by joint.
        missing: frames by joint that are still missing.
    """

    points: int = 0
    rejected: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    filled: Mapping[str, int] = field(default_factory=dict)
    missing: Mapping[str, int] = field(default_factory=dict)

    def notes(self) -> tuple[str, ...]:
        """What a user should know, in lines; none where nothing was done."""
        lines = [f"{_share(sum(joints.values()), self.points)} rejected by {reason} ({_most(joints)})"
                 for reason, joints in self.rejected.items() if joints]  # fmt: skip
        for joints, what in ((self.filled, "filled in"), (self.missing, "missing")):
            lines += [f"{_share(sum(joints.values()), self.points)} {what} ({_most(joints)})"] if joints else []
        return tuple(lines)


def clean(
    skeleton: Skeleton, reject: Reject | None = _REJECT, fill: Fill | None = _FILL, smooth: Smooth | None = _SMOOTH
) -> tuple[Skeleton, Cleaning]:
    """Reject what cannot be right, fill short gaps, smooth without lag.

    Args:
        skeleton: the person as recorded.
        reject: None keeps every point.
        fill: None keeps every gap.
        smooth: None keeps the tracks as they are.

    Returns:
        The person cleaned, with the same times and joints, and what was done.
    """
    found = reject.find(skeleton) if reject else {}
    kept = without(skeleton, found)
    whole = fill.filter(kept) if fill else kept
    cleaning = Cleaning(
        points=skeleton.confidence.size,
        rejected={reason: _counts(skeleton, mask) for reason, mask in found.items()},
        filled=_counts(skeleton, _missing(kept) & ~_missing(whole)),
        missing=_counts(skeleton, _missing(whole)),
    )
    return smooth.filter(whole) if smooth else whole, cleaning


def _missing(skeleton: Skeleton) -> NDArray[np.bool_]:
    return np.asarray(np.isnan(skeleton.positions).any(axis=2))


def _counts(skeleton: Skeleton, mask: NDArray[np.bool_]) -> dict[str, int]:
    """Frames of each joint, of those that have any."""
    return {name: count for name, count in zip(skeleton.joints, mask.sum(axis=0).tolist(), strict=True) if count}


def _share(count: int, points: int) -> str:
    return f"{count} of {points} points"


def _most(joints: Mapping[str, int]) -> str:
    """The joints concerned, the most frequent first."""
    names = sorted(joints, key=lambda name: -joints[name])
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")  # noqa: PLR2004
