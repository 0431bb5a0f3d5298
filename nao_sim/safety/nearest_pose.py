"""The safe pose nearest to one that is not."""

from __future__ import annotations

import numpy as np

from nao_sim.robot import Array, Mask
from nao_sim.safety.nearest import nearest
from nao_sim.safety.promise import AIM, Promise

STEPS = 40
TRUST = 0.15  # rad that slopes hold for
STILL = 1e-5  # rad


def nearest_pose(
    promise: Promise, target: Array, start: Array, bounds: tuple[Array, Array], free: Mask
) -> Array | None:
    """Go from a start along the slopes of what is broken until nothing is, always as near to the target as they allow.

    Args:
        promise: whose rules hold.
        target: (26,).
        start: (26,) where to begin, safe or not.
        bounds: lowest and highest pose.
        free: (26,) joints that may differ from the target.

    Returns:
        A safe pose (26,), nearest to the target of all around it; None where none was found.
    """
    pose, ones = start.copy(), np.ones(int(free.sum()))
    low, high = (np.where(free, bound, target) for bound in bounds)
    found: Array | None = None
    for _ in range(STEPS):
        findings = promise.findings(np.array([pose, pose]), np.ones((2, len(pose))), 1.0, AIM + TRUST * 0.05)
        if all(f.margin.value >= 0.0 for f in findings):
            found = pose if found is None else min(found, pose, key=lambda safe: float(np.linalg.norm(safe - target)))
        rows = np.array([f.row[free] for f in findings]).reshape(-1, int(free.sum()))
        least = np.array([AIM - f.margin.value + f.row[free] @ pose[free] for f in findings])
        box = np.maximum(low, pose - TRUST)[free], np.minimum(high, pose + TRUST)[free]
        following = pose.copy()
        following[free] = nearest(target[free], ones, box, rows, least) if len(rows) else np.clip(target[free], *box)
        if np.abs(following - pose).max() < STILL:
            break
        pose = following
    return found
