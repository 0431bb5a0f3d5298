"""Which pose the arms hold, decided frame by frame for people never seen before.

A pose is where its four segments point; a reading is compared with all poses
at once (`angular.density_ratio`), each segment as far as it is trusted.  What the
rule rests on, none of it fitted to a user:

* Means come from labelled examples, both arms of a symmetric pose pooled by
  mirroring.  Arms whose own numbers contradict each other are left out.
* The spread does not come from how exactly a few people repeated a pose, but
  from geometry: segments of different poses stand 90 degrees apart, so half
  way between them is two standard deviations (`TOLERANCE`).  The examples' own
  spread is added to it.
* `none` is as likely as a pose that is `REACH`, one and a half standard
  deviations, off in every segment: nearer than half way, so that a movement
  from one pose to the next passes through `none`.
* In space a pose with a segment more than 45 degrees off, nearer to where
  another pose has it, is `none`.  A picture distorts the directions of segments
  that leave its plane, so there the mean decides alone.
* A segment may be anything at all with a small probability (`STRAY`), so that
  no single one decides by being absurd.
* An arm out of sight is more likely to hang, hidden by the trunk, than to be
  raised, where nothing hides it (`HIDDEN_HANGING`).
* In a picture a segment that is seen long cannot point at the camera; one that
  is seen short may have other reasons, and tells nothing.
* A pose and its mirror image share one prior, so that a pose of both arms that
  is held askew is not taken for one of a single arm.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from nao_sim import body
from nao_sim.errors import UsageError
from nao_sim.gestures import pose_examples
from nao_sim.gestures.angular import density_ratio
from nao_sim.gestures.directions import ArmReadings, readings_of_features
from nao_sim.gestures.pose_examples import LIKE, TOLERANCE, Pose, hanging, pose_of
from nao_sim.imitation.person import unit
from nao_sim.robot import Array, Mask, read_only

NONE = "none"
REACH = 1.5 * TOLERANCE
STRAY = 0.05
HIDDEN_HANGING = 4.0
_FORESHORTENED = 0.25  # lengths of a segment, standard deviation of the one seen: proportions differ, cameras err
ENOUGH = 1.0  # trusted segments in all, below which nothing is decided


@dataclass(frozen=True)
class Decisions:
    """What was recognised in T frames.

    Attributes:
        labels: (T,) names of poses, or `none`.
        confidence: (T,) probability of that label.
        nearest: (T,) the most likely pose where `none` is no answer.
        probabilities: (T, P + 1) of each pose, and of `none` in the last column.
    """

    labels: tuple[str, ...]
    confidence: Array
    nearest: tuple[str, ...]
    probabilities: Array


@dataclass(frozen=True, eq=False)
class PoseRecogniser:
    """A set of poses and the rule that chooses one of them, or none.

    Attributes:
        names: (P,) of the poses.
        means: (P, 2, 2, 3) unit vectors, x forward, y left, z up: side (left,
            right), segment (upper arm, forearm), coordinate.
        spreads: (P, 2, 2) rad, standard deviation of each segment.
    """

    names: tuple[str, ...]
    means: Array
    spreads: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "means", read_only(unit(np.asarray(self.means, float))))
        object.__setattr__(self, "spreads", read_only(self.spreads))
        poses = len(self.names)
        if self.means.shape != (poses, 2, 2, 3) or self.spreads.shape != (poses, 2, 2):
            raise ValueError(f"{poses} names, means {self.means.shape}, spreads {self.spreads.shape}")
        if not (np.isfinite(self.means).all() and np.isfinite(self.spreads).all() and (self.spreads > 0.0).all()):
            raise ValueError("means or spreads are not finite, or no spread")
        if len(set(self.names)) < poses or NONE in self.names or not poses:
            raise ValueError(f"names {self.names}; expected each once, at least one, and no '{NONE}'")

    @classmethod
    def fit(cls, readings: ArmReadings, labels: Sequence[str], single_arms: bool = True) -> PoseRecogniser:
        """Learn poses from examples.

        Args:
            readings: (T) frames, of any people in any order.
            labels: (T,) the pose of each.
            single_arms: whether to add each symmetric pose with the left and
                with the right arm alone, the other hanging.

        Raises:
            UsageError: a label without a usable example.
        """
        poses = [pose_of(readings, labels, str(name)) for name in sorted(set(labels) - {NONE})]
        if not poses:
            raise UsageError("no labelled example; expected at least one pose")
        return cls._of([*poses, *(pose_examples.single_arms(poses) if single_arms else ())])

    @classmethod
    def of_thesis_rows(cls, features: Array, labels: Sequence[str], single_arms: bool = True) -> PoseRecogniser:
        """Learn from rows of the thesis's ten features (T, 10) rad and their labels."""
        return cls.fit(readings_of_features(features), labels, single_arms)

    def taught(self, name: str, examples: ArmReadings) -> PoseRecogniser:
        """The same with one more pose, or with another meaning of a known one.

        Args:
            name: of the pose; that of a `left_…` or `right_…` pose is taught for the other side, too.
            examples: one or more frames of it, of anybody.

        Raises:
            UsageError: no example shows every segment, or the name means no pose.
        """
        if name == NONE:
            raise UsageError(f"a pose called '{NONE}', which means that there is no pose; expected another name")
        pose = pose_of(examples, [name] * len(examples), name)
        added = [pose] if body.twin(name) == name else [pose, pose.mirrored()]
        new = {each.name for each in added}
        known = [Pose(*each) for each in zip(self.names, self.means, self.spreads, strict=True) if each[0] not in new]
        return self._of([*known, *added])

    def decide(self, readings: ArmReadings) -> Decisions:
        """Decide every frame by itself."""
        probabilities = self.probabilities(readings)
        names = (*self.names, NONE)
        labels = tuple(names[place] for place in probabilities.argmax(axis=1))
        along = self._along(readings.directions, readings.trust, readings.planar)
        shares = self._shares(along, readings.trust, readings.seen, readings.planar)
        nearest = tuple(names[place] for place in shares[:, :-1].argmax(axis=1))
        return Decisions(labels, probabilities.max(axis=1), nearest, probabilities)

    def probabilities(self, readings: ArmReadings) -> Array:
        """(T, P + 1) of each pose, and of `none` in the last column."""
        return self.weigh(readings.directions, readings.trust, readings.seen, readings.planar)

    def weigh(self, directions: Array, trust: Array, seen: Array, planar: bool) -> Array:
        """`probabilities` of the parts of readings."""
        along = self._along(directions, trust, planar)
        shares = self._shares(along, trust, seen, planar)
        shares[:, :-1] *= self._possible(along, trust, planar)
        shares[:, -1] = 1.0 - shares[:, :-1].sum(axis=1)
        return shares

    def _along(self, directions: Array, trust: Array, planar: bool) -> Array:
        """(T, P, 2, 2) products of directions with means over spreads; 0 where not trusted."""
        known = np.where(trust[..., None] > 0.0, directions, 0.0)
        return np.einsum("tabi,pabi->tpab", known, self._scaled[planar][0])

    def _shares(self, along: Array, trust: Array, seen: Array, planar: bool) -> Array:
        """(T, P + 1) probabilities if every pose were possible."""
        scores = self._scores(along, trust, seen, planar)
        weights = np.exp(scores - scores.max(axis=1, keepdims=True))
        shares: Array = weights / weights.sum(axis=1, keepdims=True)
        return shares

    def _possible(self, along: Array, trust: Array, planar: bool) -> Mask:
        """(T, P) whether enough is seen, and in space every trusted segment nearer than half way to other poses."""
        enough = (trust.sum(axis=(1, 2)) >= ENOUGH)[:, None]
        if planar:
            return enough
        near = (along > self._half_way) | (trust[:, None] == 0.0)
        return np.asarray(near.all(axis=(2, 3)) & enough)

    @classmethod
    def _of(cls, poses: Sequence[Pose]) -> PoseRecogniser:
        means, spreads = np.stack([pose.mean for pose in poses]), np.stack([pose.spread for pose in poses])
        return cls(tuple(pose.name for pose in poses), means, spreads)

    def _scores(self, along: Array, trust: Array, seen: Array, planar: bool) -> Array:
        """(T, P + 1) log likelihoods relative to knowing nothing."""
        ratio = density_ratio(along, self._scaled[planar][1], planar)
        if planar:
            ratio = ratio * self._not_too_long(seen)
        evidence = np.log((1.0 - STRAY) * ratio + STRAY) * trust[:, None]
        poses = evidence.sum(axis=(2, 3)) + self._log_prior
        poses += (trust.sum(axis=2) == 0.0) @ self._hanging
        none = trust.sum(axis=(1, 2)) * self._at_reach[planar]
        return np.concatenate([poses, none[:, None]], axis=1)

    @cached_property
    def _log_prior(self) -> Array:
        """(P,) half for each of a pose and its mirror image."""
        twins = [body.twin(name) != name and body.twin(name) in self.names for name in self.names]
        return np.where(twins, np.log(0.5), 0.0)

    @cached_property
    def _scaled(self) -> tuple[tuple[Array, Array], ...]:
        """Means over spreads and their squared lengths, in space and in a picture."""
        whole = self.means / self.spreads[..., None]
        flat = whole * np.array([0.0, 1.0, 1.0])
        return (whole, (whole**2).sum(axis=-1)), (flat, (flat**2).sum(axis=-1))

    @cached_property
    def _half_way(self) -> Array:
        """(P, 2, 2) what `_along` is of directions that are `LIKE` off."""
        return np.cos(LIKE) / self.spreads

    @cached_property
    def _hanging(self) -> Array:
        """(2, P) what an arm out of sight says for the poses in which it hangs."""
        return hanging(self.means).T * np.log(HIDDEN_HANGING)

    @cached_property
    def _at_reach(self) -> tuple[float, float]:
        """What a segment says that is `REACH` off, in space and in a picture."""
        sharp = 1.0 / float(np.median(self.spreads))
        along, square = np.array(np.cos(REACH) * sharp), np.array(sharp**2)
        in_space, in_picture = (float(density_ratio(along, square, planar)) for planar in (False, True))
        return float(np.log((1.0 - STRAY) * in_space + STRAY)), float(np.log((1.0 - STRAY) * in_picture + STRAY))

    def _not_too_long(self, seen: Array) -> Array:
        """(T, P, 2, 2) likelihood of lengths in a picture, 1 where they are not longer than they can be."""
        in_picture = np.linalg.norm(self.means[..., 1:], axis=-1)
        excess = np.maximum(seen[:, None] - in_picture, 0.0) / _FORESHORTENED
        return np.where(in_picture < 1.0 - _FORESHORTENED, np.exp(-0.5 * excess**2), 1.0)

    def tables(self) -> dict[str, Array]:
        """All that makes the recogniser, as arrays to be saved."""
        return {"names": np.array(self.names), "means": self.means, "spreads_rad": self.spreads}

    @classmethod
    def of_tables(cls, tables: Mapping[str, Array]) -> PoseRecogniser:
        """The recogniser of `tables`.

        Raises:
            KeyError: a table is missing.
            ValueError: a table is not as it should be.
        """
        return cls(tuple(str(name) for name in tables["names"]), tables["means"], tables["spreads_rad"])
