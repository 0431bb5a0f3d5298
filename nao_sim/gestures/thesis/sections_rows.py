"""What the learners make of the rows: accuracy, confusion, sparsity, contradictions, thresholds."""

from __future__ import annotations

from typing import Any

import numpy as np

from nao_sim.gestures.arm_places import AXES, PLACES
from nao_sim.gestures.held_out import confusion
from nao_sim.gestures.thesis.section import nearest, share
from nao_sim.gestures.thesis.sparsity import PAIR, SETS, Sparsity, sparsity
from nao_sim.gestures.thesis.study import Study
from nao_sim.gestures.thresholds import ranges
from nao_sim.gestures.training_table import GESTURES, ceiling, contradictions
from nao_sim.imitation.features import elbow_disagreement
from nao_sim.sections import Section


def accuracy(study: Study) -> Section:
    """How many rows each learner gets right, its own and those of users it has not seen."""
    percent, count = study.figures.percent, len(study.table.labels)
    reported = {
        "gradient descent": f"{percent['gradient_descent']} %",
        "normal equation": f"{percent['normal_equation']} %",
        "decision rule": f"{percent['decision_rule']} %, set by hand, without piUp",
    }
    names = {"decision rule": "decision rule, learned thresholds", "logistic": "logistic regression"}
    rows = [
        (names.get(name, name), reported.get(name, "-"), share(trial.own_correct, count),
         share(trial.held_out.correct, count), f"{100 * trial.held_out.by_user.min():.0f} %")
        for name, trial in study.trials.items()
    ]  # fmt: skip
    printed = (_predicted(study) == study.table.labels).sum()
    rows.insert(1, ("the printed parameters", "70 %", share(int(printed), count), "-", "-"))
    top = study.output(study.figures.theta, study.table.features_deg).max()
    return Section(
        "Accuracy",
        ("learner", "thesis", "its own 28 rows", "each user left out", "worst user"),
        rows,
        (
            f"With the printed parameters no printed row has an output above {top:.2f}: rounding finds neither up (4) "
            "nor down (5), two fifths of all rows. So 70 % cannot have been counted by rounding such outputs.",
            "The classes have no order, so a regression onto their numbers is the wrong model. Logistic regression on "
            "the same angles, which knows no order, shows what the rows hold.",
            f"No classifier can get more than {ceiling(study.table)} of {count}.",
        ),
        "outputs",
    )


def confusions(study: Study) -> Section:
    """Table 4.1 beside the confusions of the printed rows."""
    trial = study.trials["normal equation"]
    ours = [confusion(trial.held_out.labels, each, GESTURES) for each in (trial.own, trial.held_out.predicted)]
    rows = [
        (name, *(" ".join(f"{value:2d}" for value in matrix[place]) for matrix in (study.figures.confusion, *ours)))
        for place, name in enumerate(GESTURES)
    ]
    right, total = int(np.trace(study.figures.confusion)), int(study.figures.confusion.sum())
    return Section(
        "Normal equation: confusion (Table 4.1)",
        ("made", f"thesis, {total} behaviours of 10 users", "ours, its own 28 rows", "ours, each user left out"),
        rows,
        (
            f"Columns: {', '.join(GESTURES)}. The printed matrix adds up to {right} of {total}, the reported 72 %.",
            f"A regression mistakes a class for its neighbours on the scale: {_neighbours(study.figures.confusion)} in "
            f"print, {_neighbours(ours[0])} on our own rows. Ours lack the 22 rows that are not printed, and with them "
            "four of the ten users and part of a fifth.",
        ),
        "confusion",
    )


def sparse_features(study: Study) -> Section:
    """Two gestures in all features, and without the dependent ones."""
    rows = []
    for name, features in SETS.items():
        found = sparse(study, features)
        counts = (
            share(found.own, found.rows[0]),
            share(found.held_out, found.rows[0]),
            share(found.pair, found.rows[1]),
        )
        rows.append((f"{name} ({len(features)})", f"{found.condition:.0f}", f"{found.nearest:.2f}", *counts))
    pair = " and ".join(PAIR)
    return Section(
        f"Sparsity: {pair}, dependent and reduced features",
        ("features", "condition", f"nearest {pair}", "normal equation, own rows", "users left out", f"{pair} only"),
        rows,
        (
            "The elbow's interior angle follows from the other four angles of its arm; the reduced features leave it "
            "out. With fewer features fewer of the own rows are right, and more of the strangers.",
            "The points of the thesis's own plots are not at hand as numbers: only pictures can be compared.",
        ),
        "sparsity",
    )


def contradictory_rows(study: Study) -> Section:
    """The rows that no learner can get right, and why."""
    table = study.table
    off = np.degrees(elbow_disagreement(table.features)).max(axis=1)
    alike = {row for rows in contradictions(table) for row in rows}
    shown = [row for row in range(len(table.labels)) if row + 1 in alike or off[row] > 45.0]  # noqa: PLR2004
    rows = [(f"{row + 1}", f"{table.users[row]}", f"{table.labels[row]}", f"{off[row]:.0f}°") for row in shown]
    pair = " and ".join(str(row) for row in contradictions(table)[0])
    return Section(
        "Rows that contradict each other or themselves",
        ("row", "user", "label", "elbow angle off by"),
        rows,
        (
            f"Rows {pair} are one posture under two labels: of {len(table.labels)} rows at most {ceiling(table)} can "
            "be right. This user's elbow angles are far from what the arm's directions say: the tracking was lost.",
        ),
    )


def decision_rule(study: Study) -> Section:
    """One arm's thresholds; those of the other are the same."""
    half = len(PLACES) // 2
    rows = []
    for label, columns in ranges(study.rule.thresholds_).items():
        for start in range(0, half, len(AXES)):
            part = PLACES[start].split()[1]
            rows.append((label, part, *(columns.get(column, "") for column in range(start, start + len(AXES)))))
    right = int((study.hand_set == study.table.labels).sum())
    ruled = int((study.table.labels != "piUp").sum())
    return Section(
        "Decision Based Rule: thresholds learned from the 28 rows",
        ("gesture", "both arms'", *AXES),
        rows,
        (
            "Places beside the shoulder, in arm lengths and in the person's frame, so that they hold for adults, "
            "children and people who turn; tried in this order, and none where no row holds.",
            "The thesis's thresholds T1 to T16 are not available. Sixteen set by hand for an adult, on the rows as "
            f"that adult's postures, get {right} of the {ruled} that have a rule.",
        ),
    )


def not_reproducible(study: Study) -> Section:
    """Figures for which the print does not say enough."""
    at_hand = "not among the published figures at hand"
    rows = [
        ("the parameters of Table 3.3 exactly", f"22 of the {study.figures.rows} training rows are not printed"),
        ("the worked output of Table 3.4", f"means and deviations of the {study.figures.rows} rows are {at_hand}"),
        ("70 % of gradient descent", f"on which rows, and how outputs became classes, is {at_hand}"),
        ("72 % and Table 4.1", "22 rows, and so four users and part of a fifth, are not printed"),
        ("96 % of the decision rule", f"its thresholds, and the skeletons that it was tried on, are {at_hand}"),
        ("the cost curve and the sparsity plots", "they are pictures without numbers"),
    ]
    return Section("What the print does not allow to reproduce", ("figure", "why"), rows)


def _predicted(study: Study) -> Any:
    """The labels (N,) of the printed rows by the printed parameters."""
    outputs = study.output(study.figures.theta, study.table.features_deg)
    return np.array([nearest(output) for output in outputs])


def _neighbours(matrix: Any) -> str:
    """How many of the mistakes are one class away."""
    rows, columns = np.indices(matrix.shape)
    near = int(matrix[np.abs(rows - columns) == 1].sum())
    return f"{near} of {int(matrix.sum() - np.trace(matrix))} mistakes"


def sparse(study: Study, features: tuple[str, ...]) -> Sparsity:
    """The printed rows in some of the features."""
    return sparsity(study.table, study.z_scores(study.table.features_deg), features)
