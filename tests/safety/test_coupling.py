"""Limits that depend on another joint."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from nao_sim.robot import load_robot
from nao_sim.safety.coupling import MARGIN_RAD, CouplingRule, coupling_excess, narrowed
from tests.motions import poses

ROBOT = load_robot()
RULE = CouplingRule(ROBOT)
COUPLED = [coupling.joint for coupling in ROBOT.couplings]
SAMPLES = 401  # of each straight line
STEEPEST = max(
    np.abs(np.diff(bound) / np.diff(coupling.knots)).max()
    for coupling in ROBOT.couplings
    for bound in (coupling.lower, coupling.upper)
)
couplings = st.sampled_from(ROBOT.couplings)


@st.composite
def lines(draw: st.DrawFn) -> np.ndarray:
    """Poses (N, 26) near the tables' edges; from one to the next some joints stay, and some are on a knot."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    line = random.uniform(ROBOT.lower, ROBOT.upper, (draw(st.integers(1, 5)), 26))
    for coupling in ROBOT.couplings:
        on_knot = random.random(len(line)) < 0.2
        line[:, coupling.by] = np.where(on_knot, random.choice(coupling.knots, len(line)), line[:, coupling.by])
        low, high = coupling.bounds(line[:, coupling.by])
        edge = np.where(random.random(len(line)) < 0.5, low, high) + random.normal(0.0, 0.05, len(line))
        line[:, coupling.joint] = np.where(random.random(len(line)) < 0.7, edge, line[:, coupling.joint])
    for before, after in pairwise(line):
        stays = random.random(26) < 0.2
        after[stays] = before[stays]
    return line


def _worst(line):
    """How far (rad) densely sampled straight lines go beyond a limit less the margin, negative where they never do."""
    share = np.linspace(0.0, 1.0, SAMPLES)[:, None]
    dense = np.concatenate([line[:1], *(before + share * (after - before) for before, after in pairwise(line))])
    worst = []
    for coupling in ROBOT.couplings:
        low, high = coupling.bounds(dense[:, coupling.by])
        angle = dense[:, coupling.joint]
        worst.append(max((low + MARGIN_RAD - angle).max(), (angle - high + MARGIN_RAD).max()))
    return max(worst)


def _between_samples(line):
    """How much farther (rad) beyond a limit a line may be between two samples."""
    steps = np.abs(np.diff(line, axis=0)).max(initial=0.0) / (SAMPLES - 1)
    return (1.0 + STEEPEST) * steps + 1e-9


@given(lines())
def test_a_line_is_broken_where_dense_sampling_finds_it_broken_and_nowhere_else(line):
    worst = _worst(line)
    if worst > 1e-9:
        assert RULE.broken(line, 0.0)
        assert RULE.broken(line, worst - 1e-9)
    assert not RULE.broken(line, max(worst, 0.0) + _between_samples(line))


@given(lines(), st.floats(0.0, 0.2))
def test_the_margins_of_a_line_are_the_smallest_on_it(line, within):
    found, told = ([margin.value for margin, _ in RULE.margins(line, np.ones_like(line), w)] for w in (10.0, within))
    assert told == [value for value in found if value < within]
    assert len(found) == 2 * len(ROBOT.couplings)
    assert -_between_samples(line) - _worst(line) <= min(found) <= 1e-9 - _worst(line)


@given(lines())
def test_the_reach_of_a_margin_is_that_of_the_place_where_it_is_smallest(line):
    """With the poses themselves for a reach, it is the pose there."""
    for margin, pose in RULE.margins(line, line, 10.0):
        coupling = next(c for c in ROBOT.couplings if margin.gradient[c.joint])
        low, high = coupling.bounds(pose[coupling.by])
        inside = pose[coupling.joint] - low if margin.gradient[coupling.joint] > 0.0 else high - pose[coupling.joint]
        assert inside - MARGIN_RAD == pytest.approx(margin.value, abs=1e-9)


@given(poses())
def test_the_nearest_pose_is_allowed_and_moves_only_what_is_not(pose):
    nearest = RULE.nearest(pose)
    assert not RULE.broken(nearest[None], 1e-12)
    assert np.array_equal(np.delete(nearest, COUPLED), np.delete(pose, COUPLED))
    for coupling in ROBOT.couplings:
        low, high = coupling.bounds(pose[coupling.by])
        allowed = np.clip(pose[coupling.joint], low + MARGIN_RAD, high - MARGIN_RAD)
        assert nearest[coupling.joint] == pytest.approx(allowed, abs=1e-12)
    if not RULE.broken(pose[None], 0.0):
        assert np.array_equal(nearest, pose)


@pytest.mark.parametrize("coupling", ROBOT.couplings)
def test_the_margin_leaves_room_even_where_the_limits_are_tightest(coupling):
    assert (coupling.upper - coupling.lower > 2.0 * MARGIN_RAD).all()
    assert coupling.upper.min() - coupling.lower.max() > 2.0 * MARGIN_RAD


@given(lines(), couplings, st.data())
def test_gradients_are_the_finite_differences_of_the_margins(line, coupling, data):
    """Of lines within one piece of the table; each pose as far from the next speeds' effect as its reach says."""
    random = np.random.default_rng(data.draw(st.integers(0, 2**32 - 1)))
    piece = data.draw(st.integers(0, len(coupling.knots) - 2))
    low, high = coupling.knots[piece : piece + 2]
    line[:, coupling.by] = random.uniform(low + 1e-4, high - 1e-4, len(line))
    reach, way = random.uniform(0.0, 1.0, line.shape), random.normal(size=26)

    def values(share):
        return _values_of(coupling, RULE.margins(line + share * reach * way, reach, 10.0))

    less, now, more = values(-1e-6), values(0.0), values(1e-6)
    for before, (value, row), after in zip(less, now, more, strict=True):
        assume(abs(before[0] - 2.0 * value + after[0]) < 1e-12)  # the same place of the line is the worst one
        assert (after[0] - before[0]) / 2e-6 == pytest.approx(row @ way, abs=1e-6)


def _values_of(coupling, found):
    """The margins of one coupling, and their derivatives (26,) by the speeds of the next step."""
    return [(m.value, m.gradient * there) for m, there in found if m.gradient[coupling.joint]]


@given(lines())
def test_the_mirrored_line_has_the_same_margins(line):
    plain = sorted(margin.value for margin, _ in RULE.margins(line, np.ones_like(line), 10.0))
    turned = ROBOT.mirror(line)
    mirrored = sorted(margin.value for margin, _ in RULE.margins(turned, np.ones_like(line), 10.0))
    assert mirrored == pytest.approx(plain, abs=1e-6)


@given(poses())
def test_the_mirrored_pose_has_the_mirrored_nearest_pose(pose):
    np.testing.assert_allclose(RULE.nearest(ROBOT.mirror(pose)), ROBOT.mirror(RULE.nearest(pose)), atol=1e-6)


@given(poses(), couplings)
def test_excess_is_the_way_back_inside(pose, coupling):
    low, high = coupling.bounds(pose[coupling.by])
    nearest = np.clip(pose[coupling.joint], low, high)
    assert float(coupling_excess(coupling, pose)) == pytest.approx(abs(pose[coupling.joint] - nearest))


def test_head_table_is_the_vendors():
    head = ROBOT.couplings[0]
    assert np.degrees(head.bounds(np.radians(87.49))) == pytest.approx([-18.91, 11.46], abs=0.01)
    assert np.degrees(head.bounds(0.0)) == pytest.approx([-38.5, 29.51], abs=0.01)


def test_ankle_tables_mirror():
    left, right = ROBOT.couplings[1:]
    for angle in np.linspace(-1.18, 0.92, 50):
        low, high = left.bounds(angle)
        assert right.bounds(angle) == pytest.approx((-high, -low), abs=1e-6)


@given(st.sampled_from(ROBOT.couplings), st.floats(0.0, 0.1), st.floats(0.0, 1.0), st.floats(-1.0, 1.0))
def test_a_narrowed_coupling_holds_wherever_the_other_joint_sags_to(coupling, sag, place, share):
    low, high = coupling.knots[[0, -1]]
    other = low + place * (high - low)
    narrow_lower, narrow_upper = narrowed(coupling, sag).bounds(other)
    lower, upper = coupling.bounds(np.clip(other + share * sag, low, high))
    assert narrow_lower >= lower - 1e-9 and narrow_upper <= upper + 1e-9
    assert narrow_lower <= narrow_upper
    np.testing.assert_array_equal(narrowed(coupling, 0.0).bounds(other), coupling.bounds(other))
