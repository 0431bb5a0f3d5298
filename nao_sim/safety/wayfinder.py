"""Who stands before an obstacle, although there is a way round it, is led that way."""

from __future__ import annotations

import numpy as np

from nao_sim.robot import Array, Robot
from nao_sim.safety.detour import Detour
from nao_sim.safety.nearest_pose import nearest_pose
from nao_sim.safety.promise import Promise
from nao_sim.safety.route import Route
from nao_sim.safety.speed import Pace

LIMBS = ("Head", "LArm", "RArm")  # legs have no way round: they stand
CONSTANT = 0.05  # rad; a request that moves less stands still
NOT_THERE = 0.02  # rad of a joint from the request
PROGRESS = 0.005  # rad nearer, all joints together
PATIENCE = 0.4  # s without progress before the search begins
WORTH = 0.05  # rad by which the way round must end nearer to the request, all joints together
SHARE = 0.6  # of the usual speed and acceleration, on the way round
SETTLED = 0.003  # rad; who rests before an obstacle moves again when the request does so by more
LOST = 0.1  # rad beside the way
POSES_A_STEP = 40  # looked at in a control step


class Wayfinder:
    """Leads the robot round what bars its way to a request that stands still.

    Args:
        robot: whose arms and head go the way.
        promise: which poses are allowed.
        bounds: lowest and highest command, (26,) each.
        pace: the speeds that the joints may have.
    """

    def __init__(self, robot: Robot, promise: Promise, bounds: tuple[Array, Array], pace: Pace) -> None:
        self._robot, self._promise, self._bounds, self._pace = robot, promise, bounds, pace
        self._joints = robot.joints_of(*LIMBS)
        self._request: Array | None = None
        self._resting: Array | None = None
        self._rest = self._start = np.zeros(0)
        self._begin(None)

    def step(self, target: Array, position: Array, dt: float) -> Array | None:
        """Where (26,) to go instead of the target; None: straight there.

        Args:
            target: (26,) what the joints' own rules leave of the request.
            position: (26,) the previous command.
            dt: s.
        """
        if self._request is None or np.abs(target - self._request).max() > CONSTANT:
            self._begin(target)
        if self._route is not None:
            return self._followed(position, dt)
        if self._search is not None:
            return self._searched(target)
        if self._resting is not None:
            if np.abs(target - self._resting).max() < SETTLED:
                return self._rest
            self._resting = None
            self._waited = 0.0
        if self._stuck(target, position, dt):
            if self._tried:
                return self._rested(target, position)
            self._look_for(target, position)
        return None

    @property
    def rests(self) -> bool:
        """Whether the robot stands before what bars its way, and there is no way round."""
        return self._resting is not None

    def _begin(self, request: Array | None) -> None:
        """Forget what was done for another request."""
        self._request = None if request is None else request.copy()
        self._waited, self._nearest, self._tried = 0.0, np.inf, False
        self._resting = None
        self._search: Detour | None = None
        self._route: Route | None = None
        self._time = 0.0

    def _stuck(self, target: Array, position: Array, dt: float) -> bool:
        """Whether the robot has come no nearer for a while; one that trembles on the spot comes no nearer."""
        away = (target - position)[self._joints]
        gap = float(np.linalg.norm(away))
        if gap < self._nearest - PROGRESS or np.abs(away).max() < NOT_THERE:
            self._nearest, self._waited = min(gap, self._nearest), 0.0
        else:
            self._waited += dt
        return self._waited > PATIENCE

    def _rested(self, target: Array, position: Array) -> Array:
        """There is no way nearer: stand still, rather than tremble before what bars it."""
        self._rest, self._resting = np.where(self._joints, position, target), target.copy()
        return self._rest

    def _look_for(self, target: Array, position: Array) -> None:
        """Begin to search for a way to the target, or if that is no safe pose to the nearest one."""
        self._tried, self._waited = True, 0.0
        wished = np.where(self._joints, target, position)
        goal: Array | None = wished
        if not self._promise.allowed(wished[None]):
            goal = nearest_pose(self._promise, wished, wished, self._bounds, self._joints)
        if goal is None or np.linalg.norm(goal - wished) > np.linalg.norm(position - wished) - WORTH:
            return
        self._start = position.copy()
        self._search = Detour(self._robot, self._promise.allowed, self._start, goal, self._joints, self._bounds)

    def _searched(self, target: Array) -> Array | None:
        """Search a little; stay meanwhile."""
        search = self._search
        if search is None or search.state == "failed":
            self._search = None
            return None
        search.work(POSES_A_STEP)
        if search.path is not None:
            self._search = None
            self._route = Route(search.path, SHARE * self._pace.top, SHARE * self._pace.acceleration)
        return np.where(self._joints, self._start, target)

    def _followed(self, position: Array, dt: float) -> Array | None:
        """The next place on the way, unless it is at its end or the robot is no longer on it."""
        route = self._route
        if route is None or self._time >= route.duration:
            self._route = None
            return None
        if np.abs(route.at(self._time) - position)[self._joints].max() > LOST:
            self._route = None
            return None
        self._time += dt
        return np.where(self._joints, route.at(self._time), position)
