"""How well gestures of a data set are recognised when other people make them."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nao_sim import options
from nao_sim.console import ProgressBar
from nao_sim.files import check_results, make_folder

if TYPE_CHECKING:
    from nao_sim.gestures.evaluation.evaluate import Evaluation

NAME = "evaluation"


def evaluate(
    manifest: options.Manifest,
    *,
    context: typer.Context,
    kind: options.Kind = options.KindOption.auto,
    learner: Annotated[
        str, typer.Option(metavar="NAME", help="Also try another learner, or `all`; a wrong name lists them.")
    ] = "nao_sim",
    folds: Annotated[
        int | None, typer.Option(metavar="K", help="Judge K folds by chance, not each user by what others show.")
    ] = None,
    test: Annotated[
        Path | None, typer.Option(metavar="MANIFEST", help="Learn from the first manifest, and judge by this one.")
    ] = None,
    vocabulary: Annotated[
        Path | None,
        typer.Option("--vocabulary", "--model", metavar="VOCAB", help="Learn nothing: judge this vocabulary."),
    ] = None,
    single_arms: options.SingleArms = False,
    rate: options.Rate = None,
    skip_unreadable: options.SkipUnreadable = False,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FOLDER", help="Where the text, the numbers and the plots go.")
    ] = Path("render") / NAME,
    plot: options.Plot = None,
    plot_size: options.PlotSize = None,
    html: options.Html = None,
    quiet: options.Quiet = False,
) -> None:
    """Say how well gestures are recognised when people make them whom nobody has learned from.

    Each user is left out in turn and judged by what all others showed, unless
    --folds, --test or a column `split` of the manifest say otherwise; --vocabulary
    judges one that has learned already.  Writes Markdown, JSON and pictures.
    """
    options.check_picture(plot)
    options.check_page(html)
    check_results([plot, html], *(path for path in (manifest, test, vocabulary) if path))
    from nao_sim.gestures.evaluation.data_set import read_examples
    from nao_sim.gestures.evaluation.evaluate import Wanted
    from nao_sim.gestures.evaluation.evaluate import evaluate as evaluated
    from nao_sim.gestures.evaluation.summary import TITLE, numbers, sections
    from nao_sim.gestures.manifest import load_manifest
    from nao_sim.gestures.storage import load_vocabulary
    from nao_sim.sections import markdown, print_sections, write_text

    manifests = [load_manifest(path) for path in (manifest, test) if path]
    known = load_vocabulary(vocabulary) if vocabulary else None
    make_folder(output)
    with ProgressBar(quiet) as progress:
        data = [
            read_examples(each, rate, skip_unreadable, lambda done, total: progress("reading", done, total))
            for each in manifests
        ]
        wanted = Wanted(kind.wanted, folds, learner, single_arms, known, str(vocabulary))
        found = evaluated(data[0], data[1] if test else None, wanted, progress)
    parts = sections(found)
    written = [output / f"{NAME}.md", output / f"{NAME}.json", *_draw(found, output)]
    write_text(written[0], markdown(TITLE, f"Data: {manifest}.", parts))
    write_text(written[1], json.dumps(numbers(found), indent=2) + "\n")
    if plot:
        from nao_sim.plotting.evaluation_pages import save_evaluation

        save_evaluation(found, plot, plot_size and plot_size.value)
    if html:
        from nao_sim.web.documents import evaluation_document
        from nao_sim.web.writing import write_document

        write_document(evaluation_document(found, TITLE, parts, manifest, options.command_line(context)), html)
    if not quiet:
        print_sections(parts, [*written, *(path for path in (plot, html) if path)])


def _draw(found: Evaluation, folder: Path) -> list[Path]:
    """The pictures that the text shows."""
    from nao_sim.plotting.evaluation_pages import save_confusion, save_learners, save_users

    paths = []
    for kind, part in found.parts.items():
        title = f"{kind.capitalize()} by {part.focus}: {part.shown.accuracy} right; {found.plan.words}"
        paths.append(folder / f"{kind}_confusion.png")
        save_confusion(part.shown, title, paths[-1])
        if len(part.shown.by_users) > 1:
            paths.append(folder / f"{kind}_users.png")
            save_users(part.shown, title, paths[-1])
        if len(part.outcomes) > 1:
            paths.append(folder / f"{kind}_learners.png")
            save_learners(part.outcomes, f"{kind.capitalize()}: {found.plan.words}", paths[-1])
    return paths


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["evaluate", *sys.argv[1:]]))
