"""The figures that the thesis published, read from `published.toml`."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nao_sim.robot import Array, read_only


@dataclass(frozen=True, eq=False)
class Published:
    """What is printed.

    Attributes:
        learning_rate: of gradient descent.
        iterations: its steps.
        theta: (11,) its parameters, the intercept first, for z-scored features.
        confusion: (5, 5) of the normal equation, rows are what was made, in the order of `GESTURES`.
        sample_deg: (10,) the features of the worked prediction.
        sample_output: its output.
        percent: reported accuracy by method.
        rows: of the training table, printed or not.
    """

    learning_rate: float
    iterations: int
    theta: Array
    confusion: NDArray[np.int_]
    sample_deg: Array
    sample_output: float
    percent: dict[str, int]
    rows: int


@cache
def published() -> Published:
    """The figures."""
    table = tomllib.loads(Path(__file__).with_name("published.toml").read_text(encoding="utf-8"))
    descent, sample = table["gradient_descent"], table["sample"]
    methods = ("gradient_descent", "normal_equation", "decision_rule")
    return Published(
        descent["learning_rate"],
        descent["iterations"],
        read_only(np.array(descent["theta"])),
        read_only(np.array(table["normal_equation"]["confusion"]), np.int_),
        read_only(np.array(sample["features_deg"], float)),
        sample["output"],
        {method: table[method]["accuracy_percent"] for method in methods},
        table["training_table"]["rows"],
    )
