"""The book of changes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.safety.guard import Change
from nao_sim.safety.ledger import ledger


def _change(reason, joint, size, links=()):
    sizes = np.zeros(26)
    sizes[joint] = size
    return Change(reason, sizes, links)


@given(st.lists(st.booleans(), min_size=1, max_size=60))
def test_spells_cover_exactly_the_changed_steps(changed):
    entries = ledger([(_change("limit", 3, 0.1),) if now else () for now in changed])
    covered = [False] * len(changed)
    for entry in entries:
        for first, last in entry.spells:
            covered[first : last + 1] = [True] * (last - first + 1)
    assert covered == changed
    assert sum(entry.steps for entry in entries) == sum(changed)
    assert all(b[0] - a[1] > 1 for entry in entries for a, b in zip(entry.spells, entry.spells[1:], strict=False))


def test_each_joint_and_reason_has_its_own_entry_and_its_largest_change():
    steps = [
        (_change("limit", 3, 0.1), _change("speed", 3, 0.4)),
        (_change("limit", 3, 0.3), _change("limit", 5, 0.2)),
    ]
    found = {(entry.joint, entry.reason): (entry.steps, entry.largest) for entry in ledger(steps)}
    assert found == {(3, "limit"): (2, 0.3), (3, "speed"): (1, 0.4), (5, "limit"): (1, 0.2)}


def test_two_collisions_in_one_step_are_one_step_and_two_pairs():
    step = (
        _change("self_collision", 2, 0.1, ("torso", "l_wrist")),
        _change("self_collision", 2, 0.2, ("l_wrist", "Head")),
    )
    (entry,) = ledger([step])
    assert entry.steps == 1
    assert entry.largest == pytest.approx(0.2)
    assert entry.pairs == {("l_wrist", "torso"), ("Head", "l_wrist")}
