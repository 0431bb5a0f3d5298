"""A new gesture for the robot's vocabulary, from a few examples of it."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from nao_sim import body, options
from nao_sim.console import ProgressBar
from nao_sim.errors import UsageError
from nao_sim.files import check_results

if TYPE_CHECKING:
    from nao_sim.lesson import Order, Taught

ENOUGH = 3  # examples find 87 % of strangers' signs, a single one 68 % (benchmarks/GESTURES.md)


def teach(  # noqa: PLR0913  # a command line's options are its function's arguments
    name: Annotated[
        str, typer.Argument(help="What the gesture is called; a left_NAME or right_NAME is learned for both sides.")
    ],
    recordings: Annotated[
        list[Path],
        typer.Argument(metavar="FILE...", help="People who show it, of any format in README.md; one to five do."),
    ],
    *,
    into: Annotated[
        Path, typer.Option("--into", metavar="VOCAB", help="The vocabulary's file; if it exists, it is added to.")
    ],
    base: Annotated[
        Path | None,
        typer.Option("--from", metavar="VOCAB", help="Vocabulary to start from.", show_default="the built-in poses"),
    ] = None,
    kind: Annotated[
        Literal["pose", "movement"] | None,
        typer.Option(help="What it is.", show_default="a pose if the arms are held still, else a movement"),
    ] = None,
    start: Annotated[float | None, typer.Option(help="Where a single example begins in its file, seconds.")] = None,
    end: Annotated[float | None, typer.Option(help="Where it ends, seconds.")] = None,
    rate: options.Rate = None,
    layout: options.Layout = None,
    person: options.Person = None,
    rig: options.Rig = None,
    plot: options.Plot = None,
    plot_size: options.PlotSize = None,
    quiet: options.Quiet = False,
) -> None:
    """Teach a gesture by one to five examples; the robot's motion for it is learned from them, too, and made safe.

    A known pose gets the new meaning; a known movement gets more examples. In
    both cases the robot's new motion replaces the old one.
    """
    _check(name, recordings, start, end)
    options.check_picture(plot)
    check_results([into, plot], *recordings)
    from nao_sim.lesson import Order, give_lesson
    from nao_sim.recordings import Source

    sources = tuple(Source(path, None, rate, layout, person, rig) for path in recordings)
    order = Order(name, sources, into, base, kind, start, end)
    with ProgressBar(quiet) as progress:
        taught = give_lesson(order, progress)
    if plot:
        from nao_sim.plotting.picture import save_angles
        from nao_sim.robot import load_robot

        motion, title = taught.vocabulary.motions[taught.lesson.name], f"{name}: what the robot does, joint angles"
        save_angles(motion, plot, title, load_robot(), plot_size and plot_size.value)
    if not quiet:
        for word, line in [*lines(order, taught), *([("written", str(plot))] if plot else [])]:
            typer.echo(f"{word:<9} {line}")


def lines(order: Order, taught: Taught) -> list[tuple[str, str]]:
    """What a user should know of a lesson: a word and a line each."""
    lesson, count = taught.lesson, len(order.sources)
    other = "movement" if lesson.kind == "pose" else "pose"
    say = "" if order.kind else f"; if it is a {other}: --kind {other}"
    told = [("learned", f"{lesson.name}, a {lesson.kind} ({lesson.why}{say})")]
    if (twin := body.twin(lesson.name)) != lesson.name:
        told.append(("mirrored", f"{twin}, learned from the same"))
    if lesson.known:
        more = "new meaning instead of the old one" if lesson.kind == "pose" else "more examples besides those known"
        told.append(("known", f"already: {more}; the robot's motion is replaced"))
    told.append(("robot", _robot(order, taught)))
    told.append(("heard", f"announced in {lesson.recognised} of {count}" + _also(taught)))
    if lesson.recognised < count:
        told.append(("warning", "it is not announced in all of them: show it more clearly, longer or more often"))
    if lesson.kind == "movement" and count < ENOUGH and not lesson.known:
        told.append(("hint", f"{ENOUGH} examples, by several people, are recognised more often than {count}"))
    for rival in lesson.rivals:
        taken = lesson.like.count(rival)
        told.append(("warning", f"hard to tell from {rival}: {taken} of {count} examples would have been taken for it"))
    poses, movements = len(taught.vocabulary.pose_names), len(taught.vocabulary.movement_names)
    told.append(("written", f"{order.into}: {taught.began_with} and this (poses: {poses}, movements: {movements})"))
    told.append(("next", f"nao-sim play FILE --mode gestures --vocabulary {order.into}"))
    return told


def _robot(order: Order, taught: Taught) -> str:
    from math import degrees

    lesson, motion = taught.lesson, taught.vocabulary.motions[taught.lesson.name]
    does = "holds the posture" if lesson.kind == "pose" else f"does the {motion.duration:.1f} s of movement"
    changed = round(degrees(taught.changed))
    safe = f", made safe: changed by {changed}° on average" if changed else ""
    return f"{does} of {order.sources[lesson.typical].path}{safe}"


def _also(taught: Taught) -> str:
    also = taught.lesson.also_heard
    return f"; also announced there: {', '.join(also)}" if also else ""


def _check(name: str, recordings: list[Path], start: float | None, end: float | None) -> None:
    """Refuse words that cannot mean what they say.

    Raises:
        UsageError: the name is a file's, or a stretch is given of several files, or ends before it begins.
    """
    if Path(name).is_file():
        raise UsageError(f"{name}: is a file; expected the gesture's name first: nao-sim teach NAME {name}")
    if (start is not None or end is not None) and len(recordings) > 1:
        raise UsageError(f"--start and --end: {len(recordings)} files are given; expected one")
    if start is not None and end is not None and not start < end:
        raise UsageError(f"--start {start:g} --end {end:g}: expected a start before the end")


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["teach", *sys.argv[1:]]))
