"""From a file to a film and a report: the rooms in the order that the data takes."""

from __future__ import annotations

from concurrent.futures import Future
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np

from nao_sim.errors import RenderingError, UsageError
from nao_sim.motion import JointTrajectory
from nao_sim.recordings import Recording, load
from nao_sim.rendering import Backend, RenderReport, check_film, start_pool, start_probe, write_video
from nao_sim.rendering.frames import Pool
from nao_sim.robot import Array, load_robot

if TYPE_CHECKING:
    from nao_sim.report import Report
    from nao_sim.simulation.performance import Performance
    from nao_sim.simulation.simulator import Simulator


LONGEST_S = 2 * 3600.0


class Progress(Protocol):
    """Told how far the work is."""

    def __call__(self, stage: str, done: int, total: int) -> None:
        """`done` of `total` steps of a stage are finished."""


@dataclass(frozen=True)
class Film:
    """What to render.

    Attributes:
        path: .mp4, .webm, .gif, or .png for a folder of frames.
        fps: frames a second.
        size: (width, height) in pixels.
        camera: name of a camera preset.
        quality: name of a quality preset.
    """

    path: Path
    fps: float = 30.0
    size: tuple[int, int] = (640, 480)
    camera: str = "three-quarter"
    quality: str = "standard"


@dataclass(frozen=True)
class Orders:
    """Everything that a replay can be told.

    Attributes:
        recording: the file.
        report: where the JSON goes.
        film: what to render; None for nothing.
        rollout: where the NPZ goes, if anywhere.
        robot: `v4`, `v5` or `v6`.
        base: `free` or `pinned`.
        unit: of angles, where the file does not say.
        rate: Hz, where the file has no times.
        speed: times as fast as recorded.
    """

    recording: Path
    report: Path
    film: Film | None = None
    rollout: Path | None = None
    robot: str = "v5"
    base: Literal["free", "pinned"] = "free"
    unit: Literal["deg", "rad"] | None = None
    rate: float | None = None
    speed: float = 1.0


@dataclass(frozen=True)
class Outcome:
    """What came of a replay.

    Attributes:
        report: as the JSON has it.
        written: what is where.
        rendering_error: why there is no film although one was ordered.
    """

    report: Report
    written: dict[str, Path]
    rendering_error: RenderingError | None


def replay(orders: Orders, progress: Progress = lambda stage, done, total: None) -> Outcome:
    """Read, make safe, simulate, render and report.

    What cannot render is no reason to lose the rest: the report and the
    rollout are written all the same.

    Raises:
        NaoSimError: the recording cannot be read, or a file cannot be written.
    """
    began = perf_counter()
    recording = load(orders.recording, orders.unit, orders.rate)
    _check_length(recording, orders.speed)
    _check_outputs(orders)
    backend = start_probe() if orders.film else None
    loaded = perf_counter()
    from nao_sim.report import save_report
    from nao_sim.simulation.simulator import Simulator

    simulator = Simulator(load_robot(orders.robot), orders.base)
    written: dict[str, Path] = {}
    timing: dict[str, float | str] = {"load_s": loaded - began}
    painters: Pool | None = None
    error: RenderingError | None = None
    with ExitStack() as stack:
        try:  # the rendering processes get ready while the robot performs
            painters = _start_painters(orders, recording, simulator, backend, stack)
        except RenderingError as failure:
            error = failure
        report, performance = _perform(recording, orders, simulator, progress)
        timing |= {"safety_s": performance.safety_s, "simulate_s": performance.simulate_s}
        if orders.rollout:
            performance.rollout.save(orders.rollout)
            written["rollout"] = orders.rollout
        try:
            if orders.film and painters:
                made = _render(orders.film, performance, simulator, painters, progress)
                written["video"] = made.path
                timing |= _rendering_times(made)
        except RenderingError as failure:
            error = failure
    total = perf_counter() - began
    timing |= {"total_s": total, "realtime_factor": float(performance.rollout.time[-1]) / total}
    report["timing"] = {key: round(value, 4) if isinstance(value, float) else value for key, value in timing.items()}
    save_report(report, orders.report)
    return Outcome(report, written | {"report": orders.report}, error)


def _start_painters(
    orders: Orders, recording: Recording, simulator: Simulator, backend: Future[Backend] | None, stack: ExitStack
) -> Pool | None:
    if not (orders.film and backend):
        return None
    film = orders.film
    frames = int(recording.motion.duration / orders.speed * film.fps)
    pool = start_pool(simulator.model, frames, film.size, film.camera, film.quality, backend.result())
    return stack.enter_context(pool)


def _check_length(recording: Recording, speed: float) -> None:
    """A run is kept in memory, so it must end some time.

    Raises:
        UsageError: it would last too long.
    """
    lasts = recording.motion.duration / speed
    if lasts > LONGEST_S:
        raise UsageError(
            f"{recording.path}: lasts {lasts / 3600:.1f} hours; expected at most {LONGEST_S / 3600:g} "
            "(are its times in milliseconds? --speed 1000 plays those)"
        )


def _check_outputs(orders: Orders) -> None:
    """Say now, not after the work, what cannot be written.

    Raises:
        UsageError: a path or a film that cannot be.
    """
    if film := orders.film:
        check_film(film.path, film.fps, film.size, film.camera, film.quality)
    outputs = [path for path in (orders.report, orders.rollout, film and film.path) if path]
    for path in outputs:
        if path.resolve() == orders.recording.resolve():
            raise UsageError(f"{path}: would overwrite the recording; expected another name")
        if path.is_dir():
            raise UsageError(f"{path}: is a folder; expected the name of a file")
    if len({path.resolve() for path in outputs}) < len(outputs):
        raise UsageError(f"{outputs[0]}: named for two results; expected a name for each")
    for path in outputs:
        make_folder(path.parent)


def _perform(
    recording: Recording, orders: Orders, simulator: Simulator, progress: Progress
) -> tuple[Report, Performance]:
    from nao_sim.report import build_report
    from nao_sim.safety.assessment import assess
    from nao_sim.simulation.performance import perform
    from nao_sim.simulation.simulator import START_POSTURE

    motion, robot = recording.motion.at_speed(orders.speed), simulator.robot
    assert isinstance(motion, JointTrajectory)
    start = robot.postures[START_POSTURE]
    asked = assess(motion, robot, start, lambda done, total: progress("checking", done, total))
    performance = perform(motion, simulator, lambda done, total: progress("simulating", done, total))
    return build_report(recording, asked, performance, simulator), performance


def _render(
    film: Film, performance: Performance, simulator: Simulator, painters: Pool, progress: Progress
) -> RenderReport:
    rollout = performance.rollout
    return write_video(
        simulator.model,
        simulator.map.to_qpos(*rollout.at(frame_times(float(rollout.time[-1]), film.fps))),
        film.path,
        fps=film.fps,
        size=film.size,
        camera=film.camera,
        quality=film.quality,
        progress=lambda done, total: progress("rendering", done, total),
        pool=painters,
    )


def _rendering_times(made: RenderReport) -> dict[str, float | str]:
    return {
        "render_s": made.seconds,
        "render_fps": made.frames / made.seconds,
        "gl_backend": made.backend.name,
        "gl_renderer": made.backend.renderer,
    }


def frame_times(duration: float, fps: float) -> Array:
    """Times (N,) s of the frames of a film that shows `duration` seconds."""
    return np.arange(max(1, round(duration * fps))) / fps


def make_folder(folder: Path) -> None:
    """Make a folder for results; a new one keeps itself out of version control.

    Raises:
        UsageError: it cannot be made, or is something else.
    """
    if folder.is_dir():
        return
    try:
        folder.mkdir(parents=True)
        (folder / ".gitignore").write_text("*\n", encoding="utf-8")
    except OSError as error:
        raise UsageError(f"{folder}: cannot make this folder: {error.strerror}") from None
