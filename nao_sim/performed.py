"""A recording guarded and simulated, before anybody films, draws or views it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from nao_sim.gestures.recognised import Recognised
    from nao_sim.imitation.similarity import Similarity
    from nao_sim.replay import Orders
    from nao_sim.report import Report
    from nao_sim.simulation.performance import Performance
    from nao_sim.simulation.simulator import Simulator
    from nao_sim.tasks import Progress, Task


@dataclass(frozen=True, eq=False)
class Performed:
    """A recording that was guarded and simulated.

    Attributes:
        task: what the robot was asked, and whom it follows.
        report: as the JSON has it.
        performance: what was asked, commanded and done.
        simulator: who did it.
        similarity: how alike the robot was to whom it imitates, if it imitates.
        player: what the robot beside it did, which plays gestures, if there is one.
    """

    task: Task
    report: Report
    performance: Performance
    simulator: Simulator
    similarity: Similarity | None = None
    player: Performed | None = None

    @property
    def recognised(self) -> Recognised | None:
        """The gestures that one of the robots plays."""
        return (self.player or self).task.recognised


def perform(task: Task, orders: Orders, simulator: Simulator, progress: Progress) -> Performed:
    """Guard, simulate and report a task."""
    from nao_sim.replay import perform_task
    from nao_sim.report import build_report, imitation

    performance, asked = perform_task(task, orders, simulator, progress)
    imitated = imitation(task, performance, simulator.robot)
    report = build_report(task, asked, performance, simulator, orders.rules, imitated)
    return Performed(task, report, performance, simulator, imitated)


def perform_recording(orders: Orders, progress: Progress, simulator: Simulator | None = None) -> Performed:
    """Read, retarget, make safe and simulate.

    Args:
        orders: what to read and how; nothing is written.
        progress: told how far the work is.
        simulator: a robot as ordered; a new one where None.

    Raises:
        NaoSimError: the recording cannot be read or followed.
    """
    from nao_sim.replay import read_recording
    from nao_sim.tasks import task_of

    task = task_of(read_recording(orders), orders, progress)
    from nao_sim.simulation.simulator import Simulator

    simulator = simulator or Simulator(task.robot, orders.base)
    simulator.reset()
    return perform(task, orders, simulator, progress)
