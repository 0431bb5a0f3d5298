"""Learners of movements: what all of them must do, those of the extra `learn` where it is installed."""

from importlib.util import find_spec

import numpy as np
import pytest
from gestures.test_movements import MOVEMENTS, shown

from nao_sim.body import twin
from nao_sim.errors import UsageError
from nao_sim.gestures import sequence_learners
from nao_sim.gestures.sequence_learners import SEQUENCE_LEARNERS
from nao_sim.gestures.windows import window_of

EXTRA = {"DTW": "aeon", "MiniRocket": "aeon", "HMM": "hmmlearn"}


def learners():
    for name in SEQUENCE_LEARNERS:
        missing = name in EXTRA and find_spec(EXTRA[name]) is None
        why = f"{name} needs {EXTRA.get(name)}: pip install 'nao-sim[learn]'"
        yield pytest.param(name, marks=pytest.mark.skipif(missing, reason=why))


@pytest.fixture(scope="module")
def examples():
    pairs = [(window_of(shown(name, user)), name) for name in MOVEMENTS for user in range(4)]
    return [window for window, _ in pairs], [name for _, name in pairs]


@pytest.mark.parametrize("name", list(learners()))
def test_strangers_are_recognised_and_an_order_of_examples_changes_nothing(name, examples):
    windows, labels = examples
    pairs = [(window_of(shown(label, user)), label) for label in MOVEMENTS for user in (100, 101, 102)]
    strangers, wanted = [window for window, _ in pairs], [label for _, label in pairs]
    said = SEQUENCE_LEARNERS[name].make(0).fit(windows, labels).predict(strangers)
    assert np.mean([one == other for one, other in zip(said, wanted, strict=True)]) >= 0.7
    assert SEQUENCE_LEARNERS[name].make(0).fit(windows, labels).predict(strangers) == said
    if name not in ("MiniRocket", "HMM"):  # chance falls on other examples there
        backwards = SEQUENCE_LEARNERS[name].make(0).fit(windows[::-1], labels[::-1])
        assert backwards.predict(strangers) == said


@pytest.mark.parametrize("name", list(learners()))
def test_the_other_arm_makes_the_mirrored_movement(name, examples):
    learner = SEQUENCE_LEARNERS[name].make(0).fit(*examples)
    knocks = [window_of(shown("left_knock", user)) for user in (200, 201)]
    assert learner.predict(knocks) == ["left_knock"] * 2
    assert learner.predict([knock.mirrored() for knock in knocks]) == ["right_knock"] * 2


@pytest.mark.parametrize("name", list(learners()))
def test_one_example_of_each_or_a_single_label_will_do(name, examples):
    windows, labels = examples
    learner = SEQUENCE_LEARNERS[name].make(0).fit(windows[::4], labels[::4])
    known = {name for label in labels for name in (label, twin(label))}  # the other arm's movement needs no example
    assert set(learner.predict(windows)) <= known and learner.predict([]) == []
    alone = SEQUENCE_LEARNERS[name].make(0).fit(windows[:1], labels[:1])
    assert alone.predict(windows[:3]) == [labels[0]] * 3


@pytest.mark.parametrize("name", list(learners()))
def test_what_cannot_be_learned_is_refused(name, examples):
    with pytest.raises(UsageError, match="one label each"):
        SEQUENCE_LEARNERS[name].make(0).fit(examples[0][:2], ["a"])
    with pytest.raises(UsageError, match="0 windows"):
        SEQUENCE_LEARNERS[name].make(0).fit([], [])


@pytest.mark.parametrize("name", EXTRA)
def test_a_missing_extra_is_told_in_one_line_and_others_do_without(name, monkeypatch):
    def absent(_):
        raise ImportError

    monkeypatch.setattr(sequence_learners, "import_module", absent)
    with pytest.raises(UsageError, match=rf"'{name}' needs {EXTRA[name]}.*pip install 'nao-sim\[learn\]'"):
        SEQUENCE_LEARNERS[name].make(0)
    SEQUENCE_LEARNERS["SVM"].make(0)
