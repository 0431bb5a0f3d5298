"""What was learned, in words."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from nao_sim.errors import NaoSimError
from nao_sim.gestures.evaluation.data_set import DataSet
from nao_sim.gestures.evaluation.evaluate import Evaluation, Progress, Wanted, evaluate
from nao_sim.gestures.evaluation.kinds import Kinds
from nao_sim.gestures.evaluation.summary import many
from nao_sim.gestures.poses import NONE
from nao_sim.sections import Section

HEAD = ("gesture", "taken for", "examples", "users", "because")
FEW = 3  # users or examples; with fewer, what is learned may be theirs rather than the gesture's


def held_out(data: DataSet, wanted: Wanted, progress: Progress | None = None) -> Evaluation | None:
    """How well users are recognised whom the others have taught; None where there are no others.

    Args:
        data: the examples.
        wanted: how they were learned.
        progress: called with a stage, and how many of its steps are done.
    """
    try:
        return evaluate(data.without_splits(), wanted=wanted, progress=progress)
    except NaoSimError:
        return None


def counted(data: DataSet, kinds: Kinds) -> dict[str, tuple[int, int]]:
    """By gesture how many examples there are, and how many users who are named made them."""
    shown = {label: [each for each in data.examples if each.label == label] for label in kinds.of}
    return {label: (len(own), len({each.user for each in own if each.user})) for label, own in shown.items()}


def report(
    data: DataSet, kinds: Kinds, robot: Mapping[str, str], file: Path, judged: Evaluation | None
) -> list[Section]:
    """What a vocabulary was learned from, how well it recognises users left out, and what to do next.

    Args:
        data: the examples.
        kinds: of its gestures.
        robot: by gesture what the robot's motion is.
        file: where the vocabulary is.
        judged: how well users left out are recognised, where that is known.
    """
    shown = {label: [each for each in data.examples if each.label == label] for label in kinds.of}
    rows = [
        (label, kinds.of[label], str(examples), str(users or "?"), reason)
        for (label, (examples, users)), reason in zip(counted(data, kinds).items(), kinds.reasons, strict=True)
    ]
    negative = sum(not each.known for each in data.examples)
    words = [f"{many(negative, 'example')} labelled '{NONE}' taught nothing."] if negative else []
    words += [f"Left out, as it cannot be read: {why}" for why in data.skipped]
    words += [_of_two_kinds(label) for label in kinds.of if len({each.readings.planar for each in shown[label]}) > 1]
    motions = [(label, robot[label]) for label in robot]
    return [
        Section("Learned", HEAD, rows, tuple(words)),
        Section("What the robot does", ("gesture", "motion"), motions),
        _judged(judged),
        _next(data, file),
    ]


def _of_two_kinds(label: str) -> str:
    return f"{label}: some examples are flat, others have depth; they are averaged as they are."


def _judged(found: Evaluation | None) -> Section:
    """How well users are recognised whom the others have taught."""
    title, head = "With each user left out", ("gestures", "recognised", "if it must choose", "worst user")
    if found is None:
        return Section(title, head, (), ("Not known: it takes two users or more, each named in every row.",))
    rows = []
    for kind, part in found.parts.items():
        user, share = next(iter(part.shown.by_users.items()))
        rows.append((kind, str(part.shown.accuracy), str(part.shown.forced), f"{user}: {share}"))
    words = list(found.notes)
    return Section(title, head, rows, tuple(words))


def _next(data: DataSet, file: Path) -> Section:
    commands = {
        "what a recording shows": f"nao-sim recognise FILE --vocabulary {file}",
        "let the robot do it": f"nao-sim play FILE --mode gestures --vocabulary {file}",
        "how well strangers fare": f"nao-sim evaluate {data.manifest.path}",
    }
    words = []
    if few := [label for label in data.labels if sum(each.label == label for each in data.examples) < FEW]:
        words.append(f"Fewer than {FEW} examples: {', '.join(few)}. Show these more often, best by other people.")
    if len(data.users) < FEW:
        words.append(f"Examples of {many(len(data.users), 'user')}: more people make a vocabulary that fits strangers.")
    return Section("Next", ("to see", "run"), list(commands.items()), tuple(words))
