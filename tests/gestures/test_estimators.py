"""The project's own learners are scikit-learn classifiers, and say no where they must."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sklearn.utils.estimator_checks import parametrize_with_checks

from nao_sim.gestures.arm_places import places_of_directions
from nao_sim.gestures.decision_rule import DecisionBasedRule
from nao_sim.gestures.learners import LEARNERS, learner
from nao_sim.gestures.regression import ClassScaleRegression, GradientDescentRegression, NormalEquationRegression
from nao_sim.gestures.thresholds import AT_LEAST, Threshold
from nao_sim.gestures.training_table import GESTURES, thesis_table
from nao_sim.imitation.features import directions_of

TABLE = thesis_table()


@parametrize_with_checks(
    [
        GradientDescentRegression(),
        GradientDescentRegression(learning_rate=0.3, max_iter=3000),
        NormalEquationRegression(),
        ClassScaleRegression(),
        DecisionBasedRule(),
        DecisionBasedRule(reach=0.7),
    ]
)
def test_scikit_learns_own_checks_pass(estimator, check):
    check(estimator)


def test_gradient_descent_arrives_where_the_normal_equation_is():
    """On features that hardly depend on each other both minimise the same cost."""
    features = np.random.default_rng(0).normal(3.0, 2.0, (60, 4))
    labels = np.tile(GESTURES, 12)
    descent = GradientDescentRegression(learning_rate=0.3, max_iter=2000).fit(features, labels)
    normal = NormalEquationRegression().fit(features, labels)
    np.testing.assert_allclose(descent.regress(features), normal.regress(features), atol=1e-9)
    assert (np.diff(descent.costs_) <= 1e-15).all()


def test_the_intercept_of_balanced_classes_is_the_published_one():
    """It depends on nothing but the classes' mean: 3 (1 - 0.99^100)."""
    features = np.random.default_rng(1).normal(size=(50, 10))
    theta = GradientDescentRegression().fit(features, np.tile(GESTURES, 10)).theta_
    assert round(float(theta[0]), 3) == 1.902


@given(seed=st.integers(0, 1000))
def test_an_output_becomes_the_nearest_class_and_half_way_the_higher(seed):
    outputs = np.append(np.random.default_rng(seed).uniform(-2.0, 8.0, 20), [1.5, 2.5, 4.5])
    model = ClassScaleRegression().fit(np.arange(1.0, 6.0)[:, None], np.array(GESTURES))
    expected = np.clip(np.floor(outputs + 0.5), 1, 5).astype(int) - 1
    near = np.abs(outputs * 2 - np.round(outputs * 2)) > 1e-9  # least squares leaves the last digit open
    assert (model.predict(outputs[:, None])[near] == np.array(GESTURES)[expected][near]).all()
    assert model.values_.tolist() == [GESTURES.index(label) + 1.0 for label in model.classes_]


def test_dependent_features_are_no_error():
    twice = np.repeat(TABLE.features_deg, 2, axis=1)
    once, both = (NormalEquationRegression().fit(each, TABLE.labels) for each in (TABLE.features_deg, twice))
    np.testing.assert_allclose(both.regress(twice), once.regress(TABLE.features_deg), atol=1e-8)


def test_a_label_off_the_scale_is_refused():
    with pytest.raises(ValueError, match="'wave' is not on the scale side, up"):
        NormalEquationRegression(scale=("side", "up")).fit([[0.0], [1.0]], ["side", "wave"])


def test_a_table_for_columns_that_are_not_there_is_refused():
    with pytest.raises(ValueError, match="column 6, the data has 2"):
        DecisionBasedRule([Threshold("up", 6, AT_LEAST, 0.2)]).fit([[0.0, 1.0]], ["up"])
    with pytest.raises(ValueError, match="'down' is not in the order up"):
        DecisionBasedRule(order=("up",)).fit([[0.0], [1.0]], ["up", "down"])


@pytest.mark.parametrize("name", LEARNERS)
def test_no_learner_depends_on_the_order_of_its_rows(name):
    """What is learned from the table is learned from the table in another order, too; chance is held fast."""
    if LEARNERS[name].random:
        pytest.skip("chance is drawn row by row")
    consistent = np.arange(len(TABLE.labels)) != 17  # row 18 is row 17 under another label
    values, labels = places_of_directions(directions_of(TABLE.features))[consistent], TABLE.labels[consistent]
    order = np.random.default_rng(3).permutation(len(values))
    tried = values + 0.05
    plain = learner(name).make(0).fit(values, labels).predict(tried)
    assert (learner(name).make(0).fit(values[order], labels[order]).predict(tried) == plain).all()
