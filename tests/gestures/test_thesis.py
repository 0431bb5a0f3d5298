"""The thesis computed again: what is known about its figures, and what the command writes."""

import io
import json
import re
from contextlib import redirect_stderr, redirect_stdout

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim import cli
from nao_sim.gestures.held_out import confusion, leave_one_user_out
from nao_sim.gestures.regression import GradientDescentRegression, NormalEquationRegression
from nao_sim.gestures.thesis.closed_form import Descent
from nao_sim.gestures.thesis.published import published
from nao_sim.gestures.thesis.sections_descent import balanced_intercept, correlation
from nao_sim.gestures.thesis.sparsity import SETS, sparsity
from nao_sim.gestures.thesis.study import study
from nao_sim.gestures.training_table import GESTURES, ceiling, contradictions, thesis_table

TABLE = thesis_table()


@pytest.fixture(scope="module")
def done():
    return study()


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The folder of results, and what is printed."""
    path, out, err = tmp_path_factory.mktemp("out") / "reproduction", io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        assert cli.main(["reproduce", "-o", str(path)]) == 0
    return path, out.getvalue(), err.getvalue()


@pytest.fixture
def folder(run):
    return run[0]


def test_the_table_is_five_whole_users_and_three_rows_of_a_sixth():
    assert TABLE.features.shape == (28, 10)
    assert [list(TABLE.labels[TABLE.users == user]) for user in range(1, 7)] == [list(GESTURES)] * 5 + [
        list(GESTURES[:3])
    ]


def test_two_rows_contradict_each_other_so_that_one_must_be_wrong():
    assert contradictions(TABLE) == [(17, 18)]
    assert ceiling(TABLE) == 27


def test_the_recipe_gives_the_published_intercept_and_nearly_the_published_parameters(done):
    assert round(balanced_intercept(done), 3) == published().theta[0]
    assert round(correlation(done), 3) == 0.988


def test_the_normal_equation_gets_17_rows_by_heart_and_8_of_strangers(done):
    trial = done.trials["normal equation"]
    assert (trial.own_correct, trial.held_out.correct) == (17, 8)
    assert done.trials["logistic"].held_out.correct == 26


def test_the_published_confusion_adds_up_to_the_published_accuracy():
    matrix, percent = published().confusion, published().percent["normal_equation"]
    assert 100 * np.trace(matrix) == percent * matrix.sum()
    assert (matrix.sum(axis=1) == 10).all()


def test_both_ways_to_the_converged_fit_are_one(done):
    np.testing.assert_allclose(
        done.output(done.closed.optimum, TABLE.features_deg), done.normal.regress(TABLE.features_deg), atol=1e-8
    )


@given(seed=st.integers(0, 1000), rate=st.floats(0.01, 0.4), steps=st.integers(0, 60))
def test_the_closed_form_is_what_stepping_arrives_at(seed, rate, steps):
    random = np.random.default_rng(seed)
    features, labels = random.normal(size=(20, 3)), random.permutation(np.tile(GESTURES, 4))
    stepped = GradientDescentRegression(learning_rate=rate, max_iter=steps).fit(features, labels)
    design = np.column_stack([np.ones(20), (features - stepped.mean_) / stepped.deviation_])
    closed = Descent(design, np.array([GESTURES.index(label) + 1.0 for label in labels]))
    np.testing.assert_allclose(stepped.costs_, closed.cost(rate, np.arange(steps + 1)), rtol=1e-7)


def test_steps_are_counted_to_the_first_that_is_near_enough(done):
    closed, rate = done.closed, 0.1
    steps = closed.steps_to(rate)
    goal = closed.least_cost + 0.01 * (closed.cost(rate, 0) - closed.least_cost)
    assert closed.cost(rate, steps) <= goal < closed.cost(rate, steps - 1)
    assert closed.steps_to(closed.fastest_rate * 1.001) is None


def test_the_reduced_features_leave_out_what_the_others_determine(done):
    found = {name: sparsity(TABLE, done.z_scores(TABLE.features_deg), features) for name, features in SETS.items()}
    assert set(SETS["all ten"]) - set(SETS["reduced"]) == {"RER", "LER"}
    assert found["reduced"].condition < found["all ten"].condition
    assert found["reduced"].nearest < found["all ten"].nearest  # a part of a distance is shorter
    assert (found["all ten"].own, found["all ten"].held_out) == (17, 8)


def test_a_user_who_is_left_out_is_judged_by_others_alone():
    features = np.array([[0.0], [1.0], [1.0], [0.0]])
    held = leave_one_user_out(
        NormalEquationRegression, features, np.array(["a", "b", "a", "b"]), np.array([1, 1, 2, 2])
    )
    assert held.predicted.tolist() == ["b", "a", "b", "a"] and held.correct == 0
    assert confusion(held.labels, held.predicted, ("a", "b")).tolist() == [[0, 2], [2, 0]]
    with pytest.raises(ValueError, match="two users"):
        leave_one_user_out(NormalEquationRegression, features, held.labels, np.ones(4))


def test_every_picture_of_the_page_is_there_and_every_file_is_on_it(folder):
    page = (folder / "reproduction.md").read_text(encoding="utf-8")
    shown = set(re.findall(r"\]\((\w+\.png)\)", page))
    assert shown == {path.name for path in folder.glob("*.png")} and len(shown) == 6
    assert all(path.stat().st_size > 5000 for path in folder.glob("*.png"))


def test_the_page_and_the_numbers_say_the_same(folder):
    page = (folder / "reproduction.md").read_text(encoding="utf-8")
    values = json.loads((folder / "reproduction.json").read_text(encoding="utf-8"))
    assert f"{values['sample']['thesis, z-scores of 28 rows']:.3f}" in page
    assert f"{values['gradient_descent']['correlation_with_published_theta']:.3f}" in page
    normal = values["learners"]["normal equation"]
    assert f"| {normal['own_rows_right']} of 28 (61 %) | {normal['left_out_right']} of 28 (29 %) |" in page
    assert np.trace(normal["confusion_left_out"]) == normal["left_out_right"]


def test_all_rows_of_a_table_have_its_columns(folder):
    lines = (folder / "reproduction.md").read_text(encoding="utf-8").split("\n")
    tables = "\n".join(lines).split("\n\n")
    for table in (part.splitlines() for part in tables if part.startswith("|")):
        assert len({line.count("|") for line in table}) == 1


def test_a_file_in_the_place_of_the_folder_is_refused_in_one_line(tmp_path, capsys):
    (tmp_path / "taken").write_text("mine", encoding="utf-8")
    assert cli.main(["reproduce", "-o", str(tmp_path / "taken")]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1 and "taken" in err
    assert (tmp_path / "taken").read_text(encoding="utf-8") == "mine"


def test_the_terminal_shows_each_table_and_where_the_files_are(run):
    _, out, err = run
    assert "0.988" in out and "27" in out and "reproduction.md" in out and err == ""
