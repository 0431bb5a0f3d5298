"""Pictures of single moments: for a paper, a slide or a wall."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from nao_sim import options
from nao_sim.console import ProgressBar
from nao_sim.errors import UsageError
from nao_sim.verdict import UNSAFE_STATUS

MOST, USUAL = 100, 8  # pictures of a sheet


def still(  # noqa: PLR0913  # a command line's options are its function's arguments
    recording: Annotated[
        Path, typer.Argument(help="A person's skeleton or a NAO's joint angles, of any format in README.md.")
    ],
    *,
    at: Annotated[
        list[float] | None,
        typer.Option(metavar="SECONDS", help="Moment of the recording; several make a sheet.", show_default="a sheet"),
    ] = None,
    sheet: Annotated[
        int | None,
        typer.Option(metavar="N", help="A sheet of the N poses that differ most.", show_default="8 without --at"),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", metavar="PICTURE", help=".png, .jpg or .pdf.", show_default="render/<name>_still.png"
        ),
    ] = None,
    size: Annotated[
        str | None,
        typer.Option(metavar="WIDTHxHEIGHT", help="Pixels of a picture.", show_default="1280x960, on a sheet 480x360"),
    ] = None,
    camera: options.Camera = "three-quarter",
    quality: options.Quality = "fine",
    look: options.Look = "studio",
    theme: options.Theme = "orange",
    arrange: options.Arrange = "beside",
    overlay: options.Overlay = "gestures",
    show_person: options.ShowPerson = True,
    show_safety: options.ShowSafety = False,
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
    quiet: options.Quiet = False,
) -> int:
    """Take pictures of a robot that imitates a recording: one at a moment, or a sheet of several.

    The robot moves there as in `play`, guarded and simulated, so that the
    picture shows what it can do.  Exit status as of `play`.
    """
    if at and sheet:
        raise UsageError("--at and --sheet contradict each other; give one of them")
    if sheet is not None and not 1 <= sheet <= MOST:
        raise UsageError(f"--sheet {sheet}: expected 1 to {MOST}")
    if at and (early := [moment for moment in at if not moment >= 0.0]):
        raise UsageError(f"--at {early[0]:g}: expected seconds from the recording's start, 0 or more")
    from nao_sim.filming import Film
    from nao_sim.moments import Moments
    from nao_sim.recordings import Source
    from nao_sim.replay import Orders, replay

    moments = Moments(tuple(at or ()), 0 if at else sheet or USUAL)
    single = moments.key_poses == 1 or len(moments.at) == 1
    film = options.film_of(recording)
    picture = output or film.with_name(f"{film.stem}_still.png")
    pixels = options.parse_size(size or ("1280x960" if single else "480x360"))
    shown = options.overlaid(overlay, show_safety)
    orders = Orders(
        recording=Source(recording, unit, rate, layout, person, rig),
        film=Film(picture, 30.0, pixels, camera, quality, show_person, shown, look, theme, moments, arrange),
        robot=robot,
        base=base,
        match=match.value,
        body=body.value,
        raw=raw,
    )
    with ProgressBar(quiet) as progress:
        outcome = replay(orders, progress)
    if not quiet:
        for path in outcome.written.values():
            print(f"picture  {path}")
    if outcome.rendering_error:
        raise outcome.rendering_error
    return UNSAFE_STATUS if outcome.unsafe else 0


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["still", *sys.argv[1:]]))
