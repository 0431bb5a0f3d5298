"""The book of changes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.safety import ledger as module
from nao_sim.safety.change import Change
from nao_sim.safety.ledger import ledger

JOINTS = (0, 3, 7, 25)
LINKS = ((), ("torso", "l_wrist"), ("l_wrist", "torso"), ("Head", "r_wrist"))


def _change(reason, joint, size, links=()):
    sizes = np.zeros(26)
    sizes[joint] = size
    return Change(reason, sizes, links)


changes = st.builds(
    _change,
    st.sampled_from(("limit", "speed", "self_collision")),
    st.sampled_from(JOINTS),
    st.floats(1e-6, 3.0),
    st.sampled_from(LINKS),
)
runs = st.lists(st.lists(changes, max_size=4).map(tuple), max_size=40)


@given(st.lists(st.booleans(), min_size=1, max_size=60))
def test_spells_cover_exactly_the_changed_steps_and_never_touch(changed):
    book = ledger([(_change("limit", 3, 0.1),) if now else () for now in changed])
    covered = [any(first <= step <= last for first, last in book.spells) for step in range(len(changed))]
    assert covered == changed
    assert book.share == pytest.approx(np.mean(changed))
    assert (book.spells[1:, 0] - book.spells[:-1, 1] > 1).all()


@given(runs, st.integers(1, 5))
def test_every_rule_joint_and_pair_has_what_counting_one_by_one_gives(run, chunk):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "_CHUNK", chunk)
        book = ledger(run)
    rows = [
        (step, change.reason, int(joint), tuple(sorted(change.links)), change.size[joint])
        for step, intervention in enumerate(run)
        for change in intervention
        for joint in np.flatnonzero(change.size)
    ]
    assert (book.run, len(book)) == (len(run), len(rows))
    for reason in {row[1] for row in rows}:
        _agrees(book.only(reason=reason), [row for row in rows if row[1] == reason])
    for joint in JOINTS:
        _agrees(book.only(joint=joint), [row for row in rows if row[2] == joint])
    for pair in {row[3] for row in rows if row[3]}:
        _agrees(book.only(pair=pair[::-1]), [row for row in rows if row[3] == pair])


def _agrees(book, rows):
    assert book.steps.tolist() == sorted({row[0] for row in rows})
    assert book.reasons == sorted({row[1] for row in rows})
    assert book.joints == sorted({row[2] for row in rows})
    assert book.pairs == sorted({row[3] for row in rows if row[3]})
    assert book.largest == max((row[4] for row in rows), default=0.0)
    cells = {(row[0], row[2]): max(r[4] for r in rows if (r[0], r[2]) == (row[0], row[2])) for row in rows}
    assert book.mean == pytest.approx(np.mean(list(cells.values())) if cells else 0.0)


@given(runs, st.integers(0, 40), st.integers(0, 40))
def test_a_time_has_the_rows_of_its_steps_both_ends_included(run, first, last):
    part = ledger(run).only(between=(first, last))
    inside = [step for step, intervention in enumerate(run) for _ in intervention if first <= step <= last]
    assert part.step.tolist() == inside


def test_what_never_happened_has_no_rows():
    book = ledger([(_change("limit", 3, 0.1),)])
    nothing = book.only(reason="balance"), book.only(joint=4), book.only(pair=("a", "b")), ledger([])
    assert [len(part) + len(part.steps) + len(part.spells) for part in nothing] == [0] * 4
    assert {part.largest + part.mean for part in nothing} == {0.0}


def test_two_collisions_in_one_step_are_one_step_and_two_pairs():
    step = (
        _change("self_collision", 2, 0.1, ("torso", "l_wrist")),
        _change("self_collision", 2, 0.2, ("l_wrist", "Head")),
    )
    book = ledger([step])
    assert len(book.steps) == 1
    assert book.largest == book.mean == pytest.approx(0.2)
    assert book.pairs == [("Head", "l_wrist"), ("l_wrist", "torso")]
