"""Self-collision: no two links nearer than a clearance, but for neighbours by construction."""

from __future__ import annotations

from collections.abc import Mapping

import mujoco
import numpy as np

from nao_sim.safety.margins import Margin
from nao_sim.safety.posed import PosedRobot, hand_of_finger

NAME = "self_collision"
Links = tuple[str, ...]
CLEARANCE = 0.01  # m kept between links at the command: sag and lag take the rest
WIDER: Mapping[Links, float] = {("l_ankle", "r_ankle"): 0.0125}  # at the far ends of legs whose joints lag unalike
WIDEST = max(CLEARANCE, *WIDER.values())
ALLOWED: Mapping[Links, float] = {}


def clearance(links: Links) -> float:
    """What two links keep between them, m."""
    return WIDER.get(links, CLEARANCE)


class SelfCollisionRule:
    """Looks at the distances between the links of a posed robot.

    Args:
        posed: the robot, compiled with at least the margin that is asked for.
    """

    def __init__(self, posed: PosedRobot) -> None:
        self._posed = posed
        model = posed.model
        self._link = tuple(hand_of_finger(model.body(i).name) for i in range(model.nbody))

    def near(self, within: float, allowed: Mapping[Links, float] = ALLOWED) -> list[tuple[float, Links, int]]:
        """Pairs of links of the pose that are nearer than the clearance and `within` (m) more.

        Args:
            within: m; 0 for those that break the rule.
            allowed: smaller clearances (m) of single pairs.

        Returns:
            For each pair of shapes the distance (m) less the clearance, the links, and where `margin` finds it.
        """
        model, data = self._posed.model, self._posed.data
        mujoco.mj_collision(model, data)
        if data.ncon == 0:
            return []
        distances, geoms = data.contact.dist, data.contact.geom
        found = []
        for i in np.flatnonzero(distances < WIDEST + within):
            links = self._links(*model.geom_bodyid[geoms[i]])
            value = float(distances[i]) - allowed.get(links, clearance(links))
            if value < within:
                found.append((value, links, int(i)))
        return found

    def margin(self, value: float, links: Links, i: int) -> Margin:
        """What `near` found, with its gradient: how the two links part along the line between them."""
        contact = self._posed.data.contact
        first, second = self._posed.model.geom_bodyid[contact.geom[i]]
        return Margin(NAME, value, self._posed.parting(first, second, contact.pos[i], contact.frame[i, :3]), links)

    def _links(self, first: int, second: int) -> Links:
        a, b = self._link[first], self._link[second]
        return (a, b) if a < b else (b, a)
