"""Whether a gesture is a pose that is held or a movement, decided from its examples.

A gesture is a pose where `MOST` of its examples show one, as
`nao_sim.gestures.examples` tells; a picture and a row of a table always do.
It takes more than half of them, as a movement that is taken for a pose cannot be
recognised at all, while a pose that is taken for a movement can.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from nao_sim import body
from nao_sim.errors import UsageError
from nao_sim.gestures.evaluation.data_set import SHORTEST, DataSet, Example

Kind = Literal["poses", "movements"]
KINDS: tuple[Kind, ...] = ("poses", "movements")
MOST = 0.75


@dataclass(frozen=True)
class Kinds:
    """What the gestures of a data set are.

    Attributes:
        of: by label.
        reasons: why, for each label.
    """

    of: dict[str, Kind]
    reasons: tuple[str, ...]

    @property
    def present(self) -> tuple[Kind, ...]:
        """Those that there are."""
        return tuple(kind for kind in KINDS if kind in self.of.values())

    def has(self, kind: Kind, example: Example) -> bool:
        """Whether an example is one of a kind; negative ones are of both, where they last long enough."""
        if example.known:
            return self.of.get(example.label) == kind
        return kind == "poses" or example.moves

    def joined(self, other: Kinds) -> Kinds:
        """With the labels of others that these do not have."""
        new = [place for place, label in enumerate(other.of) if label not in self.of]
        labels = list(other.of)
        added = {labels[place]: other.of[labels[place]] for place in new}
        return Kinds(self.of | added, (*self.reasons, *(other.reasons[place] for place in new)))


def kinds_of(data: DataSet, wanted: Kind | None = None, known: Kinds | None = None) -> Kinds:
    """What the gestures of a data set are; those of the left and of the right side are of one kind.

    Args:
        data: the examples.
        wanted: what all of them are taken for; decided by the data where None.
        known: what labels are that are known already.

    Raises:
        UsageError: there is no gesture in it.
        RecordingError: an example of a movement is too short for one.
    """
    if not data.labels:
        raise UsageError(f"{data.manifest.path}: only negative examples; expected some gesture")
    found: dict[str, Kind] = {}
    reasons = []
    for label in data.labels:
        held = [each.held for each in data.examples if each.label in (label, body.twin(label))]
        measured: Kind = "poses" if sum(held) >= MOST * len(held) else "movements"
        found[label] = known.of[label] if known and label in known.of else wanted or measured
        still = f"arms keep still in {sum(held)} of {len(held)} example{'s' * (len(held) > 1)}"
        reasons.append(f"--kind {wanted}; {still}" if wanted else still)
    _check_movements(data, found)
    return Kinds(found, tuple(reasons))


def of_kind(kinds: Kinds, kind: Kind, examples: Sequence[Example]) -> list[Example]:
    """The examples of a kind."""
    return [each for each in examples if kinds.has(kind, each)]


def _check_movements(data: DataSet, found: dict[str, Kind]) -> None:
    """Refuse examples that are too short for the movements that they show."""
    for each in data.examples:
        if found.get(each.label) == "movements" and not each.moves:
            what = "is a posture without motion" if each.person is None else f"lasts {each.lasts:.2f} s"
            row = next(row for row in data.manifest.rows if row.line == each.line)
            said = f"{each.place}, '{each.label}', {what}"
            raise data.manifest.error(row, said, f"a movement of at least {SHORTEST:.2f} s, or --kind poses")
