"""One person, one robot: frames in at any time, one control step after the other out.

No socket, no thread and no clock: who calls says what time it is.  Whatever
comes in, the guard has the last word, `CONTROL_STEP` after `CONTROL_STEP`.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from nao_sim.imitation.arms import angle_between, arm_directions_of
from nao_sim.live.csv_recorder import CsvRecorder, record_aside, record_to
from nao_sim.live.follower import AngleFollower, Follower
from nao_sim.live.light import Signal, Situation
from nao_sim.live.moment import Command, Moment, World
from nao_sim.live.person import FIRST, PersonReader
from nao_sim.live.problem import LiveError
from nao_sim.live.protocol import Angles, Frame, Hello, Mode
from nao_sim.live.timing import Arrivals
from nao_sim.robot import START_POSTURE, Array
from nao_sim.safety.guard import Guard
from nao_sim.safety.support import SOLES
from nao_sim.simulation.measures import FALLEN_TILT
from nao_sim.simulation.simulator import CONTROL_STEP, Simulator

REMEMBERED = 10.0  # s that can be shown again
MOST_REMEMBERED = 1200  # frames
COMPARED = 2  # steps from a comparison of person and robot to the next


class Session:
    """One person and one robot; it has a state.

    Args:
        world: what robots share.
        hello: what the person's frames are, and what is wanted of them.
        record: a file for all that is received, if any.
        joints: what the points are, where they come from a recording that was read already.

    Raises:
        LiveError: there is no such layout.
        UsageError: the file cannot be written.
    """

    def __init__(
        self, world: World, hello: Hello, record: Path | None = None, joints: tuple[str, ...] | None = None
    ) -> None:
        self._world = world
        self._start = world.robot.postures[START_POSTURE]
        self._nothing = np.full(len(self._start), np.nan)
        self._record, self._file, self._aside = record, None, None
        self._source: object = None  # what of a hello says what the numbers are
        self._recording = self._paused = self._slow = False
        self.adopt(hello, joints)
        self._simulator = Simulator(world.robot, posture=START_POSTURE, model=world.model)
        self._soles = [world.model.geom(sole).id for sole in SOLES]
        self._signal, self._step = Signal(world.robot), 0
        self.reset()

    _follower: Follower | AngleFollower | None
    _file: CsvRecorder | None
    _aside: CsvRecorder | None

    def adopt(self, hello: Hello, joints: tuple[str, ...] | None = None) -> None:
        """Follow another source from now on; the robot goes on from where it stands.

        Raises:
            LiveError: there is no such layout.
            UsageError: a file for what is received cannot be written.
        """
        source = (hello.layout, hello.unit, hello.axes, hello.planar, joints)
        same, self._source, self._hello = self._source == source, source, hello
        self.arrivals = Arrivals()
        self._recent: deque[Frame] = deque(maxlen=MOST_REMEMBERED)
        self._shown: deque[Frame] = deque()  # what of a replay is still to come
        self._shown_from = (0.0, 0.0)  # its first time, and when it was asked for
        if same:  # who comes back need not be found out anew
            self.configure(hello.mode, hello.mirror)
            return
        self.reader, self._follower = PersonReader(hello, joints), None
        self._unread: deque[tuple[Frame, float]] = deque(maxlen=FIRST)
        self._close_files()
        self._recording = False
        self._file = record_to(self._record, self.reader.columns) if self._record and self.reader.columns else None

    def reset(self) -> None:
        """Put the robot on its feet, as it was in the beginning, and forget the person."""
        self._simulator.reset()
        self._compared = np.full((2, 2), np.nan)
        self._guard = Guard(self._world.robot, self._start, standing=True, rules=self._world.rules)
        self.forget()

    def receive(self, frame: Frame, now: float) -> None:
        """Take a frame that came at `now` (s).

        Raises:
            LiveError: it is no frame of this person; the robot is as before.
        """
        if len(frame.points) != self.reader.points:
            self.arrivals.counts.refused += 1
        elif not self.arrivals.take(frame.time, now):
            return
        else:
            self._keep(frame)
        if not self._shown or len(frame.points) != self.reader.points:
            self._follow(frame, self.arrivals.offset, now)

    def receive_angles(self, angles: Angles, now: float) -> None:
        """Take a robot's joint angles that came at `now` (s), to be done as they are."""
        if not self.arrivals.take(angles.time, now):
            return
        if not isinstance(self._follower, AngleFollower):
            self._follower = AngleFollower()
        self._follower.take(angles.positions, angles.time + self.arrivals.offset, now)

    def _follow(self, frame: Frame, offset: float, now: float) -> None:
        """Hand a frame on; the first ones as soon as it is known what their numbers mean."""
        try:
            seen = self.reader.read(frame)
        except LiveError:
            self._unread.clear()
            raise
        if seen is None:
            self._unread.append((frame, offset))
            return
        if not isinstance(self._follower, Follower):
            self._follower = self._new_follower()
        while self._unread:
            self._take(*self._unread.popleft(), now)
        self._follower.take(seen[0], frame.time + offset, seen[1], now)

    def _take(self, frame: Frame, offset: float, now: float) -> None:
        """Hand on a frame that could not be read before."""
        seen = self.reader.read(frame)
        if seen is not None and isinstance(self._follower, Follower):
            self._follower.take(seen[0], frame.time + offset, seen[1], now)

    def _new_follower(self) -> Follower:
        world = self._world
        return Follower(
            self.reader.joints, world.robot, self._start, world.vocabulary, self._hello.mode, self.reader.planar
        )

    def _keep(self, frame: Frame) -> None:
        """Remember a frame, and write it where it is to be written."""
        self._recent.append(frame)
        while not 0.0 <= frame.time - self._recent[0].time <= REMEMBERED:
            self._recent.popleft()
        for recorder in (self._file, self._aside if self._recording else None):
            if recorder:
                recorder.write(frame)

    def pass_over(self, frame: Frame) -> None:
        """Remember and record a frame that newer ones have overtaken; the robot never sees it."""
        self.arrivals.pass_over()
        newest = self._recent[-1].time if self._recent else -math.inf
        if len(frame.points) == self.reader.points and newest < frame.time:
            self._keep(frame)

    def configure(self, mode: Mode | None = None, mirror: bool | None = None) -> None:
        """Imitate otherwise from now on."""
        self._hello = replace(
            self._hello, mode=mode or self._hello.mode, mirror=self._hello.mirror if mirror is None else mirror
        )
        self.reader.mirror(self._hello.mirror)
        if self.reader.understood is not None:
            self._follower = self._new_follower()

    def pause(self, on: bool) -> None:
        """Let the robot wait where it is, or go on."""
        self._paused = on

    def record(self, on: bool) -> None:
        """Begin to record what comes, anew, or end it."""
        if on:
            if self._aside:
                self._aside.close()
            self._aside = record_aside(self.reader.columns)
        self._recording = on

    def recording(self) -> tuple[bytes, int]:
        """What was recorded, as CSV, and how many frames.

        Raises:
            LiveError: nothing was.
        """
        if self._aside is None or not self._aside.rows:
            raise LiveError("no_recording", "nothing was recorded; expected a record message, and frames, before")
        return self._aside.text(), self._aside.rows

    def replay(self, on: bool, now: float) -> None:
        """Do again what came in the last ten seconds; or follow the person again.

        Raises:
            LiveError: nothing came.
        """
        if on and not self._recent:
            raise LiveError("nothing_to_replay", "no frame in the last ten seconds; expected some")
        self.forget()
        self._shown = deque(self._recent) if on else deque()
        self._shown_from = (self._recent[0].time, now) if on else (0.0, 0.0)

    def forget(self) -> None:
        """Take the next frame for the first."""
        if self._follower:
            self._follower.reset()

    def _show_again(self, now: float) -> None:
        """Feed what of a replay is due."""
        first, began = self._shown_from
        while self._shown and self._shown[0].time - first <= now - began:
            self._follow(self._shown.popleft(), began - first, now)
        if not self._shown:
            self.forget()

    def behind(self, slow: bool) -> None:
        """Say whether the machine falls behind."""
        self._slow = slow

    def step(self, now: float, commanded_now: Callable[[Command], None] | None = None) -> Moment:
        """The next control step.

        Args:
            now: s.
            commanded_now: told the command before the physics, which takes as long as the guard.
        """
        if self._shown:
            self._show_again(now)
        asked = None if self._follower is None else self._follower.asked(now, self.arrivals.interval)
        requested = self._nothing if asked is None or self._paused else asked
        commanded, intervention = self._guard.step(requested, CONTROL_STEP)
        self._step += 1
        frame_time = self.arrivals.last if math.isfinite(self.arrivals.last) else math.nan
        if commanded_now:
            commanded_now(Command(self._step, commanded, frame_time))
        simulated = self._simulator.advance(commanded)
        age = now - self.arrivals.received if math.isfinite(self.arrivals.last) else math.nan
        return Moment(
            step=self._step,
            requested=requested,
            commanded=commanded,
            simulated=simulated,
            base_pose=self._simulator.base_pose(),
            intervention=intervention,
            frame_time=frame_time,
            age=age,
            decision=self._follower.decision if self._follower else None,
            errors=self._errors(simulated),
            light=self._signal.show(self._situation(asked, age), intervention, now),
            flags=self._flags(),
            counts=replace(self.arrivals.counts),
        )

    def _errors(self, simulated: Array) -> Array:
        """Angles (2, 2) between the person's arms and the robot's, every second step: about as often as frames come."""
        if self._follower is None:
            return np.full((2, 2), np.nan)
        if self._step % COMPARED == 0:
            self._compared = angle_between(self._follower.arms, arm_directions_of(simulated[None])[0])
        return self._compared

    def _situation(self, asked: Array | None, age: float) -> Situation:
        showing = bool(self._shown)
        return Situation(
            fell=bool(self._simulator.data.geom_xmat[self._soles, 8].max() < np.cos(FALLEN_TILT)),
            silence=None if math.isnan(age) else 0.0 if showing else age,
            seen=asked is None or bool(np.isfinite(asked).any()),
            learning=self.reader.understood is None,
            paused=self._paused,
            delay=self.arrivals.delay,
            slow=self._slow,
        )

    def _flags(self) -> tuple[str, ...]:
        told = {"paused": self._paused, "recording": self._recording, "replaying": bool(self._shown)}
        return tuple(name for name, is_so in told.items() if is_so)

    def noticed(self, moment: Moment) -> list[tuple[str, tuple[str, ...], list[int]]]:
        """What the guard changed so far that a user should know: reason, links, joints."""
        return [(change.reason, change.links, joints) for change, joints in self._signal.noticed(moment.intervention)]

    def _close_files(self) -> None:
        for recorder in (self._file, self._aside):
            if recorder:
                recorder.close()
        self._file = self._aside = None

    def close(self) -> None:
        """Let go of files."""
        self._close_files()
