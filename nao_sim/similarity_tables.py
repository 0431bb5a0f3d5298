"""The imitation score as a table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from nao_sim.sections import Section

NEAREST = "nearest"
ROWS = {  # what a line shows: the path to it in a stage of the report, and its digits
    "left upper arm (°)": ("direction_error_deg left_upper_arm mean", 1),
    "left forearm (°)": ("direction_error_deg left_forearm mean", 1),
    "right upper arm (°)": ("direction_error_deg right_upper_arm mean", 1),
    "right forearm (°)": ("direction_error_deg right_forearm mean", 1),
    "both arms (°)": ("direction_error_deg all mean", 1),
    "both arms, median (°)": ("direction_error_deg all median", 1),
    "both arms, 95 % below (°)": ("direction_error_deg all p95", 1),
    "beyond the nearest (°)": ("excess_deg mean", 1),
    "hands (arm lengths)": ("hand_error_arm_lengths all mean", 3),
    "WBF similarity": ("wbf mean", 3),
    "LLF similarity": ("llf mean", 3),
    "delay (ms)": ("lag_ms", 0),
}


def score_section(score: Mapping[str, Any]) -> Section:
    """The score of each stage of the robot's motion beside that of NAO's nearest pose.

    Args:
        score: `Similarity.as_report()`.
    """
    columns = {NEAREST: {"direction_error_deg": score["limits_deg"]}, **score["stages"]}
    rows = [
        (label, *(_cell(column, path, digits) for column in columns.values())) for label, (path, digits) in ROWS.items()
    ]
    return Section("How alike the robot was", ("mean, where it does not say", *columns), rows)


def measured(score: Mapping[str, Any]) -> str:
    """How much of the recording was compared."""
    shares = " and ".join(f"{100 * share:.0f} % ({side})" for side, share in score["coverage"].items())
    return f"arms measured in {shares} of the frames; {score['compared']} moments compared"


def _cell(part: Any, path: str, digits: int) -> str:
    """The number at a path of keys in a part of the report."""
    for key in path.split():
        part = (part or {}).get(key)
    return "-" if part is None else f"{part:.{digits}f}"
