"""A recording guarded and simulated, before anybody films, draws or views it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
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
    """

    task: Task
    report: Report
    performance: Performance
    simulator: Simulator


def perform_recording(orders: Orders, progress: Progress, simulator: Simulator | None = None) -> Performed:
    """Read, retarget, make safe and simulate.

    Args:
        orders: what to read and how; nothing is written.
        progress: told how far the work is.
        simulator: a robot as ordered; a new one where None.

    Raises:
        NaoSimError: the recording cannot be read or followed.
    """
    from nao_sim.replay import perform_task, read_recording
    from nao_sim.tasks import task_of

    task = task_of(read_recording(orders), orders, progress)
    from nao_sim.report import build_report
    from nao_sim.simulation.simulator import Simulator

    simulator = simulator or Simulator(task.robot, orders.base)
    simulator.reset()
    performance, asked = perform_task(task, orders, simulator, progress)
    return Performed(task, build_report(task, asked, performance, simulator, orders.rules), performance, simulator)
