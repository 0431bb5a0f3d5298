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
from nao_sim.imitation.similarity import similarity
from nao_sim.robot import Robot
from nao_sim.safety.assessment import Assessment
from nao_sim.safety.ledger import Entry, ledger
from nao_sim.safety.self_distance import SelfDistance
from nao_sim.simulation import measures
from nao_sim.simulation.performance import Performance
from nao_sim.simulation.simulator import CONTROL_STEP, Simulator

if TYPE_CHECKING:
    from nao_sim.replay import Task

SCHEMA = 1
Report = dict[str, Any]


def build_report(task: Task, asked: Assessment, performance: Performance, simulator: Simulator) -> Report:
    """Everything but the timing, as the JSON has it."""
    robot, recording = simulator.robot, task.recording
    imitated = similarity(recording.motion, performance.rollout, robot)
    return {
        "schema": SCHEMA,
        "recording": str(recording.path),
        "format": recording.format,
        "format_reason": recording.reason,
        "notes": [*recording.notes, *(task.retargeted.notes if task.retargeted else ())],
        "frames": recording.frames,
        "duration_s": round(recording.motion.duration, 6),
        "robot": robot.version,
        "base": "free" if simulator.map.free else "pinned",
        "approach_s": round(performance.approach, 6),
        "requested": asdict(asked),
        "changed": [_changed(robot, entry) for entry in ledger(performance.interventions)],
        "simulated": _simulated(performance, simulator),
        "similarity": imitated.as_report(),
    }


def _changed(robot: Robot, entry: Entry) -> Report:
    unit = "largest_change_opening" if robot.is_hand[entry.joint] else "largest_change_deg"
    row = {
        "joint": robot.joint_names[entry.joint],
        "reason": entry.reason,
        "seconds": round(entry.steps * CONTROL_STEP, 2),
        unit: round(entry.largest * robot.report_unit(entry.joint), 3),
        "times_s": [[round(a * CONTROL_STEP, 2), round((b + 1) * CONTROL_STEP, 2)] for a, b in entry.spells],
    }
    return row | ({"pairs": [list(pair) for pair in sorted(entry.pairs)]} if entry.pairs else {})


def _simulated(performance: Performance, simulator: Simulator) -> Report:
    robot, rollout, states = simulator.robot, performance.rollout, performance.states
    violations, excess = measures.limit_violations(robot, states)
    balance = measures.balance(simulator.model, rollout)
    rmse, lag = measures.tracking(rollout)
    distance = SelfDistance()
    units = [robot.report_unit(joint) for joint in range(len(robot.joint_names))]
    return {
        "limit_violations": violations,
        "max_limit_excess_deg": _rounded(np.degrees(excess)),
        "max_coupling_excess_deg": _rounded(np.degrees(measures.max_coupling_excess(robot, rollout))),
        "max_speed_ratio": _rounded(measures.max_speed_ratio(robot, states)),
        "self_collision_frames": sum(bool(state.touching) for state in states),
        "min_self_distance_m": _rounded(min(distance.nearest(q).distance for q in rollout.joint_positions), 5),
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
