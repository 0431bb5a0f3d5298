"""The page about a run of the robot: what it was asked, what it did, and whether that was safe."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from nao_sim.check_tables import rules_section, verdict_words
from nao_sim.console import REASONS, about, in_order, summary
from nao_sim.gestures.poses import NONE
from nao_sim.motion import Skeleton
from nao_sim.plotting.run_page import run_blocks
from nao_sim.sections import Section
from nao_sim.similarity_tables import measured, score_section
from nao_sim.verdict import Verdict as Outcome
from nao_sim.web.document import Document, Plot, Tone, Verdict, made_by, without_folders
from nao_sim.web.film import film_in_page

if TYPE_CHECKING:
    from nao_sim.performed import Performed
    from nao_sim.plotting.style import Block
    from nao_sim.replay import Orders
    from nao_sim.report import Report

TONES: dict[Outcome, Tone] = {Outcome.as_requested: "good", Outcome.made_safe: "fair", Outcome.unsafe: "bad"}
_KEY_FIRST = "What the lines and colours of the plots of joints, self-distance and balance mean."


def run_document(run: Performed, orders: Orders, film: Path | None = None, no_film: str = "") -> Document:
    """A page about a run.

    Args:
        run: what came of a recording; of two robots the one that imitates.
        orders: how it was made.
        film: of it, if there is one.
        no_film: why there is none although one was ordered.
    """
    report = run.report
    key, *blocks = run_blocks(run)
    off = [f"Switched off: {', '.join(report['rules_off'])}."] if report["rules_off"] else []
    return Document(
        title=f"{Path(report['recording']).name}, by a simulated NAO",
        lead=_lead(run),
        verdict=Verdict(_sentence(verdict_words(report)), TONES[Outcome(report["verdict"])]),
        warnings=off,
        summary={word: lines for word, lines in summary(report).items() if word != "took"},
        film=film_in_page(film) if film else None,
        no_film=without_folders(no_film),
        key=Plot(key, _KEY_FIRST),
        plots=[Plot(block, _about(block, report), block.title.endswith("over time")) for block in blocks],
        sections=list(_sections(report)),
        remarks=[without_folders(note) for note in report["notes"]],
        made=_made(run, orders),
    )


def _lead(run: Performed) -> str:
    report, held = run.report, {"free": "free on its feet", "pinned": "held by the torso"}
    person = isinstance(run.task.recording.motion, Skeleton)
    does = "plays the gestures recognised in" if run.task.recognised else "imitates" if person else "does"
    whose = "a person's recording" if person else "recorded joint angles"
    robot = f"NAO H25 {report['robot']}, {held[report['base']]}"
    return f"A simulated {robot}, {does} {whose}: {about(report)}."


def _sections(report: Report) -> Iterator[Section]:
    if report["rules"]:
        yield rules_section(report)
    if report["similarity"] and report["similarity"]["compared"]:
        table = score_section(report["similarity"])
        yield Section(table.title, table.head, table.rows, (_sentence(measured(report["similarity"])),))
    if report["gestures"]:
        yield _gestures(report["gestures"]["segments"])


def _gestures(segments: list[Report]) -> Section:
    rows = [
        (row["label"], f"{row['start_s']:.2f} s", f"{row['end_s']:.2f} s", f"{100 * row['confidence']:.0f} %",
         "yes" if row["has_motion"] else "no: it rests")
        for row in segments
    ]  # fmt: skip
    head = ("gesture", "from", "to", "confidence", "the robot has a motion")
    return Section("Gestures recognised", head, rows, () if rows else ("None was.",))


def _about(block: Block, report: Report) -> str:
    """What is to be seen in a plot, from the report."""
    name, told, did = block.title, summary(report), report["simulated"]
    if name == "similarity over time":
        return " ".join(map(_sentence, told.get("imitated", [])))
    if name == "gestures over time":
        return f"A band for each gesture, as high as the confidence; a line for {NONE}."
    if name == "self-distance":
        return f"Parts of the simulated robot came within {1000 * did['min_self_distance_m']:.1f} mm of each other."
    if name == "balance":
        return _sentence(told["robot"][-1])
    changed = [row for row in in_order(report["changed"]) if row["joint"] == name]
    reasons = [f"{REASONS.get(row['reason'], row['reason'])} ({row['seconds']:.2f} s)" for row in changed]
    return f"{name}, changed: {'; '.join(reasons)}." if reasons else f"{name}: nothing was changed."


def _sentence(words: str) -> str:
    return f"{words[:1].upper()}{words[1:].rstrip('.')}."


def _made(run: Performed, orders: Orders) -> dict[str, str]:
    report = run.report
    more = {"safety": f"joints at most at {100 * report['speed_fraction']:.0f} % of their motors' no-load speed"}
    timing = report.get("timing", {})
    if "gl_renderer" in timing:
        more["rendering"] = f"{timing['gl_backend']}, {timing['gl_renderer']}"
    recording = f"{Path(report['recording']).name}: {report['format']} ({without_folders(report['format_reason'])})"
    files = {"recording": recording}
    named = {"report": orders.report, "rollout": orders.rollout}
    files |= {what: path.name for what, path in named.items() if path}
    return made_by(orders.command, files, more)
