"""What is in a recording, and how good it is."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from nao_sim import options
from nao_sim.files import check_results


def inspect(  # noqa: PLR0913  # a command line's options are its function's arguments
    recording: Annotated[Path, typer.Argument(help="A recording of a person or of a NAO, of any format in README.md.")],
    *,
    plot: options.Plot = None,
    plot_size: options.PlotSize = None,
    json: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Also write everything as JSON; - prints it, and nothing else.")
    ] = None,
    unit: options.Unit = None,
    rate: options.Rate = None,
    layout: options.Layout = None,
    person: options.Person = None,
    rig: options.Rig = None,
    robot: options.Version = "v5",
    quiet: options.Quiet = False,
) -> None:
    """Say what is in a recording and how good it is: format, frames, joints, gaps, jitter, bones; limits and speeds."""
    options.check_picture(plot)
    check_results([plot, None if json == options.STDOUT else json], recording)
    from nao_sim.inspect_report import inspection
    from nao_sim.recordings import load
    from nao_sim.robot import load_robot

    found = load(recording, unit, rate, layout=layout, person=person, rig=rig)
    report = inspection(found, load_robot(robot))
    if plot:
        from nao_sim.plotting import save_picture

        save_picture(found, plot, load_robot(robot), plot_size and plot_size.value)
    if json == options.STDOUT:
        _print_json(report)
        return
    if json:
        from nao_sim.report import save_report

        save_report(report, json)
    if not quiet:
        from nao_sim.inspect_tables import print_inspection

        print_inspection(report, [path for path in (plot, json) if path])


def _print_json(report: dict[str, Any]) -> None:
    from json import dumps

    print(dumps(report, indent=2))


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["inspect", *sys.argv[1:]]))
