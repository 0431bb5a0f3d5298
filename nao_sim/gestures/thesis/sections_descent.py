"""Gradient descent: its parameters, its cost and the worked prediction, published and ours."""

from __future__ import annotations

import numpy as np

from nao_sim.gestures.thesis.closed_form import NEAR_OPTIMUM
from nao_sim.gestures.thesis.section import nearest
from nao_sim.gestures.thesis.study import Study
from nao_sim.gestures.training_table import GESTURES
from nao_sim.imitation.features import FEATURES
from nao_sim.sections import Section

RATES = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 0.5, 0.6)


def parameters(study: Study) -> Section:
    """Table 3.3 beside the parameters that the printed rows give, after as many steps and at the optimum."""
    columns = (study.figures.theta, study.descent.theta_, study.closed.optimum)
    names = ("intercept", *FEATURES)
    rows = [(name, *(f"{column[place]:.3f}" for column in columns)) for place, name in enumerate(names)]
    mean = float(study.closed.optimum[0])
    return Section(
        "Gradient descent: parameters (Table 3.3)",
        ("parameter", "thesis, 50 rows", "ours, 28 rows", "ours, converged"),
        rows,
        (
            f"z-scored features, learning rate {study.figures.learning_rate}, {study.figures.iterations} steps from "
            f"zero. With balanced classes the intercept is 3 (1 - 0.99^100) = {balanced_intercept(study):.3f}, as "
            f"printed; the printed rows lack an up and a down, so the mean of their classes is {mean:.3f} and not 3.",
            f"The other ten parameters correlate by {correlation(study):.3f} with the printed ones; the 22 rows that "
            "are not printed make the difference.",
            "The converged parameters are many times larger and of other signs: the descent was stopped far from its "
            "optimum.",
        ),
        "parameters",
    )


def cost_curve(study: Study) -> Section:
    """How the cost falls."""
    steps = (0, 10, 30, 100, 1000, 10_000, 100_000)
    rate = study.figures.learning_rate
    costs = study.closed.cost(rate, np.array(steps))
    rows = [(f"{step}", f"{cost:.4f}") for step, cost in zip(steps, costs, strict=True)]
    return Section(
        "Gradient descent: cost",
        ("steps", "cost J"),
        [*rows, ("converged", f"{study.closed.least_cost:.4f}")],
        (
            f"J is half the mean squared error. The cost still falls after {study.figures.iterations} steps; it takes "
            f"{_count(study.closed.steps_to(rate))} until {100 * NEAR_OPTIMUM:.0f} % of what can be avoided is left.",
        ),
        "cost",
    )


def learning_rates(study: Study) -> Section:
    """What other learning rates would have done."""
    steps = study.figures.iterations
    rows = []
    for rate in RATES:
        grows = rate >= study.closed.fastest_rate
        cost = "diverges" if grows else f"{study.closed.cost(rate, steps):.4f}"
        rows.append((f"{rate:g}", cost, _count(study.closed.steps_to(rate))))
    return Section(
        "Gradient descent: learning rate",
        ("learning rate", f"cost after {steps} steps", f"steps until {100 * NEAR_OPTIMUM:.0f} % is left"),
        rows,
        (
            f"It diverges from {study.closed.fastest_rate:.3f} on, 2 / the largest eigenvalue of the features' "
            "correlations. The smallest ones decide how long it takes: features that depend on each other.",
        ),
        "rates",
    )


def worked_prediction(study: Study) -> Section:
    """Table 3.4: one sample, by the published parameters and ours."""
    rows = [(name, f"{value:.3f}", nearest(value)) for name, value in sample_outputs(study).items()]
    low, high = study.table.features_deg.min(axis=0), study.table.features_deg.max(axis=0)
    sample = study.figures.sample_deg
    outside = [f"{name} {value:.0f}" for name, value, a, b in zip(FEATURES, sample, low, high, strict=True)
               if not a <= value <= b]  # fmt: skip
    return Section(
        "The worked prediction (Table 3.4)",
        ("parameters", "output", "class"),
        rows,
        (
            "The thesis's means and deviations are those of 50 rows and are not printed; the second line has those of "
            "the 28. Without z-scores its parameters give the third: so it used them.",
            f"The sample is unlike every printed row ({', '.join(outside)} degrees are outside their range): there the "
            "converged fit, which has learned the noise of dependent features, is off any scale.",
        ),
    )


def sample_outputs(study: Study) -> dict[str, float]:
    """Outputs for the sample of Table 3.4, by whose parameters."""
    sample, theta = study.figures.sample_deg, study.figures.theta
    return {
        "thesis, as printed": study.figures.sample_output,
        "thesis, z-scores of 28 rows": float(study.output(theta, sample[None])[0]),
        "thesis, without z-scores": float(theta[0] + theta[1:] @ sample),
        "ours, 28 rows": float(study.descent.regress(sample[None])[0]),
        "ours, converged, as the normal equation": float(study.normal.regress(sample[None])[0]),
    }


def correlation(study: Study) -> float:
    """Between the published parameters and ours after as many steps, without the intercepts."""
    return float(np.corrcoef(study.figures.theta[1:], study.descent.theta_[1:])[0, 1])


def balanced_intercept(study: Study) -> float:
    """The intercept that the recipe gives wherever all gestures are equally frequent."""
    mean = (len(GESTURES) + 1) / 2.0
    return float(mean * (1.0 - (1.0 - study.figures.learning_rate) ** study.figures.iterations))


def _count(steps: int | None) -> str:
    return "never" if steps is None else f"{steps}"
