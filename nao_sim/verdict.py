"""Whether a run was safe as requested, was made safe, or was not safe at all."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from enum import StrEnum
from typing import Any

COUPLING_DEG, SPEED_RATIO, NEAREST_M = 0.5, 1.02, 0.005  # beyond these a rule counts as broken
UNSAFE_STATUS = 4


class Verdict(StrEnum):
    """What came of a run."""

    as_requested = "as_requested"
    made_safe = "made_safe"
    unsafe = "unsafe"


def verdict(changed_steps: int, wrong: list[str]) -> Verdict:
    """The verdict on a run with so many changed control steps, whose simulated robot did so much wrong."""
    if wrong:
        return Verdict.unsafe
    return Verdict.made_safe if changed_steps else Verdict.as_requested


def wrongs(simulated: Mapping[str, Any]) -> list[str]:
    """What the simulated robot did that no robot may, in words; nothing where all was well.

    Args:
        simulated: as the report has it.
    """
    return list(_wrongs(simulated))


def _wrongs(did: Mapping[str, Any]) -> Iterator[str]:
    if did["fell"]:
        yield "the robot fell"
    if did["limit_violations"]:
        yield f"a joint passed its limit, by up to {did['max_limit_excess_deg']:.2f}°"
    if did["max_coupling_excess_deg"] > COUPLING_DEG:
        yield f"a joint passed the limit that another joint sets, by up to {did['max_coupling_excess_deg']:.2f}°"
    if did["max_speed_ratio"] > SPEED_RATIO:
        yield f"a joint went at {100 * did['max_speed_ratio']:.0f} % of its motor's no-load speed"
    if did["self_collision_frames"]:
        yield f"the robot touched itself in {did['self_collision_frames']} steps"
    elif did["min_self_distance_m"] < NEAREST_M:
        yield f"parts of the robot came within {1000 * did['min_self_distance_m']:.1f} mm of each other"
