"""The report: what was asked, what was changed and why, what the robot did.

`SCHEMA` names the version of the JSON's layout, which `docs/report.md` describes.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from nao_sim.files import beside
from nao_sim.imitation.similarity import Similarity, similarity
from nao_sim.robot import Robot
from nao_sim.safety.assessment import Assessment
from nao_sim.safety.ledger import Ledger, ledger
from nao_sim.safety.rules import Rules
from nao_sim.safety.trajectory_distance import smallest_distances
from nao_sim.simulation import measures
from nao_sim.simulation.performance import Performance
from nao_sim.simulation.simulator import CONTROL_STEP, Simulator
from nao_sim.verdict import verdict, wrongs

if TYPE_CHECKING:
    from nao_sim.tasks import Task

SCHEMA = 1
OF_A_RUN = (
    "approach_s", "verdict", "wrong", "steps", "changed_steps", "requested", "rules", "changed", "simulated"
)  # fmt: skip
Report = dict[str, Any]


def imitation(task: Task, performance: Performance, robot: Robot) -> Similarity | None:
    """How alike the robot was; None where it plays gestures."""
    return None if task.recognised else similarity(task.recording.motion, performance.rollout, robot)


def build_report(
    task: Task,
    asked: Assessment,
    performance: Performance,
    simulator: Simulator,
    rules: Rules,
    imitated: Similarity | None,
) -> Report:
    """Everything but the timing, as the JSON has it."""
    robot, recording = simulator.robot, task.recording
    told = task.recognised
    book, simulated = ledger(performance.interventions), _simulated(performance, simulator)
    wrong = wrongs(simulated)
    return {
        "schema": SCHEMA,
        "recording": str(recording.path),
        "format": recording.format,
        "format_reason": recording.reason,
        "notes": [*recording.notes, *task.notes],
        "frames": recording.frames,
        "duration_s": round(recording.motion.duration, 6),
        "robot": robot.version,
        "base": "free" if simulator.map.free else "pinned",
        "approach_s": round(performance.approach, 6),
        "speed_fraction": rules.speed_fraction,
        "rules_off": sorted(rules.off),
        "verdict": verdict(len(book.steps), wrong).value,
        "wrong": wrong,
        "steps": book.run,
        "changed_steps": len(book.steps),
        "requested": asdict(asked),
        "rules": [_rule(robot, book.only(reason=reason)) for reason in book.reasons],
        "changed": _changed(robot, book),
        "simulated": simulated,
        "similarity": imitated.as_report() if imitated else None,
        "gestures": told.as_report() if told else None,
    }


def with_player(report: Report, player: Report) -> Report:
    """The report of a robot that imitates, and in it that of one that plays gestures beside it."""
    notes = [*report["notes"], *(note for note in player["notes"] if note not in report["notes"])]
    own = {key: player[key] for key in OF_A_RUN}
    return report | {"notes": notes, "gestures": player["gestures"] | {"robot": own}}


def _rule(robot: Robot, book: Ledger) -> Report:
    """What one rule changed."""
    by_joint = {joint: book.only(joint=joint).largest * robot.report_unit(joint) for joint in book.joints}
    joints = sorted(by_joint, key=lambda joint: (bool(robot.is_hand[joint]), -by_joint[joint]))
    row: Report = {"reason": book.reasons[0], "joints": [robot.joint_names[joint] for joint in joints]}
    row |= _when(book) | {"share": _rounded(book.share)}
    for hands, unit in ((False, "deg"), (True, "opening")):
        part = book.where(robot.is_hand[book.joint] == hands)
        scale = 1.0 if hands else float(np.degrees(1.0))
        if part:
            row |= {f"largest_change_{unit}": round(part.largest * scale, 3)}
            row |= {f"mean_change_{unit}": round(part.mean * scale, 3)}
    pairs = [{"links": list(pair), **_when(book.only(pair=pair))} for pair in book.pairs]
    return row | ({"pairs": sorted(pairs, key=lambda pair: -pair["steps"])} if pairs else {})


def _when(book: Ledger) -> Report:
    times = np.round(CONTROL_STEP * (book.spells + np.array([0, 1])), 2).tolist()
    return {"steps": len(book.steps), "seconds": round(len(book.steps) * CONTROL_STEP, 2), "times_s": times}


def _changed(robot: Robot, book: Ledger) -> list[Report]:
    """A row for each joint and reason."""
    by_joint = [book.only(joint=joint) for joint in book.joints]
    return [_row(robot, part.only(reason=reason)) for part in by_joint for reason in part.reasons]


def _row(robot: Robot, book: Ledger) -> Report:
    (joint,), (reason,), when = book.joints, book.reasons, _when(book)
    unit = "largest_change_opening" if robot.is_hand[joint] else "largest_change_deg"
    row = {
        "joint": robot.joint_names[joint],
        "reason": reason,
        "seconds": when["seconds"],
        unit: round(book.largest * robot.report_unit(joint), 3),
        "times_s": when["times_s"],
    }
    return row | ({"pairs": [list(pair) for pair in book.pairs]} if book.pairs else {})


def _simulated(performance: Performance, simulator: Simulator) -> Report:
    robot, rollout, states = simulator.robot, performance.rollout, performance.states
    violations, excess = measures.limit_violations(robot, states)
    balance = measures.balance(simulator.model, rollout)
    rmse, lag = measures.tracking(rollout)
    units = [robot.report_unit(joint) for joint in range(len(robot.joint_names))]
    return {
        "limit_violations": violations,
        "max_limit_excess_deg": _rounded(np.degrees(excess)),
        "max_coupling_excess_deg": _rounded(np.degrees(measures.max_coupling_excess(robot, rollout))),
        "max_speed_ratio": _rounded(measures.max_speed_ratio(robot, states)),
        "self_collision_frames": sum(bool(state.touching) for state in states),
        "min_self_distance_m": _rounded(smallest_distances(rollout.joint_positions).min(), 5),
        "fell": balance.fell,
        "min_support_margin_m": _rounded(balance.min_support_margin, 5),
        "tracking_rmse_deg": {
            name: _rounded(error * unit) for name, error, unit in zip(robot.joint_names, rmse, units, strict=True)
        },
        "tracking_lag_ms": _rounded(None if lag is None else 1000.0 * lag, 1),
    }


def _rounded(value: float | None, digits: int = 4) -> float | None:
    return None if value is None or not np.isfinite(value) else round(float(value), digits)


def save_report(report: Mapping[str, Any], path: Path) -> None:
    """Write the JSON whole or not at all.

    Raises:
        UsageError: it cannot be written there.
    """
    with beside(path) as draft:
        draft.write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
