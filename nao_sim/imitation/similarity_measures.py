"""How alike two bodies are at the same times: angles, hands, the two published measures, and the delay.

The Whole-Body-Focused (WBF) and Local-Link-Focused (LLF) similarity are those of
Z. Zhang, Y. Niu, Z. Yan and S. Lin, "Real-Time Whole-Body Imitation by Humanoid
Robots and Task-Oriented Teleoperation Using an Analytical Mapping Method and
Quantitative Evaluation", Applied Sciences 8(10):2005, 2018, as their published
program computes them (chrisyrniu/whole_body_imitation_and_lfd, commit 62580db,
`naoRobot::evaluation`): the mean over ten links of the cosine between the
person's and the robot's link vector.  WBF has all vectors in one upright frame
that faces where the body faces, so that an error at the shoulder counts again
at the forearm; LLF has each vector in the frame of the link it hangs on.  A
link that is not known on either side is left out of the mean.  The program
also notes a product of torso, inner and outer links that is not computed here.
"""

from __future__ import annotations

import numpy as np

from nao_sim.imitation.arms import angle_between
from nao_sim.imitation.similarity_body import BodyDirections
from nao_sim.robot import Array

STEP = 0.02  # s between samples when looking for the delay
LONGEST_DELAY = 1.0  # s
MOVING = np.radians(1.0)  # arms that move less tell nothing about delay
ALIKE = 0.5  # correlation; motions that are less alike at any delay have none
AS_GOOD = 0.01  # of correlation; of delays that fit as well as that the smallest counts (a wave repeats itself)


def direction_errors(person: BodyDirections, robot: BodyDirections) -> Array:
    """Angles (T, 2, 2) rad between the arms: side, segment."""
    return angle_between(person.arms, robot.arms)


def hand_errors(person: BodyDirections, robot: BodyDirections) -> Array:
    """Distances (T, 2) of the hands from each other, each seen from its shoulder, in arm lengths."""
    return np.linalg.norm(person.hands - robot.hands, axis=-1)


def whole_body_focused(person: BodyDirections, robot: BodyDirections) -> Array:
    """WBF: cosines (T, 10) between links in the upright frame, 1 where they point alike."""
    return np.sum(person.upright * robot.upright, axis=-1)


def local_link_focused(person: BodyDirections, robot: BodyDirections) -> Array:
    """LLF: cosines (T, 10) between links, each in the frame of the link it hangs on."""
    return np.sum(person.local * robot.local, axis=-1)


def delay(person: BodyDirections, robot: BodyDirections) -> float | None:
    """How much later (s) the robot's arms do what the person's arms do.

    The shift within a second either way at which the arms' directions correlate
    best, refined by a parabola; at least half of the person's known directions
    must have the robot's beside them.

    Returns:
        The delay; None where nothing moves or no delay makes the motions alike.
    """
    reach = round(LONGEST_DELAY / STEP)
    first = max(person.times[0], robot.times[0] - LONGEST_DELAY)
    last = min(person.times[-1], robot.times[-1] + LONGEST_DELAY)
    count = max(int(np.floor((last - first) / STEP + 1e-9)) + 1, 1)
    grid = first + STEP * np.arange(-reach, count + reach)
    theirs = _channels(person, grid[reach : reach + count])
    scores = _correlations(theirs, _channels(robot, grid), reach)
    inner = scores[1:-1]
    peaks = 1 + np.flatnonzero((inner >= scores[:-2]) & (inner > scores[2:]) & (inner > ALIKE))
    if not len(peaks):
        return None
    peaks = peaks[scores[peaks] >= scores[peaks].max() - AS_GOOD]
    best = int(peaks[np.argmin(np.abs(peaks - reach))])
    before, at, after = scores[best - 1 : best + 2]
    bend = before - 2.0 * at + after
    offset = 0.5 * (before - after) / bend if np.isfinite(bend) and bend < 0.0 else 0.0
    return float((best - reach + offset) * STEP)


def _channels(body: BodyDirections, times: Array) -> Array:
    """The arms' directions as (N, 12)."""
    return body.at(times).arms.reshape(len(times), -1)


def _correlations(person: Array, robot: Array, reach: int) -> Array:
    """Correlation of (N, C) with every shift of (N + 2 reach, C); -inf where too little overlaps or nothing moves.

    Sums over the overlap of every shift at once: they are convolutions.
    """
    a, b = (np.nan_to_num(values) for values in (person, robot))
    a_known, b_known = (np.isfinite(values).astype(float) for values in (person, robot))
    n, sum_a, sum_b, sum_aa, sum_bb, sum_ab = (
        _sliding(left, right, reach)
        for left, right in (
            (a_known, b_known),
            (a, b_known),
            (a_known, b),
            (a * a, b_known),
            (a_known, b * b),
            (a, b),
        )
    )
    safe = np.maximum(n, 1.0)
    moved_a, moved_b = ((square - total**2 / safe).sum(axis=1) for square, total in ((sum_aa, sum_a), (sum_bb, sum_b)))
    together = (sum_ab - sum_a * sum_b / safe).sum(axis=1)
    frames = n.sum(axis=1) / 3.0  # three channels are one direction
    enough = (frames >= 0.5 * a_known.sum() / 3.0) & (frames >= 1.0)
    moving = np.minimum(moved_a, moved_b) > MOVING**2 * np.maximum(frames, 1.0)
    size = np.sqrt(np.maximum(moved_a * moved_b, np.finfo(float).tiny))
    return np.where(enough & moving, together / size, -np.inf)


def _sliding(short: Array, long: Array, reach: int) -> Array:
    """Sums (2 reach + 1, C) of short (N, C) times long (N + 2 reach, C) at every shift."""
    size = 1 << (len(long) - 1).bit_length()
    spectrum = np.conj(np.fft.rfft(short, size, axis=0)) * np.fft.rfft(long, size, axis=0)
    sums: Array = np.fft.irfft(spectrum, size, axis=0)[: 2 * reach + 1]
    return sums
