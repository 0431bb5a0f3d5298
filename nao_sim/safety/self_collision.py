"""Self-collision: no two links nearer than a clearance, but for neighbours by construction."""

from __future__ import annotations

from collections.abc import Mapping

import mujoco
import numpy as np

from nao_sim.safety.margins import Margin
from nao_sim.safety.posed import PosedRobot

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
        of_shape = [posed.links[body] for body in posed.model.geom_bodyid]
        self._links = [[_pair(a, b) for b in of_shape] for a in of_shape]
        self._clearance = np.array([[clearance(links) for links in row] for row in self._links])

    def near(self, within: float, allowed: Mapping[Links, float] = ALLOWED) -> list[tuple[float, Links, int]]:
        """Pairs of links of the pose that are nearer than the clearance and `within` (m) more.

        Args:
            within: m; 0 for those that break the rule.
            allowed: smaller clearances (m) of single pairs.

        Returns:
            For each pair of shapes the distance (m) less the clearance, the links, and where `margin` finds it.
        """
        data = self._posed.data
        mujoco.mj_collision(self._posed.model, data)
        if data.ncon == 0:
            return []
        contact = data.contact
        shapes = contact.geom
        values = contact.dist - self._clearance[shapes[:, 0], shapes[:, 1]]
        found = []
        for i in (values < within).nonzero()[0].tolist():
            first, second = shapes[i].tolist()
            links, value = self._links[first][second], float(values[i])
            value += clearance(links) - allowed.get(links, clearance(links)) if allowed else 0.0
            if value < within:
                found.append((value, links, i))
        return found

    def margin(self, value: float, links: Links, i: int) -> Margin:
        """What `near` found, with its gradient: how the two links part along the line between them."""
        contact = self._posed.data.contact
        first, second = self._posed.model.geom_bodyid[contact.geom[i]]
        return Margin(NAME, value, self._posed.parting(first, second, contact.pos[i], contact.frame[i, :3]), links)


def _pair(a: str, b: str) -> Links:
    return (a, b) if a < b else (b, a)
