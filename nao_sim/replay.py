"""From a file to a film and a report: the rooms in the order that the data takes."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal, Protocol

from nao_sim.errors import RenderingError, UsageError
from nao_sim.files import check_results
from nao_sim.filming import Crew, Film
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.recordings import Recording, Source, read
from nao_sim.rendering import start_probe
from nao_sim.robot import START_POSTURE, Robot, load_robot
from nao_sim.safety.rules import Rules
from nao_sim.stopwatch import Stopwatch

if TYPE_CHECKING:
    from nao_sim.imitation.retarget import Body, Match, Retargeted
    from nao_sim.report import Report
    from nao_sim.safety.assessment import Assessment
    from nao_sim.simulation.performance import Performance
    from nao_sim.simulation.simulator import Simulator


LONGEST_S = 2 * 3600.0


class Progress(Protocol):
    """Told how far the work is."""

    def __call__(self, stage: str, done: int, total: int) -> None:
        """`done` of `total` steps of a stage are finished."""


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


@dataclass(frozen=True, eq=False)
class Task:
    """What the robot is asked to do, and where it comes from.

    Attributes:
        recording: the file as read.
        robot: who is asked.
        motion: what is asked, at the speed at which it is asked.
        retargeted: the person whom the motion follows; None for a robot's own motion.
    """

    recording: Recording
    robot: Robot
    motion: JointTrajectory
    retargeted: Retargeted | None = None

    @property
    def person(self) -> Skeleton | None:
        """The person whom the motion follows."""
        return self.retargeted.person if self.retargeted else None


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
    task = task_of(recording, orders, progress)
    clock.lap("retarget_s")
    from nao_sim.report import build_report, save_report
    from nao_sim.simulation.simulator import Simulator

    simulator = Simulator(task.robot, orders.base)
    written: dict[str, Path] = {}
    error: RenderingError | None = None
    with ExitStack() as stack:
        crew: Crew | None = None
        try:  # the rendering processes get ready while the robot performs
            if orders.film and backend:
                person, lasts = task.person, task.motion.duration
                crew = stack.enter_context(Crew(orders.film, simulator, person, lasts, backend.result()))
        except RenderingError as failure:
            error = failure
        performance, asked = perform_task(task, orders, simulator, progress)
        report = build_report(task, asked, performance, simulator, orders.rules)
        if orders.rollout:
            performance.rollout.save(orders.rollout)
            written["rollout"] = orders.rollout
        try:
            if crew:
                made = crew.shoot(
                    performance.rollout,
                    lambda done, total: progress("rendering", done, total),
                    performance.interventions,
                )
                written["video"] = made.path
                clock.film(made)
        except RenderingError as failure:
            error = failure
    report["timing"] = clock.timing(performance)
    if orders.report:
        save_report(report, orders.report)
        written["report"] = orders.report
    return Outcome(report, written, error)


def read_recording(orders: Orders) -> Recording:
    """The file, if it can be read and ends some time: a run is kept in memory.

    Raises:
        NaoSimError: it cannot be read, or would last too long.
    """
    recording = read(orders.recording)
    lasts = recording.motion.duration / orders.speed
    if lasts > LONGEST_S:
        raise UsageError(
            f"{recording.path}: lasts {lasts / 3600:.1f} hours; expected at most {LONGEST_S / 3600:g} "
            "(are its times in milliseconds? --speed 1000 plays those)"
        )
    return recording


def task_of(recording: Recording, orders: Orders, progress: Progress) -> Task:
    """What the robot is asked to do: the recording's own joint angles, or those that follow its person.

    Raises:
        UsageError: the person cannot be followed, or an option is given that a robot's motion has no use for.
    """
    robot, motion = load_robot(orders.robot), recording.motion
    if isinstance(motion, JointTrajectory):
        _refuse_options_for_people(orders, recording)
        return Task(recording, robot, motion.at_speed(orders.speed))
    from nao_sim.imitation.retarget import retarget

    try:
        retargeted = retarget(
            motion,
            robot,
            match=orders.match,
            body=orders.body,
            start=robot.postures[START_POSTURE],
            raw=orders.raw,
            speed=orders.speed,
            progress=lambda done, total: progress("retargeting", done, total),
        )
    except UsageError as error:
        raise UsageError(f"{recording.path}: {error}") from None
    return Task(recording, robot, retargeted.motion, retargeted)


def _refuse_options_for_people(orders: Orders, recording: Recording) -> None:
    """Do not pass over an option that a robot's own motion has no use for.

    Raises:
        UsageError: one is given.
    """
    given = {"--match hands": orders.match == "hands", "--body whole": orders.body == "whole", "--raw": orders.raw}
    if any(given.values()):
        option = next(option for option, is_given in given.items() if is_given)
        raise UsageError(
            f"{recording.path}: holds joint angles ({recording.format}); expected a person's recording for {option}"
        )


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
        film.check()
    outputs = [path for path in (orders.report, orders.rollout, film and film.path) if path]
    check_results(outputs, orders.recording.path)
    for path in outputs:
        make_folder(path.parent)


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
