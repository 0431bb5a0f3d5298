"""A page about a run: what the guard changed, how alike the robot was to the person, which gestures it played."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from nao_sim.plotting.safety_page import safety_blocks, save_safety_plot
from nao_sim.plotting.style import Block

if TYPE_CHECKING:
    from nao_sim.performed import Performed


def save_run(run: Performed, path: Path, size: str | None = None) -> None:
    """Draw all of a run on one page.

    Args:
        run: what came of a recording.
        path: a `.png`, `.svg` or `.pdf`.
        size: a name of `SIZES`; what suits the kind of file where None.

    Raises:
        UsageError: it cannot be written there.
    """
    save_safety_plot(run.report, run.performance, run.simulator, path, size=size, more=_beside(run))


def run_blocks(run: Performed) -> list[Block]:
    """The same in small pieces, for a page of another kind; the legend of the first ones is the first."""
    return [*safety_blocks(run.performance, run.simulator), *_beside(run)]


def _beside(run: Performed) -> list[Block]:
    """What there is beside the guard's work."""
    blocks = []
    if run.similarity is not None and len(run.similarity.times):
        from nao_sim.plotting.similarity_page import similarity_block

        blocks.append(similarity_block(run.similarity))
    if run.recognised:
        from nao_sim.plotting.gestures_page import gestures_block

        blocks.append(gestures_block(run.recognised))
    return blocks
