"""The film of a performance: the robot, and beside it the person whom it imitates."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.moments import Moments
from nao_sim.motion import Skeleton
from nao_sim.overlay import FilmOverlay, titles_of
from nao_sim.rendering import Backend, RenderReport, camera_names, check_film, start_pool, write_video
from nao_sim.rendering.arrangements import load_arrangement, load_overlay, views_of
from nao_sim.rendering.presets import WITH_TWO, load_camera, load_figure, load_look, load_quality, load_theme
from nao_sim.rendering.second_robot import add_second, second_poses
from nao_sim.rendering.sheet import check_sheet
from nao_sim.rendering.video import check_size
from nao_sim.robot import Array

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import mujoco
    from dm_control import mjcf

    from nao_sim.gesture_captions import GestureCaptions
    from nao_sim.rendering.figure import Figure
    from nao_sim.rendering.tint import Tinted
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
        person: whether a recorded person is shown, where the arrangement has one.
        overlay: name of what is shown over the picture.
        look: name of the surroundings.
        theme: name of the robot's colours.
        moments: single pictures on a sheet (.png, .jpg, .pdf) instead of a film.
        arrangement: name of a way to lay out the picture.
    """

    path: Path
    fps: float = 30.0
    size: tuple[int, int] = (640, 480)
    camera: str = "three-quarter"
    quality: str = "standard"
    person: bool = True
    overlay: str = "gestures"
    look: str = "studio"
    theme: str = "orange"
    moments: Moments | None = None
    arrangement: str = "beside"

    def check(self, second: bool = False) -> None:
        """Say before any work is done what cannot be filmed, with a second robot or without.

        Raises:
            UsageError: an argument that cannot be honoured.
        """
        if self.camera not in camera_names():
            raise UsageError(f"camera '{self.camera}' is not known; expected one of {', '.join(camera_names())}")
        load_overlay(self.overlay)
        self._check_arrangement(second)
        load_look(self.look)
        load_theme(self.theme)
        if self.moments:
            check_sheet(self.path)
            check_size(self.size)
            load_quality(self.quality)
        else:
            check_film(self.path, self.fps, self.size, self.camera, self.quality)

    def _check_arrangement(self, second: bool) -> None:
        arrangement = load_arrangement(self.arrangement)
        option = f"--arrange {self.arrangement}"
        if self.camera in {pane.camera for pane in arrangement.panes}:
            raise UsageError(f"{option} shows in a part what --camera {self.camera} sees; give one of them")
        if arrangement.needs_person and not self.person:
            raise UsageError(f"{option} shows the person, whom --hide-person hides; give one of them")
        if arrangement.needs_person and load_camera(self.camera).model_camera:
            raise UsageError(f"{option}: --camera {self.camera} does not see the person; expected another camera")
        if second and not arrangement.two:
            raise UsageError(f"{option}: is for one robot; expected --mode one-to-one or gestures with it")


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
        guarded: whether all rules of the guard are on.

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
        guarded: bool = True,
    ) -> None:
        self._film, self._simulator = film, simulator
        self._arrangement = load_arrangement(film.arrangement)
        self._model, self._figure = _set(film, simulator, person, second)
        where = self._arrangement.person
        with_whom = WITH_TWO if second else load_figure(where).camera if self._figure and where else ""
        views = views_of(self._arrangement, film.camera, with_whom)
        titles = titles_of(self._arrangement, guarded)
        self._overlay = FilmOverlay(load_overlay(film.overlay), self._model, simulator.robot, captions, titles)
        frames = int(duration * film.fps) if film.moments is None else max(film.moments.key_poses, len(film.moments.at))
        self._pool = start_pool(self._model, frames, film.size, views, film.quality, backend, tint=self._overlay.tint)

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
        poses = self._poses(times, rollout, second, late)
        tinted = self._overlay.at(times, rollout, interventions)
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

    def _poses(self, times: Array, rollout: Rollout, second: Rollout | None, late: float) -> Array:
        """What each pane shows at times (N,) s, side by side: the robot, whoever is beside it, the next pane's."""
        beside = [np.zeros((len(times), 0))]
        map_ = self._simulator.map
        if second:
            joints, base = second.at(times - late)
            first_joint = 7 if map_.free else 0
            beside.append(second_poses(map_.to_qpos(joints)[:, first_joint:], base))
        if self._figure is not None:
            beside.append(self._figure.at(times - rollout.motion_start))
        shown = {pane.shows for pane in self._arrangement.panes}
        robot = {"simulated": map_.to_qpos(*rollout.at(times))}
        if "requested" in shown:
            from nao_sim.requested_poses import requested_poses

            robot["requested"] = requested_poses(rollout, times, self._simulator)
        return np.hstack([part for pane in self._arrangement.panes for part in (robot[pane.shows], *beside)])

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


def frame_times(duration: float, fps: float) -> Array:
    """Times (N,) s of the frames of a film that shows `duration` seconds."""
    return np.arange(max(1, round(duration * fps))) / fps


def _set(
    film: Film, simulator: Simulator, person: Skeleton | None, second: bool
) -> tuple[mujoco.MjModel, Figure | None]:
    """The scene to film, with another robot, and the person in it where one can be shown."""
    from nao_sim.rendering.figure import add_figure, figure_of
    from nao_sim.simulation.scene import compiled

    where = load_arrangement(film.arrangement).person
    shown = film.person and not load_camera(film.camera).model_camera
    figure = figure_of(person, where) if person is not None and where and shown else None
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
