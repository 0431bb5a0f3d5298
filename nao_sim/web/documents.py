"""Pages about a comparison, about recognised gestures, and about an evaluation."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from nao_sim.sections import Section
from nao_sim.similarity_tables import measured, score_section
from nao_sim.web.document import Document, Plot, made_by, without_folders

if TYPE_CHECKING:
    from nao_sim.gestures.evaluation.evaluate import Evaluation
    from nao_sim.gestures.recognised import Recognised
    from nao_sim.imitation.similarity import Similarity
    from nao_sim.recordings import Recording


def comparison_document(recording: Recording, robot: Path, score: Similarity, command: str) -> Document:
    """A page about how alike a robot was to a recording.

    Args:
        recording: who is imitated.
        robot: the file of what the robot did.
        score: of it.
        command: the command line.
    """
    from nao_sim.plotting.similarity_page import similarity_block

    told = score.as_report()
    table, (stage, last) = score_section(told), list(told["stages"].items())[-1]
    errors = last["direction_error_deg"]["all"]
    mean, most = _number(errors["mean"]), _number(errors["p95"])
    words = f"{stage}: arms {mean}° from where they should point on average, 95 % within {most}°"
    about = f"The angle between the arms and both similarities over time. {words}."
    return Document(
        title=f"{robot.name} imitating {recording.path.name}",
        lead=f"How alike a NAO was to {recording.format}, {recording.frames} frames, "
        f"{recording.motion.duration:.1f} s: {measured(told)}.",
        summary={"imitated": [words]},
        plots=[Plot(similarity_block(score), about, wide=True)],
        sections=[table],
        remarks=[without_folders(note) for note in recording.notes],
        made=made_by(command, {"recording": f"{recording.path.name}: {recording.format}", "robot": robot.name}),
    )


def recognition_document(recording: Recording, found: Recognised, command: str) -> Document:
    """A page about the gestures that a recording shows.

    Args:
        recording: of a person.
        found: what was recognised.
        command: the command line.
    """
    from nao_sim.gestures.recognised_tables import gestures_section
    from nao_sim.plotting.gestures_page import gestures_block

    table = gestures_section(recording, found, "Gestures")
    # the gesture's name heads its row
    head, rows = _named_first(table.head), [_named_first(row) for row in table.rows]
    names = list(dict.fromkeys(each.label for each in found.segments))
    what = f"{len(found.segments)} announced: {', '.join(names)}" if names else "none was announced"
    return Document(
        title=f"Gestures in {recording.path.name}",
        lead=f"{recording.format}, {recording.frames} frames, {recording.motion.duration:.1f} s; recognised frame "
        "after frame, without looking ahead.",
        summary={"gestures": [what], "known": [", ".join(found.vocabulary.names)]},
        plots=[Plot(gestures_block(found), f"Bands over time, as high as the confidence; {what}.", wide=True)],
        sections=[Section(table.title, head, rows)],
        remarks=[without_folders(note) for note in recording.notes],
        made=made_by(command, {"recording": f"{recording.path.name}: {without_folders(recording.reason)}"}),
    )


def evaluation_document(found: Evaluation, title: str, parts: list[Section], manifest: Path, command: str) -> Document:
    """A page about how well gestures are recognised.

    Args:
        found: what was found.
        title: of the page.
        parts: the same in tables and words.
        manifest: of the data.
        command: the command line.
    """
    from nao_sim.plotting.evaluation_pages import evaluation_blocks

    shown = {f"{kind} by {part.focus}": [f"{part.shown.accuracy} right"] for kind, part in found.parts.items()}
    plots = [
        Plot(block, f"{name.partition('_')[0].capitalize()}: {block.title}; the numbers are in the tables.", wide=True)
        for name, block in evaluation_blocks(found).items()
    ]
    return Document(
        title=f"{title}: {manifest.name}",
        lead=f"{len(found.plan.examples)} examples; {found.plan.words}.",
        summary=shown,
        plots=plots,
        sections=[replace(each, remarks=tuple(map(without_folders, each.remarks))) for each in parts],
        made=made_by(command, {"data": manifest.name}),
    )


def _named_first(row: tuple[str, ...]) -> tuple[str, ...]:
    start, end, name, confidence = row
    return name, start, end, confidence


def _number(value: float | None) -> str:
    return "?" if value is None else f"{value:.1f}"
