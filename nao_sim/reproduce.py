"""The published figures of the thesis that this project grew from, computed again."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nao_sim.files import beside
from nao_sim.options import Quiet

if TYPE_CHECKING:
    from nao_sim.gestures.thesis.section import Section

NAME = "reproduction"


def reproduce(
    *,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FOLDER", help="Where the text, the numbers and the plots go.")
    ] = Path("render") / NAME,
    quiet: Quiet = False,
) -> None:
    """Put each published figure of the thesis beside ours, and say why they differ where they do.

    It learns from the printed rows of the thesis's training table; nothing is
    tuned to make a figure match.  Writes Markdown, JSON and a picture for each plot.
    """
    from nao_sim.gestures.thesis.comparison import SOURCE, numbers, sections
    from nao_sim.gestures.thesis.study import study
    from nao_sim.plotting.thesis_pages import save_pictures
    from nao_sim.replay import make_folder

    make_folder(output)
    done = study()
    parts = sections(done)
    pictures = save_pictures(done, output)
    text, values = output / f"{NAME}.md", output / f"{NAME}.json"
    _write(text, markdown(SOURCE, parts))
    _write(values, json.dumps(numbers(done), indent=2) + "\n")
    if not quiet:
        _print(parts, [text, values, *pictures])


def markdown(source: str, parts: Sequence[Section]) -> str:
    """The comparison as a page whose pictures lie beside it."""
    lines = ["# The thesis, computed again", "", f"Published: {source}. Ours: the 28 rows of its Table A.1 in print."]
    for part in parts:
        lines += ["", f"## {part.title}", "", _row(part.head), _row(("---",) * len(part.head)), *map(_row, part.rows)]
        for remark in part.remarks:
            lines += ["", remark]
        if part.picture:
            lines += ["", f"![{part.title}]({part.picture}.png)"]
    return "\n".join(lines) + "\n"


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _write(path: Path, text: str) -> None:
    with beside(path) as draft:
        draft.write_text(text, encoding="utf-8")


def _print(parts: Sequence[Section], written: Sequence[Path]) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console()
    for part in parts:
        table = Table(title=part.title, title_justify="left", title_style="bold", box=None, pad_edge=False)
        for name in part.head:
            table.add_column(name)
        for row in part.rows:
            table.add_row(*map(Text, row))
        console.print(table)
        for remark in part.remarks:
            console.print(Text(remark, style="dim"))
        console.print()
    for path in written:
        console.print(Text(f"written  {path}"), soft_wrap=True)


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["reproduce", *sys.argv[1:]]))
