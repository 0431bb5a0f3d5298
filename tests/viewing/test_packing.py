"""What is packed comes out again."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from nao_sim.viewing.packing import Parcel, unpack

ANY = st.floats(-1e6, 1e6) | st.sampled_from([np.nan, np.inf, -np.inf])


@settings(max_examples=40)
@given(arrays(float, array_shapes(min_side=0, max_dims=2), elements=ANY), st.sampled_from([1e-5, 1e-2]), st.text())
def test_numbers_come_back_within_half_a_step_and_unknown_ones_as_such(values, step, text):
    parcel = Parcel()
    parcel.add("odd", [1, 2, 3], np.uint8)
    parcel.add_rounded("values", values, step)
    parcel.add("faces", [[70000, 1, 2]], np.uint32)
    told, back = unpack(parcel.pack({"text": text}))
    assert told["text"] == text and back["odd"].tolist() == [1, 2, 3] and back["faces"].tolist() == [[70000, 1, 2]]
    known = np.isfinite(values)
    finest = max(step, np.abs(values[known]).max(initial=0.0) / 32766)
    assert back["values"].shape == values.shape and (np.isfinite(back["values"]) == known).all()
    assert np.abs(back["values"][known] - values[known]).max(initial=0.0) <= finest * 0.5001
