"""What a person sees on the terminal: progress and the summary."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID
    from rich.table import Table
    from rich.text import Text

REASONS = {
    "limit": "beyond the joint's limit",
    "margin": "at the very edge of the joint's range",
    "one_motor": "one motor turns both HipYawPitch joints",
    "coupling": "beyond the limit that another joint sets",
    "speed": "faster or jerkier than the motors",
    "self_collision": "into the robot itself",
    "detour": "round the robot's own body, not through it",
    "balance": "leaning so far that the robot would fall",
    "ramp": "far from where the robot is: approached slowly",
    "stale": "nothing came in for a while: waited",
}
_LINES = 12  # gestures before the rest is left out
_SHOWN = 3  # pairs of links before the rest is left out


class ProgressBar(AbstractContextManager["ProgressBar"]):
    """Progress of the stages, on stderr where that is a terminal; nothing when `quiet`."""

    def __init__(self, quiet: bool) -> None:
        self._quiet = quiet or not sys.stderr.isatty()
        self._bars: Progress | None = None
        self._tasks: dict[str, TaskID] = {}

    def __call__(self, stage: str, done: int, total: int) -> None:
        """`done` of `total` steps of a stage are finished."""
        if self._quiet:
            return
        if self._bars is None:
            self._bars = _bars()
            self._bars.start()
        if stage not in self._tasks:
            self._tasks[stage] = self._bars.add_task(stage, total=total)
        self._bars.update(self._tasks[stage], completed=done)

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop drawing."""
        if self._bars is not None:
            self._bars.stop()


def _bars() -> Progress:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

    columns = TextColumn("{task.description:<10}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn()
    return Progress(*columns, console=Console(stderr=True), transient=True)


def print_summary(report: Mapping[str, Any], written: Mapping[str, Path]) -> None:
    """Print what was asked, what was changed and why, how the robot did, and where the files are."""
    from rich.console import Console
    from rich.text import Text

    console = Console()
    for note in report["notes"]:
        console.print(Text(f"note: {note}", style="dim"))
    console.print(_table(report))
    if off := switched_off(report):
        console.print(off)
    for what, path in written.items():
        console.print(Text(f"{what:<8} {path}"), soft_wrap=True)


def _table(report: Mapping[str, Any]) -> Table:
    from rich.table import Table

    title = f"{report['recording']}: {about(report)}"
    table = Table(title=title, title_justify="left", title_style="bold", show_header=False, box=None, pad_edge=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column()
    for label, lines in summary(report).items():
        for first, line in enumerate(lines):
            table.add_row("" if first else label, line)
    return table


def about(report: Mapping[str, Any]) -> str:
    """What the recording is."""
    return f"{report['format']}, {report['frames']} frames, {report['duration_s']:.1f} s"


def summary(report: Mapping[str, Any]) -> dict[str, list[str]]:
    """Lines by what they are about: what was asked, changed, done, recognised, imitated, and how long it took."""
    return {
        "asked": _asked(report["requested"]),
        "changed": _changed(report["rules"]),
        "robot": did(report["simulated"]),
        **({"gestures": _gestures(report["gestures"])} if report["gestures"] else {}),
        **({"player": did(report["gestures"]["robot"]["simulated"])} if "robot" in (report["gestures"] or {}) else {}),
        **({"imitated": _imitated(report["similarity"])} if report["similarity"] else {}),
        **({"took": _took(report["timing"])} if "timing" in report else {}),
    }


def _asked(requested: Mapping[str, int]) -> list[str]:
    words = {
        "limit_frames": "beyond a joint's limit",
        "coupling_frames": "beyond a limit that another joint sets",
        "speed_frames": "faster than a motor",
        "self_collision_frames": "into the robot itself",
        "nonfinite_frames": "with gaps",
    }
    return [f"{requested[key]} frames {what}" for key, what in words.items() if requested[key]] or ["nothing unsafe"]


def _changed(rows: list[Mapping[str, Any]]) -> list[str]:
    """One line a rule: how long, how far at most and for which joints."""
    return [_rule(row) for row in in_order(rows)] or ["nothing"]


def in_order(rows: list[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """The report's rows by rule, in the order of `REASONS`; reasons that have no words come last."""
    known = list(REASONS)
    return sorted(rows, key=lambda row: known.index(row["reason"]) if row["reason"] in known else len(known))


def _rule(row: Mapping[str, Any]) -> str:
    joints = "1 joint" if len(row["joints"]) == 1 else f"{len(row['joints'])} joints"
    most = f", by up to {row['largest_change_deg']:.1f}° ({row['joints'][0]})" if "largest_change_deg" in row else ""
    met = _some([" and ".join(pair["links"]) for pair in row.get("pairs", [])])
    return f"{REASONS.get(row['reason'], row['reason'])}: {joints}, {row['seconds']:.2f} s{most}" + (
        f": {met}" if met else ""
    )


def _some(words: list[str]) -> str:
    return ", ".join(words[:_SHOWN]) + (" …" if len(words) > _SHOWN else "")


def switched_off(report: Mapping[str, Any]) -> Text | None:
    """A line, in red, that says which rules did not hold; nothing where all did."""
    from rich.text import Text

    off = report["rules_off"]
    return Text(f"SWITCHED OFF: {', '.join(off)}", style="bold red") if off else None


def did(simulated: Mapping[str, Any]) -> list[str]:
    """Lines about what the simulated robot did."""
    worst, error = max(simulated["tracking_rmse_deg"].items(), key=lambda item: item[1])
    lag = simulated["tracking_lag_ms"]
    lines = [
        f"{simulated['limit_violations']} limit violations, {simulated['self_collision_frames']} self-collisions, "
        f"top speed {100 * simulated['max_speed_ratio']:.0f} % of the motor's",
        f"followed its commands within {error:.1f}° rms (worst: {worst})"
        + ("" if lag is None else f", {lag:.0f} ms late"),
    ]
    margin = simulated["min_support_margin_m"]
    inside = "" if margin is None else f"; centre of mass at least {1000 * margin:.0f} mm inside its feet"
    if simulated["fell"] or inside:
        lines.append(("FELL" if simulated["fell"] else "stood") + inside)
    return lines


def _gestures(gestures: Mapping[str, Any]) -> list[str]:
    """What was recognised, and when in the recording."""
    rows = [
        f"{row['start_s']:.1f} to {row['end_s']:.1f} s  {row['label']} ({100 * row['confidence']:.0f} %)"
        + ("" if row["has_motion"] else ", for which there is no motion")
        for row in gestures["segments"]
    ]
    more = [f"and {len(rows) - _LINES} more: see the report"] if len(rows) > _LINES else []
    return rows[:_LINES] + more or ["none recognised"]


def _imitated(similarity: Mapping[str, Any]) -> list[str]:
    """How far the simulated arms pointed from the person's, and why."""
    score = similarity["stages"]["simulated"]
    error, limits = score["direction_error_deg"]["all"], similarity["limits_deg"]["all"]
    if error["mean"] is None:
        return ["no arm to compare"]
    lag = score["lag_ms"]
    return [
        f"arms {error['mean']:.1f}° from where they should point (median {error['median']:.1f}°, "
        f"95 % within {error['p95']:.1f}°)" + ("" if lag is None else f", {lag:.0f} ms late"),
        f"of that {limits['mean']:.1f}° is what NAO's joints cannot reach, "
        f"and {_added(similarity, 'requested', 'commanded'):.1f}° what safety and the motors' speed take",
    ]


def _added(similarity: Mapping[str, Any], before: str, after: str) -> float:
    """How much larger the mean error is at one stage than at the one before, degrees."""
    means = [similarity["stages"][stage]["direction_error_deg"]["all"]["mean"] for stage in (before, after)]
    return 0.0 if None in means else max(0.0, float(means[1] - means[0]))


def _took(timing: Mapping[str, Any]) -> list[str]:
    line = f"{timing['total_s']:.1f} s ({timing['realtime_factor']:.2f} times real time)"
    if "render_fps" in timing:
        line += f"; rendering {timing['render_fps']:.0f} frames/s with {timing['gl_backend']}"
    return [line]
