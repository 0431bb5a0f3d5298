"""Which shapes of a model may touch each other, by the model's own rules."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import mujoco


def shape_pairs(model: mujoco.MjModel) -> Iterator[tuple[int, int]]:
    """Pairs of geoms that bits, exclusions, and the rule on parents and their children leave."""
    excluded = {tuple(sorted((s >> 16, s & 0xFFFF))) for s in model.exclude_signature}
    for first, second in combinations(range(model.ngeom), 2):
        a, b = sorted((model.geom_bodyid[first], model.geom_bodyid[second]))
        weld_a, weld_b = model.body_weldid[[a, b]]
        related = weld_a == weld_b or (weld_a and model.body_weldid[model.body_parentid[weld_b]] == weld_a)
        bits = model.geom_contype[[first, second]] & model.geom_conaffinity[[second, first]]
        if bits.any() and not related and (a, b) not in excluded:
            yield first, second
