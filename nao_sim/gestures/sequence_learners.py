"""Learners of movements, under one name each: what the recogniser of movements is compared with.

All look at a `Window` as one of a person whose right arm does a one-handed
movement, like the recogniser.  The sequences among them read its segments as
18 numbers a frame, hands 0 where they are not tracked.  Settings are usual ones.
"""

from __future__ import annotations

import logging
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any, Protocol, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.linear_model import LogisticRegression
from sklearn.neighbors import KNeighborsClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVC

from nao_sim import body
from nao_sim.errors import UsageError
from nao_sim.gestures.learners import Learner
from nao_sim.gestures.windows import RATE, Window, measures
from nao_sim.robot import Array

FRAMES = 32  # to which a movement is resampled for what needs equal lengths
WARP = 0.2  # Sakoe and Chiba's band: how far times may be warped, in lengths of the movement
STATES = 5  # of a hidden Markov model
_LEAST_VARIANCE = 1e-2  # of a state, 6 degrees of a direction: few frames must not make it sure
_AHEAD = 0.2  # s, which makes speeds about as large as places
_EXTRA = "learn"


class SequenceLearner(Protocol):
    """What learns labels of windows; it must choose among those it has seen."""

    def fit(self, windows: Sequence[Window], labels: Sequence[str]) -> Self:
        """Learn from examples; one of each label may do."""

    def predict(self, windows: Sequence[Window]) -> list[str]:
        """The labels (N,), each one of those that were fitted or its twin of the other side."""


@dataclass
class Classifier:
    """A scikit-learn classifier, or one like it, of what is told of windows.

    Args:
        model: the classifier.
        told: (N, ...) what it is told of N windows.
    """

    model: Any
    told: Callable[[Sequence[Window]], Any]
    _only: str | None = field(default=None, init=False)

    def fit(self, windows: Sequence[Window], labels: Sequence[str]) -> Self:
        """Learn; with a single label there is nothing to tell apart."""
        names = _names(windows, labels)
        self._only = names[0] if len(set(names)) == 1 else None
        if self._only is None:
            self.model.fit(self.told([_righted(window) for window in windows]), np.array(names))
        return self

    def predict(self, windows: Sequence[Window]) -> list[str]:
        """The labels (N,), each one of those that were fitted or its twin of the other side."""
        if not windows:
            return []
        if self._only is not None:
            found: Sequence[str] = [self._only] * len(windows)
        else:
            found = self.model.predict(self.told([_righted(window) for window in windows]))
        return _as_shown(windows, found)


class DynamicTimeWarping:
    """One nearest neighbour by dynamic time warping (H. Sakoe and S. Chiba, 1978), lengths as they are; aeon's."""

    def fit(self, windows: Sequence[Window], labels: Sequence[str]) -> Self:
        """Remember the examples, in an order of their own, so that theirs decides no tie."""
        known = zip(windows, _names(windows, labels), strict=True)
        self._known = sorted(known, key=lambda pair: (pair[1], pair[0].segments.tobytes()))
        return self

    def predict(self, windows: Sequence[Window]) -> list[str]:
        """The labels (N,), each one of those that were fitted or its twin of the other side."""
        if not windows:
            return []
        apart = distances_by_warping(windows, [window for window, _ in self._known])
        return _as_shown(windows, [self._known[place][1] for place in np.argmin(apart, axis=1)])


def distances_by_warping(windows: Sequence[Window], known: Sequence[Window]) -> Array:
    """How far windows (N) are from known ones (K), (N, K), by dynamic time warping within `WARP`.

    Raises:
        UsageError: aeon is not installed.
    """
    pairwise = _needed("aeon.distances", "DTW").dtw_pairwise_distance
    sequences = [[_channels(_righted(window)) for window in each] for each in (windows, known)]
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "unsafe cast")  # numba's, about an index
        apart: Array = pairwise(*sequences, window=WARP)
    return apart


class HiddenMarkovModels:
    """A hidden Markov model with Gaussian states for each label (L. R. Rabiner, 1989); the likeliest wins; hmmlearn's.

    Args:
        seed: of where the states begin.
    """

    def __init__(self, seed: int = 0) -> None:
        self.seed = seed

    def fit(self, windows: Sequence[Window], labels: Sequence[str]) -> Self:
        """Learn one model a label."""
        names = _names(windows, labels)
        shown = [_moving(_righted(window)) for window in windows]
        self._models = {
            name: self._model([each for each, own in zip(shown, names, strict=True) if own == name])
            for name in sorted(set(names))
        }
        return self

    def predict(self, windows: Sequence[Window]) -> list[str]:
        """The labels (N,), each one of those that were fitted or its twin of the other side."""
        found = []
        for window in windows:
            shown = _moving(_righted(window))
            found.append(max(self._models, key=lambda name: self._models[name].score(shown)))
        return _as_shown(windows, found)

    def _model(self, examples: Sequence[Array]) -> Any:
        frames = np.concatenate(sorted(examples, key=lambda each: (len(each), each.tobytes())))
        make = _needed("hmmlearn.hmm", "HMM").GaussianHMM
        states = min(STATES, *map(len, examples))
        model = make(states, min_covar=_LEAST_VARIANCE, covars_prior=_LEAST_VARIANCE, random_state=self.seed, n_iter=10)
        with _quiet("hmmlearn"), np.errstate(invalid="ignore"):  # a state may lose all its frames
            model.fit(frames, sorted(map(len, examples)))
        # Few examples leave states that are never left or never reached; every step stays possible.
        model.transmat_ = _possible(model.transmat_)
        model.startprob_ = _possible(model.startprob_)
        model.means_ = np.where(np.isfinite(model.means_), model.means_, frames.mean(axis=0))
        return model


def _direction_neighbour(_: int) -> SequenceLearner:
    return Classifier(KNeighborsClassifier(1), _even_rows)


def _support_vectors(_: int) -> SequenceLearner:
    return Classifier(make_pipeline(StandardScaler(), SVC(C=10.0)), _measured)


def _logistic(_: int) -> SequenceLearner:
    return Classifier(make_pipeline(StandardScaler(), LogisticRegression(max_iter=1000)), _measured)


def _mini_rocket(seed: int) -> SequenceLearner:
    make = _needed("aeon.classification.convolution_based", "MiniRocket").MiniRocketClassifier
    return Classifier(make(random_state=seed), _even)


def _dynamic_time_warping(_: int) -> SequenceLearner:
    _needed("aeon.distances", "DTW")
    return DynamicTimeWarping()


def _hidden_markov(seed: int) -> SequenceLearner:
    _needed("hmmlearn.hmm", "HMM")
    return HiddenMarkovModels(seed)


SEQUENCE_LEARNERS: Mapping[str, Learner] = {
    "nearest neighbour": Learner(f"of segments resampled to {FRAMES} frames", _direction_neighbour),
    "DTW": Learner("nearest neighbour by dynamic time warping", _dynamic_time_warping),
    "HMM": Learner(f"a hidden Markov model of {STATES} states each", _hidden_markov, random=True),
    "MiniRocket": Learner("random convolutions and ridge", _mini_rocket, random=True),
    "SVM": Learner("radial basis functions, of the measures", _support_vectors),
    "logistic": Learner("regularised, of the measures", _logistic),
}


def _names(windows: Sequence[Window], labels: Sequence[str]) -> list[str]:
    """Labels as those of windows whose right arm does it.

    Raises:
        UsageError: there is no example, or not a label for each.
    """
    if not len(windows) or len(windows) != len(labels):
        raise UsageError(f"{len(windows)} windows with {len(labels)} labels; expected one or more, and one label each")
    return _as_shown(windows, labels)


def _as_shown(windows: Sequence[Window], labels: Sequence[str]) -> list[str]:
    """Labels of windows, those of left arms mirrored."""
    pairs = zip(windows, map(str, labels), strict=True)
    return [body.twin(label) if window.left_handed else label for window, label in pairs]


def _righted(window: Window) -> Window:
    return window.mirrored() if window.left_handed else window


def _channels(window: Window) -> Array:
    """(18, T) the numbers of a frame, contiguous."""
    return np.ascontiguousarray(window.segments.reshape(len(window), -1).T)


def _moving(window: Window) -> Array:
    """(T, 36) the numbers of a frame, and how far they go in `_AHEAD` at the speed they have."""
    tracks = _channels(window)
    return np.concatenate([tracks, np.gradient(tracks, axis=1) * RATE * _AHEAD]).T


def _even(windows: Sequence[Window]) -> Array:
    """(N, 18, `FRAMES`), resampled evenly."""
    return np.stack([_resampled(_channels(window)) for window in windows])


def _resampled(tracks: Array) -> Array:
    at = np.linspace(0.0, tracks.shape[1] - 1.0, FRAMES)
    return np.stack([np.interp(at, np.arange(tracks.shape[1]), track) for track in tracks])


def _even_rows(windows: Sequence[Window]) -> Array:
    return _even(windows).reshape(len(windows), -1)


def _measured(windows: Sequence[Window]) -> Array:
    return np.stack([measures(window) for window in windows])


def _possible(shares: NDArray[np.float64]) -> Array:
    raised = np.nan_to_num(shares) + 1e-6
    return raised / raised.sum(axis=-1, keepdims=True)


def _needed(module: str, learner: str) -> Any:
    """A module of the extra.

    Raises:
        UsageError: it is not installed.
    """
    try:
        return import_module(module)
    except ImportError:
        package = module.split(".", maxsplit=1)[0]
        raise UsageError(
            f"learner '{learner}' needs {package}; install it with: pip install 'nao-sim[{_EXTRA}]'"
        ) from None


@contextmanager
def _quiet(logger: str) -> Iterator[None]:
    """Less of a library's warnings: it tells each model that has converged to the last digit."""
    log = logging.getLogger(logger)
    level = log.level
    log.setLevel(logging.ERROR)
    try:
        yield
    finally:
        log.setLevel(level)
