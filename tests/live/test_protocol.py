"""Whatever comes is a message or a refusal that says what was found; nothing else."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.live.problem import LiveError
from nao_sim.live.protocol import LARGEST, Frame, Hello, Order, binary_frame, pack, parse

JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=5) | st.dictionaries(st.text(max_size=6), inner, max_size=5),
    max_leaves=12,
)
KEYS = st.sampled_from(
    ["type", "time", "points", "role", "layout", "mode", "mirror", "unit", "axes", "rate", "on", "x"]
)
TYPES = st.sampled_from(["hello", "frame", "config", "pause", "replay", "ping", "bye", "nonsense"])


def _message_or_refusal(data: str | bytes) -> object:
    try:
        return parse(data)
    except LiveError as problem:
        assert "expected" in str(problem)
        assert len(str(problem)) < 400, "garbage is not sent back whole"
        return None


@settings(max_examples=60)
@given(st.text(max_size=60) | st.binary(max_size=60) | st.binary(max_size=60).map(lambda tail: b"NF\x01\x03" + tail))
def test_garbage_is_refused_in_one_sentence(data):
    _message_or_refusal(data)


@settings(max_examples=60)
@given(TYPES, st.dictionaries(KEYS, JSON, max_size=6))
def test_wrong_values_are_refused_in_one_sentence_and_a_frame_is_finite_or_missing(kind, fields):
    message = _message_or_refusal(json.dumps({**fields, "type": kind}))
    if isinstance(message, Frame):
        assert np.isfinite(message.time)
        assert not np.isinf(message.points).any()
        assert (np.isnan(message.confidence) | (message.confidence <= 1.0)).all()


@settings(max_examples=20)
@given(st.integers(1, 40), st.floats(-1e9, 1e9), st.integers(0, 10))
def test_a_frame_survives_the_binary_form(count, time, seed):
    random = np.random.default_rng(seed)
    points = np.float32(random.normal(size=(count, 3))).astype(float)
    points[random.random(count) < 0.2] = np.nan
    back = binary_frame(pack(Frame(time, points, np.ones(count))))
    assert back.time == time
    np.testing.assert_array_equal(back.points, points)


@pytest.mark.parametrize("point", [[1, 2, 3], [1, 2, 3, 0.5], {"x": 1, "y": 2, "z": 3}, {"x": 1, "y": 2, "z": 3,
                                   "visibility": 0.5}])  # fmt: skip
def test_points_come_as_lists_or_as_mediapipe_has_them(point):
    frame = parse(json.dumps({"time": 1, "points": [point, point, None, point]}))
    assert isinstance(frame, Frame)
    np.testing.assert_array_equal(frame.points, [[1, 2, 3], [1, 2, 3], [np.nan] * 3, [1, 2, 3]])


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("", "bad_json"),
        ("[" * 60000, "bad_json"),
        ('{"type": "fly"}', "unknown_type"),
        ('{"type": ["frame"]}', "unknown_type"),
        ('{"time": 1, "points": []}', "bad_frame"),
        ('{"time": NaN, "points": [[0, 0, 0]]}', "bad_frame"),
        ('{"time": 1, "points": [["a", 0, 0]]}', "bad_frame"),
        ('{"time": 1, "points": ' + json.dumps([[0, 0, 0]] * 257) + "}", "bad_frame"),
        ('{"type": "hello", "protocol": 2}', "bad_version"),
        ('{"type": "hello", "rate": 1000}', "bad_message"),
        ('{"type": "hello", "axes": ["+x", "-x", "+y"]}', "bad_message"),
        ('{"type": "hello", "unit": "parsec"}', "bad_message"),
        ("x" * (LARGEST + 1), "too_large"),
    ],
)
def test_each_mistake_has_its_code(text, code):
    with pytest.raises(LiveError) as refusal:
        parse(text)
    assert refusal.value.code == code


def test_a_hello_and_orders_say_what_is_wanted():
    hello = parse('{"type": "hello", "layout": "kinect_v2", "unit": "mm", "axes": ["-z", "-x", "+y"], "rate": 25}')
    assert hello == Hello(layout="kinect_v2", unit=0.001, axes=("-z", "-x", "+y"), rate=25)
    assert parse('{"type": "pause", "on": false}') == Order("pause", on=False)
