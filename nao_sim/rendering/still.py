"""Poses as pictures."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nao_sim.errors import UsageError
from nao_sim.rendering.backend import Backend, choose_backend
from nao_sim.rendering.frames import Pool, default_workers
from nao_sim.rendering.tint import Tinted
from nao_sim.rendering.video import SIZE, check_poses, check_size, rows_of, turns

if TYPE_CHECKING:
    import mujoco

Array = NDArray[np.float64]


def render_still(
    model: mujoco.MjModel,
    qpos: ArrayLike,
    size: tuple[int, int] = SIZE,
    camera: str = "three-quarter",
    quality: str = "fine",
    backend: Backend | None = None,
) -> NDArray[np.uint8]:
    """The pose `qpos` (nq,) as a picture (height, width, 3), top row first; see `render_stills`."""
    return render_stills(model, np.atleast_2d(np.asarray(qpos, np.float64))[:1], size, camera, quality, backend)[0]


def render_stills(
    model: mujoco.MjModel,
    qpos: ArrayLike,
    size: tuple[int, int] = SIZE,
    camera: str = "three-quarter",
    quality: str = "fine",
    backend: Backend | None = None,
) -> list[NDArray[np.uint8]]:
    """Poses `qpos` (N, nq) as pictures (height, width, 3), top row first.

    Args:
        model: the scene.
        qpos: (N, nq) the poses.
        size: (width, height) in pixels.
        camera: name of a camera preset.
        quality: name of a quality preset.
        backend: what renders; `choose_backend()` where None.

    Raises:
        UsageError: an argument that cannot be honoured.
        RenderingError: nothing can render here, or the rendering process failed.
    """
    poses = check_poses(model, qpos)
    check_size(size)
    backend = backend or choose_backend()
    with Pool(model, size, camera, quality, backend, default_workers(backend, len(poses))) as pool:
        return paint_stills(pool, poses, np.zeros(len(poses)), size)


def paint_stills(
    pool: Pool, poses: Array, times: Array, size: tuple[int, int], tinted: Tinted | None = None
) -> list[NDArray[np.uint8]]:
    """Single pictures (height, width, 3), top row first.

    Args:
        pool: processes started for the poses' model, this size, and the tint.
        poses: (N, views * nq).
        times: (N,) s, when they are, for a camera that goes round.
        size: (width, height) in pixels.
        tinted: colours and words that the pictures show besides.

    Raises:
        RenderingError: the rendering process failed.
    """
    from nao_sim.rendering.encode import shrink

    rows = rows_of(poses, turns(pool.views, times), tinted)
    return [shrink(painted, size) for painted in pool.paint(rows)]


def save_png(picture: NDArray[np.uint8], path: str | Path) -> None:
    """Write a picture (height, width, 3) as a PNG file, whole or not at all.

    Raises:
        UsageError: the name does not end in .png, or the folder cannot be written.
    """
    from PIL import Image

    from nao_sim.files import beside

    path = Path(path)
    if path.suffix.lower() != ".png":
        raise UsageError(f"{path}: stills are written as .png")
    with beside(path) as draft:
        Image.fromarray(picture).save(draft, format="PNG")
