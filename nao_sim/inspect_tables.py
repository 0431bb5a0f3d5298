"""What `nao-sim inspect` prints: the report as tables for people, with what looks wrong in colour."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nao_sim.health import together

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

Row = Mapping[str, Any]
_SHOWN = 6  # labels, and absent joints, before the rest is only counted
# From here on a value is shown as one to look at.
_SEEN, _CONFIDENCE, _GAP_S, _JITTER_MM, _SPREAD, _UNLIKE = 0.95, 0.5, 0.5, 10.0, 0.1, 0.1


def print_inspection(report: Row, written: Sequence[Path]) -> None:
    """Print what is known of the recording, and where the files are."""
    from rich.console import Console
    from rich.text import Text

    console = Console()
    console.print(Text(report["recording"], style="bold"), soft_wrap=True)
    for part in _parts(report):
        console.print(part)
        console.print()
    for path in written:
        console.print(Text(f"written  {path}"), soft_wrap=True)


def _parts(report: Row) -> Iterator[RenderableType]:
    yield _overview(report)
    if report["holds"] == "person":
        yield _joints(report["joints"])
        if report["bones"]:
            yield _bones(report["bones"])
    else:
        yield _angles(report["joints"])


def _overview(report: Row) -> Table:
    from rich.table import Table
    from rich.text import Text

    table = Table(show_header=False, box=None, pad_edge=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    person = report["holds"] == "person"
    blocks = {
        "format": [report["format"]],
        "because": [report["format_reason"]],
        "note": report["notes"],
        "frames": _frames(report),
        "holds": _holds(report),
        "labels": _some([label["name"] for label in report["labels"]]),
        "filters": (report["cleaning"]["notes"] or ["nothing to reject or fill"]) if person else [],
    }
    for label, lines in blocks.items():
        for place, line in enumerate(lines):
            table.add_row("" if place else label, Text(line))
    return table


def _frames(report: Row) -> list[str]:
    if report["rate_hz"] is None:
        return ["1 frame"]
    spread = 100.0 * report["interval_spread"]
    lines = [f"{report['frames']} in {report['duration_s']:.2f} s, {report['rate_hz']:.1f} frames/s "
             f"({'even' if spread < 0.5 else f'uneven by {spread:.0f} %'})"]  # noqa: PLR2004  # fmt: skip
    if report["interval_gaps"]:
        longest = f"the longest {1000.0 * report['longest_interval_s']:.0f} ms"
        lines.append(f"{_counted(report['interval_gaps'], 'pause')} between frames, {longest}")
    if report["repeated_frames"] and report["holds"] == "person":
        lines.append(f"{_counted(report['repeated_frames'], 'frame')} the same as the one before")
    return lines


def _holds(report: Row) -> list[str]:
    person = report["holds"] == "person"
    seen = [row for row in report["joints"] if row["seen"]]
    what = "a person, seen by one camera" if person and report["planar"] else "a person" if person else "joint angles"
    absent = "without " + ", ".join(_some(report["joints_absent"], ", "))
    return [f"{what}, {_counted(len(seen), 'joint')}", *([absent] if report["joints_absent"] else [])]


def _counted(count: int, what: str) -> str:
    return f"{count} {what}{'s' if count != 1 else ''}"


def _some(names: Sequence[str], between: str = ", ") -> list[str]:
    """The first names in a line, and how many more there are; no line for no names."""
    if not names:
        return []
    more = len(names) - _SHOWN
    return [between.join(names[:_SHOWN]) + (f" and {more} more" if more > 0 else "")]


def _table(*columns: str) -> Table:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold")
    for place, column in enumerate(columns):
        table.add_column(column, justify="right" if place else "left", no_wrap=True)
    return table


def _joints(rows: Sequence[Row]) -> Table:
    table = _table("joint", "seen (%)", "gaps", "longest (s)", "confidence", "jitter (mm)")
    for row in with_fingers_together(rows):
        table.add_row(
            row["joint"].replace("_", " "),
            _cell(row["seen"], 1, 100.0, row["seen"] < _SEEN),
            str(row["gaps"] or ""),
            _cell(row["longest_gap_s"] or None, 2, 1.0, row["longest_gap_s"] > _GAP_S),
            _cell(row["confidence"], 2, 1.0, (row["confidence"] or 1.0) < _CONFIDENCE),
            _cell(row["jitter_mm"], 1, 1.0, (row["jitter_mm"] or 0.0) > _JITTER_MM),
        )
    return table


def with_fingers_together(rows: Sequence[Row]) -> list[Row]:
    """The rows in the body's order, those of a hand's fingers as one: the mean, and of gaps the worst."""
    found: list[Row] = []
    for name, places in together([row["joint"] for row in rows]).items():
        members = [rows[place] for place in places]
        mean = {key: _mean([row[key] for row in members]) for key in ("seen", "confidence", "jitter_mm")}
        worst = {key: max(row[key] for row in members) for key in ("gaps", "longest_gap_s")}
        label = name if len(members) == 1 else f"{name} ({len(members)})"
        found.append({"joint": label} | mean | worst)
    return found


def _mean(values: Sequence[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return sum(known) / len(known) if known else None


def _bones(rows: Sequence[Row]) -> Table:
    table = _table("bone", "length (cm)", "spread (%)", "other side (%)")
    for row in rows:
        unlike = row["longer_than_other_side"]
        table.add_row(
            f"{row['start']} - {row['end']}".replace("_", " "),
            _cell(row["length_m"], 1, 100.0),
            _cell(row["spread"], 1, 100.0, row["spread"] > _SPREAD),
            _cell(unlike, 1, 100.0, abs(unlike or 0.0) > _UNLIKE, sign=True),
        )
    return table


def _angles(rows: Sequence[Row]) -> Table:
    limits = ("lower\nlimit", "upper\nlimit", "beyond\n(% frames)")
    table = _table("joint (°,\nhands 0 to 1)", "lowest", "highest", *limits, "fastest\n(/s)", "of the\nmotor's (%)")
    for row in rows:
        unit, digits = ("_deg", 1) if "lowest_deg" in row else ("", 2)
        kinds = ("lowest", "highest", "lower_limit", "upper_limit")
        ratio = row["top_speed_ratio"]
        table.add_row(
            row["joint"],
            *(_cell(row[f"{kind}{unit}"], digits) for kind in kinds),
            _cell(row["beyond_limits"] or None, 1, 100.0, row["beyond_limits"] > 0.0),
            _cell(row[f"top_speed{unit}_per_s"], digits),
            _cell(ratio, 0, 100.0, (ratio or 0.0) > 1.0),
        )
    return table


def _cell(value: float | None, digits: int, factor: float = 1.0, strange: bool = False, *, sign: bool = False) -> Any:
    """A number; in colour where it is one to look at."""
    from rich.text import Text

    if value is None:
        return ""
    text = f"{factor * value:{'+' if sign else ''}.{digits}f}"
    return Text(text, style="bold yellow" if strange else "")
