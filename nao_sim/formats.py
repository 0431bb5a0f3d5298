"""What can be read, and how it is told."""

from __future__ import annotations

import sys


def formats() -> None:
    """List every format that can be read and what tells it, and every layout of skeletons in text."""
    from rich.console import Console
    from rich.table import Table

    from nao_sim.recordings import FORMATS
    from nao_sim.recordings.skeletons.layouts import builtin

    console = Console()
    known = Table("format", "told by", title="Formats", title_justify="left", box=None, pad_edge=False)
    for format_ in FORMATS:
        known.add_row(format_.name, format_.looks)
    console.print(known)
    console.print()
    layouts = Table("layout", "joints", "source", title="Layouts", title_justify="left", box=None, pad_edge=False)
    for layout in builtin():
        layouts.add_row(layout.name, str(len(layout.joints)), layout.source)
    console.print(layouts)
    console.print("\nAnother text layout is a table of your own: --layout my.toml, see docs/layouts.md.")


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["formats", *sys.argv[1:]]))
