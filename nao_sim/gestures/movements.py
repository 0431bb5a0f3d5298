"""Which movement a window shows: signs, decided over a second or two, for signers never seen before.

Kernel ridge regression of a score for each movement (1 for its examples, 0 for
others' and far from all) on the windows' `measures`, with a Gaussian kernel:

    s(x) = sum_i a_i exp(-|z(x) - z_i|^2 / D),   a = (K + L I)^-1 Y

over standardised measures z (D of them).  Ridge and width are usual values, not
searched ones.  It is closed form: the same examples in any order give the same
recogniser, and how it does on people left out is known without training again.

* A movement of one arm is looked at as one of the right arm, whichever did it;
  movements of both arms are learned in the mirror, too.
* Each example is learned as if its person stood turned and leaning, too
  (`_TURNS`), as far as sensors err about that, and as a bad sensor would see it
  (`SHAKEN`): what noise changes much, weighs less for it.
* Few examples of a movement are near to few strangers' ways of it, so scores of
  a movement of n examples are raised by 1 + 1 / n.
* `none` where the best score is low: all scores fall to 0 far from every example.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.spatial.transform import Rotation
from scipy.special import expit

from nao_sim import body
from nao_sim.errors import UsageError
from nao_sim.gestures.poses import NONE
from nao_sim.gestures.windows import HAND_MEASURES, Window, measures
from nao_sim.robot import Array, read_only

RIDGE = 0.1
REJECT = 0.5  # a best score not above is none; an example's own is about 0.9, and half way between two movements 0.5
_TURNS = Rotation.from_euler("zy", [[0.0, 0.0], [0.26, 0.1], [-0.26, 0.1], [0.26, -0.1], [-0.26, -0.1]]).as_matrix()
SHAKEN = (0.04,)  # m, how far joints wander as a bad sensor sees them
_COPIES = len(_TURNS) + len(SHAKEN)
_USUAL, _CERTAIN = 0.3, 20.0  # spread of a measure that is expected before, and the examples it is worth
_SHARP = 14.0  # what scores are multiplied with to become logarithms of shares
_STEEP = 8.0  # the same of how far the best one is above `REJECT`


@dataclass(frozen=True)
class MovementDecision:
    """What a window shows.

    Attributes:
        label: a movement, or `none`.
        confidence: its probability.
        nearest: the most likely movement where `none` is no answer.
        scores: by movement, about 1 where it is that and 0 where not.
    """

    label: str
    confidence: float
    nearest: str
    scores: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class MovementRecogniser:
    """Examples of movements and the rule that compares a window with them.

    Attributes:
        names: (C,) of the movements, and of those of `left_…` and `right_…`
            for the other side, too; they need no examples.
        examples: (N, D) measures.
        classes: (N,) which of the names each is.
        hands: (N,) whether hands are tracked in it.
    """

    names: tuple[str, ...]
    examples: Array
    classes: Array
    hands: Array

    def __post_init__(self) -> None:
        for name, kind in (("examples", float), ("classes", int), ("hands", bool)):
            object.__setattr__(self, name, read_only(getattr(self, name), kind))
        count = len(self.examples)
        if self.examples.ndim != 2 or self.classes.shape != (count,) or self.hands.shape != (count,):  # noqa: PLR2004
            raise ValueError(f"examples {self.examples.shape}, classes {self.classes.shape}, hands {self.hands.shape}")
        if not count or not np.isfinite(self.examples).all() or len(set(self.names)) < len(self.names):
            raise ValueError("no examples, measures that are not finite, or a name twice")
        if not {body.twin(name) for name in self.names} <= set(self.names):
            raise ValueError(f"names {self.names}; expected those of the other side, too")
        if NONE in self.names or not np.isin(self.classes, np.arange(len(self.names))).all():
            raise ValueError(f"a movement called '{NONE}', or examples of movements without a name")

    @classmethod
    def fit(cls, windows: Sequence[Window], labels: Sequence[str]) -> MovementRecogniser:
        """Learn movements from examples, of any people in any order; one of each may do.

        Raises:
            UsageError: there is no example, or a movement is called `none`.
        """
        if not len(windows) or NONE in labels:
            raise UsageError(f"{len(windows)} examples, {sorted(set(labels))}; expected some, and none called '{NONE}'")
        found = [copy for window, label in zip(windows, labels, strict=True) for copy in _copies(window, str(label))]
        names = tuple(sorted({name for _, label, _ in found for name in (label, body.twin(label))}))
        classes = np.array([names.index(label) for _, label, _ in found])
        return cls(names, np.stack([each for each, _, _ in found]), classes, np.array([each for _, _, each in found]))

    def taught(self, name: str, windows: Sequence[Window]) -> MovementRecogniser:
        """The same with one more movement, or with more examples of a known one, of which one to five do.

        Raises:
            UsageError: there is no example, or the movement is called `none`.
        """
        new = MovementRecogniser.fit(windows, [name] * len(windows))
        names = tuple(sorted({*self.names, *new.names}))
        place = np.array([names.index(each) for each in (*self.names, *new.names)])
        classes = np.concatenate([place[self.classes], place[new.classes + len(self.names)]])
        examples, hands = np.concatenate([self.examples, new.examples]), np.concatenate([self.hands, new.hands])
        return MovementRecogniser(names, examples, classes, hands)

    def decide(self, window: Window) -> MovementDecision:
        """What the window shows."""
        scores = self._scores(window)
        best = int(scores.argmax())
        known = float(expit(_STEEP * (scores[best] - REJECT)))
        shares = np.exp(_SHARP * (scores - scores[best]))
        label = self.names[best] if scores[best] > REJECT else NONE
        confidence = 1.0 - known if label == NONE else known / float(shares.sum())
        told = dict(zip(self.names, scores.tolist(), strict=True))
        return MovementDecision(label, confidence, self.names[best], told)

    def _scores(self, window: Window) -> Array:
        """(C,) scores; those of a window in the mirror are those of the mirrored movements."""
        machine = self._machine(window.hands)
        if window.left_handed:
            return machine.scores(measures(window.mirrored()))[self._twins]
        scores = machine.scores(measures(window))
        if window.two_handed:
            scores = (scores + machine.scores(measures(window.mirrored()))[self._twins]) / 2.0
        return scores

    @cached_property
    def _twins(self) -> Array:
        """(C,) where the mirrored movement of each stands among the names."""
        return np.array([self.names.index(body.twin(name)) for name in self.names])

    def tables(self) -> dict[str, Array]:
        """All that makes the recogniser, as arrays to be saved."""
        return {
            "names": np.array(self.names), "examples": self.examples, "classes": self.classes, "hands": self.hands
        }  # fmt: skip

    @classmethod
    def of_tables(cls, tables: Mapping[str, Array]) -> MovementRecogniser:
        """The recogniser of `tables`.

        Raises:
            KeyError: a table is missing.
            ValueError: a table is not as it should be.
        """
        names = tuple(str(name) for name in tables["names"])
        return cls(names, tables["examples"], tables["classes"], tables["hands"])

    def _machine(self, hands: bool) -> _Ridge:
        return self._with_hands if hands and self.hands.any() else self._without_hands

    @cached_property
    def _with_hands(self) -> _Ridge:
        return _Ridge(self.examples[self.hands], self.classes[self.hands], len(self.names))

    @cached_property
    def _without_hands(self) -> _Ridge:
        return _Ridge(self.examples[:, :-HAND_MEASURES], self.classes, len(self.names))


class _Ridge:
    """The regression of scores on measures (N, D) of examples of classes (N,)."""

    def __init__(self, examples: Array, classes: Array, count: int) -> None:
        self._mean = examples.mean(axis=0)
        variance = ((examples - self._mean) ** 2).sum(axis=0) + _CERTAIN * _USUAL**2
        self._spread = np.sqrt(variance / (len(examples) + _CERTAIN))
        self._known = (examples - self._mean) / self._spread
        self._squares = (self._known**2).sum(axis=1)
        kernel = np.exp(-self._apart(self._known))
        kernel[np.diag_indices_from(kernel)] += RIDGE
        wanted = (classes[:, None] == np.arange(count)).astype(float)
        shown = np.maximum(wanted.sum(axis=0) / _COPIES, 1.0)
        self._weights = cho_solve(cho_factor(kernel, lower=True), wanted) * (1.0 + 1.0 / shown)

    def scores(self, measured: Array) -> Array:
        """(C,) of the measures (D,) of a window; more than `D` are those of hands, and left out."""
        standard = (measured[: len(self._mean)] - self._mean) / self._spread
        scores: Array = (np.exp(-self._apart(standard[None])) @ self._weights)[0]
        return scores

    def _apart(self, standard: Array) -> Array:
        """(M, N) mean squares of the differences to the examples."""
        squares = (standard**2).sum(axis=1)[:, None] + self._squares - 2.0 * standard @ self._known.T
        return np.maximum(squares, 0.0) / standard.shape[1]


def _copies(window: Window, label: str) -> list[tuple[Array, str, bool]]:
    """The measures, labels and hands of an example as it is learned."""
    seen = [(window.mirrored(), body.twin(label))] if window.left_handed else [(window, label)]
    if window.two_handed:
        seen.append((window.mirrored(), body.twin(label)))
    found = []
    for each, name in seen:
        shown = [*(each.turned(turn) for turn in _TURNS), *(each.shaken(noise) for noise in SHAKEN)]
        found += [(measures(copy), name, copy.hands) for copy in shown]
    return found
