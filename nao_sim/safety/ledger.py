"""The book of what the guard changed: which joint, why, when and by how much."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from nao_sim.robot import Array
from nao_sim.safety.change import Change, Intervention

Indices = NDArray[np.int_]
Pair = tuple[str, ...]
COLUMNS = ("step", "joint", "size", "reason", "pair")
_CHUNK = 8192  # changes that are looked at together, which keeps an hour's book small while it is written
_NOBODY = -1  # index of no pair


@dataclass(frozen=True, eq=False)
class Ledger:
    """Changes of a run, a row for each control step, change and joint, in the order of steps.

    `only` takes out the rows of a rule, a joint, a pair of links or a time; what it gives can be asked the same.

    Attributes:
        run: control steps of the whole run.
        step: (N,) control step, from 0.
        joint: (N,) index of the joint.
        size: (N,) how far it was moved, rad (hands 0..1).
        reason_names: the reasons that `reason` counts in.
        reason: (N,) index of the reason.
        pair_names: the pairs of links that `pair` counts in, each in alphabetical order.
        pair: (N,) index of the pair that would have met, -1 for none.
    """

    run: int
    step: Indices
    joint: Indices
    size: Array
    reason_names: tuple[str, ...]
    reason: Indices
    pair_names: tuple[Pair, ...]
    pair: Indices

    def only(
        self,
        *,
        reason: str | None = None,
        joint: int | None = None,
        pair: Pair | None = None,
        between: tuple[int, int] | None = None,
    ) -> Ledger:
        """The rows of a reason, of a joint, of a pair of links, from a first to a last control step."""
        part = self.where(slice(*np.searchsorted(self.step, [between[0], between[1] + 1]))) if between else self
        if reason is not None:
            part = part.where(part.reason == _index(part.reason_names, reason))
        if joint is not None:
            part = part.where(part.joint == joint)
        if pair is not None:
            part = part.where(part.pair == _index(part.pair_names, tuple(sorted(pair))))
        return part

    def where(self, rows: NDArray[np.bool_] | slice) -> Ledger:
        """The rows (N,) that are chosen."""
        return replace(self, **{name: getattr(self, name)[rows] for name in COLUMNS})

    def __len__(self) -> int:
        return len(self.step)

    @cached_property
    def steps(self) -> Indices:
        """The control steps (M,) in which something was changed."""
        return self.step[np.diff(self.step, prepend=-1) > 0]

    @property
    def share(self) -> float:
        """Their share of the run."""
        return len(self.steps) / self.run if self.run else 0.0

    @property
    def spells(self) -> Indices:
        """First and last control step (K, 2) of each uninterrupted spell."""
        breaks = np.diff(self.steps) > 1
        firsts, lasts = np.append(True, breaks), np.append(breaks, True)
        return np.stack([self.steps[firsts], self.steps[lasts]], axis=1) if len(self) else np.empty((0, 2), np.int_)

    @property
    def reasons(self) -> list[str]:
        """The reasons, in alphabetical order."""
        return sorted(self.reason_names[i] for i in np.flatnonzero(np.bincount(self.reason)))

    @property
    def joints(self) -> list[int]:
        """The joints that were changed."""
        return [int(joint) for joint in np.flatnonzero(np.bincount(self.joint))]

    @property
    def pairs(self) -> list[Pair]:
        """The pairs of links that would have met, in alphabetical order."""
        return sorted(self.pair_names[i] for i in np.flatnonzero(np.bincount(self.pair[self.pair != _NOBODY])))

    @property
    def largest(self) -> float:
        """The largest change, rad (hands 0..1); 0 where nothing was changed."""
        return float(self.size.max(initial=0.0))

    @property
    def mean(self) -> float:
        """The mean, over changed joints in changed steps, of the largest change there; 0 where there is none."""
        if not len(self):
            return 0.0
        cell = self.step * (self.joint.max() + 1) + self.joint
        order = np.argsort(cell, kind="stable")
        first = np.flatnonzero(np.diff(cell[order], prepend=-1))
        return float(np.maximum.reduceat(self.size[order], first).mean())


def ledger(interventions: Sequence[Intervention]) -> Ledger:
    """The book of a run's interventions, one for each control step."""
    reasons: dict[str, int] = {}
    pairs: dict[Pair, int] = {}
    changes = ((step, change) for step, intervention in enumerate(interventions) for change in intervention)
    written = [np.empty((len(COLUMNS), 0))]
    while chunk := list(islice(changes, _CHUNK)):
        written.append(_rows(chunk, reasons, pairs))
    step, joint, size, reason, pair = np.concatenate(written, axis=1)
    step, joint, reason, pair = (column.astype(np.int_) for column in (step, joint, reason, pair))
    return Ledger(len(interventions), step, joint, size, tuple(reasons), reason, tuple(pairs), pair)


def _rows(chunk: list[tuple[int, Change]], reasons: dict[str, int], pairs: dict[Pair, int]) -> Array:
    """`COLUMNS` (5, N); new names are added to those known."""
    sizes = np.array([change.size for _, change in chunk])
    row, joint = np.nonzero(sizes)
    step = np.array([step for step, _ in chunk])
    reason = np.array([reasons.setdefault(change.reason, len(reasons)) for _, change in chunk])
    pair = np.array([_pair(change, pairs) for _, change in chunk])
    return np.stack([step[row], joint, sizes[row, joint], reason[row], pair[row]])


def _pair(change: Change, pairs: dict[Pair, int]) -> int:
    return pairs.setdefault(tuple(sorted(change.links)), len(pairs)) if change.links else _NOBODY


def _index(names: tuple[object, ...], name: object) -> int:
    """Where a name is; an index that no row has where it is not."""
    return names.index(name) if name in names else len(names)
