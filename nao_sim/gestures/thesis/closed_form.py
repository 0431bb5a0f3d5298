"""Gradient descent on a linear model, in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np

from nao_sim.robot import Array

NEAR_OPTIMUM = 0.01  # of the way from the first cost to the least one that is left
MOST_STEPS = 10_000_000


class Descent:
    """Gradient descent on the z-scored rows in closed form, for any rate and number of steps.

    Along each eigenvector of A^T A / N, of eigenvalue lambda, the distance to the optimum shrinks
    by 1 - alpha lambda a step; so the cost is J* + 1/2 sum lambda c^2 (1 - alpha lambda)^(2 t).

    Args:
        design: (N, P) A, a column of ones and the z-scores.
        values: (N,) class numbers.

    Attributes:
        optimum: (P,) the parameters of least cost.
        least_cost: J there.
        eigenvalues: (P,) of A^T A / N, ascending.
    """

    def __init__(self, design: Array, values: Array) -> None:
        self.optimum = np.linalg.lstsq(design, values, rcond=None)[0]
        errors = design @ self.optimum - values
        self.least_cost = float(errors @ errors) / (2.0 * len(values))
        self.eigenvalues, vectors = np.linalg.eigh(design.T @ design / len(values))
        self._weights = 0.5 * self.eigenvalues * (vectors.T @ self.optimum) ** 2

    @property
    def fastest_rate(self) -> float:
        """The learning rate from which on it diverges: 2 / the largest eigenvalue."""
        return float(2.0 / self.eigenvalues[-1])

    def cost(self, rate: float, steps: Any) -> Array:
        """J after a number of steps, or after each of several."""
        shrunk = np.abs(1.0 - rate * self.eigenvalues) ** (2.0 * np.asarray(steps, float)[..., None])
        return self.least_cost + shrunk @ self._weights

    def steps_to(self, rate: float, share: float = NEAR_OPTIMUM) -> int | None:
        """After how many steps no more than `share` of the avoidable cost is left; None where it never is."""
        goal = self.least_cost + share * float(self._weights.sum())
        if rate >= self.fastest_rate or self.cost(rate, MOST_STEPS) > goal:
            return None
        low, high = 0, MOST_STEPS
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (low, middle) if self.cost(rate, middle) <= goal else (middle, high)
        return high
