"""The film of a performance: the robot, and beside it the person whom it imitates."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.motion import Skeleton
from nao_sim.rendering import Backend, RenderReport, camera_names, check_film, start_pool, write_video
from nao_sim.rendering.presets import WITH_PERSON, load_camera, load_look, load_theme
from nao_sim.robot import Array
from nao_sim.safety_colours import SafetyColours

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import mujoco

    from nao_sim.rendering.figure import Figure
    from nao_sim.safety.change import Intervention
    from nao_sim.simulation.rollout import Rollout
    from nao_sim.simulation.simulator import Simulator


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

    def check(self) -> None:
        """Say before any work is done what cannot be filmed.

        Raises:
            UsageError: an argument that cannot be honoured.
        """
        if self.camera not in camera_names():
            raise UsageError(f"camera '{self.camera}' is not known; expected one of {', '.join(camera_names())}")
        load_look(self.look)
        load_theme(self.theme)
        check_film(self.path, self.fps, self.size, self.camera, self.quality)


class Crew:
    """Rendering processes that get ready while the robot still performs; use it in a `with` block.

    Args:
        film: what to render.
        simulator: whose robot is filmed.
        person: who is shown beside it, if anybody.
        duration: s, about how long the film will be.
        backend: what renders.

    Raises:
        RenderingError: nothing can render here.
    """

    def __init__(
        self, film: Film, simulator: Simulator, person: Skeleton | None, duration: float, backend: Backend
    ) -> None:
        self._film, self._map = film, simulator.map
        self._model, self._figure = _set(film, simulator, person)
        camera = film.camera if self._figure is None else f"{film.camera}{WITH_PERSON}"
        self._colours = SafetyColours(self._model, simulator.robot) if film.safety else None
        frames, tint = int(duration * film.fps), self._colours.tint if self._colours else None
        self._pool = start_pool(self._model, frames, film.size, camera, film.quality, backend, tint=tint)

    def __enter__(self) -> Crew:
        return self

    def __exit__(self, *error: object) -> None:
        self._pool.close()

    def shoot(
        self, rollout: Rollout, progress: Callable[[int, int], None], interventions: Sequence[Intervention] = ()
    ) -> RenderReport:
        """Render the whole performance.

        Args:
            rollout: what the robot did, T control steps.
            progress: called with (frames done, frames in all) after each frame.
            interventions: what the guard changed, (T,); a film that shows safety needs it.

        Raises:
            RenderingError: a rendering process failed.
            UsageError: the film cannot be written.
        """
        film, times = self._film, frame_times(float(rollout.time[-1]), self._film.fps)
        poses = self._map.to_qpos(*rollout.at(times))
        if self._figure is not None:
            poses = np.hstack([poses, self._figure.at(times - rollout.motion_start)])
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
            tinted=self._colours.at(times, interventions, rollout.time) if self._colours else None,
        )


def frame_times(duration: float, fps: float) -> Array:
    """Times (N,) s of the frames of a film that shows `duration` seconds."""
    return np.arange(max(1, round(duration * fps))) / fps


def _set(film: Film, simulator: Simulator, person: Skeleton | None) -> tuple[mujoco.MjModel, Figure | None]:
    """The scene to film, and the person in it where one can be shown."""
    from nao_sim.rendering.figure import add_figure, figure_of
    from nao_sim.rendering.looks import dress
    from nao_sim.simulation.scene import compiled, compose

    shown = film.person and not load_camera(film.camera).model_camera
    figure = figure_of(person) if person is not None and shown else None
    scene = compose(simulator.robot.version, "free" if simulator.map.free else "pinned")
    dress(scene, load_look(film.look), load_theme(film.theme))
    if figure is not None:
        add_figure(scene, figure)
    return compiled(scene), figure
