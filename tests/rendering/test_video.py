"""Films of a small model."""

import os
import signal
import subprocess
import sys
import textwrap
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import av
import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from nao_sim.errors import RenderingError, UsageError
from nao_sim.rendering import render_still, save_png, write_video
from nao_sim.rendering.frames import Pool
from nao_sim.rendering.presets import load_camera
from nao_sim.rendering.video import check_rate, runs

from .conftest import SIZE, XML


def film(model, poses, path, backend, **options):
    return write_video(
        model, poses, path, **{"fps": 25, "size": SIZE, "quality": "draft", "backend": backend} | options
    )


def decode(path):
    with av.open(str(path)) as container:
        return [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]


@pytest.mark.parametrize("kind", ["mp4", "webm", "gif"])
def test_a_film_has_all_frames_at_the_right_size_and_shows_the_motion(model, poses, backend, tmp_path, kind):
    said = []
    report = film(model, poses, tmp_path / f"a.{kind}", backend, progress=lambda *at: said.append(at))
    frames = decode(report.path)
    assert (report.frames, report.painted, len(frames)) == (20, 20, 20)
    assert frames[0].shape == (120, 160, 3) and np.abs(frames[0].astype(int) - frames[-1]).max() > 50
    assert said == [(i + 1, 20) for i in range(20)]
    with av.open(str(report.path)) as container:
        assert float(container.duration / av.time_base) == pytest.approx(20 / 25, abs=0.05)


def test_an_mp4_is_what_every_player_takes(model, poses, backend, tmp_path):
    path = film(model, poses[:2], tmp_path / "a.mp4", backend).path
    data = path.read_bytes()
    assert data.index(b"moov") < data.index(b"mdat")
    with av.open(str(path)) as container:
        context = container.streams.video[0].codec_context
        assert (context.name, context.pix_fmt, context.colorspace) == ("h264", "yuv420p", 1)


def test_frames_go_into_a_numbered_folder(model, poses, backend, tmp_path):
    report = film(model, poses[:3], tmp_path / "a.png", backend)
    assert report.path == tmp_path / "a"
    assert sorted(p.name for p in report.path.iterdir()) == [f"frame_0000{i}.png" for i in (1, 2, 3)]
    still = render_still(model, poses[1], SIZE, quality="draft", backend=backend)
    assert np.array_equal(np.asarray(Image.open(report.path / "frame_00002.png")), still)


@pytest.mark.parametrize("camera", ["three-quarter", "orbit", "head"])
def test_pixels_do_not_depend_on_the_number_of_workers(model, poses, backend, camera):
    poses = np.hstack([poses, load_camera(camera).rows(7.0 * np.arange(len(poses)))])
    painted = []
    for workers in (1, 2):
        with Pool(model, SIZE, camera, "standard", backend, workers) as pool:
            painted.append([picture.copy() for picture in pool.paint(poses)])
    assert len(painted[0]) == len(poses)
    assert np.array_equal(*painted)


def test_equal_frames_in_a_row_are_painted_once(model, poses, backend, tmp_path):
    report = film(model, poses[[0, 0, 0, 5, 5, 0]], tmp_path / "a.mp4", backend)
    assert (report.frames, report.painted, len(decode(report.path))) == (6, 3, 6)


@pytest.mark.parametrize(("fps", "shown"), [(100, 10), (30, 20)])
def test_a_gif_keeps_the_speed_where_viewers_cannot_follow(model, poses, backend, tmp_path, fps, shown):
    path = film(model, poses, tmp_path / "a.gif", backend, fps=fps).path
    assert len(decode(path)) in (shown, shown + 1)
    with av.open(str(path)) as container:
        assert float(container.duration / av.time_base) == pytest.approx(20 / fps, abs=0.05)


@pytest.mark.parametrize("size", [(161, 120), (160, 121)])
def test_odd_sizes_are_refused_for_video_and_taken_for_pictures(model, poses, backend, tmp_path, size):
    with pytest.raises(UsageError, match=r"even width and height.*try 16[02]x12[02]"):
        film(model, poses[:2], tmp_path / "a.mp4", backend, size=size)
    assert not list(tmp_path.iterdir())
    assert render_still(model, poses[0], size, quality="draft", backend=backend).shape == (size[1], size[0], 3)


@pytest.mark.parametrize("camera", ["front", "side", "top", "head"])
def test_every_camera_sees_something_and_a_shadow_shows(model, poses, backend, camera):
    plain, shaded = (render_still(model, poses[0], SIZE, camera, q, backend) for q in ("draft", "standard"))
    assert plain.std() > 3 and not np.array_equal(plain, shaded)


def test_a_camera_that_the_model_lacks_is_a_usage_error(backend):
    import mujoco

    bare = mujoco.MjModel.from_xml_string("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>")
    with pytest.raises(UsageError, match=r"camera 'head' needs a model with a camera named CameraTop"):
        render_still(bare, np.zeros(0), SIZE, "head", "draft", backend)


def test_when_a_worker_dies_expect_one_clear_error(model, poses, backend, tmp_path):
    def kill_workers(done, _):
        if done == 2:
            for child in Path(f"/proc/self/task/{os.getpid()}/children").read_text().split():
                os.kill(int(child), signal.SIGKILL)

    with pytest.raises(RenderingError, match=r"a rendering process died .*signal 9"):
        film(model, np.tile(poses, (5, 1)), tmp_path / "a.mp4", backend, progress=kill_workers, workers=2)
    assert not list(tmp_path.iterdir())


def test_when_the_program_in_between_fails_expect_nothing_left(model, poses, backend, tmp_path):
    def interrupt(done, _):
        if done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        film(model, poses, tmp_path / "a.mp4", backend, progress=interrupt)
    assert not list(tmp_path.iterdir())
    assert not Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()


@pytest.mark.parametrize(("stop", "clean"), [(signal.SIGINT, True), (signal.SIGKILL, False)])
def test_when_killed_in_mid_render_expect_no_film(backend, tmp_path, stop, clean):
    script = """
        import signal, sys, mujoco, numpy as np
        from nao_sim.rendering import write_video
        signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it
        model = mujoco.MjModel.from_xml_string(
            "<mujoco><worldbody><light pos='0 0 1'/><body><joint/><geom size='.3'/></body></worldbody></mujoco>")
        write_video(model, np.arange(1e5)[:, None], sys.argv[1], fps=30, size=(64, 48), quality="draft",
                    progress=lambda done, total: print(done, flush=True))
    """
    command = [sys.executable, "-c", textwrap.dedent(script), str(tmp_path / "a.mp4")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
        assert process.stdout.readline() == b"1\n"
        workers = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        process.send_signal(stop)
        process.wait(120)
    assert workers and not (tmp_path / "a.mp4").exists()
    if clean:
        assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("poses", "message"),
    [
        (np.zeros((0, 2)), r"shape \(0, 2\).*expected \(frames, 2\)"),
        (np.zeros((3, 5)), r"shape \(3, 5\)"),
        (np.array([[0, 0], [0, np.nan]]), "frame 2: .*not finite"),
    ],
)
def test_poses_that_are_none_are_refused(model, tmp_path, poses, message):
    with pytest.raises(UsageError, match=message):
        write_video(model, poses, tmp_path / "a.mp4", fps=25)


@pytest.mark.parametrize("fps", [0, -1, float("nan"), float("inf"), 2000])
def test_rates_that_are_none_are_refused(fps):
    with pytest.raises(UsageError, match=r"frames a second"):
        check_rate(fps)


def test_television_rates_stay_exact():
    assert check_rate(30000 / 1001) == Fraction(30000, 1001)


@given(st.lists(st.tuples(st.integers(0, 2), st.integers(1, 4)), min_size=1, max_size=12))
def test_runs_tell_the_film_again(pieces):
    poses = np.array([[float(value)] for value, times in pieces for _ in range(times)])
    first, times = runs(poses)
    assert np.array_equal(np.repeat(poses[first], times, axis=0), poses)
    assert all(poses[a] != poses[b] for a, b in pairwise(first))


def test_slow_motion_is_not_lost():
    poses = np.linspace(0, 1e-3, 1001)[:, None]
    first, times = runs(poses)
    assert len(first) > 80 and np.abs(np.repeat(poses[first], times, axis=0) - poses).max() <= 1e-5


def test_a_still_is_saved_whole(model, poses, backend, tmp_path):
    picture = render_still(model, poses[0], SIZE, quality="draft", backend=backend)
    save_png(picture, tmp_path / "a.png")
    assert np.array_equal(np.asarray(Image.open(tmp_path / "a.png")), picture)
    with pytest.raises(UsageError, match=r"stills are written as .png"):
        save_png(picture, tmp_path / "a.jpg")


def pictures(report):
    return [np.asarray(Image.open(path)).astype(int) for path in sorted(report.path.iterdir())]


def test_an_orbit_goes_once_round_and_ends_where_it_began(model, poses, backend, tmp_path):
    camera = load_camera("orbit")
    still = np.repeat(poses[:1], 5, axis=0)
    first, quarter, half, _, last = pictures(
        film(model, still, tmp_path / "a.png", backend, camera="orbit", fps=4 / camera.turn_s)
    )
    assert np.array_equal(first, last)
    assert all(np.abs(first - other).max() > 50 for other in (quarter, half))


def test_a_camera_that_follows_sees_a_body_that_travels_in_the_same_place(backend, tmp_path):
    travelling = mujoco.MjModel.from_xml_string(XML.replace('axis="0 0 1"', 'axis="1 0 0"'))
    ways = np.array([[0.0, 0.0], [0.25, 0.0]])  # a tile of the floor is 0.25 m, so that it looks alike, too
    seen = {}
    for camera in ("follow", "three-quarter"):
        here, there = pictures(film(travelling, ways, tmp_path / f"{camera}.png", backend, camera=camera))
        body = (here[..., 0] - here[..., 2] > 60, there[..., 0] - there[..., 2] > 60)
        seen[camera] = (body[0] & body[1]).sum() / (body[0] | body[1]).sum()
    assert seen["follow"] > 0.95
    assert seen["three-quarter"] < 0.7
