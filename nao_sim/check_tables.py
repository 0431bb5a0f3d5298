"""What `nao-sim check` prints: the verdict, what the guard changed by rule, and what the robot did."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nao_sim.console import REASONS, about, did, in_order, switched_off
from nao_sim.sections import Section
from nao_sim.verdict import Verdict

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.text import Text

Row = Mapping[str, Any]
_HEAD = ("changed", "seconds", "of run", "largest", "mean")
_LINE = "{:<46}{:>8}{:>8}{:>9}{:>8}"
_SPELLS, _NAMES, _PAIRS = 4, 4, 2  # that are shown before the rest is only counted
_STYLES = {Verdict.as_requested: "bold green", Verdict.made_safe: "bold yellow", Verdict.unsafe: "bold red"}
_WORDS = {Verdict.as_requested: "safe as requested", Verdict.made_safe: "made safe", Verdict.unsafe: "NOT SAFE"}


def print_check(report: Row, written: Sequence[Path]) -> None:
    """Print everything about one recording."""
    from rich.console import Console
    from rich.text import Text

    console = Console()
    console.print(Text(f"{report['recording']}: {about(report)}", style="bold"), soft_wrap=True)
    for note in report["notes"]:
        console.print(Text(f"note: {note}", style="dim"))
    console.print(_verdict_line(report), soft_wrap=True)
    if off := switched_off(report):
        console.print(off)
    for part in _rules(report["rules"]) if report["rules"] else ():
        console.print(part)
    for place, line in enumerate(did(report["simulated"])):
        console.print(Text.assemble(("" if place else "robot").ljust(7), line, style="bold" if report["wrong"] else ""))
    for path in written:
        console.print(Text(f"written {path}"), soft_wrap=True)


def print_line(report: Row) -> None:
    """Print one recording's verdict in one line."""
    from rich.console import Console
    from rich.text import Text

    line = Text.assemble(_verdict_line(report), f"  {report['recording']}")
    reasons = [row["reason"] for row in in_order(report["rules"])]
    Console().print(line.append(f": {', '.join(reasons)}" if reasons else ""), soft_wrap=True)


def print_totals(reports: Sequence[Row], unreadable: int) -> None:
    """Print how many recordings came to which verdict, and how often each rule was needed."""
    from rich.console import Console
    from rich.table import Table

    verdicts = Counter(report["verdict"] for report in reports)
    table = Table("", "recordings", box=None, pad_edge=False)
    table.columns[1].justify = "right"
    for verdict in Verdict:
        table.add_row(_WORDS[verdict], str(verdicts[verdict]), style=_STYLES[verdict] if verdicts[verdict] else "dim")
    table.add_row("cannot be read", str(unreadable), style="bold red" if unreadable else "dim")
    needed = Counter(row["reason"] for report in reports for row in report["rules"])
    for row in in_order([{"reason": reason} for reason in needed]):
        table.add_row(_words(row["reason"]), str(needed[row["reason"]]))
    console = Console()
    console.print()
    console.print(table)
    if reports and (off := switched_off(reports[0])):
        console.print(off)


def _verdict_line(report: Row) -> Text:
    from rich.text import Text

    return Text(verdict_words(report), style=_STYLES[report["verdict"]])


def verdict_words(report: Row) -> str:
    """The verdict, and how much was changed or what went wrong."""
    verdict = Verdict(report["verdict"])
    if verdict is Verdict.unsafe:
        return f"{_WORDS[verdict]}: {'; '.join(report['wrong'])}"
    changed = f": {report['changed_steps']} of {report['steps']} frames (50 Hz) changed"
    return _WORDS[verdict] + (changed if verdict is Verdict.made_safe else "")


def _rules(rows: list[Row]) -> Iterator[RenderableType]:
    """A line of numbers for each rule, and below it the joints, the pairs of links and the times."""
    from rich.padding import Padding
    from rich.text import Text

    yield Text(_LINE.format(*_HEAD), style="bold")
    for row in in_order(rows):
        yield Text(_LINE.format(*_figures(row)))
        for line in _details(row):
            yield Padding(Text(line, style="dim"), (0, 0, 0, 2))


def rules_section(report: Row) -> Section:
    """What the guard changed, a row for each rule."""
    ordered = in_order(report["rules"])
    met = any("pairs" in row for row in ordered)
    head = (*_HEAD, "joints", *(("parts that would have met",) if met else ()), "when")
    rows = []
    for row in ordered:
        joints, *pairs, when = _details(row)
        rows.append((*_figures(row), joints, *((pairs or [""]) if met else ()), when))
    return Section("What the guard changed", head, rows)


def _figures(row: Row) -> tuple[str, ...]:
    """A rule in numbers, under `_HEAD`."""
    share = f"{100 * row['share']:.1f} %"
    return _words(row["reason"]), f"{row['seconds']:.2f}", share, _change(row, "largest"), _change(row, "mean")


def _words(reason: str) -> str:
    return REASONS.get(reason, reason)


def _details(row: Row) -> Iterator[str]:
    yield _some(row["joints"], _NAMES)
    if pairs := row.get("pairs"):
        yield _some([f"{' and '.join(pair['links'])} ({pair['seconds']:.2f} s)" for pair in pairs], _PAIRS)
    yield "at " + _some([f"{start:.2f}-{end:.2f}" for start, end in row["times_s"]], _SPELLS, " s")


def _some(words: Sequence[str], most: int, unit: str = "") -> str:
    """The first words, and how many more there are."""
    more = len(words) - most
    return ", ".join(words[:most]) + unit + (f" and {more} more" if more > 0 else "")


def _change(row: Row, which: str) -> str:
    """The largest or mean change, in degrees where it has any."""
    if (angle := row.get(f"{which}_change_deg")) is not None:
        return f"{angle:.1f}°"
    return f"{row[f'{which}_change_opening']:.2f}"
