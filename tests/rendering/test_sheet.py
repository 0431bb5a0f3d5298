"""Sheets of pictures."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from nao_sim.errors import UsageError
from nao_sim.rendering.sheet import KINDS, save_sheet, sheet

RANDOM = np.random.default_rng(0)
PICTURES = [RANDOM.integers(0, 255, (24, 32, 3), dtype=np.uint8) for _ in range(12)]


def _places(whole, picture):
    """Where (N, 2) a picture appears unaltered."""
    height, width = picture.shape[:2]
    windows = np.lib.stride_tricks.sliding_window_view(whole, (height, width, 3))[:, :, 0]
    return np.argwhere((windows == picture).all(axis=(2, 3, 4)))


@given(st.integers(1, 12), st.booleans(), st.none() | st.integers(1, 5))
def test_every_picture_is_on_the_sheet_once_unaltered_and_in_reading_order(count, named, columns):
    whole = sheet(PICTURES[:count], [f"{i} s" if named else "" for i in range(count)], columns)
    places = [_places(whole, picture) for picture in PICTURES[:count]]
    assert [len(found) for found in places] == [1] * count
    order = [tuple(found[0]) for found in places]
    assert order == sorted(order) and len(set(order)) == count


def test_words_take_room_below_their_pictures():
    plain, named = sheet(PICTURES[:4], [""] * 4), sheet(PICTURES[:4], ["a", "b", "c", "d"])
    assert named.shape[0] > plain.shape[0] and named.shape[1] == plain.shape[1]


@pytest.mark.parametrize("kind", KINDS)
def test_it_is_written_as_every_kind(tmp_path, kind):
    path = tmp_path / f"sheet{kind}"
    save_sheet(PICTURES[0], path)
    if kind == ".pdf":
        assert path.read_bytes().startswith(b"%PDF")
        return
    with Image.open(path) as image:
        assert image.size == (32, 24)
        assert kind != ".png" or np.array_equal(np.asarray(image), PICTURES[0])


def test_another_kind_is_refused_with_the_known_ones(tmp_path):
    with pytest.raises(UsageError, match=r"sheet\.mp4: cannot write '\.mp4' pictures; expected \.png, "):
        save_sheet(PICTURES[0], tmp_path / "sheet.mp4")
    assert not list(tmp_path.iterdir())
