"""Gestures learned from labelled recordings."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from nao_sim import options
from nao_sim.console import ProgressBar
from nao_sim.files import check_results, make_folder


def train(
    manifest: options.Manifest,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="The vocabulary to write.")],
    *,
    kind: options.Kind = options.KindOption.auto,
    single_arms: options.SingleArms = False,
    motions: Annotated[
        bool, typer.Option(help="Also record what the robot does for each gesture, after its most typical example.")
    ] = True,
    rate: options.Rate = None,
    skip_unreadable: options.SkipUnreadable = False,
    plot: options.Plot = None,
    plot_size: options.PlotSize = None,
    quiet: options.Quiet = False,
) -> None:
    """Learn poses and movements from labelled recordings, and say how well they are recognised.

    Examples labelled `none` teach nothing, but tell how often something is
    recognised where nothing is.
    """
    options.check_picture(plot)
    check_results([output, plot], manifest)
    from nao_sim.gestures.evaluation.data_set import read_examples
    from nao_sim.gestures.evaluation.evaluate import Wanted
    from nao_sim.gestures.evaluation.kinds import kinds_of
    from nao_sim.gestures.evaluation.taught import counted, held_out, report
    from nao_sim.gestures.manifest import load_manifest
    from nao_sim.gestures.storage import save
    from nao_sim.sections import print_sections
    from nao_sim.training import train as trained_by

    rows = load_manifest(manifest)
    make_folder(output.parent)
    with ProgressBar(quiet) as progress:
        data = read_examples(rows, rate, skip_unreadable, lambda done, total: progress("reading", done, total))
        kinds = kinds_of(data, kind.wanted)
        trained = trained_by(data, kinds, single_arms, motions, progress)
        save(output, trained.vocabulary)
        if quiet and not plot:
            return
        judged = held_out(data, Wanted(kind.wanted, single_arms=single_arms), progress)
    if plot:
        from nao_sim.plotting.evaluation_pages import save_training

        save_training(counted(data, kinds), judged, plot, plot_size and plot_size.value)
    if not quiet:
        print_sections(report(data, kinds, trained.robot, output, judged), [path for path in (output, plot) if path])


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["train", *sys.argv[1:]]))
