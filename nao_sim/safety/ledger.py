"""The book of what the guard changed: which joint, why, when and by how much."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from nao_sim.safety.guard import Intervention


@dataclass
class Entry:
    """What one rule did to one joint over a run.

    Attributes:
        joint: index of the joint.
        reason: the rule.
        steps: control steps in which it was changed.
        largest: largest change, rad (hands 0..1).
        spells: first and last control step of each uninterrupted spell.
        pairs: pairs of links that would have met.
    """

    joint: int
    reason: str
    steps: int = 0
    largest: float = 0.0
    spells: list[tuple[int, int]] = field(default_factory=list)
    pairs: set[tuple[str, ...]] = field(default_factory=set)

    def add(self, step: int, size: float, links: tuple[str, ...]) -> None:
        """Note a change of `size` in control step `step`."""
        if links:
            self.pairs.add(tuple(sorted(links)))
        self.largest = max(self.largest, size)
        if self.spells and self.spells[-1][1] == step:
            return  # two pairs of links in one step
        self.steps += 1
        if self.spells and self.spells[-1][1] == step - 1:
            self.spells[-1] = (self.spells[-1][0], step)
        else:
            self.spells.append((step, step))


def ledger(interventions: Iterable[Intervention]) -> list[Entry]:
    """Entries of a run's interventions, one for each control step, in the order of joints and reasons."""
    entries: dict[tuple[int, str], Entry] = {}
    for step, intervention in enumerate(interventions):
        for change in intervention:
            for joint in np.flatnonzero(change.size):
                entry = entries.setdefault((int(joint), change.reason), Entry(int(joint), change.reason))
                entry.add(step, float(change.size[joint]), change.links)
    return [entries[key] for key in sorted(entries)]
