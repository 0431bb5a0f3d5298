"""What a page draws over time, and what it plays: joints, distances, balance, contacts, colours."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from nao_sim.console import REASONS
from nao_sim.plotting.safety_page import shown_joints
from nao_sim.plotting.safety_panels import CLEARANCES, reason_colour
from nao_sim.safety.ledger import Ledger, ledger
from nao_sim.safety.self_distance import HORIZON
from nao_sim.safety.trajectory_distance import smallest_distances
from nao_sim.simulation.measures import stance
from nao_sim.simulation.simulator import CONTROL_STEP
from nao_sim.viewing.packing import Parcel
from nao_sim.viewing.stage import Stage

MOST = 15000  # moments in a page: five minutes at 50 Hz; longer ones have fewer a second
FINE, FINE_MM = 1e-4, 0.01  # rad or m, mm: to which curves are rounded
FALLING_MM = -50.0  # farther outside its feet a robot cannot be saved, and how far says nothing


def pack_curves(parcel: Parcel, stage: Stage) -> dict[str, Any]:
    """Put everything that changes over time into a parcel, and tell what is to know of it."""
    rollout, simulator = stage.rollout, stage.performed.simulator
    robot, every = simulator.robot, -(-len(stage.rollout) // MOST)
    rows = np.arange(0, len(rollout), every)
    for name in ("requested", "command", "joint_positions", "base_pose"):
        parcel.add_rounded(name, getattr(rollout, name)[rows], FINE)
    distances = [smallest_distances(poses[rows]) for poses in (rollout.joint_positions, rollout.command)]
    parcel.add_rounded("distance", 1000.0 * np.stack(distances), FINE_MM)
    if simulator.map.free:
        margin = 1000.0 * stance(simulator.model, rollout).margin[rows]
        parcel.add_rounded("balance", np.where(margin > FALLING_MM, margin, np.nan), FINE_MM)
    if stage.figure is not None:
        parcel.add_rounded("person", stage.figure.at(rollout.time[rows] - rollout.motion_start), FINE)
    _pack_contacts(parcel, stage, rows)
    parcel.add("tint", np.rint(255.0 * stage.tinted.rows[rows]), np.uint8)
    book = ledger(stage.performed.performance.interventions)
    changed = shown_joints(rollout, book, robot, False)
    return {
        "times": [float(rollout.time[0]), CONTROL_STEP * every, len(rows)],
        "motion_start": rollout.motion_start,
        "speed": rollout.speed,
        "recording_s": stage.recording_lasts,
        "joints": [
            {
                "name": name,
                "unit": "opening" if robot.is_hand[joint] else "°",
                "factor": robot.report_unit(joint),
                "limits": [robot.lower[joint], robot.upper[joint]],
                "spells": _spells(book.only(joint=joint)),
            }
            for joint, name in enumerate(robot.joint_names)
        ],
        "changed": changed,
        "reasons": [_reason(reason) for reason in _ordered(book.reasons)],
        "clearances_mm": list(CLEARANCES),
        "horizon_mm": 1000.0 * HORIZON,
        "words": [{"word": label.word, "colour": label.colour} for label in stage.tinted.tint.script.labels],
        "parts": len(stage.tinted.tint.parts),
    }


def _pack_contacts(parcel: Parcel, stage: Stage, rows: NDArray[np.int_]) -> None:
    """Where the robot touches the floor or itself: how many points each moment has, and all of them in a row."""
    model, data = stage.model, mujoco.MjData(stage.model)
    counts, points = [], [np.empty((0, 3))]
    for qpos in stage.qpos(stage.rollout.time[rows]):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_collision(model, data)
        counts.append(min(data.ncon, 255))
        points.append(data.contact.pos[: counts[-1]].copy())
    parcel.add("contact_counts", counts, np.uint8)
    parcel.add_rounded("contact_points", np.concatenate(points), FINE)


def _spells(book: Ledger) -> list[tuple[str, list[list[float]]]]:
    """When each reason held: seconds from and to."""
    return [
        (reason, np.round(CONTROL_STEP * (book.only(reason=reason).spells + np.array([0, 1])), 2).tolist())
        for reason in _ordered(book.reasons)
    ]


def _ordered(reasons: Sequence[str]) -> list[str]:
    """Those that have words first, and in the order of these."""
    return [*(reason for reason in REASONS if reason in reasons), *(each for each in reasons if each not in REASONS)]


def _reason(reason: str) -> dict[str, str]:
    return {"name": reason, "words": REASONS.get(reason, reason), "colour": reason_colour(reason)}
