"""Arms that bring the robot's hands where the person's are, by differential inverse kinematics.

The hands go to the places of `hand_places.py`, the elbows as far as that
leaves them free where the one-to-one arms have theirs; joint limits hold and
hands and forearms keep clear of head, trunk, thighs and each other (mink).
Frame after frame the last one's arms are where the search begins.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.imitation.arms import ARM_JOINTS
from nao_sim.imitation.hand_places import places_of, robot_hand, robot_places
from nao_sim.motion import Skeleton
from nao_sim.mujoco_model import JointMap, robot_alone_spec
from nao_sim.robot import START_POSTURE, Array, Robot, facts

if TYPE_CHECKING:
    import mink
    import mujoco

CLEARANCE = 0.012  # m between the arms and all else; so much more than the guard keeps that it seldom stops them
LOOKOUT = 0.03  # m, from where on two shapes are kept from each other
DEEPEST = 0.1  # m, more than shapes can be in each other
HASTE = 0.85  # of the room that is left, or missing, an iteration may use up, or must make
LIMIT_MARGIN = np.radians(0.45)  # a little more than the guard keeps
HAND_WEIGHT, ELBOW_WEIGHT, POSTURE_WEIGHT = 1.0, 0.1, 0.01  # on m, m and rad
FASTEST = 12.0  # rad/s of a joint, as fast as people's arms are: no jump from one way of reaching to another
LONGEST_STEP = 0.12  # rad of a joint in one iteration
ITERATIONS = (6, 60)  # most in a frame, and in the first one
ARRIVED = 1e-4  # rad; an iteration that moves no joint farther is the last
SOFT = 8  # DAQP's mark of a constraint that is broken as little as possible rather than leave no solution
PROGRESS_EVERY = 20  # frames
ARMS = {"L": "l_wrist", "R": "r_wrist"}
OBSTACLES = ("torso", "Head", "LPelvis", "RPelvis", "LHip", "RHip", "LThigh", "RThigh", "LTibia", "RTibia")
Progress = Callable[[int, int], None]


def match_hands(skeleton: Skeleton, positions: Array, robot: Robot, progress: Progress | None = None) -> Array:
    """Change the arms so that the hands are where the person's are.

    Args:
        skeleton: the person, T frames.
        positions: (T, 26) the one-to-one arms and what else is asked; nan where nothing is.
        robot: whose limits hold.
        progress: called now and then with the frames done and the frames in all.

    Returns:
        (T, 26) with other shoulders and elbows; nan where `positions` is.
    """
    targets = robot_places(places_of(skeleton), positions, robot)
    elapsed = np.diff(skeleton.times, prepend=-np.inf)
    follower, matched = _Follower(robot), np.array(positions)
    for frame in range(len(positions)):
        arms = follower.step(positions[frame], targets[frame], float(elapsed[frame]))
        matched[frame, follower.joints] = np.where(np.isfinite(positions[frame, follower.joints]), arms, np.nan)
        if progress and ((frame + 1) % PROGRESS_EVERY == 0 or frame + 1 == len(positions)):
            progress(frame + 1, len(positions))
    return matched


class _Follower:
    """Follows places of the hands, frame after frame.  It has a state: the pose of the last frame.

    Attributes:
        joints: (8,) indices of the arm joints that it moves.
    """

    def __init__(self, robot: Robot) -> None:
        import mink

        self._model = _model_with_palms()
        self._map, self._configuration = JointMap(self._model), mink.Configuration(self._model)
        self.joints = np.array([robot.index[letter + name] for letter in ARMS for name in ARM_JOINTS])
        self._dofs = self._map.dofs[self.joints]
        self._bounds = robot.lower[self.joints] + LIMIT_MARGIN, robot.upper[self.joints] - LIMIT_MARGIN
        self._torso = self._model.body("torso").pos
        self._hands = [mink.FrameTask(f"{letter}Palm", "site", HAND_WEIGHT, 0.0) for letter in ARMS]
        self._elbows = [mink.FrameTask(f"{letter}Elbow", "body", ELBOW_WEIGHT, 0.0) for letter in ARMS]
        self._posture = mink.PostureTask(self._model, POSTURE_WEIGHT)
        self._limit = mink.ConfigurationLimit(self._model, gain=1.0, min_distance_from_limits=LIMIT_MARGIN)
        self._collision = mink.CollisionAvoidanceLimit(
            self._model,
            _pairs(self._model),
            gain=HASTE,
            # mink only stops what is too near from coming nearer; counted from deep inside, it drives it out
            minimum_distance_from_collisions=-DEEPEST,
            bound_relaxation=-HASTE * (CLEARANCE + DEEPEST),
            collision_detection_distance=LOOKOUT,
        )
        self._pose = robot.postures[START_POSTURE].copy()

    def step(self, asked: Array, places: Array, elapsed: float) -> Array:
        """The arms (8,) rad of the next frame.

        Args:
            asked: (26,) the one-to-one arms and the rest of the body, not finite where nothing is asked.
            places: (2, 3) m, where the palms belong in the torso; not finite for a hand that is not tracked.
            elapsed: s since the last frame; infinite in the first one.
        """
        last = self._pose[self.joints]
        self._pose = np.where(np.isfinite(asked), asked, self._pose)
        self._pose[self.joints] = np.clip(self._pose[self.joints], *self._bounds)
        goals = self._goals(places)
        if np.isfinite(elapsed) or not self._is_free():
            self._pose[self.joints] = last
        for _ in range(ITERATIONS[int(np.isinf(elapsed))]):
            move = self._move(goals, last, FASTEST * elapsed)
            self._pose[self.joints] += move
            if np.abs(move).max() < ARRIVED:
                break
        return self._pose[self.joints].copy()

    def _goals(self, places: Array) -> list[tuple[mink.FrameTask, Array]]:
        """What is to come where, m: palms and elbows; the posture besides.  The pose is the one-to-one one."""
        qpos = self._map.to_qpos(self._pose)
        self._configuration.update(qpos)
        self._posture.set_target(qpos)
        known = [side for side in range(len(ARMS)) if np.isfinite(places[side]).all()]
        elbows = [self._configuration.data.xpos[self._model.body(f"{letter}Elbow").id].copy() for letter in ARMS]
        hands = [(self._hands[side], self._torso + places[side]) for side in known]
        return hands + [(self._elbows[side], elbows[side]) for side in known]

    def _is_free(self) -> bool:
        """Whether nothing is too near to anything."""
        room = np.asarray(self._collision.compute_qp_inequalities(self._configuration, 1.0).h)
        return bool((room >= 0.0).all())

    def _move(self, goals: list[tuple[mink.FrameTask, Array]], last: Array, farthest: float) -> Array:
        """One iteration: the way (8,) rad that brings the joints nearer to the goals, and by no more than that."""
        import daqp
        import mink

        configuration, arms = self._configuration, self._pose[self.joints]
        configuration.update(self._map.to_qpos(self._pose))
        for task, goal in goals:
            # only the place counts: a target that is turned as the frame is now leaves no error of that
            now = configuration.get_transform_frame_to_world(task.frame_name, task.frame_type)
            task.set_target(mink.SE3.from_rotation_and_translation(now.rotation(), goal))
        tasks = [self._posture, *(task for task, _ in goals)]
        problem = mink.build_ik(configuration, tasks, 1.0, limits=[self._limit, self._collision])
        # all other joints stay, so their columns drop out
        ours, most_of = np.asarray(problem.G)[:, self._dofs], np.asarray(problem.h)
        rows = np.flatnonzero(np.isfinite(most_of) & ours.any(axis=1))
        least, most = (
            np.maximum(last - farthest - arms, -LONGEST_STEP),
            np.minimum(last + farthest - arms, LONGEST_STEP),
        )
        upper = np.concatenate([np.maximum(most, 0.0), most_of[rows]])
        lower = np.concatenate([np.minimum(least, 0.0), np.full(len(rows), -np.inf)])
        sense = np.concatenate([np.zeros(len(arms)), np.where(rows < 2 * len(self._limit.indices), 0, SOFT)])
        hessian = np.ascontiguousarray(np.asarray(problem.P)[np.ix_(self._dofs, self._dofs)])
        move, _, status, _ = daqp.solve(
            hessian, np.asarray(problem.q)[self._dofs], ours[rows], upper, lower, sense.astype(np.int32)
        )
        return np.asarray(move) if status > 0 else np.zeros(len(arms))


def _model_with_palms() -> mujoco.MjModel:
    """The robot with a site in the middle of each palm, on the axis of the forearm."""
    spec = robot_alone_spec()
    for letter, link in ARMS.items():
        spec.body(link).add_site(name=f"{letter}Palm", pos=[robot_hand(), 0.0, 0.0])
    for equality in list(spec.equalities):  # all joints that they tie stay where they are
        spec.delete(equality)
    return spec.compile()


def _pairs(model: mujoco.MjModel) -> list[tuple[list[int], list[int]]]:
    """Groups of shapes that are kept from each other: hands and forearms from all else, upper arms from the head."""

    def shapes(*links: str) -> list[int]:
        return [int(i) for i in np.flatnonzero(np.isin(model.geom_bodyid, [model.body(link).id for link in links]))]

    fingers = [finger["child_link"] for finger in facts()["hand"]["finger_joints"]]
    left, right = (
        shapes(f"{letter}ForeArm", link, *(finger for finger in fingers if finger[0] == letter))
        for letter, link in ARMS.items()
    )
    return [
        (left, right),
        (left, shapes(*OBSTACLES, "RShoulder", "RBicep")),
        (right, shapes(*OBSTACLES, "LShoulder", "LBicep")),
        (shapes("LBicep", "RBicep"), shapes("Head")),
    ]
