"""Frames come out in order whatever order they are painted in."""

from hypothesis import given
from hypothesis import strategies as st

from nao_sim.rendering.frames import Window


@given(st.integers(1, 6), st.integers(0, 30), st.randoms(use_true_random=False))
def test_jobs_are_delivered_once_and_in_order(slots, jobs, random):
    window, holds, busy, delivered, started = Window(slots), {}, set(), [], 0
    while len(delivered) < jobs:
        while started < jobs and not window.is_full():
            slot = window.start()
            assert slot not in holds
            holds[slot], started = started, started + 1
            busy.add(slot)
        if busy:
            slot = random.choice(sorted(busy))
            busy.remove(slot)
            window.finish(slot)
        while (head := window.head()) is not None:
            delivered.append(holds.pop(head))
            window.deliver()
        assert len(holds) <= slots
    assert delivered == list(range(jobs))


def test_when_nothing_is_done_expect_no_head():
    window = Window(2)
    assert window.head() is None
    first, second = window.start(), window.start()
    window.finish(second)
    assert window.is_full() and window.head() is None
    window.finish(first)
    assert window.head() == first
