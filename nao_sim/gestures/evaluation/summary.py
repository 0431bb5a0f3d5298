"""An evaluation in words and tables, and as JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from nao_sim.gestures.evaluation.contenders import OURS
from nao_sim.gestures.evaluation.evaluate import Evaluation, Part
from nao_sim.gestures.evaluation.judging import Announcement
from nao_sim.gestures.evaluation.kinds import Kind
from nao_sim.gestures.evaluation.outcome import ClassFigures, Outcome
from nao_sim.gestures.poses import NONE
from nao_sim.gestures.shares import Share, percent, share_of
from nao_sim.sections import Section

SCHEMA = 1
TITLE = "How well gestures are recognised"
LEARNERS_HEAD = ("learner", "recognised", "F1", "forced", "none", "worst", "decision")
LEARNERS_WORDS = (
    "F1: mean over the gestures; forced: recognised where none is no answer; none: gestures told none; worst: the user "
    "recognised least; decision: median time."
)
GESTURES_HEAD = ("gesture", "examples", "recognised", "precision", "F1", "mistakes")


def sections(found: Evaluation) -> list[Section]:
    """Tables with words."""
    parts = [section for kind, part in found.parts.items() for section in _part(kind, part, found)]
    if found.announcements:
        parts.append(_stream(found.announcements))
    return [*parts, _data(found)]


def numbers(found: Evaluation) -> dict[str, Any]:
    """Everything as the JSON has it; only `timing` differs from run to run."""
    return {
        "schema": SCHEMA,
        "manifest": str(found.data.manifest.path),
        "how": found.plan.words,
        "examples": len(found.plan.examples),
        "users": list(found.users),
        "kinds": found.kinds.of,
        "skipped": list(found.skipped),
        "notes": list(found.notes),
        **{
            kind: {name: outcome.as_report() for name, outcome in part.outcomes.items()}
            for kind, part in found.parts.items()
        },
        "stream": _stream_numbers(found.announcements),
        "timing": {
            kind: {name: _timing(outcome) for name, outcome in part.outcomes.items()}
            for kind, part in found.parts.items()
        },
    }


def _part(kind: Kind, part: Part, found: Evaluation) -> list[Section]:
    outcome, of = part.shown, f"{kind.capitalize()} by {part.focus}"
    gestures = [_gesture(each, outcome) for each in outcome.by_classes]
    parts = [
        Section(of, ("what", "figure"), _figures(outcome, found), (_counted(outcome, found),)),
        Section(f"{of}: each gesture", GESTURES_HEAD, gestures, (), f"{kind}_confusion"),
    ]
    if len(outcome.by_users) > 1:
        users = [(user, str(share.count), str(share)) for user, share in outcome.by_users.items()]
        parts.append(Section(f"{of}: each user", ("user", "examples", "recognised"), users, (), f"{kind}_users"))
    if len(part.outcomes) > 1 or part.left_out:
        rows = [_learner(name, each) for name, each in part.outcomes.items()]
        words = (LEARNERS_WORDS, *(f"Left out: {why}." for why in part.left_out))
        picture = f"{kind}_learners" if len(rows) > 1 else None
        parts.append(Section(f"{kind.capitalize()}: learners", LEARNERS_HEAD, rows, words, picture))
    return parts


def _counted(outcome: Outcome, found: Evaluation) -> str:
    """How many of what."""
    users = [user for user in outcome.by_users if user != "?"]
    by = f" by {many(len(users), 'user')}" if users else ""
    gestures = f"{many(int(outcome.known.sum()), 'example')} of {many(len(outcome.by_classes), 'gesture')}{by}"
    return f"{gestures}; {found.plan.words}. Intervals are 95 % ones."


def _figures(outcome: Outcome, found: Evaluation) -> list[tuple[str, str]]:
    """All figures of one learner."""
    rows = [("recognised, told none counts as wrong", str(outcome.accuracy))]
    if found.between_users and outcome.accuracy.right < outcome.accuracy.count:  # else there is nothing to draw from
        drawn = percent(outcome.accuracy.value, outcome.users_interval)
        rows.append(("the same, interval between users", drawn))
    rows += [
        ("macro F1", f"{outcome.macro_f1:.3f}"),
        ("recognised where none is no answer", str(outcome.forced)),
        ("gestures told none", str(outcome.told_none)),
    ]
    if outcome.false_alarms.count:
        rows.append(("negative examples told a gesture", str(outcome.false_alarms)))
    if len(outcome.by_users) > 1:
        user, share = next(iter(outcome.by_users.items()))
        rows.append(("worst user", f"{user}: {share}"))
    return [*rows, ("learning, a round", f"{outcome.trained:.2f} s"), ("a decision, median", _decision(outcome))]


def _learner(name: str, outcome: Outcome) -> tuple[str, ...]:
    worst = next(iter(outcome.by_users.values()), Share(0, 0))
    plain = [f"{100 * share.value:.1f} %" for share in (outcome.forced, outcome.told_none, worst)]
    return name, str(outcome.accuracy), f"{outcome.macro_f1:.3f}", *plain, _decision(outcome)


def _decision(outcome: Outcome) -> str:
    return f"{1e3 * np.median(outcome.seconds):.2f} ms"


def many(count: int, what: str) -> str:
    """`1 user`, `2 users`."""
    return f"{count} {what}{'' if count == 1 else 's'}"


def _gesture(figures: ClassFigures, outcome: Outcome) -> tuple[str, ...]:
    said = outcome.predicted[(outcome.labels == figures.label) & (outcome.predicted != figures.label)]
    others, counts = np.unique(said, return_counts=True)
    wrong = ", ".join(f"{counts[place]} {others[place]}" for place in np.argsort(-counts, kind="stable")[:3])
    precise = f"{100 * figures.precision.value:.1f} %" if figures.precision.count else "-"
    return figures.label, str(figures.recall.count), str(figures.recall), precise, f"{figures.f1:.3f}", wrong or "-"


def _stream(announcements: Sequence[Announcement]) -> Section:
    found = _stream_numbers(announcements)
    alarms = _share(found["false_alarms"])
    rows = [
        ("the right gesture announced first", str(_share(found["right"]))),
        ("another one announced first", str(_share(found["another"]))),
        ("nothing announced", str(_share(found["nothing"]))),
        *([("negative examples, something announced", str(alarms))] if alarms.count else ()),
        ("start of the example to the right announcement, median", _seconds(found["latency_median_s"])),
        ("95 % within", _seconds(found["latency_p95_s"])),
    ]
    words = (
        "Frame after frame, without looking ahead, as play and recognise do; poses and movements together. Only "
        "examples of half a second or more."
    )
    return Section(f"{OURS} in a stream", ("what", "figure"), rows, (words,))


def _stream_numbers(announcements: Sequence[Announcement]) -> dict[str, Any]:
    known = [each for each in announcements if each.example.known]
    right = np.array([each.label == each.example.label for each in known], bool)
    nothing = np.array([each.label == NONE for each in known], bool)
    alarms = np.array([each.label != NONE for each in announcements if not each.example.known], bool)
    waits = np.array([each.after for each in known])[right]
    shares = {"right": right, "another": ~right & ~nothing, "nothing": nothing, "false_alarms": alarms}
    return {name: share_of(each).as_report() for name, each in shares.items()} | {
        "latency_median_s": round(float(np.median(waits)), 4) if len(waits) else None,
        "latency_p95_s": round(float(np.quantile(waits, 0.95)), 4) if len(waits) else None,
    }


def _share(report: Mapping[str, Any]) -> Share:
    return Share(report["right"], report["count"])


def _seconds(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f} s"


def _timing(outcome: Outcome) -> dict[str, float]:
    return {"learning_s": round(outcome.trained, 4), "decision_ms": round(1e3 * float(np.median(outcome.seconds)), 4)}


def _data(found: Evaluation) -> Section:
    """What the data are, and what was left out of them."""
    rows = [(label, kind, reason) for (label, kind), reason in zip(found.kinds.of.items(), found.kinds.reasons,
                                                                   strict=True)]  # fmt: skip
    words = [f"Left out, as it cannot be read: {why}" for why in found.skipped]
    return Section("The data", ("gesture", "taken for", "because"), rows, (*words, *found.notes))
