"""The main job: a recording in, a video of a NAO doing it and a report out."""

from __future__ import annotations

import sys
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nao_sim import options
from nao_sim.console import ProgressBar, print_summary
from nao_sim.errors import RenderingError, UsageError
from nao_sim.paths import TRAJECTORIES
from nao_sim.verdict import UNSAFE_STATUS

if TYPE_CHECKING:
    from nao_sim.gestures.vocabulary import Vocabulary

SAMPLE = TRAJECTORIES / "wave.csv"


class Mode(StrEnum):
    """How the robot imitates."""

    one_to_one = "one-to-one"
    gestures = "gestures"
    both = "both"


def play(
    recording: Annotated[
        Path,
        typer.Argument(
            help="A person's skeleton or a NAO's joint angles, of any format in README.md.", show_default="a wave"
        ),
    ] = SAMPLE,
    *,
    context: typer.Context,
    mode: Annotated[
        Mode,
        typer.Option(help="Imitate every frame; or play the gestures recognised in them; or two robots, side by side."),
    ] = Mode.one_to_one,
    vocabulary: Annotated[
        Path | None,
        typer.Option(
            metavar="VOCAB", help="Gestures to recognise, of nao-sim teach or train.", show_default="the built-in poses"
        ),
    ] = None,
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
    fps: Annotated[float, typer.Option(help="Frames a second of the video.")] = 30.0,
    size: Annotated[str, typer.Option(metavar="WIDTHxHEIGHT", help="Pixels of the video.")] = "640x480",
    camera: options.Camera = "three-quarter",
    quality: options.Quality = "standard",
    look: options.Look = "studio",
    theme: options.Theme = "orange",
    video: Annotated[
        Path | None,
        typer.Option(
            help="Video: .mp4, .webm, .gif, or .png for a folder of frames.", show_default="render/<name>.mp4"
        ),
    ] = None,
    arrange: options.Arrange = "beside",
    overlay: options.Overlay = "gestures",
    show_person: options.ShowPerson = True,
    show_safety: options.ShowSafety = False,
    no_video: Annotated[bool, typer.Option("--no-video", help="Make no video, only the report.")] = False,
    report: Annotated[
        Path | None, typer.Option(help="Where the report goes (JSON).", show_default="the video's name with .json")
    ] = None,
    rollout: Annotated[Path | None, typer.Option(help="Also write the motion at 50 Hz as .npz.")] = None,
    plot: options.Plot = None,
    plot_size: options.PlotSize = None,
    html: options.Html = None,
    speed: options.Speed = 1.0,
    max_speed: options.MaxSpeed = None,
    without: options.Without = None,
    accept_risk: options.AcceptRisk = False,
    quiet: options.Quiet = False,
) -> int:
    """Let the robot imitate a recording; write a video and a report.

    Exit status: 0 done, 2 bad input or usage, 3 nothing can render here (all
    but the video is written), 4 the simulated robot fell or broke a rule.
    """
    options.check_speed(speed)
    _check_mode(
        mode, vocabulary, {"--match": match.value != "directions", "--body": body.value != "arms", "--raw": raw}
    )
    if mode is Mode.both:
        _check_both({"--rollout": rollout, "--camera head": camera == "head", **options.for_one(overlay, show_safety)})
    if video and no_video:
        raise UsageError("--video and --no-video contradict each other; give one of them")
    options.check_picture(plot)
    options.check_page(html)
    film = video or options.film_of(recording)
    from nao_sim.filming import Film
    from nao_sim.recordings import Source
    from nao_sim.replay import Orders, replay

    orders = Orders(
        recording=Source(recording, unit, rate, layout, person, rig),
        report=report or film.with_suffix(".json"),
        film=None
        if no_video
        else Film(
            film,
            fps,
            options.parse_size(size),
            camera,
            quality,
            show_person,
            options.overlaid(overlay, show_safety),
            look,
            theme,
            arrangement=arrange,
        ),
        rollout=rollout,
        robot=robot,
        base=base,
        speed=speed,
        match=match.value,
        body=body.value,
        raw=raw,
        rules=options.rules(max_speed, without, accept_risk),
        vocabulary=None if mode is Mode.one_to_one else _gestures(vocabulary),
        both=mode is Mode.both,
        plot=plot,
        plot_size=plot_size and plot_size.value,
        html=html,
        command=options.command_line(context),
    )
    with ProgressBar(quiet) as progress:
        outcome = replay(orders, progress)
    if not quiet:
        print_summary(outcome.report, outcome.written)
    if outcome.rendering_error:
        raise RenderingError(f"{outcome.rendering_error}; all but the video was written")
    return UNSAFE_STATUS if outcome.unsafe else 0


def _check_mode(mode: Mode, vocabulary: Path | None, for_imitation: dict[str, bool]) -> None:
    """Refuse options that the mode has no use for.

    Raises:
        UsageError: one is given.
    """
    if vocabulary and mode is Mode.one_to_one:
        raise UsageError(f"--vocabulary {vocabulary}: no gestures are recognised; expected --mode gestures with it")
    if mode is Mode.gestures and any(for_imitation.values()):
        option = next(option for option, given in for_imitation.items() if given)
        raise UsageError(f"{option}: says how every frame is imitated; expected no --mode gestures with it")


def _check_both(for_one: dict[str, object]) -> None:
    """Refuse options that are for one robot.

    Raises:
        UsageError: one is given.
    """
    if option := next((option for option, given in for_one.items() if given), None):
        raise UsageError(f"{option}: is for one robot; expected --mode one-to-one or gestures with it")


def _gestures(file: Path | None) -> Vocabulary:
    from nao_sim.gestures.storage import vocabulary_of  # a robot that imitates every frame needs none of that room

    return vocabulary_of(file)


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["play", *sys.argv[1:]]))
