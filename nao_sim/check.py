"""What the robot can safely do of a recording: guarded and simulated, not filmed."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from nao_sim import options
from nao_sim.console import ProgressBar
from nao_sim.errors import NaoSimError, UsageError
from nao_sim.files import check_results, make_folder
from nao_sim.verdict import UNSAFE_STATUS, Verdict

if TYPE_CHECKING:
    from nao_sim.replay import Orders
    from nao_sim.report import Report
    from nao_sim.simulation.simulator import Simulator

STATUS = {Verdict.as_requested: 0, Verdict.made_safe: 1, Verdict.unsafe: UNSAFE_STATUS}


def check(  # noqa: PLR0913  # a command line's options are its function's arguments
    recordings: Annotated[
        list[Path],
        typer.Argument(
            metavar="RECORDING", help="People's skeletons or a NAO's joint angles, of any format in README.md."
        ),
    ],
    *,
    context: typer.Context,
    plot: options.Plot = None,
    plot_size: options.PlotSize = None,
    joints: Annotated[
        Literal["changed", "all"], typer.Option(help="Joints in the picture: those changed most, or all.")
    ] = "changed",
    json: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Also write the report as JSON; - prints it, and nothing else.")
    ] = None,
    html: options.Html = None,
    match: options.Match = options.MatchOption.directions,
    body: options.Body = options.BodyOption.arms,
    raw: options.Raw = False,
    unit: options.Unit = None,
    rate: options.Rate = None,
    layout: options.Layout = None,
    person: options.Person = None,
    rig: options.Rig = None,
    base: options.Base = "free",
    robot: options.Version = "v5",
    speed: options.Speed = 1.0,
    max_speed: options.MaxSpeed = None,
    without: options.Without = None,
    accept_risk: options.AcceptRisk = False,
    quiet: options.Quiet = False,
) -> int:
    """Say what of a recording the robot can safely do: what the guard changes, when and why, and what the robot does.

    Exit status: 0 safe as requested, 1 made safe, 2 bad input or usage, 4 the
    simulated robot fell or broke a rule; of many recordings the highest.
    """
    options.check_speed(speed)
    _check_results(recordings, plot, html, json)
    from nao_sim.performed import perform_recording
    from nao_sim.recordings import Source
    from nao_sim.replay import Orders, show

    orders = Orders(
        recording=Source(recordings[0], unit, rate, layout, person, rig),
        robot=robot,
        base=base,
        speed=speed,
        match=match.value,
        body=body.value,
        raw=raw,
        rules=options.rules(max_speed, without, accept_risk),
        html=html,
        command=options.command_line(context),
    )
    silent = quiet or json == options.STDOUT
    if len(recordings) > 1:
        return _check_many([replace(orders, recording=replace(orders.recording, path=path)) for path in recordings],
                           json, silent)  # fmt: skip
    with ProgressBar(silent) as progress:
        checked = perform_recording(orders, progress)
        if plot:
            from nao_sim.plotting.safety_page import save_safety_plot

            every, size = joints == "all", plot_size and plot_size.value
            save_safety_plot(checked.report, checked.performance, checked.simulator, plot, every=every, size=size)
        show(checked, orders)
    _write(checked.report, json)
    if not silent:
        from nao_sim.check_tables import print_check

        print_check(checked.report, [path for path in (plot, html, json) if path])
    return STATUS[checked.report["verdict"]]


def _check_many(many: Sequence[Orders], json: Path | None, silent: bool) -> int:
    """A line for each recording and a summary; what cannot be read is said, and the others are checked all the same."""
    from nao_sim.check_tables import print_line, print_totals
    from nao_sim.performed import perform_recording

    simulator: Simulator | None = None
    reports: list[Report] = []
    for orders in many:
        try:
            with ProgressBar(silent) as progress:
                checked = perform_recording(orders, progress, simulator)
        except NaoSimError as error:
            print(f"nao-sim: {' '.join(str(error).splitlines())}", file=sys.stderr)
            continue
        simulator = checked.simulator
        reports.append(checked.report)
        if not silent:
            print_line(checked.report)
    unreadable = len(many) - len(reports)
    _write({"recordings": reports, "unreadable": unreadable}, json)
    if not silent:
        print_totals(reports, unreadable)
    return max([*(STATUS[report["verdict"]] for report in reports), NaoSimError.exit_status if unreadable else 0])


def _check_results(recordings: Sequence[Path], plot: Path | None, html: Path | None, json: Path | None) -> None:
    """Say before the work what cannot be.

    Raises:
        UsageError: a picture or page of many recordings or of an unknown kind, or a file that cannot be written.
    """
    options.check_picture(plot)
    options.check_page(html)
    for option, path in {"--plot": plot, "--html": html}.items():
        if path and len(recordings) > 1:
            raise UsageError(f"{option} {path}: shows one recording, and {len(recordings)} are given")
    results = [path for path in (plot, html, None if json == options.STDOUT else json) if path]
    check_results(results, *recordings)
    for path in results:
        make_folder(path.parent)


def _write(report: dict[str, Any], json: Path | None) -> None:
    if json == options.STDOUT:
        from json import dumps

        print(dumps(report, indent=2))
    elif json:
        from nao_sim.report import save_report

        save_report(report, json)


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["check", *sys.argv[1:]]))
