"""Measure the filters on real recordings made worse, and note the tables in RESULTS.md.

    python benchmarks/filters.py RECORDINGS

To each recording are added, with fixed seeds, 1 cm rms of white noise a
coordinate; and in the second half of the table 3 % dropouts of one to six
frames and 1 % outliers of 15 to 60 cm besides.  Jitter is the rms of what a
zero-lag smoothing at 6 Hz takes away, as a share of the worsened recording's;
error is the rms distance to the recording as it was (its own noise counts as
motion); lag is where the cross-correlation with it is greatest.  Shoulders,
elbows, wrists.  Mocap is thinned out to 30 Hz.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from benchmark import Rows, machine, note

from nao_sim.errors import NaoSimError
from nao_sim.imitation.filters import Fill, Filter, Kalman, Smooth, clean
from nao_sim.motion import Skeleton
from nao_sim.recordings import load

SETS = {
    "optical mocap": ("cmu_mocap6/amc/*.amc*", 30.0),
    "Kinect v2": ("labanotation_kinect/samples/Ges*.csv", None),
    "Kinect v1": ("isl_kinect_signs/samples/*.txt", None),
}
JOINTS = tuple(f"{side}_{name}" for side in ("left", "right") for name in ("shoulder", "elbow", "wrist"))
NOISE, DROPOUTS, OUTLIERS = 0.01, 0.03, 0.01  # m, shares of points
LONGEST_DROPOUT, FARTHEST = 6, (0.15, 0.6)  # frames, m
LAGS = np.arange(-0.1, 0.3, 0.002)  # s


@dataclass(frozen=True)
class OneEuro:
    """The 1 Euro filter (Casiez, Roussel and Vogel, CHI 2012), to compare with; what is missing stays where it was.

    Attributes:
        min_cutoff: Hz, at rest.
        beta: Hz for each m/s.
        d_cutoff: Hz, of the speed.
    """

    min_cutoff: float = 1.5
    beta: float = 4.0
    d_cutoff: float = 1.0

    def filter(self, skeleton: Skeleton) -> Skeleton:
        """The whole recording, frame after frame."""
        result = np.array(skeleton.positions)
        speed = np.zeros(result.shape[1:])
        last = result[0]
        for frame in range(1, len(skeleton)):
            step = skeleton.times[frame] - skeleton.times[frame - 1]
            seen = np.where(np.isfinite(result[frame]), result[frame], last)
            speed += _share(self.d_cutoff, step) * (np.nan_to_num((seen - last) / step) - speed)
            cutoff = self.min_cutoff + self.beta * np.linalg.norm(speed, axis=1, keepdims=True)
            before = np.where(np.isfinite(result[frame - 1]), result[frame - 1], seen)
            result[frame] = before + _share(cutoff, step) * (seen - before)
            last = seen
        return replace(skeleton, positions=result)


def _share(cutoff: float | np.ndarray, step: float) -> float | np.ndarray:
    turn = 2.0 * math.pi * cutoff * step
    return turn / (1.0 + turn)


class Butterworth:
    """What biomechanics uses: gaps filled, then a second-order filter at 6 Hz run both ways."""

    def filter(self, skeleton: Skeleton) -> Skeleton:
        """The whole recording, taken for evenly sampled."""
        from scipy.signal import butter, sosfiltfilt

        full = Fill().filter(skeleton)
        sections = butter(2, 6.0, output="sos", fs=1.0 / np.median(np.diff(full.times)))
        return replace(full, positions=_each_track(full, lambda track: sosfiltfilt(sections, track, axis=0)))


def _each_track(skeleton: Skeleton, smooth: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    result = np.array(skeleton.positions)
    for joint in range(result.shape[1]):
        known = np.isfinite(result[:, joint]).all(axis=1)
        if known.sum() > 20:
            result[known, joint] = smooth(result[known, joint])
    return result


class Cleaned:
    """What `play` does with a file."""

    def filter(self, skeleton: Skeleton) -> Skeleton:
        """The whole recording."""
        return clean(skeleton)[0]


class Raw:
    """Nothing."""

    def filter(self, skeleton: Skeleton) -> Skeleton:
        """The recording itself."""
        return skeleton


FILTERS: dict[str, Filter] = {
    "none": Raw(),
    "1 Euro (causal)": OneEuro(),
    "Kalman (causal)": Kalman(),
    "fill, Butterworth (zero lag)": Butterworth(),
    "clean (zero lag)": Cleaned(),
}


def recordings(folder: Path, pattern: str, rate: float | None) -> Iterator[Skeleton]:
    """The set's skeletons, of the joints of the arms alone."""
    for path in sorted(folder.glob(pattern)):
        try:
            motion = load(path).motion
        except NaoSimError as error:
            print(f"left out: {error}")
            continue
        assert isinstance(motion, Skeleton)
        step = 1 if rate is None else max(1, round(1.0 / (rate * float(np.median(np.diff(motion.times))))))
        positions = np.stack([motion.track(name) for name in JOINTS], axis=1)[::step]
        yield Skeleton(motion.times[::step], positions, JOINTS)


def worsened(skeleton: Skeleton, seed: int, gaps: bool) -> Skeleton:
    """The recording with noise, and with dropouts and outliers if asked."""
    random = np.random.default_rng(seed)
    shape = skeleton.confidence.shape
    positions = skeleton.positions + random.normal(0.0, NOISE, (*shape, 3))
    if gaps:
        far = random.normal(size=(*shape, 3))
        far *= random.uniform(*FARTHEST, (*shape, 1)) / np.linalg.norm(far, axis=2, keepdims=True)
        positions += far * (random.random(shape) < OUTLIERS)[:, :, None]
        starts = np.argwhere(random.random(shape) < DROPOUTS / ((1 + LONGEST_DROPOUT) / 2.0))
        for frame, joint in starts:
            positions[frame : frame + random.integers(1, LONGEST_DROPOUT + 1), joint] = np.nan
    return replace(skeleton, positions=positions)


def jitter(skeleton: Skeleton) -> np.ndarray:
    """Squared distances (N,) that zero-lag smoothing moves the points by, m^2."""
    moved = Smooth().filter(skeleton).positions - skeleton.positions
    return _squares(moved)


def _squares(differences: np.ndarray) -> np.ndarray:
    squares = np.sum(differences**2, axis=2).ravel()
    return squares[np.isfinite(squares)]


def correlation(result: Skeleton, truth: Skeleton) -> np.ndarray:
    """Sums (lags, 3) of result times truth, truth squared and result squared, each about its mean.

    The truth is smoothed, for between its frames noise would lower it.
    """
    from scipy.interpolate import CubicSpline

    inside = (truth.times > truth.times[0] + LAGS[-1]) & (truth.times < truth.times[-1] + LAGS[0])
    known = np.isfinite(truth.positions).all(axis=(0, 2))
    total = np.zeros((len(LAGS), 3))
    if not inside.any() or not known.any():
        return total
    smooth = CubicSpline(truth.times, Smooth().filter(truth).positions[:, known])
    there = np.isfinite(result.positions[inside][:, known])
    a = _centred(np.where(there, result.positions[inside][:, known], 0.0), there)
    for i, lag in enumerate(LAGS):
        b = _centred(smooth(truth.times[inside] - lag), there)
        total[i] = np.sum(a * b), np.sum(b * b), np.sum(a * a)
    return total


def _centred(tracks: np.ndarray, there: np.ndarray) -> np.ndarray:
    mean = np.sum(tracks, axis=0, where=there) / np.maximum(there.sum(axis=0), 1)
    return np.where(there, tracks - mean, 0.0)


def measured(filter_: Filter, truths: Sequence[Skeleton], gaps: bool) -> tuple[float, float, float, float, float]:
    """Jitter (m), error (m), its 99th percentile (m), lag (s), share of points missing."""
    moved, errors, sums, missing = [], [], np.zeros((len(LAGS), 3)), []
    for seed, truth in enumerate(truths):
        result = filter_.filter(worsened(truth, seed, gaps))
        moved.append(jitter(result))
        errors.append(_squares(result.positions - truth.positions))
        sums += correlation(result, truth)
        missing.append(np.isnan(result.positions[:, :, 0]).mean())
    squares = np.concatenate(errors)
    lag = LAGS[np.argmax(sums[:, 0] / np.sqrt(sums[:, 1] * sums[:, 2]))]
    rms = [math.sqrt(each.mean()) for each in (np.concatenate(moved), squares)]
    return rms[0], rms[1], math.sqrt(np.quantile(squares, 0.99)), float(lag), float(np.mean(missing))


def noise_table(sets: dict[str, list[Skeleton]]) -> Rows:
    """Every filter on every set."""
    figures = ("jitter", "error (mm)", "worst 1 % (mm)", "lag (ms)", "missing (%)")
    rows: Rows = [("recordings", "made worse by", "filter", *figures)]
    for name, truths in sets.items():
        for gaps, what in ((False, "noise"), (True, "noise, dropouts, outliers")):
            before = None
            for title, filter_ in FILTERS.items():
                shaking, error, worst, lag, missing = measured(filter_, truths, gaps)
                before = before or shaking
                row = (f"{shaking / before:.2f}", f"{1e3 * error:.1f}", f"{1e3 * worst:.0f}")
                rows.append((name, what, title, *row, f"{1e3 * lag:.0f}", f"{100 * missing:.1f}"))
    return rows


def wave_table(rate: float = 120.0) -> Rows:
    """What is left of a wave of 30 cm, and how long a frame of 25 joints takes."""
    times = np.arange(0.0, 10.0, 1.0 / rate)
    rows: Rows = [("filter", "1 Hz (%)", "2 Hz (%)", "3 Hz (%)", "a frame of 25 joints (µs)")]
    for title, filter_ in list(FILTERS.items())[1:]:
        kept = []
        for frequency in (1.0, 2.0, 3.0):
            wave = np.exp(2j * math.pi * frequency * times)
            places = np.column_stack([np.zeros(len(times)), 0.3 * wave.imag, np.zeros(len(times))])[:, None]
            result = filter_.filter(Skeleton(times, places, ("left_wrist",))).positions[:, 0, 1] / 0.3
            middle = slice(round(rate), -round(rate))
            kept.append(abs(2.0 * np.mean(result[middle] * wave[middle].conj())))
        many = Skeleton(times, np.random.default_rng(0).normal(size=(len(times), 25, 3)), tuple(map(str, range(25))))
        began = time.perf_counter()
        filter_.filter(many)
        took = f"{1e6 * (time.perf_counter() - began) / len(times):.0f}"
        rows.append((title, *(f"{100 * share:.0f}" for share in kept), took))
    return rows


def main(words: Sequence[str] | None = None) -> None:
    """Measure and note."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", type=Path, metavar="RECORDINGS", help="folder of recordings, as SETS names them")
    parser.add_argument("--print", action="store_true", help="print only, leave RESULTS.md alone")
    args, where = parser.parse_args(words), machine()
    folder, command = args.recordings, "filters.py RECORDINGS"
    sets = {name: list(recordings(folder, pattern, rate)) for name, (pattern, rate) in SETS.items()}
    sets = {name: skeletons for name, skeletons in sets.items() if skeletons}
    if sets:
        note("Filters on recordings made worse", noise_table(sets), command, where, args.print)
    else:
        print(f"skipped: no recordings in {folder}")
    note("What filters leave of a wave at 120 Hz", wave_table(), command, where, args.print)


if __name__ == "__main__":
    main()
