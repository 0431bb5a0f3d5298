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
    quiet: options.Quiet = False,
) -> None:
    """Learn poses and movements from labelled recordings, and say how well they are recognised.

    Examples labelled `none` teach nothing, but tell how often something is
    recognised where nothing is.
    """
    check_results([output], manifest)
    from nao_sim.gestures.evaluation.data_set import read_examples
    from nao_sim.gestures.evaluation.evaluate import Wanted
    from nao_sim.gestures.evaluation.kinds import kinds_of
    from nao_sim.gestures.evaluation.taught import report
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
        if quiet:
            return
        wanted = Wanted(kind.wanted, single_arms=single_arms)
        parts = report(data, kinds, trained.robot, output, wanted, progress)
    print_sections(parts, [output])


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["train", *sys.argv[1:]]))
