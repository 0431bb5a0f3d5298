"""Which gestures a recording of a person shows, and when."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nao_sim import options
from nao_sim.errors import UsageError
from nao_sim.files import check_results, make_folder

if TYPE_CHECKING:
    from nao_sim.gestures.recognised import Recognised
    from nao_sim.recordings import Recording, Source


def recognise(
    recording: Annotated[Path, typer.Argument(help="A person's skeleton, of any format in README.md.")],
    *,
    context: typer.Context,
    vocabulary: Annotated[
        Path | None,
        typer.Option(
            "--vocabulary",
            "--model",
            metavar="VOCAB",
            help="Gestures to recognise, of nao-sim train or teach.",
            show_default="the built-in poses",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="CSV", help="Also write what each frame shows; - prints it."),
    ] = None,
    json: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Also write the gestures as JSON; - prints it."),
    ] = None,
    plot: options.Plot = None,
    plot_size: options.PlotSize = None,
    html: options.Html = None,
    rate: options.Rate = None,
    layout: options.Layout = None,
    person: options.Person = None,
    rig: options.Rig = None,
    quiet: options.Quiet = False,
) -> None:
    """Say which gestures a recording shows, and when: frame after frame, as a stream would, never looking ahead."""
    options.check_picture(plot)
    options.check_page(html)
    if output == json == options.STDOUT:
        raise UsageError("-o - and --json -: both would be printed; expected a file's name for one of them")
    files = [path for path in (output, json, plot, html) if path and path != options.STDOUT]
    check_results(files, recording)
    from nao_sim.gestures.recognised_tables import csv_text, json_text, print_recognised
    from nao_sim.plotting.gestures_page import save_gestures
    from nao_sim.recordings import Source
    from nao_sim.sections import write_text

    source, found = _recognised(Source(recording, rate=rate, layout=layout, person=person, rig=rig), vocabulary)
    for file in files:
        make_folder(file.parent)
    texts = {output: partial(csv_text, found), json: partial(json_text, source, found)}
    for path, text in texts.items():
        if path == options.STDOUT:
            print(text(), end="")
        elif path:
            write_text(path, text())
    if plot:
        save_gestures(found, source, plot, plot_size and plot_size.value)
    if html:
        from nao_sim.web.documents import recognition_document
        from nao_sim.web.writing import write_document

        write_document(recognition_document(source, found, options.command_line(context)), html)
    if not (quiet or options.STDOUT in texts):
        print_recognised(source, found, files)


def _recognised(source: Source, vocabulary: Path | None) -> tuple[Recording, Recognised]:
    from nao_sim.gestures.recognised import recognise as recognised
    from nao_sim.gestures.storage import vocabulary_of
    from nao_sim.motion import Skeleton
    from nao_sim.recordings import read

    known = vocabulary_of(vocabulary)
    recording = read(source)
    if not isinstance(recording.motion, Skeleton):
        raise UsageError(f"{source.path}: holds a robot's joint angles ({recording.format}); expected a person")
    try:
        return recording, recognised(recording.motion, known)
    except UsageError as error:
        raise UsageError(f"{source.path}: {error}") from None


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["recognise", *sys.argv[1:]]))
