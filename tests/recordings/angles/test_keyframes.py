"""Curves between key frames: NAOqi's Bezier, checked against its definition and its published exports."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.errors import RecordingError
from nao_sim.recordings.angles.keyframes import LONGEST_S, RATE, Curve, automatic_handles, evaluate, trajectory
from nao_sim.recordings.source import Source

SOURCE = Source(Path("x.xar"))
AUTOMATIC, LINEAR = np.nan, 0.0


def curve(times, values, handles=AUTOMATIC, held=False, joint=0):
    shape = (len(times), 2, 2)
    return Curve(
        joint,
        np.array(times, float),
        np.array(values, float),
        np.broadcast_to(np.asarray(handles, float), shape).copy(),
        np.broadcast_to(held, len(times)),
    )


def by_definition(p0, p1, p2, p3, t):
    """A cubic Bezier's ordinate at abscissa t, by the polynomial's roots."""
    a, b = np.array([p0[0], p1[0], p2[0], p3[0]]), np.array([p0[1], p1[1], p2[1], p3[1]])
    cubic = [-a[0] + 3 * a[1] - 3 * a[2] + a[3], 3 * a[0] - 6 * a[1] + 3 * a[2], -3 * a[0] + 3 * a[1], a[0] - t]
    roots = np.roots(cubic)
    u = min((r.real for r in roots if abs(r.imag) < 1e-6 and -1e-6 < r.real < 1 + 1e-6), key=lambda r: abs(r - 0.5))
    return b @ [(1 - u) ** 3, 3 * u * (1 - u) ** 2, 3 * u**2 * (1 - u), u**3]


def test_automatic_handles_are_those_that_choregraphe_exports():
    """A key of a published export: times 0.92, 1.52, 2.36 s, handles [-0.2, -0.287302] and [0.28, 0.402222]."""
    handles = automatic_handles(np.array([0.92, 1.52, 2.36]), np.array([-0.829141, 0.150098, 1.23943]))
    np.testing.assert_allclose(handles[1], [[-0.2, -0.287302], [0.28, 0.402222]], atol=1e-6)
    np.testing.assert_allclose(handles[0, 1], [0.2, 0.0], atol=1e-12)
    np.testing.assert_allclose(handles[2, 0], [-0.28, 0.0], atol=1e-12)


@given(st.lists(st.tuples(st.floats(0.05, 2.0), st.floats(-2.0, 2.0)), min_size=2, max_size=6))
def test_an_automatic_curve_stays_between_neighbouring_keys(rows):
    """NAOqi calls it anti overshooting."""
    times, values = np.cumsum([step for step, _ in rows]), np.array([value for _, value in rows])
    motion = trajectory(SOURCE, [curve(times, values)])
    now = motion.positions[:, 0]
    left = np.clip(np.searchsorted(times, motion.times, side="right") - 1, 0, len(times) - 2)
    low, high = np.minimum(values[left], values[left + 1]), np.maximum(values[left], values[left + 1])
    assert (now >= low - 1e-9).all() and (now <= high + 1e-9).all()


@settings(max_examples=60)
@given(
    st.floats(0.05, 5.0), st.floats(-2, 2), st.floats(-2, 2), st.floats(0, 1), st.floats(-2, 2), st.floats(0, 1),
    st.floats(-2, 2), st.floats(0.02, 0.98),
)  # fmt: skip
def test_a_curve_is_the_bezier_of_its_handles(span, v0, v1, x1, y1, x2, y2, share):
    handles = [[[0, 0], [x1 * span, y1]], [[-x2 * span, y2], [0, 0]]]
    bent = curve([0.0, span], [v0, v1], handles)
    expected = by_definition((0, v0), (x1 * span, v0 + y1), (span - x2 * span, v1 + y2), (span, v1), share * span)
    found = evaluate(bent, np.array([share * span]))[0]
    around = evaluate(bent, share * span + span * np.array([-1e-6, 1e-6]))  # a steep stretch moves with rounding
    assert found == pytest.approx(expected, abs=1e-6 + 2.0 * abs(np.diff(around)[0]))


@given(st.lists(st.tuples(st.floats(0.001, 2.0), st.floats(-2.0, 2.0)), min_size=1, max_size=6), st.booleans())
def test_keys_are_hit_to_the_last_bit(rows, straight):
    times, values = np.cumsum([step for step, _ in rows]), np.array([value for _, value in rows])
    motion = trajectory(SOURCE, [curve(times, values, LINEAR if straight else AUTOMATIC)])
    at = np.searchsorted(motion.times, times)
    np.testing.assert_array_equal(motion.times[at], times)
    np.testing.assert_array_equal(motion.positions[at, 0], values)
    if straight:
        assert len(motion) == len(times)


def test_bent_stretches_are_sampled_at_naoqis_rate_and_straight_ones_are_not():
    straight = curve([0.0, 1.0, 2.0], [0.0, 1.0, 0.0], LINEAR)
    assert trajectory(SOURCE, [straight]).times.tolist() == [0.0, 1.0, 2.0]
    bent = curve([1.0, 2.0], [0.0, 1.0], joint=1)
    motion = trajectory(SOURCE, [straight, bent])
    assert len(motion) == 2 + RATE and np.diff(motion.times[1:]).max() == pytest.approx(1.0 / RATE)
    assert motion.positions[np.isclose(motion.times, 1.5), 0] == pytest.approx(0.5)
    flat = curve([0.0, 60.0], [0.3, 0.3])
    assert len(trajectory(SOURCE, [flat])) == 2


def test_a_key_and_the_tick_beside_it_are_one_sample():
    motion = trajectory(SOURCE, [curve([0.1, 0.3000001, 0.5], [0.0, 1.0, 0.5])])
    assert 0.3000001 in motion.times and np.diff(motion.times).min() > 0.0199


def test_a_held_key_keeps_its_value_until_the_next_one():
    motion = trajectory(SOURCE, [curve([0.0, 1.0, 2.0], [0.2, 0.8, 0.4], LINEAR, held=[True, False, False])])
    assert set(motion.positions[motion.times < 1.0, 0]) == {0.2}
    assert motion.times[motion.times < 1.0][-1] == pytest.approx(0.98)
    np.testing.assert_array_equal(motion.positions[motion.times >= 1.0, 0], [0.8, 0.4])


def test_a_handle_past_the_next_key_is_shortened_and_time_never_runs_back():
    long = [[[0, 0], [3.0, 0.6]], [[-0.2, 0.0], [0, 0]]]
    fits = [[[0, 0], [1.0, 0.2]], [[-0.2, 0.0], [0, 0]]]
    found, expected = (trajectory(SOURCE, [curve([0.0, 1.0], [0.0, 1.0], handles)]) for handles in (long, fits))
    np.testing.assert_allclose(found.positions[:, 0], expected.positions[:, 0], atol=1e-12)


def test_a_joint_has_its_first_key_before_it_and_its_last_after_it():
    motion = trajectory(SOURCE, [curve([0.0, 2.0], [0.0, 1.0], LINEAR), curve([1.0], [0.7], joint=1)])
    assert motion.times.tolist() == [0.0, 1.0, 2.0] and set(motion.positions[:, 1]) == {0.7}
    assert motion.given.sum() == 2


def test_an_end_cuts_the_motion_where_it_is():
    keys = [curve([0.0, 2.0], [0.0, 1.0], LINEAR)]
    assert trajectory(SOURCE, keys, end=1.5).positions[:, 0].tolist() == [0.0, 0.75]
    assert trajectory(SOURCE, keys, end=9.0).times.tolist() == [0.0, 2.0]


def test_curves_that_fill_the_memory_are_refused_and_straight_lines_are_not():
    with pytest.raises(RecordingError, match="6 hours"):
        trajectory(SOURCE, [curve([0.0, 2 * LONGEST_S], [0.0, 1.0])])
    assert len(trajectory(SOURCE, [curve([0.0, 1e300], [0.0, 1.0], LINEAR)])) == 2
