"""The figures carried over from the thesis are the thesis's."""

import csv
from pathlib import Path

import numpy as np
import pytest

from nao_sim.gestures.thesis.published import published
from nao_sim.gestures.training_table import GESTURES, thesis_table
from nao_sim.imitation.features import FEATURES

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "thesis"
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason=f"no {FOLDER}")


def table(name):
    with (FOLDER / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_the_training_rows_are_those_in_print():
    rows, ours = table("table_a1"), thesis_table()
    assert [row["Behavior"] for row in rows] == ours.labels.tolist()
    np.testing.assert_allclose(ours.features_deg, [[float(row[name]) for name in FEATURES] for row in rows], atol=1e-9)


def test_the_parameters_the_sample_and_the_confusion_are_those_in_print():
    (theta,), (sample,) = table("table_3_3_theta"), table("table_3_4_sample")
    figures = published()
    assert figures.theta.tolist() == [float(theta[f"theta{place}"]) for place in range(11)]
    assert figures.sample_deg.tolist() == [float(sample[name]) for name in FEATURES]
    assert figures.sample_output == float(sample["y"])
    counts = {row["actual"]: [int(row[name]) for name in GESTURES] for row in table("table_4_1_confusion")}
    assert figures.confusion.tolist() == [counts[name] for name in GESTURES]
