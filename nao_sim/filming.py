"""The film of a performance: the robot, and beside it the person whom it imitates."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.gesture_captions import GestureCaptions
from nao_sim.motion import Skeleton
from nao_sim.rendering import Backend, RenderReport, camera_names, check_film, start_pool, write_video
from nao_sim.rendering.presets import WITH_PERSON, WITH_TWO, load_camera, load_look, load_safety, load_theme
from nao_sim.rendering.second_robot import add_second, second_poses
from nao_sim.rendering.tint import Tinted, tint_with
from nao_sim.robot import Array
from nao_sim.safety_colours import SafetyColours

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import mujoco
    from dm_control import mjcf

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
        frames = int(duration * film.fps)
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
        film, times = self._film, frame_times(lasts, self._film.fps)
        poses = self._map.to_qpos(*rollout.at(times))
        if second:
            joints, base = second.at(times - late)
            first_joint = 7 if self._map.free else 0
            poses = np.hstack([poses, second_poses(self._map.to_qpos(joints)[:, first_joint:], base)])
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
            tinted=Tinted(self._tint, self._shown(times, rollout, interventions)) if self._tint else None,
        )

    def _shown(self, times: Array, rollout: Rollout, interventions: Sequence[Intervention]) -> Array:
        """What the frames at times (N,) show of the tint: colours, and then captions."""
        rows = []
        if self._colours:
            rows.append(self._colours.at(times, interventions, rollout.time).rows)
        if self._captions:
            rows.append(self._captions.at((times - rollout.motion_start) * rollout.speed))
        return np.hstack(rows)


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
    scene = _dressed(film, simulator)
    if second:
        add_second(scene, _dressed(film, simulator))
    if figure is not None:
        add_figure(scene, figure)
    return compiled(scene), figure


def _dressed(film: Film, simulator: Simulator) -> mjcf.RootElement:
    from nao_sim.rendering.looks import dress
    from nao_sim.simulation.scene import compose

    scene = compose(simulator.robot.version, "free" if simulator.map.free else "pinned")
    return dress(scene, load_look(film.look), load_theme(film.theme))
