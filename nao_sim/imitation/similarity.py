"""The imitation score: how alike the robot's motion and the person's are, stage by stage, and what NAO allows.

Person and robot are compared at the robot's times (a rollout's control steps)
between the recording's first and last frame; the approach before and the rest
after do not count.  What is not known on either side is left out.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from nao_sim.imitation.arms import arm_directions_of, direction_error
from nao_sim.imitation.feasible import feasible_positions
from nao_sim.imitation.person import arm_directions
from nao_sim.imitation.similarity_body import ARM_LINKS, LINKS, BodyDirections, person_body, robot_body
from nao_sim.imitation.similarity_measures import (
    STEP,
    delay,
    direction_errors,
    hand_errors,
    local_link_focused,
    whole_body_focused,
)
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.robot import Array, Robot, load_robot

STAGES = {"requested": "requested", "commanded": "command", "simulated": "joint_positions"}  # and a rollout's array
ASKED = "requested"  # the one stage of a joint-angle recording
_SIDES = ("left", "right")
SPARSE = 0.04  # s; frames further apart are compared in between as well
_ROUNDING = 1e-6  # s


class Run(Protocol):
    """What of a rollout is looked at; see `nao_sim.simulation.rollout.Rollout`."""

    @property
    def time(self) -> Array:
        """(T,) s."""

    @property
    def base_pose(self) -> Array:
        """(T, 7) of the torso."""

    @property
    def motion_start(self) -> float:
        """When the recording's first frame was asked for, s."""

    @property
    def speed(self) -> float:
        """Times as fast as recorded."""


@dataclass(frozen=True, eq=False)
class StageScore:
    """How alike the person and one stage of the robot's motion are, T times.

    Attributes:
        direction_errors: (T, 2, 2) rad, angles between the arms: side, segment.
        excess: (T, 2) rad, mean angle of an arm's two segments beyond that of NAO's nearest pose.
        hand_errors: (T, 2) arm lengths.
        wbf: (T, 10) cosines between `LINKS`, whole-body-focused.
        llf: (T, 10) cosines between `LINKS`, local-link-focused.
        lag: s; None where nothing moves or no delay fits.
    """

    direction_errors: Array
    excess: Array
    hand_errors: Array
    wbf: Array
    llf: Array
    lag: float | None

    def as_report(self) -> dict[str, Any]:
        """As the JSON has it; see docs/report.md."""
        return {
            "direction_error_deg": _by_segment(self.direction_errors),
            "excess_deg": _spread(np.degrees(self.excess)),
            "hand_error_arm_lengths": _by_side(self.hand_errors),
            "wbf": _links(self.wbf),
            "llf": _links(self.llf),
            "lag_ms": None if self.lag is None else _rounded(1000.0 * self.lag, 1),
        }


@dataclass(frozen=True, eq=False)
class Similarity:
    """The score of one motion, T times compared.

    Attributes:
        times: (T,) s, the robot's.
        coverage: (2,) share of the recording's frames in which the left and the right arm are measured whole.
        limits: (T, 2, 2) rad, angles between the person's arms and those of NAO's nearest pose.
        stages: scores by stage: `requested`, `commanded` and `simulated` for a rollout.
    """

    times: Array
    coverage: Array
    limits: Array
    stages: Mapping[str, StageScore]

    def as_report(self) -> dict[str, Any]:
        """As the JSON has it; see docs/report.md."""
        return {
            "compared": int(np.any(np.isfinite(self.limits).all(axis=2), axis=1).sum()),
            "coverage": {side: _rounded(share) for side, share in zip(_SIDES, self.coverage, strict=True)},
            "limits_deg": _by_segment(self.limits),
            "stages": {name: score.as_report() for name, score in self.stages.items()},
        }


def similarity(
    human: Skeleton | JointTrajectory, motion: Run | JointTrajectory, robot: Robot | None = None
) -> Similarity:
    """How well a robot imitates.

    Args:
        human: the recording; of a joint-angle recording its own angles are what to imitate.
        motion: a rollout, whose clock says when the recording's frames were
            asked for; or a joint-angle recording that begins with the human's.
        robot: whose limits count; NAO v5 where None.
    """
    if isinstance(motion, JointTrajectory):
        start, speed, times = float(motion.times[0]), 1.0, _moments(motion.times)
        bodies = {ASKED: robot_body(times, motion.sample(times))}
    else:
        start, speed, times = motion.motion_start, motion.speed, motion.time
        bodies = {stage: robot_body(times, getattr(motion, array), motion.base_pose) for stage, array in STAGES.items()}
    person = _imitated(human, start, speed, times)
    times = times[(times > person.times[0] - _ROUNDING) & (times < person.times[-1] + _ROUNDING)]
    seen = person.at(times)
    limits = direction_error(feasible_positions(seen.arms, robot or load_robot()), seen.arms)
    stages = {stage: _score(seen, body.at(times), limits, delay(person, body)) for stage, body in bodies.items()}
    return Similarity(times, _coverage(human), limits, stages)


def _moments(times: Array) -> Array:
    """A recording's times, and every control step between frames that are far apart: joints move on between them."""
    steps = np.arange(times[0], times[-1], STEP)
    after = np.minimum(np.searchsorted(times, steps, side="right"), len(times) - 1)
    sparse = times[after] - times[after - 1] > SPARSE
    return np.union1d(times, steps[sparse])


def _imitated(human: Skeleton | JointTrajectory, start: float, speed: float, times: Array) -> BodyDirections:
    """Who is imitated, by the robot's clock; joints, which move on between frames, at the robot's `times` as well."""
    clock = start + (human.times - human.times[0]) / speed
    if isinstance(human, Skeleton):
        return replace(person_body(human), times=clock)
    moments = np.union1d(clock, times[(times > clock[0]) & (times < clock[-1])])
    return robot_body(moments, JointTrajectory(clock, human.positions).sample(moments))


def _coverage(human: Skeleton | JointTrajectory) -> Array:
    """Share (2,) of frames in which an arm is known whole."""
    directions = arm_directions(human) if isinstance(human, Skeleton) else arm_directions_of(human.positions)
    share: Array = np.isfinite(directions).all(axis=(2, 3)).mean(axis=0)
    return share


def _score(person: BodyDirections, robot: BodyDirections, limits: Array, lag: float | None) -> StageScore:
    errors = direction_errors(person, robot)
    return StageScore(
        direction_errors=errors,
        excess=(errors - limits).mean(axis=2),
        hand_errors=hand_errors(person, robot),
        wbf=whole_body_focused(person, robot),
        llf=local_link_focused(person, robot),
        lag=lag,
    )


def _by_segment(errors: Array) -> dict[str, Any]:
    """Angles (T, 2, 2) rad by segment and all together, in degrees."""
    degrees = np.degrees(errors).reshape(-1, len(ARM_LINKS))
    return {link: _spread(degrees[:, i]) for i, link in enumerate(ARM_LINKS)} | {"all": _spread(degrees)}


def _by_side(errors: Array) -> dict[str, Any]:
    return {side: _spread(errors[:, i]) for i, side in enumerate(_SIDES)} | {"all": _spread(errors)}


def _spread(values: Array) -> dict[str, float | None]:
    """Mean, median and 95th percentile of what is known."""
    known = values[np.isfinite(values)]
    if not len(known):
        return {"mean": None, "median": None, "p95": None}
    mean, (median, high) = known.mean(), np.percentile(known, (50, 95))
    return {"mean": _rounded(mean), "median": _rounded(median), "p95": _rounded(high)}


def _links(cosines: Array) -> dict[str, Any]:
    """The mean over times of the mean over known links (T, 10), and each link's own mean."""
    known = np.isfinite(cosines)
    total, count = np.where(known, cosines, 0.0), known.sum(axis=1)
    each = total[count > 0].sum(axis=1) / count[count > 0]
    links = {link: _rounded(total[:, i].sum() / known[:, i].sum()) for i, link in enumerate(LINKS) if known[:, i].any()}
    return {"mean": _rounded(each.mean()) if len(each) else None, "links": links}


def _rounded(value: float | np.floating, digits: int = 4) -> float | None:
    return round(float(value), digits) + 0.0 if np.isfinite(value) else None
