"""Who is who in a crowd."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.errors import RecordingError
from nao_sim.recordings.landmarks.people import choose, linked
from nao_sim.recordings.source import Source


def places(centre, spread=1.0):
    """Where the points of somebody at `centre` are."""
    return {
        key: (centre + spread * x, spread * y)
        for key, (x, y) in enumerate([(0, 0), (0.3, 0.5), (0.2, 1.0), (0.5, 0.2)])
    }


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 999),
    people=st.integers(1, 4),
    frames=st.integers(1, 15),
    step=st.floats(0.0, 0.4),
)
def test_people_keep_their_numbers_while_they_move_whatever_the_order_of_the_list(seed, people, frames, step):
    random = np.random.default_rng(seed)
    centres = 3.0 * np.arange(people) + np.cumsum(random.uniform(-step, step, (frames, people)), axis=0) * 0.3
    order = [random.permutation(people) for _ in range(frames)]
    found = linked([[places(centres[frame, who]) for who in order[frame]] for frame in range(frames)])
    names = dict(zip(order[0].tolist(), found[0], strict=True))
    for frame in range(frames):
        assert found[frame] == [names[who] for who in order[frame].tolist()]


def test_numbers_are_given_in_order_of_appearance_and_once_each():
    found = linked([[places(0.0)], [places(9.0), places(0.1)], [], [places(9.2), places(30.0), places(0.2)]])
    assert found == [[1], [2, 1], [], [2, 3, 1]]


def test_people_without_any_point_are_somebody_new_and_no_fault():
    assert linked([[{}], [{}, places(0.0)]]) == [[1], [2, 3]]


def test_the_one_tracked_longest_is_chosen_and_of_equals_the_first():
    source = Source(Path("x"))
    assert choose(source, {"a": 3}) == ("a", ())
    name, notes = choose(source, {"a": 3, "b": 5, "c": 5})
    assert name == "b" and notes == (
        "several people: a (3 frames), b (5 frames), c (5 frames); person b, tracked longest, is read",
    )


def test_many_people_are_not_all_listed():
    with pytest.raises(RecordingError, match=r"h \(1 frames\) and 12 more"):
        choose(Source(Path("x"), person="z1"), {chr(97 + i): 1 for i in range(20)})
