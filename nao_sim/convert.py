"""Joint angles from one format to another."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from nao_sim import options
from nao_sim.files import check_results


def convert(
    recording: Annotated[Path, typer.Argument(help="A NAO's joint angles, of any format in README.md.")],
    target: Annotated[Path, typer.Argument(help="File to write: .csv, .motion (Webots), .npz or .py (Choregraphe).")],
    unit: options.Unit = None,
    rate: options.Rate = None,
    plot: options.Plot = None,
    plot_size: options.PlotSize = None,
    quiet: options.Quiet = False,
) -> None:
    """Convert joint angles to the format of the target's extension, and say what it cannot hold."""
    from nao_sim.recordings import Source
    from nao_sim.recordings.angles.conversion import convert as convert_recording

    options.check_picture(plot)
    check_results([target, plot], recording)
    before, after, loss = convert_recording(Source(recording, unit, rate), target)
    if plot:
        from nao_sim.plotting import save_picture

        save_picture(after, plot, size=plot_size and plot_size.value)
    if quiet:
        return
    for note in before.notes:
        typer.echo(f"note: {note}")
    for what, path, read in (("read", recording, before), ("written", target, after)):
        motion = read.motion
        typer.echo(f"{what:<8} {path}: {read.format}, {len(motion)} frames, {motion.duration:.2f} s")
    for text in loss.told or ("nothing",):
        typer.echo(f"lost     {text}")
    if plot:
        typer.echo(f"written  {plot}")


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["convert", *sys.argv[1:]]))
