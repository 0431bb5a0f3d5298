"""What the guard changed, as colours on the limbs of the filmed robot: the film's side of `--overlay safety`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nao_sim.fading import shown
from nao_sim.rendering.captions import Label, Script
from nao_sim.rendering.preset_kinds import ReasonLooks
from nao_sim.rendering.presets import load_safety
from nao_sim.rendering.tint import Tint, Tinted, cover
from nao_sim.robot import Array, Robot

if TYPE_CHECKING:
    import mujoco

    from nao_sim.safety.change import Change, Intervention

TORSO = "torso"  # its body's name in the model, and the part of the robot that no joint moves


class SafetyColours:
    """Tells which limbs of one robot take which colour, and when.

    Args:
        model: the filmed scene, with one robot in it.
        robot: whose limbs they are.

    Attributes:
        tint: what of the scene may take colour, and the captions.
    """

    def __init__(self, model: mujoco.MjModel, robot: Robot) -> None:
        self._robot, self._looks = robot, load_safety()
        self._parts = (*robot.limbs, TORSO)
        self._part_of_body = _part_of_body(model, robot)
        order = list(self._looks.colours)  # a colour covers those before it
        self._reasons = dict(sorted(self._looks.reasons.items(), key=lambda item: order.index(item[1].colour)))
        self._words = tuple(dict.fromkeys((reason.word, reason.colour) for reason in self._reasons.values()))
        self.tint = Tint(
            *_geoms(model, self._part_of_body, self._parts, self._looks.takes),
            Script(tuple(Label(word, self._looks.colours[colour]) for word, colour in self._words), self._looks.letter),
        )

    def at(self, times: Array, interventions: Sequence[Intervention], step_times: Array) -> Tinted:
        """What the frames of a film show.

        Args:
            times: (N,) s, of the frames.
            interventions: what the guard changed, (T,).
            step_times: (T,) s, when; evenly.
        """
        if len(interventions) != len(step_times):
            raise ValueError(f"{len(interventions)} interventions; expected one for each of {len(step_times)} steps")
        active = self._active(interventions)
        covers = np.zeros((len(times), len(self._parts), 4))
        opacities = np.zeros((len(times), len(self._words)))
        for name, reason in self._reasons.items():
            if name not in active:
                continue
            levels = shown(active[name], times, step_times, self._looks.hold, self._looks.fade)
            covers = cover(covers, self._looks.colours[reason.colour], levels)
            word = self._words.index((reason.word, reason.colour))
            opacities[:, word] = np.maximum(opacities[:, word], levels.max(axis=1))
        return Tinted(self.tint, self.tint.row(covers, opacities))

    def _active(self, interventions: Sequence[Intervention]) -> dict[str, Array]:
        """In which steps each reason holds for which parts: (T, parts) of 0 and 1, where it ever does."""
        active: dict[str, Array] = {}
        least = {name: self._least(reason) for name, reason in self._reasons.items()}
        for step, intervention in enumerate(interventions):
            for change in intervention:
                large = change.size >= least.get(change.reason, np.inf)
                if large.any():
                    steps = active.setdefault(change.reason, np.zeros((len(interventions), len(self._parts))))
                    steps[step, [self._parts.index(part) for part in self._concerned(change, large)]] = 1.0
        return active

    def _least(self, reason: ReasonLooks) -> Array:
        """Changes (26,) of the joints that are large enough to be shown."""
        return np.where(self._robot.is_hand, self._looks.least_hand, np.radians(reason.least_deg))

    def _concerned(self, change: Change, large: NDArray[np.bool_]) -> Iterable[str]:
        """The parts that a change colours, `large` (26,) telling the joints that it really changed."""
        where = self._reasons[change.reason].where
        if not isinstance(where, str):
            return where
        if where == "links" and change.links:
            return {self._part_of_body[link] for link in change.links if link in self._part_of_body}
        return [limb for limb, joints in self._robot.limbs.items() if large[joints].any()]


def _part_of_body(model: mujoco.MjModel, robot: Robot) -> dict[str, str]:
    """The limb of each body of the robot: that of the nearest joint above it; the torso's own has none."""
    limb_of = {robot.joint_names[joint]: limb for limb, joints in robot.limbs.items() for joint in joints}
    parts = {TORSO: TORSO}
    for number in range(1, model.nbody):  # parents come before their children
        body, parent = model.body(number), model.body(model.body_parentid[number]).name
        joints = [model.joint(i).name for i in range(body.jntadr[0], body.jntadr[0] + body.jntnum[0])]
        limb = next((limb_of[name] for name in joints if name in limb_of), parts.get(parent))
        if limb is not None and body.name != TORSO:
            parts[body.name] = limb
    return parts


def _geoms(
    model: mujoco.MjModel, part_of_body: Mapping[str, str], parts: Sequence[str], takes: Mapping[str, float]
) -> tuple[tuple[tuple[int, ...], ...], tuple[tuple[float, ...], ...]]:
    """The geoms of each part that take colour, by their material, and how far."""
    take = {i: takes[name] for i in range(model.nmat) if (name := model.material(i).name) in takes}
    geoms: dict[str, list[int]] = {part: [] for part in parts}
    for geom in np.flatnonzero(np.isin(model.geom_matid, list(take))):
        if part := part_of_body.get(model.body(model.geom_bodyid[geom]).name):
            geoms[part].append(int(geom))
    each = tuple(map(tuple, geoms.values()))
    return each, tuple(tuple(take[int(model.geom_matid[geom])] for geom in of_part) for of_part in each)
