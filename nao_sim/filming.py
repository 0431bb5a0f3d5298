"""The film of a performance: the robot, and beside it the person whom it imitates."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nao_sim.errors import UsageError
from nao_sim.motion import Skeleton
from nao_sim.rendering import Backend, RenderReport, camera_names, check_film, start_pool, write_video
from nao_sim.rendering.presets import (
    WITH_PERSON,
    WITH_TWO,
    load_camera,
    load_look,
    load_quality,
    load_safety,
    load_theme,
)
from nao_sim.rendering.second_robot import add_second, second_poses
from nao_sim.rendering.sheet import check_sheet
from nao_sim.rendering.tint import Tinted, tint_with
from nao_sim.rendering.video import check_size
from nao_sim.robot import Array
from nao_sim.safety_colours import SafetyColours

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import mujoco
    from dm_control import mjcf

    from nao_sim.gesture_captions import GestureCaptions
    from nao_sim.rendering.figure import Figure
    from nao_sim.safety.change import Intervention
    from nao_sim.simulation.rollout import Rollout
    from nao_sim.simulation.simulator import Simulator


@dataclass(frozen=True)
class Moments:
    """Of what there are pictures instead of a film; exactly one of both is given.

    Attributes:
        at: s of the recording.
        key_poses: how many of the poses that differ most.
    """

    at: tuple[float, ...] = ()
    key_poses: int = 0

    def times(self, rollout: Rollout) -> Array:
        """Where in a rollout (N,) s they are, in the recording's order.

        Raises:
            UsageError: there is nothing of the recording at a moment.
        """
        moving = np.flatnonzero(rollout.time >= rollout.motion_start)
        if self.key_poses:
            return rollout.time[moving[key_poses(rollout.joint_positions[moving], self.key_poses)]]
        lasts = float(rollout.time[-1] - rollout.motion_start) * rollout.speed
        if late := [at for at in self.at if at > lasts + 1e-9]:
            raise UsageError(f"--at {late[0]:g}: after the end of the recording; expected 0 to {lasts:.2f} s")
        return rollout.motion_start + np.array(self.at) / rollout.speed


@dataclass(frozen=True)
class Film:
    """What to render.

    Attributes:
        path: .mp4, .webm, .gif, or .png for a folder of frames.
        fps: frames a second.
        size: (width, height) in pixels.
        camera: name of a camera preset.
        quality: name of a quality preset.
        person: whether a recorded person is shown beside the robot.
        safety: whether the limbs in which the guard intervenes take colour.
        look: name of the surroundings.
        theme: name of the robot's colours.
        moments: single pictures on a sheet (.png, .jpg, .pdf) instead of a film.
    """

    path: Path
    fps: float = 30.0
    size: tuple[int, int] = (640, 480)
    camera: str = "three-quarter"
    quality: str = "standard"
    person: bool = True
    safety: bool = False
    look: str = "studio"
    theme: str = "orange"
    moments: Moments | None = None

    def check(self) -> None:
        """Say before any work is done what cannot be filmed.

        Raises:
            UsageError: an argument that cannot be honoured.
        """
        if self.camera not in camera_names():
            raise UsageError(f"camera '{self.camera}' is not known; expected one of {', '.join(camera_names())}")
        load_look(self.look)
        load_theme(self.theme)
        if self.moments:
            check_sheet(self.path)
            check_size(self.size)
            load_quality(self.quality)
        else:
            check_film(self.path, self.fps, self.size, self.camera, self.quality)


class Crew:
    """Rendering processes that get ready while the robot still performs; use it in a `with` block.

    Args:
        film: what to render.
        simulator: whose robot is filmed.
        person: who is shown beside it, if anybody.
        duration: s, about how long the film will be.
        backend: what renders.
        captions: which gestures are named in it, if any.
        second: whether another robot acts beside it.

    Raises:
        RenderingError: nothing can render here.
    """

    def __init__(
        self,
        film: Film,
        simulator: Simulator,
        person: Skeleton | None,
        duration: float,
        backend: Backend,
        captions: GestureCaptions | None = None,
        second: bool = False,
    ) -> None:
        self._film, self._map, self._captions = film, simulator.map, captions
        self._model, self._figure = _set(film, simulator, person, second)
        camera = f"{film.camera}{WITH_TWO if second else WITH_PERSON if self._figure else ''}"
        self._colours = SafetyColours(self._model, simulator.robot) if film.safety else None
        self._tint = self._colours.tint if self._colours else None
        if captions:
            self._tint = tint_with(self._tint, captions.labels, load_safety().letter)
        frames = int(duration * film.fps) if film.moments is None else max(film.moments.key_poses, len(film.moments.at))
        self._pool = start_pool(self._model, frames, film.size, camera, film.quality, backend, tint=self._tint)

    def __enter__(self) -> Crew:
        return self

    def __exit__(self, *error: object) -> None:
        self._pool.close()

    def shoot(
        self,
        rollout: Rollout,
        progress: Callable[[int, int], None],
        interventions: Sequence[Intervention] = (),
        second: Rollout | None = None,
    ) -> RenderReport:
        """Render the whole performance.

        Args:
            rollout: what the robot did, T control steps.
            progress: called with (frames done, frames in all) after each frame.
            interventions: what the guard changed, (T,); a film that shows safety needs it.
            second: what the robot beside it did, in step with the recording; where there is one.

        Raises:
            RenderingError: a rendering process failed.
            UsageError: the film cannot be written.
        """
        late = rollout.motion_start - second.motion_start if second else 0.0
        lasts = max(float(each.time[-1]) + shift for each, shift in ((rollout, 0.0), (second or rollout, late)))
        film = self._film
        times = film.moments.times(rollout) if film.moments else frame_times(lasts, film.fps)
        poses = self._map.to_qpos(*rollout.at(times))
        if second:
            joints, base = second.at(times - late)
            first_joint = 7 if self._map.free else 0
            poses = np.hstack([poses, second_poses(self._map.to_qpos(joints)[:, first_joint:], base)])
        if self._figure is not None:
            poses = np.hstack([poses, self._figure.at(times - rollout.motion_start)])
        tinted = Tinted(self._tint, self._shown(times, rollout, interventions)) if self._tint else None
        if film.moments:
            return self._show(poses, times, (times - rollout.motion_start) * rollout.speed, tinted)
        return write_video(
            self._model,
            poses,
            film.path,
            fps=film.fps,
            size=film.size,
            camera=film.camera,
            quality=film.quality,
            progress=progress,
            pool=self._pool,
            tinted=tinted,
        )

    def _show(self, poses: Array, times: Array, told: Array, tinted: Tinted | None) -> RenderReport:
        """Single pictures on a sheet, with the recording's times (N,) s told below them where there are several."""
        from nao_sim.rendering.sheet import save_sheet, sheet
        from nao_sim.rendering.still import paint_stills

        began, film, pool = perf_counter(), self._film, self._pool
        pictures = paint_stills(pool, poses, times, film.size, tinted)
        words = [f"{at:.1f} s" for at in told] if len(told) > 1 else [""]
        save_sheet(sheet(pictures, words), film.path)
        count = len(pictures)
        return RenderReport(film.path, count, count, perf_counter() - began, pool.backend, pool.workers)

    def _shown(self, times: Array, rollout: Rollout, interventions: Sequence[Intervention]) -> Array:
        """What the frames at times (N,) show of the tint: colours, and then captions."""
        rows = []
        if self._colours:
            rows.append(self._colours.at(times, interventions, rollout.time).rows)
        if self._captions:
            rows.append(self._captions.at((times - rollout.motion_start) * rollout.speed))
        return np.hstack(rows)


def key_poses(positions: Array, count: int) -> NDArray[np.int_]:
    """Which of poses (T, 26) differ most, in their order: each the farthest from those chosen before (Gonzalez 1985).

    The first is the one farthest from the pose in the middle of all; there are
    at most `count` and at most as many as there are different poses.
    """
    apart = np.linalg.norm(positions - np.median(positions, axis=0), axis=1)
    chosen = [int(apart.argmax())]
    nearest = np.linalg.norm(positions - positions[chosen[0]], axis=1)
    while len(chosen) < count and nearest.max() > 0.0:
        chosen.append(int(nearest.argmax()))
        nearest = np.minimum(nearest, np.linalg.norm(positions - positions[chosen[-1]], axis=1))
    return np.sort(chosen)


def frame_times(duration: float, fps: float) -> Array:
    """Times (N,) s of the frames of a film that shows `duration` seconds."""
    return np.arange(max(1, round(duration * fps))) / fps


def _set(
    film: Film, simulator: Simulator, person: Skeleton | None, second: bool
) -> tuple[mujoco.MjModel, Figure | None]:
    """The scene to film, with another robot, and the person in it where one can be shown."""
    from nao_sim.rendering.figure import add_figure, figure_of
    from nao_sim.simulation.scene import compiled

    shown = film.person and not load_camera(film.camera).model_camera
    figure = figure_of(person) if person is not None and shown else None
    scene = dressed(film, simulator)
    if second:
        add_second(scene, dressed(film, simulator))
    if figure is not None:
        add_figure(scene, figure)
    return compiled(scene), figure


def dressed(film: Film, simulator: Simulator) -> mjcf.RootElement:
    """The scene of a film before anybody joins the robot."""
    from nao_sim.rendering.looks import dress
    from nao_sim.simulation.scene import compose

    scene = compose(simulator.robot.version, "free" if simulator.map.free else "pinned")
    return dress(scene, load_look(film.look), load_theme(film.theme))
