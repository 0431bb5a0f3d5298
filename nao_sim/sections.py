"""Parts of a comparison, tables with words, on the terminal and as Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from nao_sim.files import beside


@dataclass(frozen=True)
class Section:
    """A part of a comparison.

    Attributes:
        title: what it is about.
        head: names of the columns.
        rows: of the table, as text.
        remarks: why figures differ, and what cannot be known.
        picture: name of the plot that belongs to it, if one does.
    """

    title: str
    head: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    remarks: tuple[str, ...] = ()
    picture: str | None = None


def markdown(title: str, words: str, parts: Sequence[Section]) -> str:
    """Sections as a page whose pictures lie beside it."""
    lines = [f"# {title}", "", words]
    for part in parts:
        lines += ["", f"## {part.title}"]
        if part.rows:
            lines += ["", _row(part.head), _row(("---",) * len(part.head)), *map(_row, part.rows)]
        for remark in part.remarks:
            lines += ["", remark]
        if part.picture:
            lines += ["", f"![{part.title}]({part.picture}.png)"]
    return "\n".join(lines) + "\n"


def write_text(path: Path, text: str) -> None:
    """Write a text, whole or not at all.

    Raises:
        UsageError: it cannot be written there.
    """
    with beside(path) as draft:
        draft.write_text(text, encoding="utf-8")


def print_sections(parts: Sequence[Section], written: Sequence[Path]) -> None:
    """Print sections, and where the files are."""
    from rich.console import Console
    from rich.text import Text

    console = Console()
    for part in parts:
        console.print(Text(part.title, style="bold"), soft_wrap=True)
        print_table(part)
        for remark in part.remarks:
            console.print(Text(remark, style="dim"))
        console.print()
    for path in written:
        console.print(Text(f"written  {path}"), soft_wrap=True)


def print_table(part: Section, *, figures: bool = False) -> None:
    """Print a section's table, if it has one; with `figures` all but the first column are numbers."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False)
    for place, name in enumerate(part.head):
        numbers = figures and place > 0
        style = "bold" if figures and not place else ""
        table.add_column(name, justify="right" if numbers else "left", style=style, no_wrap=figures)
    for row in part.rows:
        table.add_row(*map(Text, row))
    if part.rows:
        Console().print(table)


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"
