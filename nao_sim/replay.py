"""From a file to a film and a report: the rooms in the order that the data takes."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from nao_sim.errors import RenderingError, UsageError
from nao_sim.files import check_results, make_folder
from nao_sim.filming import Crew, Film
from nao_sim.performed import Performed, perform
from nao_sim.recordings import Recording, Source, read
from nao_sim.rendering import Backend, start_probe
from nao_sim.robot import START_POSTURE
from nao_sim.safety.rules import Rules
from nao_sim.stopwatch import Stopwatch
from nao_sim.tasks import Progress, Task, check_options, tasks_of
from nao_sim.verdict import Verdict

if TYPE_CHECKING:
    from nao_sim.gestures.vocabulary import Vocabulary
    from nao_sim.imitation.retarget import Body, Match
    from nao_sim.report import Report
    from nao_sim.safety.assessment import Assessment
    from nao_sim.simulation.performance import Performance
    from nao_sim.simulation.simulator import Simulator


LONGEST_S = 2 * 3600.0


@dataclass(frozen=True)
class Orders:
    """Everything that a replay can be told.

    Attributes:
        recording: the file, and what the user says about it.
        report: where the JSON goes, if anywhere.
        film: what to render; None for nothing.
        rollout: where the NPZ goes, if anywhere.
        robot: `v4`, `v5` or `v6`.
        base: `free` or `pinned`.
        speed: times as fast as recorded.
        match: whether the robot's arms point as the person's, or its hands go to the same places.
        body: whether arms and head follow the person, or the legs, too.
        raw: whether to leave out the filters.
        rules: which rules hold, and how fast the robot may be.
        vocabulary: the gestures that the robot recognises and plays; it imitates every frame where None.
        both: whether one robot imitates every frame, and one beside it plays the gestures.
        plot: where the picture of the run goes, if anywhere.
        plot_size: a size of pictures; what suits the kind of file where None.
        html: where the page about the run goes, if anywhere.
        command: the command line that the page tells.
    """

    recording: Source
    report: Path | None = None
    film: Film | None = None
    rollout: Path | None = None
    robot: str = "v5"
    base: Literal["free", "pinned"] = "free"
    speed: float = 1.0
    match: Match = "directions"
    body: Body = "arms"
    raw: bool = False
    rules: Rules = field(default_factory=Rules)
    vocabulary: Vocabulary | None = None
    both: bool = False
    plot: Path | None = None
    plot_size: str | None = None
    html: Path | None = None
    command: str = ""


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

    @property
    def unsafe(self) -> bool:
        """Whether a robot fell or broke a rule."""
        gestures = self.report["gestures"] or {}
        return Verdict.unsafe in (self.report["verdict"], gestures.get("robot", {}).get("verdict"))


def replay(orders: Orders, progress: Progress = lambda stage, done, total: None) -> Outcome:
    """Read, retarget, make safe, simulate, render and report.

    What cannot render is no reason to lose the rest: the report and the
    rollout are written all the same.

    Raises:
        NaoSimError: the recording cannot be read, or a file cannot be written.
    """
    clock = Stopwatch()
    recording = read_recording(orders)
    _check_outputs(orders)
    backend = start_probe() if orders.film else None
    clock.lap("load_s")
    tasks = tasks_of(recording, orders, progress)
    clock.lap("retarget_s")
    from nao_sim.report import save_report, with_player
    from nao_sim.simulation.simulator import Simulator

    simulator = Simulator(tasks[0].robot, orders.base)
    written: dict[str, Path] = {}
    error: RenderingError | None = None
    with ExitStack() as stack:
        crew: Crew | None = None
        try:  # the rendering processes get ready while the robot performs
            if orders.film and backend:
                crew = stack.enter_context(_crew(orders.film, tasks, simulator, backend.result(), not orders.rules.off))
        except RenderingError as failure:
            error = failure
        run = perform(tasks[0], orders, simulator, progress)
        performance, report, player, beside = run.performance, run.report, None, None
        if len(tasks) > 1:
            simulator.reset()
            player = perform(tasks[1], orders, simulator, progress)
            beside, report = player.performance.rollout, with_player(report, player.report)
        if orders.rollout:
            performance.rollout.save(orders.rollout)
            written["rollout"] = orders.rollout
        try:
            if crew:
                made = crew.shoot(
                    performance.rollout,
                    lambda done, total: progress("rendering", done, total),
                    performance.interventions,
                    beside,
                )
                written["video"] = made.path
                clock.film(made)
        except RenderingError as failure:
            error = failure
    report["timing"] = clock.timing(performance)
    if orders.report:
        save_report(report, orders.report)
        written["report"] = orders.report
    written |= show(replace(run, report=report, player=player), orders, written.get("video"), str(error or ""))
    return Outcome(report, written, error)


def show(run: Performed, orders: Orders, film: Path | None = None, no_film: str = "") -> dict[str, Path]:
    """Draw a run and write the page about it, where that is ordered.

    Args:
        run: what to show.
        orders: where to, and how large.
        film: of the run, where there is one.
        no_film: why there is none although one was ordered.

    Returns:
        What is where.

    Raises:
        UsageError: a file cannot be written.
    """
    written: dict[str, Path] = {}
    if orders.plot:
        from nao_sim.plotting.run_page import save_run

        save_run(run, orders.plot, orders.plot_size)
        written["plot"] = orders.plot
    if orders.html:
        from nao_sim.web.run_document import run_document
        from nao_sim.web.writing import write_document

        write_document(run_document(run, orders, film, no_film), orders.html)
        written["page"] = orders.html
    return written


def _crew(film: Film, tasks: Sequence[Task], simulator: Simulator, backend: Backend, guarded: bool) -> Crew:
    from nao_sim.gesture_captions import GestureCaptions

    recognised, lasts = tasks[-1].recognised, max(task.motion.duration for task in tasks)
    captions = GestureCaptions(recognised) if recognised else None
    return Crew(film, simulator, tasks[0].person, lasts, backend, captions, len(tasks) > 1, guarded)


def read_recording(orders: Orders) -> Recording:
    """The file, if it can be read and ends some time: a run is kept in memory.

    Raises:
        NaoSimError: it cannot be read, would last too long, or holds angles and the orders are for people.
    """
    recording = read(orders.recording)
    check_options(orders, recording)
    lasts = recording.motion.duration / orders.speed
    if lasts > LONGEST_S:
        raise UsageError(
            f"{recording.path}: lasts {lasts / 3600:.1f} hours; expected at most {LONGEST_S / 3600:g} "
            "(are its times in milliseconds? --speed 1000 plays those)"
        )
    return recording


def perform_task(
    task: Task, orders: Orders, simulator: Simulator, progress: Progress
) -> tuple[Performance, Assessment]:
    """Guard and simulate a task; also what it asks that the robot cannot or must not do."""
    from nao_sim.safety.assessment import assess
    from nao_sim.simulation.performance import perform

    start = task.robot.postures[START_POSTURE]
    asked = assess(task.motion, task.robot, start, lambda done, total: progress("checking", done, total))
    performance = perform(
        task.motion,
        simulator,
        lambda done, total: progress("simulating", done, total),
        rules=orders.rules,
    )
    return replace(performance, rollout=replace(performance.rollout, speed=orders.speed)), asked


def _check_outputs(orders: Orders) -> None:
    """Say now, not after the work, what cannot be written.

    Raises:
        UsageError: a path or a film that cannot be.
    """
    if film := orders.film:
        film.check(orders.both)
    files = orders.report, orders.rollout, film and film.path, orders.plot, orders.html
    outputs = [path for path in files if path]
    check_results(outputs, orders.recording.path)
    for path in outputs:
        make_folder(path.parent)
