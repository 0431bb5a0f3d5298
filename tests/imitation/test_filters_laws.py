"""What holds for every filter."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from nao_sim.imitation.filters import Fill, Filter, Kalman, Reject, Smooth, clean
from nao_sim.motion import Skeleton
from tests.tracking import backwards, moved, same, tracked


class Cleaner:
    """The whole chain as a filter."""

    def filter(self, skeleton: Skeleton) -> Skeleton:
        return clean(skeleton)[0]


WITHOUT_LAG = {"reject": Reject(), "fill": Fill(), "smooth": Smooth(), "clean": Cleaner()}
FILTERS: dict[str, Filter] = WITHOUT_LAG | {"kalman": Kalman()}
every_filter = pytest.mark.parametrize("filter_", FILTERS.values(), ids=FILTERS.keys())
laws = settings(max_examples=15)


def there(skeleton: Skeleton) -> np.ndarray:
    return np.isfinite(skeleton.positions).all(axis=2)


@every_filter
@laws
@given(tracked())
def test_times_joints_and_the_recording_itself_stay(filter_: Filter, skeleton: Skeleton) -> None:
    before = np.array(skeleton.positions)
    result = filter_.filter(skeleton)
    assert np.array_equal(result.times, skeleton.times) and result.joints == skeleton.joints
    assert np.array_equal(skeleton.positions, before, equal_nan=True)
    assert ((result.confidence >= 0.0) & (result.confidence <= 1.0)).all()
    assert np.array_equal(result.confidence > 0.0, there(result))


@every_filter
@laws
@given(tracked(), st.tuples(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0), st.floats(-5.0, 5.0)))
def test_what_does_not_move_stays_where_it_is(filter_: Filter, skeleton: Skeleton, place: tuple[float, ...]) -> None:
    still = replace(skeleton, positions=np.where(np.isfinite(skeleton.positions), place, np.nan))
    result = filter_.filter(still)
    np.testing.assert_allclose(result.positions[there(result)] - place, 0.0, atol=1e-9)


@every_filter
@laws
@given(tracked(), st.integers(0, 2**16))
def test_it_makes_no_difference_where_the_camera_stands(filter_: Filter, skeleton: Skeleton, seed: int) -> None:
    random = np.random.default_rng(seed)
    turn, shift = Rotation.from_quat(random.normal(size=4)), random.normal(size=3) * 3.0
    assert same(filter_.filter(moved(skeleton, turn, shift)), moved(filter_.filter(skeleton), turn, shift), 1e-7)


@every_filter
@laws
@given(tracked())
def test_left_and_right_are_treated_alike(filter_: Filter, skeleton: Skeleton) -> None:
    assert same(filter_.filter(skeleton.mirrored()), filter_.filter(skeleton).mirrored())


@pytest.mark.parametrize("filter_", WITHOUT_LAG.values(), ids=WITHOUT_LAG.keys())
@laws
@given(tracked())
def test_without_lag_past_and_future_count_alike(filter_: Filter, skeleton: Skeleton) -> None:
    assert same(filter_.filter(backwards(skeleton)), backwards(filter_.filter(skeleton)), 1e-7)


@pytest.mark.parametrize("filter_", [Fill(), Smooth()], ids=["fill", "smooth"])
@laws
@given(tracked())
def test_what_is_there_stays_there(filter_: Filter, skeleton: Skeleton) -> None:
    assert there(filter_.filter(skeleton))[there(skeleton)].all()


@laws
@given(tracked())
def test_rejecting_moves_nothing(skeleton: Skeleton) -> None:
    result = Reject().filter(skeleton)
    kept = there(result)
    assert there(skeleton)[kept].all()
    assert np.array_equal(result.positions[kept], skeleton.positions[kept])


@every_filter
@laws
@given(tracked(), st.floats(0.05, 0.6))
def test_a_gap_longer_than_stated_stays_a_gap(filter_: Filter, skeleton: Skeleton, longest: float) -> None:
    tuned = {Fill: Fill(longest), Kalman: Kalman(hold=longest)}.get(type(filter_), filter_)
    longest = longest if tuned is not filter_ else 0.5
    seen = there(skeleton)
    result = there(tuned.filter(skeleton))
    for joint in range(len(skeleton.joints)):
        times = skeleton.times[seen[:, joint]]
        after = np.searchsorted(times, skeleton.times)
        before = np.where(after > 0, times[np.maximum(after - 1, 0)] if len(times) else np.nan, -np.inf)
        inside = ~seen[:, joint] & (skeleton.times - before > longest)
        assert not result[inside, joint].any()


@every_filter
@laws
@given(tracked())
def test_nothing_flies_away(filter_: Filter, skeleton: Skeleton) -> None:
    result = filter_.filter(skeleton).positions
    for joint, track in enumerate(skeleton.positions.transpose(1, 0, 2)):
        known = track[np.isfinite(track).all(axis=1)]
        if len(known):
            middle, size = known.mean(axis=0), np.linalg.norm(np.ptp(known, axis=0))
            away = np.linalg.norm(result[:, joint] - middle, axis=1)
            assert np.nanmax(away, initial=0.0) <= 2.5 * size + 1e-9  # one that minds speeds goes past a turn
