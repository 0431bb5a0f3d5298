"""How long a step of the guard takes beside mink, and a check of poses beside MuJoCo's own calls and Pinocchio.

    python benchmarks/guard_speed.py [--recordings FOLDER] [--repeats 3] [--print]

Guard: `Guard.step` at 50 Hz on ordinary and on hard motions, in turns with one
`mink.solve_ik` toward the same request: a posture task, the limits of
positions, speeds and collisions on the same model and pairs of shapes, daqp.
mink keeps no promise for later steps, no couplings and no balance.

Poses: `SelfDistance.smallest` in turns with bare loops of mj_kinematics and
mj_collision on the same model and poses, and of Pinocchio's computeCollisions
with Coal on the same shapes and pairs (`pip install pin`; left out where it is
missing).

Aims: a step of the guard in 0.3 ms (median) and 1 ms (99th percentile); poses
checked within 1.3 times the bare calls.
"""

from __future__ import annotations

import os

os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from time import perf_counter

import mink
import mujoco
import numpy as np
from attacks import FAMILIES, Dials
from benchmark import Rows, interleaved, machine, note

from nao_sim.errors import NaoSimError
from nao_sim.imitation.retarget import retarget
from nao_sim.motion import Skeleton
from nao_sim.mujoco_model import JointMap
from nao_sim.paths import MODEL, TRAJECTORIES
from nao_sim.recordings import load
from nao_sim.robot import START_POSTURE, Array, load_robot
from nao_sim.safety.assessment import held
from nao_sim.safety.guard import Guard
from nao_sim.safety.posed import PosedRobot
from nao_sim.safety.self_collision import CLEARANCE
from nao_sim.safety.self_distance import HORIZON, SelfDistance
from nao_sim.simulation.performance import timeline
from nao_sim.simulation.simulator import CONTROL_STEP
from tests.safety.shape_pairs import shape_pairs

ROBOT = load_robot()
START = ROBOT.postures[START_POSTURE]
HARD = ("jumps", "hands to face", "hands to each other", "squats")
PEOPLE = ("labanotation_kinect/samples/Ges06_chickenwing.csv", "isl_kinect_signs/samples/rain_s01_1.txt",
          "cmu_mocap6/amc/13_30.amc", "nao_motions/TaiChi.motion")  # fmt: skip
MEDIAN_AIM, WORST_AIM, POSES_AIM = 0.3e-3, 1e-3, 1.3  # s, s, times
LONGEST = 1000  # requests of a motion
POSES = 5000


class Mink:
    """Differential inverse kinematics toward a posture, one step a request."""

    def __init__(self) -> None:
        model = PosedRobot(0.0).model
        self._map = JointMap(model)
        speeds = {name: np.array([ROBOT.max_speed[i]]) for name, i in ROBOT.index.items()}
        pairs = [([first], [second]) for first, second in shape_pairs(model)]
        self._limits = [
            mink.ConfigurationLimit(model),
            mink.VelocityLimit(model, speeds),
            mink.CollisionAvoidanceLimit(
                model, pairs, minimum_distance_from_collisions=CLEARANCE, collision_detection_distance=HORIZON
            ),
        ]
        self._task = mink.PostureTask(model, cost=1.0)
        self._configuration = mink.Configuration(model)
        self._configuration.update(self._map.to_qpos(START))

    def step(self, request: Array, dt: float) -> None:
        """Go toward a request (26,), all of it finite."""
        self._task.set_target(self._map.to_qpos(request))
        velocity = mink.solve_ik(self._configuration, [self._task], dt, solver="daqp", limits=self._limits)
        self._configuration.integrate_inplace(velocity, dt)


def motions(recordings: Path | None) -> Mapping[str, Array]:
    """Requests (T, 26) by name."""
    asked: dict[str, Array] = {}
    paths = sorted(path for path in TRAJECTORIES.glob("*.csv") if not path.name.startswith("thesis"))
    for path in [*paths, *(recordings / name for name in PEOPLE if recordings)]:
        try:
            motion = load(path).motion
        except NaoSimError as error:
            print(f"left out: {error}", file=sys.stderr)
            continue
        if isinstance(motion, Skeleton):
            motion = retarget(motion, ROBOT, start=START).motion
        asked[path.name] = timeline(motion, START)[1][:LONGEST]
    random = np.random.default_rng(0)
    for name in HARD:
        family = FAMILIES[name]
        asked[f"{name} (attacks.py)"] = np.concatenate(
            [family.requests(Dials(random.random(family.size))) for _ in range(3)]
        )
    return asked


def step_seconds(requests: Array, repeats: int) -> dict[str, Array]:
    """Seconds of each step of guard and mink, in turns."""
    seconds: dict[str, list[float]] = {"guard": [], "mink": []}
    finite = held(requests, START)
    for turn in range(repeats):
        steps = {"guard": Guard(ROBOT, START, standing=True).step, "mink": Mink().step}
        for request, known in zip(requests, finite, strict=True):
            for name, step in steps.items():
                began = perf_counter()
                step(request if name == "guard" else known, CONTROL_STEP)
                seconds[name].append(perf_counter() - began)
        print(f"turn {turn + 1}", end="\r", file=sys.stderr)
    return {name: np.array(values) for name, values in seconds.items()}


def verdict(met: bool) -> str:
    """In words."""
    return "met" if met else "missed"


def guard_table(asked: Mapping[str, Array], repeats: int) -> Rows:
    """One row a motion."""
    head = ("motion", "steps", "guard, median (ms)", "99 % (ms)", "longest (ms)", "aims", "mink, median (ms)")
    rows: Rows = [(*head, "99 % (ms)", "ratio of medians")]
    for name, requests in asked.items():
        took = step_seconds(requests, repeats)
        (median, most), (rival, rivals_most) = (np.quantile(took[side], (0.5, 0.99)) for side in ("guard", "mink"))
        aims = f"{verdict(median <= MEDIAN_AIM)}, {verdict(most <= WORST_AIM)}"
        figures = [f"{1e3 * value:.2f}" for value in (median, most, took["guard"].max())]
        rivals = [f"{1e3 * value:.2f}" for value in (rival, rivals_most)]
        rows.append((name, str(len(requests)), *figures, aims, *rivals, f"{median / rival:.2f}"))
    return rows


def pose_table(asked: Mapping[str, Array], repeats: int) -> Rows:
    """One row a horizon: 0, which tells overlaps, and those of guard and report."""
    poses = np.concatenate([held(requests, START) for requests in asked.values()])
    poses = poses[np.linspace(0, len(poses) - 1, min(POSES, len(poses))).astype(int)]
    head = ("what", "SelfDistance.smallest (µs a pose)", "mj_kinematics and mj_collision (µs)", "ratio", "aim")
    rows: Rows = [(*head, "Pinocchio and Coal (µs)", "ratio to it")]
    for horizon, what in (
        (0.0, "overlaps"),
        (CLEARANCE, f"nearer than {1e3 * CLEARANCE:.0f} mm"),
        (HORIZON, "nearer than 30 mm"),
    ):
        distance = SelfDistance(horizon)
        sides: dict[str, Callable[[], object]] = {
            "ours": partial(distance.smallest, poses),
            "bare": partial(bare, PosedRobot(horizon), poses),
        }
        if horizon == 0.0 and (rival := pinocchio(poses, distance)):
            sides["pinocchio"] = rival
        took = {name: 1e6 * seconds / len(poses) for name, seconds in interleaved(sides, repeats).items()}
        ratio = took["ours"] / took["bare"]
        cells = [what, f"{took['ours']:.1f}", f"{took['bare']:.1f}", f"{ratio:.2f}", verdict(ratio <= POSES_AIM)]
        other = took.get("pinocchio")
        rows.append((*cells, f"{other:.1f}" if other else "-", f"{took['ours'] / other:.2f}" if other else "-"))
    return rows


def bare(robot: PosedRobot, poses: Array) -> None:
    """The least that any check does."""
    model, data = robot.model, robot.data
    for qpos in robot.map.to_qpos(poses):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)


def pinocchio(poses: Array, distance: SelfDistance) -> Callable[[], object] | None:
    """Pinocchio's check of the same poses, which must agree; None where it is not installed."""
    try:
        import coal
        import pinocchio as pin
    except ImportError:
        print("Pinocchio is left out: not installed (pip install pin)", file=sys.stderr)
        return None
    model = pin.buildModelFromUrdf(str(MODEL / "nao_h25.urdf"))
    ours = distance.robot.model
    shapes = pin.GeometryModel()
    for i in range(ours.ngeom):
        frame = model.frames[model.getFrameId(ours.body(ours.geom_bodyid[i]).name, pin.FrameType.BODY)]
        rotation = np.empty(9)
        mujoco.mju_quat2Mat(rotation, ours.geom_quat[i])
        place = frame.placement * pin.SE3(rotation.reshape(3, 3), ours.geom_pos[i])
        shapes.addGeometryObject(pin.GeometryObject(str(i), frame.parentJoint, place, _shape(coal, ours, i)))
    for first, second in shape_pairs(ours):
        shapes.addCollisionPair(pin.CollisionPair(first, second))
    data, found = model.createData(), shapes.createData()
    configurations = np.zeros((len(poses), model.nq))
    for i in range(ours.njnt):
        joint = model.joints[model.getJointId(ours.joint(i).name)]
        configurations[:, joint.idx_q] = distance.robot.map.to_qpos(poses)[:, ours.jnt_qposadr[i]]

    def check() -> Array:
        return np.array([pin.computeCollisions(model, data, shapes, found, q, False) for q in configurations])

    other = np.mean(check() != (distance.smallest(poses) < 0.0))
    print(f"Pinocchio finds something else at {100 * other:.2f} % of {len(poses)} poses", file=sys.stderr)
    return check


def _shape(coal: object, model: mujoco.MjModel, geom: int) -> object:
    """A shape of the model as Coal has it."""
    size = model.geom_size[geom]
    makers = {
        mujoco.mjtGeom.mjGEOM_SPHERE: lambda: coal.Sphere(size[0]),
        mujoco.mjtGeom.mjGEOM_CAPSULE: lambda: coal.Capsule(size[0], 2.0 * size[1]),
        mujoco.mjtGeom.mjGEOM_BOX: lambda: coal.Box(*(2.0 * size)),
    }
    return makers[mujoco.mjtGeom(model.geom_type[geom])]()


def main(words: Sequence[str] | None = None) -> None:
    """Measure and note."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--recordings", type=Path, metavar="FOLDER", help="recordings of people, as PEOPLE names them")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--only", default="", metavar="WORD", help="only motions whose name holds this")
    parser.add_argument("--print", action="store_true", help="print only, leave RESULTS.md alone")
    args, where = parser.parse_args(words), machine()
    asked = {name: requests for name, requests in motions(args.recordings).items() if args.only in name}
    command = f"guard_speed.py --repeats {args.repeats}{' --recordings RECORDINGS' if args.recordings else ''}"
    note("The guard beside mink, one thread", guard_table(asked, args.repeats), command, where, args.print)
    note("Checking poses, one thread", pose_table(asked, args.repeats), command, where, args.print)


if __name__ == "__main__":
    main()
