"""The thesis's published figures beside ours, as tables with words and as plain numbers."""

from __future__ import annotations

from typing import Any

from nao_sim.gestures.held_out import confusion
from nao_sim.gestures.thesis import sections_descent, sections_rows
from nao_sim.gestures.thesis.sections_descent import RATES, balanced_intercept, correlation, sample_outputs
from nao_sim.gestures.thesis.sections_rows import sparse
from nao_sim.gestures.thesis.sparsity import SETS
from nao_sim.gestures.thesis.study import Study
from nao_sim.gestures.training_table import GESTURES, ceiling, contradictions
from nao_sim.sections import Section

SOURCE = (
    "I. I. Itauma, Gesture Imitation Learning in Human-Robot Interaction, MSc thesis, "
    "Istanbul Technical University, 2012"
)


def sections(study: Study) -> list[Section]:
    """The whole comparison in order."""
    descent = [sections_descent.parameters, sections_descent.cost_curve, sections_descent.learning_rates]
    descent.append(sections_descent.worked_prediction)
    rows = [sections_rows.accuracy, sections_rows.confusions, sections_rows.sparse_features]
    rows += [sections_rows.contradictory_rows, sections_rows.decision_rule, sections_rows.not_reproducible]
    return [part(study) for part in (*descent, *rows)]


def numbers(study: Study) -> dict[str, Any]:
    """The same for programs."""
    figures, closed = study.figures, study.closed
    return {
        "schema": 1,
        "source": SOURCE,
        "published": {
            "theta": figures.theta.tolist(),
            "confusion": figures.confusion.tolist(),
            "sample_output": figures.sample_output,
            "accuracy_percent": figures.percent,
        },
        "gradient_descent": {
            "learning_rate": figures.learning_rate,
            "iterations": figures.iterations,
            "theta": study.descent.theta_.tolist(),
            "correlation_with_published_theta": correlation(study),
            "intercept_of_balanced_classes": balanced_intercept(study),
            "costs": study.descent.costs_.tolist(),
            "converged_theta": closed.optimum.tolist(),
            "converged_cost": closed.least_cost,
            "diverges_from_rate": closed.fastest_rate,
            "rates": [
                {"rate": rate, "cost": float(closed.cost(rate, figures.iterations)), "steps": closed.steps_to(rate)}
                for rate in RATES
            ],
        },
        "normal_equation": {"theta_deg": study.normal.theta_.tolist()},
        "sample": {name: float(value) for name, value in sample_outputs(study).items()},
        "learners": {
            name: {
                "own_rows_right": trial.own_correct,
                "left_out_right": trial.held_out.correct,
                "left_out_by_user": trial.held_out.by_user.tolist(),
                "rows": len(trial.own),
                "confusion_own_rows": confusion(trial.held_out.labels, trial.own, GESTURES).tolist(),
                "confusion_left_out": confusion(trial.held_out.labels, trial.held_out.predicted, GESTURES).tolist(),
            }
            for name, trial in study.trials.items()
        },
        "sparsity": {name: vars(sparse(study, features)) for name, features in SETS.items()},
        "contradictory_rows": contradictions(study.table),
        "ceiling": ceiling(study.table),
        "decision_rule": [row._asdict() for row in study.rule.thresholds_],
    }
