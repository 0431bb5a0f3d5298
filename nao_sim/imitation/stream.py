"""One-to-one imitation of a person who is still moving: a frame in, what the robot is asked out.

Each frame is filtered by `Kalman` and turned into joint positions by
`one_to_one`, the very function that turns a whole recording.  What a recording
knows of its own future a stream does not: where a person without a face looks
ahead is the median of the last minute, not of the whole recording; and the
breadth of a head seen by a camera without depth is that of the frame.
"""

from __future__ import annotations

from collections import deque

import numpy as np

from nao_sim.imitation.filters import Kalman
from nao_sim.imitation.head import median, nod
from nao_sim.imitation.person import torso_frames
from nao_sim.imitation.retarget import one_to_one
from nao_sim.motion import Skeleton
from nao_sim.robot import Array, Robot

REMEMBERED = 60.0  # s, in which a person without a face is taken to look ahead half of the time
_FACE = frozenset({"nose", "left_eye", "right_eye"})


class ImitationStream:
    """Follows one person; it has a state.

    Args:
        joints: (J,) names of the rows of the frames.
        robot: whose limits hold.
        planar: whether one camera sees the person and x is 0 throughout.
        raw: whether to leave out the filter.

    Attributes:
        person: the last frame as it was imitated; None before the first.
    """

    person: Skeleton | None

    def __init__(self, joints: tuple[str, ...], robot: Robot, planar: bool = False, raw: bool = False) -> None:
        self._joints, self._robot, self._planar = joints, robot, planar
        self._filter = None if raw else Kalman()
        self._faceless = _FACE.isdisjoint(joints)
        self.reset()

    def reset(self) -> None:
        """Forget the person."""
        if self._filter:
            self._filter.reset()
        self._nods: deque[tuple[float, float]] = deque()  # time, angle
        self._told = np.full(len(self._robot.joint_names), np.nan)
        self.person = None

    def update(self, positions: Array, time: float, confidence: Array | None = None) -> Array:
        """Take one frame.

        Args:
            positions: (J, 3) m, x forward, y left, z up; nan where missing.
            time: s, after the last frame's.
            confidence: (J,) from 0 to 1; 1 throughout where None.

        Returns:
            (26,) joint positions inside the documented limits; nan where nothing is tracked, legs included.

        Raises:
            ValueError: time does not go on, or the frame has other joints.
        """
        frame = self._seen(positions, time, confidence)
        torso = torso_frames(frame)
        asked = one_to_one(frame, self._robot, self._told, self._upright(frame, torso), torso)[0]
        self._told = np.where(np.isfinite(asked), asked, self._told)
        self.person = frame
        return asked

    def _seen(self, positions: Array, time: float, confidence: Array | None) -> Skeleton:
        sure = np.ones(len(self._joints)) if confidence is None else np.asarray(confidence, float)
        if self._filter:
            positions = self._filter.step(time, positions, sure)
            sure = self._filter.confidence
        return Skeleton(np.array([time]), positions[None], self._joints, sure[None], self._planar)

    def _upright(self, frame: Skeleton, torso: Array) -> float:
        """The nod (rad) that counts as looking ahead; nan for people with a face, who need none."""
        if not self._faceless:
            return np.nan
        time = float(frame.times[0])
        self._nods.append((time, float(nod(frame, torso)[0])))
        while time - self._nods[0][0] > REMEMBERED:
            self._nods.popleft()
        return median(np.array([angle for _, angle in self._nods]))


def stream_imitation(skeleton: Skeleton, robot: Robot, raw: bool = False) -> Array:
    """What the robot is asked (T, 26) over a recording, frame after frame as in a stream."""
    stream = ImitationStream(skeleton.joints, robot, skeleton.planar, raw)
    frames = zip(skeleton.positions, skeleton.times.tolist(), skeleton.confidence, strict=True)
    return np.stack([stream.update(*frame) for frame in frames])
