"""Compare the learners of single postures and those of movements, and write the tables to LEARNERS.md.

    python benchmarks/learners.py [RECORDINGS]

Those of postures learn from the 28 printed rows of the thesis's training table.
With RECORDINGS, a folder that has `openpose_body25_poses` and
`isl_kinect_signs`, they are tried on the strangers of the former, too, and
those of movements on the latter.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from datetime import date
from pathlib import Path

import numpy as np
from benchmark import Rows, machine, table
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from sequence_learners import ABOUT, signers_left_out

from nao_sim.body import SIDES, bones
from nao_sim.gestures.arm_places import ELBOWS, elbow_offsets, places, places_of_directions
from nao_sim.gestures.decision_rule import DecisionBasedRule
from nao_sim.gestures.hand_set import HAND_SET, HEIGHT
from nao_sim.gestures.held_out import leave_one_user_out
from nao_sim.gestures.learners import LEARNERS, Learner, learned_rule
from nao_sim.gestures.training_table import TrainingTable, thesis_table
from nao_sim.imitation.features import directions_of, features_of
from nao_sim.imitation.person import arm_directions
from nao_sim.motion import Skeleton
from nao_sim.recordings import load

HERE = Path(__file__).resolve().parent
OUT = HERE / "LEARNERS.md"
SEEDS, CALLS = 5, 200
SCALES, TURNS = (0.5, 0.75, 1.0, 1.25, 1.5), (0, 15, 30)  # of the adult's size; degrees
STRANGERS = {"T": "side", "Traffic_AllStop": "piUp", "Yoga_UpwardSalute": "up", "Stand": "down",
             "Stand_LeftArmRaised": "none", "Stand_RightArmRaised": "none"}  # fmt: skip
Features = dict[str, NDArray[np.float64]]
INTRODUCTION = """# Learners

Those of single postures learn from the 28 printed rows of the thesis's training table
(`trajectories/thesis_table_a1.csv`), five gestures by six users; 27 is the most that any can get right. `python
benchmarks/learners.py [RECORDINGS]` writes this file. *Angles* are the thesis's ten features in degrees, *directions*
the four segments' unit vectors, *places* the elbows and hands beside their shoulders in arm lengths. Times are of
single calls, with scikit-learn's own checks. The pictures are OpenPose's BODY_25 points of people whose arms are all
seen; T is taken for side, Traffic_AllStop for piUp, Yoga_UpwardSalute for up, Stand for down, and one raised arm for
none. How far the decision rule's thresholds and bounds reach (`reach`, `bound` and what counts as far) was settled
with these pictures in sight.
"""


def features_of_table(data: TrainingTable) -> Features:
    """Its rows in each kind of features."""
    directions = directions_of(data.features)
    flat = directions.reshape(len(directions), -1)
    return {"angles": data.features_deg, "directions": flat, "places": places_of_directions(directions)}


def kinds(learner: Learner) -> tuple[str, ...]:
    return ("places",) if learner.places_only else ("angles", "directions")


def users_left_out(data: TrainingTable) -> Rows:
    """Each learner with each kind of features."""
    rows: Rows = [("learner", "features", "own rows", "users left out, of 28", "worst user", "spread over users",
                   "fit (ms)", "a decision (µs)")]  # fmt: skip
    values = features_of_table(data)
    for name, learner in LEARNERS.items():
        for kind in kinds(learner):
            rows.append((f"{name}: {learner.about}", kind, *_judged(learner, values[kind], data)))
    return rows


def _judged(learner: Learner, values: NDArray[np.float64], data: TrainingTable) -> tuple[str, ...]:
    seeds = range(SEEDS if learner.random else 1)
    held = [leave_one_user_out(lambda seed=seed: learner.make(seed), values, data.labels, data.users) for seed in seeds]
    right = [each.correct for each in held]
    shares = np.mean([each.by_user for each in held], axis=0)
    fit = _median(lambda: learner.make(0).fit(values, data.labels), 5)
    model = learner.make(0).fit(values, data.labels)
    own = int((model.predict(values) == data.labels).sum())
    decision = _median(lambda: model.predict(values[:1]), CALLS)
    many = f"{np.mean(right):.1f} ({min(right)} to {max(right)})" if learner.random else f"{right[0]}"
    worst, spread = f"{100 * shares.min():.0f} %", f"{100 * shares.std(ddof=1):.0f} points"
    return f"{own}", many, worst, spread, f"{1e3 * fit:.1f}", f"{1e6 * decision:.0f}"


def _median(run: Callable[[], object], times: int) -> float:
    """Seconds, the first run not counted."""
    took = []
    for _ in range(times + 1):
        began = time.perf_counter()
        run()
        took.append(time.perf_counter() - began)
    return float(np.median(took[1:]))


def strangers(data: TrainingTable, folder: Path) -> Rows:
    """Learned from the table alone, tried on pictures of people whom nobody has seen; arms are seen flat."""
    named = {file: label for file, label in STRANGERS.items() if label != "none"}
    rows: Rows = [("learner", "features", *(f"{file} = {label}" for file, label in named.items()), "all four")]
    people = {file: _seen(folder / f"{file}_body.json.gz") for file in named}
    values = features_of_table(data)
    for name, learner in LEARNERS.items():
        for kind in kinds(learner):
            model = learner.make(0).fit(values[kind], data.labels)
            right = {file: model.predict(people[file][kind]) == label for file, label in named.items()}
            cells = [f"{100 * each.mean():.1f} %" for each in (*right.values(), np.concatenate([*right.values()]))]
            rows.append((name, kind, *cells))
    return rows


def strangers_and_none(data: TrainingTable, folder: Path) -> Rows:
    """The decision rule as it is used, with none where no row holds, beside the hand-set one."""
    rows: Rows = [("poses", "people", "hand-set: right", "wrong", "none", "learned: right", "wrong", "none")]
    for file, label in STRANGERS.items():
        seen = _seen(folder / f"{file}_body.json.gz")
        cells = []
        for found in (_by_hand(seen["offsets"]), learned_rule(values_of(data), data.labels).predict(seen["places"])):
            right, none = found == label, found == "none"
            cells += [f"{100 * share.mean():.1f} %" for share in (right, ~right & ~none, none)]
        rows.append((f"{file} ({label})", str(len(seen["places"])), *cells))
    return rows


def values_of(data: TrainingTable) -> NDArray[np.float64]:
    return places_of_directions(directions_of(data.features))


def _by_hand(offsets: NDArray[np.float64]) -> NDArray[np.str_]:
    return DecisionBasedRule(HAND_SET, none="none").fit(np.zeros((1, len(ELBOWS))), ["up"]).predict(offsets)


def _seen(path: Path) -> Features:
    """Features of those people whose arms are all tracked."""
    skeleton = load(path).motion
    assert isinstance(skeleton, Skeleton)
    directions = arm_directions(skeleton)
    known = np.isfinite(directions).all(axis=(1, 2, 3))
    flat = directions.reshape(len(directions), -1)
    found = {"angles": np.degrees(features_of(directions)), "directions": flat, "places": places(skeleton)}
    return {name: each[known] for name, each in (found | {"offsets": elbow_offsets(skeleton)}).items()}


def rules(data: TrainingTable) -> Rows:
    """The hand-set and the learned decision rule on the rows as postures of people of any size who turn.

    The learned rule has not seen the user; the hand-set one is for an adult who faces the sensor.
    """
    rows: Rows = [("size of the person", "turned", "hand-set, of 22 without piUp", "learned, of 22", "learned, of 28")]
    without = data.labels != "piUp"
    for scale in SCALES:
        for turn in TURNS:
            body = posed(directions_of(data.features), HEIGHT * scale, np.radians(turn))
            by_hand = _by_hand(elbow_offsets(body)) == data.labels
            learned = _left_out(data, places(body)) == data.labels
            counts = (by_hand[without].sum(), learned[without].sum(), learned.sum())
            rows.append((f"{scale:g} x {HEIGHT:.2f} m", f"{turn}°", *map(str, counts)))
    return rows


def _left_out(data: TrainingTable, seen: NDArray[np.float64]) -> NDArray[np.str_]:
    """Labels (N,) of places (N, 12) by rules that were learned from the other users' rows."""
    found = np.empty_like(data.labels)
    for user in np.unique(data.users):
        out = data.users == user
        rest = TrainingTable(data.features[~out], data.labels[~out], data.users[~out])
        found[out] = learned_rule(values_of(rest), rest.labels).predict(seen[out])
    return found


def posed(directions: NDArray[np.float64], height: float, turned: float) -> Skeleton:
    """A person of that height (m) and turn (rad) whose arms point along directions (N, 2, 2, 3), a frame each."""
    lengths = {bone.end: bone.length * height for bone in bones()}
    points = {}
    for place, side in enumerate(SIDES):
        outward = np.array([0.0, 1.0 if side == "left" else -1.0, 0.0])
        shoulder = 0.1 * height * outward + [0.0, 0.0, 0.8 * height]
        points[f"{side}_shoulder"] = np.tile(shoulder, (len(directions), 1))
        points[f"{side}_hip"] = np.tile(0.05 * height * outward + [0.0, 0.0, 0.5 * height], (len(directions), 1))
        for start, end, segment in (("shoulder", "elbow", 0), ("elbow", "wrist", 1)):
            step = lengths[f"{side}_{end}"] * directions[:, place, segment]
            points[f"{side}_{end}"] = points[f"{side}_{start}"] + step
    spin = Rotation.from_euler("z", turned)
    tracks = np.stack([spin.apply(track) for track in points.values()], axis=1)
    return Skeleton(np.arange(len(directions)) / 30.0, tracks, tuple(points))


def main(words: Sequence[str] | None = None) -> None:
    """Measure and write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", type=Path, nargs="?", metavar="RECORDINGS")
    parser.add_argument("--print", action="store_true", help="print only, leave LEARNERS.md alone")
    args, where = parser.parse_args(words), machine()
    data = thesis_table()
    parts = {
        "Leave-one-user-out on the 28 rows": users_left_out(data),
        "The decision rule, hand-set and learned, for people of any size who turn": rules(data),
    }
    folder = args.recordings / "openpose_body25_poses" if args.recordings else None
    if folder and folder.is_dir():
        parts["Learned from the 28 rows, tried on strangers in pictures"] = strangers(data, folder)
        parts["The decision rule on strangers in pictures"] = strangers_and_none(data, folder)
    movements = {}
    if args.recordings and (args.recordings / "isl_kinect_signs").is_dir():
        movements["Learners of movements, signers left out"] = signers_left_out(args.recordings / "isl_kinect_signs")
    command = f"`python benchmarks/learners.py{' RECORDINGS' * bool(args.recordings)}`"
    text = INTRODUCTION + f"\n{date.today()}, {where}. {command}\n"
    text += "".join(f"\n## {title}\n\n{table(rows)}\n" for title, rows in parts.items())
    text += "".join(f"\n## {title}\n\n{ABOUT}\n\n{table(rows)}\n" for title, rows in movements.items())
    print(text)
    if not args.print:
        OUT.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
