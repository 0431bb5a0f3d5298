"""Colours and captions in the films of a small model."""

import av
import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.errors import UsageError
from nao_sim.rendering import Tint, Tinted, write_video
from nao_sim.rendering.captions import Captions, Label, Script
from nao_sim.rendering.frames import Pool
from nao_sim.rendering.tint import cover

from .conftest import SIZE, XML

BODY, ARM = 1, 2  # geoms of the small model
GREEN = (0.1, 0.8, 0.2)
LABELS = Script((Label("slow", GREEN), Label("stop", (0.8, 0.1, 0.1))), 0.08)
TINT = Tint(((BODY,), (ARM,)), ((1.0,), (1.0,)), LABELS)
PLAIN = np.zeros(TINT.width)
share = st.floats(0.0, 1.0)
colour = st.tuples(share, share, share)


def pictures(model, rows, backend, tint=None, workers=1, quality="standard"):
    with Pool(model, SIZE, "three-quarter", quality, backend, workers, tint) as pool:
        return [picture.copy() for picture in pool.paint(rows)]


def row(body=0.0, arm=0.0, opacities=(0.0, 0.0)):
    """A row of the tint with both parts covered by green."""
    covers = np.stack([cover(np.zeros(4), GREEN, opacity) for opacity in (body, arm)])
    return TINT.row(covers, np.asarray(opacities))


def painted_by_hand(**colours):
    """The small model, its geoms of other colours from the start."""
    model = mujoco.MjModel.from_xml_string(XML)
    for geom, rgb in colours.items():
        model.geom_rgba[{"body": BODY, "arm": ARM}[geom], :3] = rgb
    return model


def test_a_tint_that_shows_nothing_changes_no_pixel(model, poses, backend):
    tinted = np.hstack([poses, np.tile(PLAIN, (len(poses), 1))])
    assert np.array_equal(pictures(model, tinted, backend, TINT), pictures(model, poses, backend))


@pytest.mark.parametrize("part", ["body", "arm"])
def test_a_covered_part_looks_as_if_it_were_of_that_colour_and_the_rest_as_ever(model, poses, backend, part):
    shown = pictures(model, [np.append(poses[3], row(**{part: 1.0}))], backend, TINT)
    by_hand = painted_by_hand(**{part: GREEN})
    assert np.array_equal(shown, pictures(by_hand, poses[3:4], backend))
    assert not np.array_equal(shown, pictures(model, poses[3:4], backend))


def test_half_a_cover_is_a_colour_half_way(model, poses, backend):
    shown = pictures(model, [np.append(poses[3], row(arm=0.5))], backend, TINT)
    half = (model.geom_rgba[ARM, :3] + GREEN) / 2
    assert np.array_equal(shown, pictures(painted_by_hand(arm=half), poses[3:4], backend))


def test_pixels_depend_on_the_row_alone_not_on_workers_or_the_frames_before(model, poses, backend):
    rng = np.random.default_rng(2)
    levels = rng.uniform(0.0, 1.0, (len(poses), 4)) * rng.integers(0, 2, (len(poses), 4))
    rows = np.array([np.append(pose, row(*level[:2], level[2:])) for pose, level in zip(poses, levels, strict=True)])
    one, two = (pictures(model, rows, backend, TINT, workers) for workers in (1, 2))
    assert np.array_equal(one, two)
    assert np.array_equal(one[::-1], pictures(model, rows[::-1], backend, TINT))


def test_a_part_at_rest_takes_colour_and_loses_it_again(backend, poses):
    still = "<body pos='0.26 0.42 0.05'><geom size='0.04' rgba='0.9 0.9 0.9 1'/></body></worldbody>"
    model = mujoco.MjModel.from_xml_string(XML.replace("</worldbody>", still))
    tint = Tint(((model.ngeom - 1,),), ((1.0,),))
    rows = [np.append(poses[0], (*GREEN, 1.0)), np.append(poses[0], np.zeros(4))]
    coloured, plain = pictures(model, rows, backend, tint)
    assert np.array_equal(plain, pictures(model, poses[:1], backend)[0])
    model.geom_rgba[-1, :3] = GREEN
    changed = np.abs(coloured.astype(int) - pictures(model, poses[:1], backend)[0]).max(axis=-1) > 3
    assert (coloured != plain).any(axis=-1).sum() > 20 and changed.mean() < 1e-3


def test_materials_lend_their_colour(backend, poses):
    blue = XML.replace("</asset>", "<material name='blue' rgba='0.2 0.3 0.9 1'/></asset>")
    model = mujoco.MjModel.from_xml_string(blue.replace('rgba="0.9 0.9 0.9 1"', "material='blue'"))
    half = pictures(model, [np.append(poses[3], row(arm=0.5))], backend, TINT)
    model.geom_rgba[ARM, :3] = (np.array((0.2, 0.3, 0.9)) + GREEN) / 2
    assert np.array_equal(half, pictures(model, poses[3:4], backend))


def test_a_gif_has_the_colour_of_a_short_moment(model, poses, backend, tmp_path):
    rows = np.tile(PLAIN, (len(poses), 1))
    rows[7] = row(body=1.0)
    report = write_video(
        model, poses, tmp_path / "a.gif", fps=25, size=SIZE, quality="draft", backend=backend, tinted=Tinted(TINT, rows)
    )
    with av.open(str(report.path)) as container:
        frames = [frame.to_ndarray(format="rgb24").astype(int) for frame in container.decode(video=0)]
    greenest = [(frame[..., 1] - frame[..., [0, 2]].max(axis=-1)).max() for frame in frames]
    assert np.argmax(greenest) == 7 and greenest[7] > 80 and np.delete(greenest, 7).max() < 30


def test_a_tint_of_another_length_is_refused(model, poses, tmp_path):
    with pytest.raises(UsageError, match=r"a tint of shape \(1, 10\) cannot be rendered; expected \(20, 10\)"):
        write_video(model, poses, tmp_path / "a.mp4", fps=25, tinted=Tinted(TINT, PLAIN[None]))


def test_a_tint_travels_as_text():
    assert Tint.from_json(TINT.to_json()) == TINT


@given(st.lists(st.tuples(colour, share), min_size=1, max_size=5))
def test_covers_stay_colours_and_the_last_opaque_one_wins(layers):
    covers = np.zeros(4)
    for rgb, opacity in layers:
        covers = cover(covers, rgb, np.float64(opacity))
        assert (covers >= 0.0).all() and (covers[:3] <= covers[3] + 1e-12).all() and covers[3] <= 1.0 + 1e-12
    np.testing.assert_array_equal(cover(covers, GREEN, np.float64(1.0)), (*GREEN, 1.0))
    np.testing.assert_array_equal(cover(covers, GREEN, np.float64(0.0)), covers)


@given(st.integers(1, 200), st.integers(1, 120), share, share)
def test_captions_fit_any_picture_and_touch_its_lower_left_alone(width, height, first, second):
    picture = np.full((height, width, 3), 128, np.uint8)
    Captions(Script(LABELS.labels, 0.05), (width, height)).draw(np.array([first, second]), picture)
    touched = (picture != 128).any(axis=-1)
    if first == second == 0.0:
        assert not touched.any()
    if height >= 100 and width >= 100:
        assert not touched[: height // 2].any() and not touched[:, 80:].any()
        assert touched.any() or max(first, second) < 0.02  # which may be less than a pixel's step


def test_a_caption_slides_up_as_another_comes_in_below_it():
    def top_of_upper(level):
        picture = np.zeros((120, 160, 3), np.uint8)
        labels = (Label("lower", (0.0, 0.0, 0.0)), Label("upper", (1.0, 0.0, 0.0)))
        Captions(Script(labels, 0.08), (160, 120)).draw(np.array([level, 1.0]), picture)
        reddest = picture[..., 0].astype(int) - picture[..., 1]
        return np.flatnonzero((reddest > 100).any(axis=1)).min()

    places = [top_of_upper(level) for level in (0.0, 0.3, 0.6, 1.0)]
    assert places == sorted(places, reverse=True) and places[0] - places[-1] > 8
