"""One-to-one retargeting against mink's differential inverse kinematics on the same robot and the same people.

    python benchmarks/retargeting.py RECORDING... [--repeats 5] [--frames 300]

mink gets what its users give it: a frame task for each elbow and wrist, where
the person's directions put them with NAO's lengths, the joint limits, and a
weak posture task; one or more iterations a frame, each from the last answer.
Both sides get the same directions and run on one thread.  The figures are
noted in RESULTS.md.
"""

from __future__ import annotations

import os

os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")

import argparse
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import mink
import numpy as np
from benchmark import Rows, interleaved, machine, note

from nao_sim.imitation.arms import direction_error
from nao_sim.imitation.feasible import feasible_positions
from nao_sim.imitation.features import LEFT, RIGHT
from nao_sim.imitation.filters import clean
from nao_sim.imitation.person import arm_directions
from nao_sim.imitation.retarget import one_to_one
from nao_sim.motion import Skeleton
from nao_sim.mujoco_model import JointMap, robot_alone
from nao_sim.recordings import load
from nao_sim.robot import Array, load_robot

ITERATIONS = (1, 5, 20)
SIDES = ((LEFT, "L"), (RIGHT, "R"))


class Mink:
    """Differential inverse kinematics of both arms.

    Args:
        iterations: steps of the solver a frame.
    """

    def __init__(self, iterations: int) -> None:
        self._iterations = iterations
        self._model = robot_alone()
        for _, letter in SIDES:  # the elbow beside the upper arm's axis would pull mink off the wanted directions
            self._model.body(f"{letter}Elbow").pos[1] = 0.0
        self._map = JointMap(self._model)
        self._limits = [mink.ConfigurationLimit(self._model)]
        self._configuration = mink.Configuration(self._model)
        start = self._map.to_qpos(load_robot().postures["StandInit"])
        self._configuration.update(start)
        self._posture = mink.PostureTask(self._model, cost=1e-3)
        self._posture.set_target(start)
        self._tasks = {
            (side, part): mink.FrameTask(body, "body", position_cost=1.0, orientation_cost=0.0)
            for side, letter in SIDES
            for part, body in (("elbow", f"{letter}Elbow"), ("wrist", f"{letter.lower()}_wrist"))
        }
        data = self._configuration.data
        self._shoulders = {side: data.body(f"{letter}Shoulder").xpos.copy() for side, letter in SIDES}
        elbow, wrist = data.body("LElbow").xpos, data.body("l_wrist").xpos
        self._lengths = [float(np.linalg.norm(elbow - self._shoulders[LEFT])), float(np.linalg.norm(wrist - elbow))]

    def retarget(self, directions: Array) -> Array:
        """Joint positions (T, 26) for directions (T, 2, 2, 3)."""
        positions = []
        tasks = [*self._tasks.values(), self._posture]
        for frame in directions:
            self._aim(frame)
            for _ in range(self._iterations):
                velocity = mink.solve_ik(self._configuration, tasks, 1.0, solver="daqp", limits=self._limits)
                self._configuration.integrate_inplace(velocity, 1.0)
            positions.append(self._configuration.q[self._map.qpos])
        return np.array(positions)

    def _aim(self, directions: Array) -> None:
        for side, _ in SIDES:
            elbow = self._shoulders[side] + self._lengths[0] * directions[side, 0]
            wrist = elbow + self._lengths[1] * directions[side, 1]
            for part, place in (("elbow", elbow), ("wrist", wrist)):
                self._tasks[side, part].set_target(mink.SE3.from_translation(place))


def errors(positions: Array, directions: Array) -> Array:
    """Mean angle (T,) rad between the robot's four segments and the wanted ones."""
    return direction_error(positions, directions).mean(axis=(1, 2))


def frame_by_frame(person: Skeleton) -> Array:
    """`one_to_one` as a stream calls it: one frame at a time, each from the last answer."""
    robot, previous, positions = load_robot(), None, []
    for i in range(len(person)):
        frame = slice(i, i + 1)
        single = replace(
            person,
            times=person.times[frame],
            positions=person.positions[frame],
            confidence=person.confidence[frame],
        )
        previous = one_to_one(single, robot, previous)[0]
        positions.append(previous)
    return np.array(positions)


def compare(path: Path, frames: int, repeats: int) -> Rows:
    """One recording's rows."""
    robot = load_robot()
    skeleton = load(path).motion
    assert isinstance(skeleton, Skeleton)
    person, _ = clean(skeleton)
    known = np.flatnonzero(np.isfinite(arm_directions(person)).all(axis=(1, 2, 3)))[:frames]
    person = replace(
        person, times=person.times[known], positions=person.positions[known], confidence=person.confidence[known]
    )
    directions = arm_directions(person)
    best = errors(feasible_positions(directions, robot), directions)
    answers: dict[str, Array] = {}

    def keep(name: str, run: Callable[[], Array]) -> Callable[[], object]:
        return lambda: answers.__setitem__(name, run())

    sides = {
        "one_to_one, whole recording": keep("one_to_one, whole recording", lambda: one_to_one(person, robot)),
        "one_to_one, frame by frame": keep("one_to_one, frame by frame", lambda: frame_by_frame(person)),
    }
    for iterations in ITERATIONS:
        name = f"mink, {iterations} iteration{'s' * (iterations > 1)} a frame"
        sides[name] = keep(name, lambda iterations=iterations: Mink(iterations).retarget(directions))
    took = interleaved(sides, repeats)
    rival = took["mink, 1 iteration a frame"]
    rows: Rows = []
    for name, seconds in took.items():
        off = errors(answers[name], directions)
        rows.append(
            (
                path.name,
                name,
                f"{len(person) / seconds:.0f}",
                f"{rival / seconds:.1f}",
                f"{np.degrees(off.mean()):.2f}",
                f"{np.degrees((off - best).mean()):.2f}",
            )
        )
    return rows


def main() -> int:
    """Measure and note."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", nargs="+", type=Path, metavar="RECORDING")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--print", action="store_true", help="print only, leave RESULTS.md alone")
    arguments, where = parser.parse_args(), machine()
    rows: Rows = [
        ("recording", "method", "frames/s", "times mink's rate", "direction error (°)", "beyond the nearest pose (°)")
    ]
    for path in arguments.recordings:
        rows += compare(path, arguments.frames, arguments.repeats)
    names = " ".join(path.name for path in arguments.recordings)
    command = f"retargeting.py {names} --repeats {arguments.repeats} --frames {arguments.frames}"
    note("One-to-one retargeting of both arms, one thread", rows, command, where, arguments.print)
    return 0


if __name__ == "__main__":
    sys.exit(main())
