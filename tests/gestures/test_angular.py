import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.gestures.angular import density_ratio

SPREAD = st.floats(0.05, 3.0)


@given(SPREAD)
def test_all_directions_together_are_certain_in_space(spread):
    cosines = (np.arange(20000) + 0.5) / 10000.0 - 1.0  # of equal areas of the sphere
    ratio = density_ratio(cosines / spread, np.array(spread**-2.0), planar=False)
    assert (ratio >= 0.0).all() and ratio.mean() == pytest.approx(1.0, rel=1e-4)


@given(SPREAD, st.floats(0.0, 1.0))
def test_all_directions_together_are_certain_in_a_picture(spread, seen):
    angles = np.linspace(0.0, 2.0 * np.pi, 5000, endpoint=False)
    ratio = density_ratio(np.cos(angles) * seen / spread, np.array((seen / spread) ** 2), planar=True)
    assert (ratio >= 0.0).all() and ratio.mean() == pytest.approx(1.0, rel=1e-6)


def test_what_points_at_the_camera_has_no_direction_in_the_picture():
    assert np.allclose(density_ratio(np.zeros(5), np.array(0.0), planar=True), 1.0)


@given(SPREAD, st.floats(0.0, np.pi), st.floats(0.0, np.pi))
def test_the_nearer_the_likelier(spread, one, other):
    near, far = sorted((one, other))
    for planar in (False, True):
        ratio = density_ratio(np.cos([near, far]) / spread, np.array(spread**-2.0), planar)
        assert ratio[0] >= ratio[1] - 1e-12
