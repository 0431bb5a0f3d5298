"""The published figures of the thesis that this project grew from, computed again."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from nao_sim import options
from nao_sim.files import make_folder

NAME = "reproduction"


def reproduce(
    *,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FOLDER", help="Where the text, the numbers and the plots go.")
    ] = Path("render") / NAME,
    plot: options.Plot = None,
    plot_size: options.PlotSize = None,
    quiet: options.Quiet = False,
) -> None:
    """Put each published figure of the thesis beside ours, and say why they differ where they do.

    It learns from the printed rows of the thesis's training table; nothing is
    tuned to make a figure match.  Writes Markdown, JSON and a picture for each plot.
    """
    options.check_picture(plot)
    from nao_sim.gestures.thesis.comparison import SOURCE, numbers, sections
    from nao_sim.gestures.thesis.study import study
    from nao_sim.plotting.thesis_pages import save_pictures, save_study
    from nao_sim.sections import markdown, print_sections, write_text

    make_folder(output)
    done = study()
    parts = sections(done)
    pictures = save_pictures(done, output)
    text, values = output / f"{NAME}.md", output / f"{NAME}.json"
    words = f"Published: {SOURCE}. Ours: the 28 rows of its Table A.1 in print."
    write_text(text, markdown("The thesis, computed again", words, parts))
    write_text(values, json.dumps(numbers(done), indent=2) + "\n")
    if plot:
        save_study(done, plot, plot_size and plot_size.value)
        pictures.append(plot)
    if not quiet:
        print_sections(parts, [text, values, *pictures])


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["reproduce", *sys.argv[1:]]))
