"""The thesis's ten features and the directions of the arms: one is the other."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from nao_sim.imitation.features import (
    FEATURES,
    FOREARM,
    LEFT,
    RIGHT,
    UPPER_ARM,
    directions_of,
    elbow_disagreement,
    features_of,
    interior_angle,
)

ANGLES = arrays(float, (10,), elements=st.floats(-3.0, 3.0))
VECTORS = arrays(float, (3, 2, 2, 3), elements=st.floats(-1.0, 1.0))


def row(**degrees):
    return np.radians([degrees.get(name, 0.0) for name in FEATURES])


@pytest.mark.parametrize(
    ("feature", "degrees", "side", "segment", "direction"),
    [
        ("RSR", 90.0, RIGHT, UPPER_ARM, (0, -1, 0)),
        ("LSR", -90.0, LEFT, UPPER_ARM, (0, 1, 0)),
        ("RSP", 90.0, RIGHT, UPPER_ARM, (0, 0, 1)),
        ("LSP", -90.0, LEFT, UPPER_ARM, (0, 0, -1)),
        ("REY", 90.0, RIGHT, FOREARM, (0, -1, 0)),
        ("LEY", -90.0, LEFT, FOREARM, (0, 1, 0)),
        ("RH", 90.0, RIGHT, FOREARM, (0, 0, 1)),
        ("LH", -90.0, LEFT, FOREARM, (0, 0, -1)),
        ("LER", 55.0, LEFT, FOREARM, (1, 0, 0)),
    ],
)
def test_a_feature_turns_its_own_segment_only(feature, degrees, side, segment, direction):
    directions = directions_of(row(**{feature: degrees}))
    expected = np.zeros((2, 2, 3))
    expected[..., 0] = 1.0
    expected[side, segment] = direction
    np.testing.assert_allclose(directions, expected, atol=1e-12)


@given(features=ANGLES)
def test_directions_are_unit_vectors_and_survive_the_round_trip(features):
    directions = directions_of(features)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=-1), 1.0)
    np.testing.assert_allclose(directions_of(features_of(directions)), directions, atol=1e-9)


@given(vectors=VECTORS, scale=st.floats(1e-3, 1e3))
def test_features_do_not_depend_on_the_length_of_the_arm(vectors, scale):
    vectors = np.where(np.linalg.norm(vectors, axis=-1, keepdims=True) < 1e-3, [1.0, 0.0, 0.0], vectors)
    features = features_of(vectors)
    unit = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    np.testing.assert_allclose(directions_of(features), unit, atol=1e-9)
    np.testing.assert_allclose(directions_of(features_of(vectors * scale)), unit, atol=1e-9)
    assert (elbow_disagreement(features) < 1e-7).all()


@given(features=ANGLES)
def test_the_mirror_swaps_sides_and_turns_azimuths_round(features):
    mirrored = np.concatenate([features[5:], features[:5]]) * np.tile([-1.0, 1.0, 1.0, -1.0, 1.0], 2)
    expected = directions_of(features)[::-1] * [1.0, -1.0, 1.0]
    np.testing.assert_array_equal(directions_of(mirrored), expected)


def test_interior_angles_are_exact_where_acos_is_not():
    tiny = 1e-9
    straight = np.array([[[1.0, 0, 0], [1.0, tiny, 0]], [[1.0, 0, 0], [-1.0, tiny, 0]]])
    np.testing.assert_allclose(interior_angle(straight), [np.pi - tiny, tiny], rtol=0, atol=1e-15)


def test_elbow_disagreement_tells_left_from_right():
    features = row(RER=180.0, LER=150.0)
    np.testing.assert_allclose(np.degrees(elbow_disagreement(features))[[LEFT, RIGHT]], [30.0, 0.0], atol=1e-9)


def test_shapes_are_those_of_the_docstrings():
    features = np.zeros((4, 3, 10))
    assert directions_of(features).shape == (4, 3, 2, 2, 3)
    assert features_of(directions_of(features)).shape == (4, 3, 10)
    assert elbow_disagreement(features).shape == (4, 3, 2)
