"""What can be seen of a performance, moment by moment: poses, colours, words."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from nao_sim.rendering.figure import add_figure, figure_of
from nao_sim.rendering.looks import dress
from nao_sim.rendering.preset_kinds import Camera
from nao_sim.rendering.presets import load_camera, load_figure, load_look, load_theme
from nao_sim.robot import Array
from nao_sim.safety_colours import SafetyColours
from nao_sim.simulation.scene import compiled, compose

if TYPE_CHECKING:
    from nao_sim.performed import Performed
    from nao_sim.rendering.figure import Figure
    from nao_sim.rendering.tint import Tinted
    from nao_sim.simulation.rollout import Rollout

PERSON_GROUP, COLLISION_GROUP = 5, 3  # groups of geoms; the person's own, so that it can be hidden
PERSON_BODIES = "person_"  # how the names of its bodies begin
_CAMERA = "three-quarter"


@dataclass(frozen=True, eq=False)
class Stage:
    """The scene of a performance, and what of it changes.

    Attributes:
        model: the scene, with the person in it where one can be drawn.
        performed: what is shown.
        figure: the person, if any.
        tinted: the guard's colours and words in each control step, (T, width).
    """

    model: mujoco.MjModel
    performed: Performed
    figure: Figure | None
    tinted: Tinted

    @property
    def rollout(self) -> Rollout:
        """What was asked, commanded and done."""
        return self.performed.performance.rollout

    @property
    def duration(self) -> float:
        """Seconds that there are to show."""
        return float(self.rollout.time[-1])

    @property
    def camera(self) -> Camera:
        """From where to look at first."""
        return load_camera(f"{_CAMERA}{load_figure().camera if self.figure else ''}")

    def qpos(self, times: Array) -> Array:
        """Poses (N, nq) of the scene at `times` (N,) s."""
        poses = self.performed.simulator.map.to_qpos(*self.rollout.at(times))
        if self.figure is None:
            return poses
        return np.hstack([poses, self.figure.at(times - self.rollout.motion_start)])

    def tint(self, time: float) -> Array:
        """The row (width,) of the tint at a time (s): that of the control step which then lasts."""
        return self.tinted.rows[min(int(np.searchsorted(self._times, time - 1e-9)), len(self._times) - 1)]

    def words(self, row: Array) -> list[str]:
        """What the guard does, of a row of the tint."""
        labels = self.tinted.tint.script.labels
        return [label.word for label, opacity in zip(labels, row[-len(labels) :], strict=True) if opacity > 0.0]

    def recording_time(self, time: float) -> float:
        """Where in the recording (s) a moment is; negative on the way to its first pose."""
        return (time - self.rollout.motion_start) * self.rollout.speed

    @property
    def recording_lasts(self) -> float:
        """Seconds of the recording."""
        return float(self.performed.task.recording.motion.duration)

    @cached_property
    def _times(self) -> Array:
        return self.rollout.time


def stage_of(performed: Performed, look: str, theme: str) -> Stage:
    """The stage of a performance.

    Args:
        performed: what is to be shown.
        look: name of the surroundings.
        theme: name of the robot's colours.

    Raises:
        UsageError: no look or theme of that name.
    """
    simulator, person = performed.simulator, performed.task.person
    scene = dress(
        compose(simulator.robot.version, "free" if simulator.map.free else "pinned"), load_look(look), load_theme(theme)
    )
    figure = figure_of(person) if person is not None else None
    if figure is not None:
        add_figure(scene, figure)
    model = compiled(scene)
    _group_person(model)
    performance = performed.performance
    times = performance.rollout.time
    tinted = SafetyColours(model, simulator.robot).at(times, performance.interventions, times)
    return Stage(model, performed, figure, tinted)


def _group_person(model: mujoco.MjModel) -> None:
    for geom in range(model.ngeom):
        if model.body(model.geom_bodyid[geom]).name.startswith(PERSON_BODIES):
            model.geom_group[geom] = PERSON_GROUP
