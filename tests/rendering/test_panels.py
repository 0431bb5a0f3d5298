"""Pictures of several views: each part is what its camera alone would show."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.rendering.arrangements import View, arrangement_names, load_arrangement, views_of
from nao_sim.rendering.captions import Captions, Script, Title
from nao_sim.rendering.frames import Pool
from nao_sim.rendering.presets import load_camera
from nao_sim.rendering.tint import Tint
from nao_sim.rendering.video import turns, write_video

from .conftest import SIZE

HALVES = (View(load_camera("front"), (0.0, 0.0, 0.5, 1.0)), View(load_camera("orbit"), (0.5, 0.0, 0.5, 1.0)))
CLOCK = Tint(script=Script(letter=0.08, titles=(Title("asked", 0.25, 0.0),), clock=True))


def pictures(model, rows, views, backend, tint=None, workers=1, size=SIZE, quality="standard"):
    with Pool(model, size, views, quality, backend, workers, tint) as pool:
        return np.array([picture.copy() for picture in pool.paint(rows)])


def two_of(poses, views=HALVES):
    """Rows of two views: the poses, and the poses in reverse."""
    return np.hstack([poses, poses[::-1], turns(views, 7.0 * np.arange(len(poses)))])


def test_each_half_is_the_picture_that_its_camera_alone_takes(model, poses, backend):
    half = (SIZE[0] // 2, SIZE[1])
    both = pictures(model, two_of(poses), HALVES, backend, quality="draft")
    alone = [
        pictures(model, np.hstack([shown, turns((view,), 7.0 * np.arange(20))]), (View(view.camera),), backend,
                 size=half, quality="draft")
        for view, shown in zip(HALVES, (poses, poses[::-1]), strict=True)
    ]  # fmt: skip
    assert np.array_equal(both, np.concatenate(alone, axis=2))


@pytest.mark.parametrize("name", ["compare", "eyes"])
def test_pixels_depend_on_the_row_alone_not_on_workers_or_the_frames_before(model, poses, backend, name):
    views = views_of(load_arrangement(name), "front")
    clock = np.floor(np.linspace(0.0, 3.0, 8))[:, None] / 10.0
    rows = np.hstack([*[poses[:8]] * len(views), turns(views, np.arange(8.0)), clock])
    one, two = (pictures(model, rows, views, backend, CLOCK, workers) for workers in (1, 2))
    assert np.array_equal(one, two)
    assert np.array_equal(one[::-1], pictures(model, rows[::-1], views, backend, CLOCK))


def test_a_frame_in_which_the_clock_alone_ticks_differs_there_alone(model, poses, backend):
    rows = np.hstack([poses[[3, 3]], [[0.4], [0.5]]])
    before, after = pictures(model, rows, (View(load_camera("front")),), backend, CLOCK)
    changed = (before != after).any(axis=-1)
    assert changed.any() and not changed[: SIZE[1] // 2].any() and not changed[:, : SIZE[0] // 2].any()


def test_a_film_of_two_views_takes_two_poses_a_frame(model, poses, backend, tmp_path):
    with Pool(model, SIZE, HALVES, "draft", backend, 1) as pool:
        both = np.hstack([poses, poses])
        report = write_video(model, both, tmp_path / "a.gif", fps=25, size=SIZE, quality="draft", pool=pool)
    assert report.frames == 20


@given(st.integers(2, 400), st.integers(2, 400))
def test_halves_share_no_pixel_and_leave_none(width, height):
    boxes = [view.box((width, height)) for view in HALVES]
    assert boxes[0][0] == 0 and boxes[0][0] + boxes[0][2] == boxes[1][0] and boxes[1][0] + boxes[1][2] == width
    assert {box[1:2] + box[3:] for box in boxes} == {(0, height)}


@pytest.mark.parametrize("name", arrangement_names())
@given(st.integers(1, 300), st.integers(1, 300))
def test_every_part_is_inside_any_picture(name, width, height):
    for view in views_of(load_arrangement(name), "front"):
        left, top, wide, tall = view.box((width, height))
        assert left >= 0 and top >= 0 and wide >= 1 and tall >= 1
        assert left + wide <= max(width, left + 1) and top + tall <= max(height, top + 1)


@given(st.integers(1, 200), st.integers(1, 120), st.floats(0.0, 9e4))
def test_the_time_fits_any_picture_and_says_tenths(width, height, seconds):
    def picture(at):
        shown = np.full((height, width, 3), 128, np.uint8)
        Captions(Script(letter=0.06, clock=True), (width, height)).draw(np.array([at]), shown)
        return shown

    tenths = np.floor(10.0 * seconds) / 10.0
    assert np.array_equal(picture(tenths), picture(tenths + 0.01))
