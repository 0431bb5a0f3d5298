"""A sequence of poses as a film."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nao_sim.errors import UsageError
from nao_sim.rendering.arrangements import View
from nao_sim.rendering.backend import Backend, choose_backend
from nao_sim.rendering.frames import Pool, default_workers
from nao_sim.rendering.preset_kinds import Quality
from nao_sim.rendering.presets import load_camera, load_quality

if TYPE_CHECKING:
    import mujoco

    from nao_sim.rendering.encode import Encoder, Picture
    from nao_sim.rendering.tint import Tint, Tinted

Progress = Callable[[int, int], None]
SIZE = (640, 480)
_SAME_POSE = 1e-5  # rad or m: a few micrometres at the fingertips, far below a pixel
_SAMPLES = 8  # pictures that a palette is made from
_LARGEST_SIDE = 8192  # pixels
_MOST_FPS = 1000


@dataclass(frozen=True)
class RenderReport:
    """What was rendered.

    Attributes:
        path: the file, or the folder of frames.
        frames: frames in it.
        painted: frames that had to be painted; the others repeat the one before.
        seconds: wall clock time it took.
        backend: what rendered.
        workers: rendering processes.
    """

    path: Path
    frames: int
    painted: int
    seconds: float
    backend: Backend
    workers: int


def write_video(  # noqa: PLR0913  # the options of the command line
    model: mujoco.MjModel,
    qpos: ArrayLike,
    path: str | Path,
    *,
    fps: float,
    size: tuple[int, int] = SIZE,
    camera: str = "three-quarter",
    quality: str = "standard",
    backend: Backend | None = None,
    progress: Progress | None = None,
    workers: int | None = None,
    pool: Pool | None = None,
    tinted: Tinted | None = None,
) -> RenderReport:
    """Render poses into `path`; its extension says what: .mp4 (H.264), .webm (VP9), .gif or .png.

    `.png` gives a folder named like the file without extension, with `frame_00001.png` on in it.  The result appears
    whole or not at all, and replaces an older one.  Pixels do not depend on the number of workers.

    Args:
        model: the scene.
        qpos: (N, model.nq) poses, one a frame; where the pool has several views, (N, views * model.nq), one a view.
        path: what to write.
        fps: frames a second.
        size: (width, height) in pixels; .mp4 and .webm need even numbers.
        camera: name of a camera preset.
        quality: name of a quality preset.
        backend: what renders; `choose_backend()` where None.
        progress: called with (frames done, frames in all) after each frame.
        workers: rendering processes; suited to the machine where None.
        pool: processes that `start_pool` has started for this model, size, camera, quality and tint; they stay open.
        tinted: colours and words that the frames show besides.

    Raises:
        UsageError: an argument that cannot be honoured, a folder that cannot be written.
        RenderingError: nothing can render here, or a rendering process failed.
    """
    from nao_sim.rendering.files import KINDS, NEEDS_SAMPLES, draft_of, target_of

    began, path = time.perf_counter(), Path(path)
    kind, preset, rate = check_film(path, fps, size, camera, quality)
    views = pool.views if pool else (View(load_camera(camera)),)
    poses = check_poses(model, qpos, len(views))
    rows = rows_of(poses, turns(views, np.arange(len(poses)) / fps), tinted)
    first, times = runs(rows)
    with draft_of(path) as draft, ExitStack() as stack:
        if pool is None:
            pool = start_pool(
                model, len(first), size, camera, quality, backend, workers, tinted.tint if tinted else None
            )
            stack.enter_context(pool)
        samples = _samples(pool, rows, poses.shape[1]) if kind in NEEDS_SAMPLES else []
        with closing(KINDS[kind](draft, size, rate, preset, samples)) as encoder:
            _encode(encoder, pool.paint(rows[i] for i in first), times, progress)
            encoder.finish()
    seconds = time.perf_counter() - began
    return RenderReport(target_of(path), len(rows), len(first), seconds, pool.backend, pool.workers)


def start_pool(
    model: mujoco.MjModel,
    frames: int,
    size: tuple[int, int],
    camera: str | tuple[View, ...],
    quality: str,
    backend: Backend | None = None,
    workers: int | None = None,
    tint: Tint | None = None,
) -> Pool:
    """Start rendering processes, which get ready beside other work; close them, or use them in a `with` block.

    Args:
        model: the scene.
        frames: about how many frames will be painted.
        size: (width, height) in pixels.
        camera: name of a camera preset, or the parts of the picture.
        quality: name of a quality preset.
        backend: what renders; `choose_backend()` where None.
        workers: how many; suited to the machine and the number of frames where None.
        tint: what may take colour, if anything.

    Raises:
        RenderingError: nothing can render here.
    """
    backend = backend or choose_backend()
    return Pool(model, size, camera, quality, backend, workers or default_workers(backend, frames), tint)


def check_film(
    path: Path, fps: float, size: tuple[int, int], camera: str, quality: str
) -> tuple[str, Quality, Fraction]:
    """The kind of file, quality and exact rate of a film that can be written, checked before any work is done.

    Raises:
        UsageError: an argument that cannot be honoured.
    """
    from nao_sim.rendering.files import check_even, kind_of

    kind = kind_of(path)
    check_size(size)
    check_even(kind, size)
    load_camera(camera)
    return kind, load_quality(quality), check_rate(fps)


def runs(poses: NDArray[np.float64]) -> tuple[list[int], list[int]]:
    """Consecutive poses (N, nq) that look the same: index of the first of each run, and the runs' lengths.

    A pose belongs to a run while it is within 1e-5 of the run's first pose, so slow motion is not lost.
    """
    first = [0]
    for i in range(1, len(poses)):
        if not np.abs(poses[i] - poses[first[-1]]).max(initial=0.0) <= _SAME_POSE:
            first.append(i)
    return first, np.diff([*first, len(poses)]).tolist()


def turns(views: tuple[View, ...], times: NDArray[np.float64]) -> NDArray[np.float64]:
    """The numbers (N, ...) of the cameras of all views at times (N,) s."""
    return np.hstack([view.camera.rows(times) for view in views])


def check_poses(model: mujoco.MjModel, qpos: ArrayLike, views: int = 1) -> NDArray[np.float64]:
    """Poses (N, views * nq) of `model`, at least one, all finite.

    Raises:
        UsageError: anything else.
    """
    poses = np.asarray(qpos, np.float64)
    if poses.shape[1:] != (views * model.nq,) or len(poses) == 0:
        raise UsageError(f"poses of shape {poses.shape} cannot be rendered; expected (frames, {views * model.nq})")
    if not np.isfinite(poses).all():
        frame = int(np.flatnonzero(~np.isfinite(poses).all(axis=1))[0])
        raise UsageError(f"frame {frame + 1}: the pose has values that are not finite")
    return poses


def check_rate(fps: float) -> Fraction:
    """Frames a second as a fraction, 29.97 being 30000/1001's neighbour 2997/100.

    Raises:
        UsageError: not between 0 and 1000.
    """
    if not (math.isfinite(fps) and 0 < fps <= _MOST_FPS):
        raise UsageError(f"{fps} frames a second cannot be written; expected more than 0 and at most {_MOST_FPS}")
    return Fraction(fps).limit_denominator(1001)


def check_size(size: tuple[int, int]) -> None:
    """A picture's (width, height).

    Raises:
        UsageError: a side is not between 1 and 8192 pixels.
    """
    if not all(1 <= side <= _LARGEST_SIDE for side in size):
        raise UsageError(f"size {'x'.join(map(str, size))} cannot be rendered; expected 1 to {_LARGEST_SIDE} a side")


def rows_of(poses: NDArray[np.float64], turned: NDArray[np.float64], tinted: Tinted | None) -> NDArray[np.float64]:
    """What each of N pictures is made of: the pose, where the camera is, what the tint shows.

    Raises:
        UsageError: not as many rows of the tint as poses, or of another width.
    """
    seen = np.hstack([poses, turned])
    if tinted is None:
        return seen
    wanted = len(poses), tinted.tint.width
    if tinted.rows.shape != wanted:
        raise UsageError(f"a tint of shape {tinted.rows.shape} cannot be rendered; expected {wanted}")
    return np.hstack([seen, tinted.rows])


def _samples(pool: Pool, rows: NDArray[np.float64], posed: int) -> list[Picture]:
    """Pictures spread over the whole film, and those that show most of each colour of a tint (past `posed` columns)."""
    spread = np.linspace(0, len(rows) - 1, _SAMPLES).round().astype(int)
    indices = np.unique(np.concatenate([spread, rows[:, posed:].argmax(axis=0)]))
    return [picture.copy() for picture in pool.paint(rows[indices])]


def _encode(encoder: Encoder, pictures: Iterator[Picture], times: list[int], progress: Progress | None) -> None:
    done, total = 0, sum(times)
    for picture, repeats in zip(pictures, times, strict=True):
        encoder.add(picture, repeats)
        done += repeats
        if progress is not None:
            progress(done, total)
