"""Evaluations: their laws, and what they cannot do."""

from __future__ import annotations

import random
from dataclasses import replace

import numpy as np
import pytest
from gestures.data_sets import shown, write_person, write_set

from nao_sim import body
from nao_sim.errors import RecordingError, UsageError
from nao_sim.gestures.evaluation.contenders import Answer, Contender
from nao_sim.gestures.evaluation.data_set import read_examples
from nao_sim.gestures.evaluation.evaluate import Wanted, evaluate
from nao_sim.gestures.evaluation.judging import judged
from nao_sim.gestures.evaluation.kinds import kinds_of
from nao_sim.gestures.evaluation.learning import learn
from nao_sim.gestures.evaluation.splits import plan
from nao_sim.gestures.evaluation.summary import numbers, sections
from nao_sim.gestures.gesture_stream import stream_gestures
from nao_sim.gestures.manifest import Manifest, Row, load_manifest, save_manifest
from nao_sim.gestures.poses import NONE
from nao_sim.gestures.storage import load_vocabulary, save
from nao_sim.gestures.streaming import segments_of

NAMES = ("wave", "clap", "left_knock", "side", "left_up", NONE)


@pytest.fixture(scope="module")
def manifest(tmp_path_factory):
    return write_set(tmp_path_factory.mktemp("people"), NAMES, range(3))


@pytest.fixture(scope="module")
def data(manifest):
    return read_examples(load_manifest(manifest.path))


@pytest.fixture(scope="module")
def found(data):
    return evaluate(data)


def told(evaluation) -> dict:
    """All figures but times and names."""
    report = numbers(evaluation)
    return {name: report[name] for name in report if name not in ("timing", "manifest", "users")}


def rewritten(manifest: Manifest, rows: list[Row], name: str) -> Manifest:
    other = Manifest(manifest.path.with_name(name), tuple(rows))
    save_manifest(other)
    return load_manifest(other.path)


def test_strangers_are_recognised_and_each_gesture_taken_for_what_it_is(found):
    assert found.kinds.of == dict.fromkeys(("clap", "left_knock", "wave"), "movements") | dict.fromkeys(
        ("left_up", "side"), "poses"
    )
    for part in found.parts.values():
        assert part.shown.accuracy.value == part.shown.forced.value == part.shown.macro_f1 == 1.0
        assert part.shown.false_alarms.right == 0 and part.shown.false_alarms.count == 3
    assert [each.label for each in found.announcements] == [each.example.label for each in found.announcements]
    waits = [each.after for each in found.announcements if each.example.known]
    assert all(0.0 < wait < 1.6 for wait in waits)


def test_the_order_of_rows_and_the_names_of_users_change_nothing(manifest, found):
    rows = list(manifest.rows)
    random.Random(1).shuffle(rows)
    names = {"user0": "zoe", "user1": "ann", "user2": "bob"}
    other = rewritten(manifest, [replace(row, user=names[row.user]) for row in rows], "shuffled.csv")
    one, two = told(found), told(evaluate(read_examples(other)))
    for kind in ("poses", "movements"):
        shares = [report[kind]["nao_sim"].pop("users") for report in (one, two)]
        assert {names[user]: share for user, share in shares[0].items()} == shares[1]
    assert one == two


def test_people_in_the_mirror_have_the_mirrored_confusion(manifest, data):
    rows = []
    for row in manifest.rows:
        person = shown(row.label, int(row.user[-1])).mirrored()
        write_person(person, manifest.path.parent / f"mirrored_{row.path}")
        rows.append(replace(row, path=f"mirrored_{row.path}", label=body.twin(row.label)))
    other = read_examples(rewritten(manifest, rows, "mirrored.csv"))
    for learner in ("nao_sim", "k-NN"):
        wanted = Wanted("poses", learner=learner)
        one, two = (evaluate(each, wanted=wanted).parts["poses"].shown for each in (data, other))
        pairs = zip(one.labels, one.predicted, one.users, strict=True)
        mirrored = [(body.twin(label), body.twin(said), user) for label, said, user in pairs]
        assert sorted(mirrored) == sorted(zip(two.labels, two.predicted, two.users, strict=True))


def test_a_perfect_learner_scores_one_and_a_constant_one_the_share_of_its_class(data):
    kinds, planned = kinds_of(data), plan(data)

    def outcome(judge):
        return judged(Contender("", "", lambda _: judge), planned.examples, planned.splits, kinds, "movements")

    perfect = outcome(lambda example: Answer(example.label, example.label))
    assert perfect.accuracy.value == perfect.macro_f1 == 1.0 and perfect.false_alarms.right == 0
    assert np.array_equal(perfect.confusion, np.diag([3, 3, 3, 3]))
    constant = outcome(lambda _: Answer("wave", "wave"))
    assert constant.accuracy.value == pytest.approx(1 / 3) and constant.false_alarms.value == 1.0
    assert constant.macro_f1 == pytest.approx(2 * 3 / (3 + 12) / 3)
    silent = outcome(lambda _: Answer(NONE, "clap"))
    assert silent.accuracy.right == 0 and silent.told_none.value == 1.0
    assert silent.forced.value == pytest.approx(1 / 3) and silent.false_alarms.right == 0


def test_nobody_is_judged_by_what_they_showed(data):
    kinds, planned = kinds_of(data), plan(data)

    def train(known):
        users = {each.user for each in known}
        return lambda example: Answer(*[NONE if example.user in users else example.label] * 2)

    for kind in kinds.present:
        outcome = judged(Contender("", "", train), planned.examples, planned.splits, kinds, kind)
        assert outcome.accuracy.value == 1.0
        assert len(outcome.labels) == sum(kinds.has(kind, each) for each in data.examples)


@pytest.mark.parametrize("wanted", [Wanted(folds=3), Wanted(learner="logistic"), Wanted(learner="all")])
def test_the_same_data_give_the_same_figures(data, wanted):
    one, two = evaluate(data, wanted=wanted), evaluate(data, wanted=wanted)
    assert told(one) == told(two)
    assert all(part.shown.accuracy.value > 0.6 for part in one.parts.values())
    assert len(sections(one)) >= 6


def test_the_decision_rule_is_left_out_of_all_where_it_does_not_know_the_poses(data):
    part = evaluate(data, wanted=Wanted("poses", learner="all")).parts["poses"]
    assert "decision rule" not in part.outcomes and any("decision rule" in why for why in part.left_out)
    with pytest.raises(UsageError, match="decision rule"):
        evaluate(data, wanted=Wanted("poses", learner="decision rule"))


def test_a_second_manifest_and_a_column_of_splits_do_the_same(manifest, data):
    own = [replace(row, split="test" if row.user == "user0" else "train") for row in manifest.rows]
    split = evaluate(read_examples(rewritten(manifest, own, "split.csv")))
    parts = [rewritten(manifest, [replace(row, split="") for row in own if row.split == side], f"{side}.csv")
             for side in ("train", "test")]  # fmt: skip
    apart = evaluate(read_examples(parts[0]), read_examples(parts[1]))
    assert split.users == apart.users == ("user0",)
    one, two = told(split), told(apart)
    for report in (one, two):
        report.pop("how"), report.pop("examples")
    assert one == two


def test_a_gesture_that_nobody_taught_counts_as_wrong_and_is_named(manifest):
    rows = [row for row in manifest.rows if row.label != "clap" or row.user == "user0"]
    found = evaluate(read_examples(rewritten(manifest, rows, "once.csv")))
    assert found.parts["movements"].shown.accuracy.count == 7
    assert found.parts["movements"].shown.accuracy.right == 6
    assert found.notes[0].endswith("wrong: clap (in 1 of 3).")


def test_a_kind_that_is_not_judged_has_no_figures(manifest, data):
    rows = [replace(row, split="train") for row in manifest.rows if row.user != "user0"]
    rows += [replace(row, split="test") for row in manifest.rows if row.user == "user0" and row.label == "clap"]
    found = evaluate(read_examples(rewritten(manifest, rows, "claps.csv")))
    assert found.kinds.present == ("poses", "movements") and list(found.parts) == ["movements"]
    assert found.parts["movements"].shown.accuracy.count == 1 and sections(found) and numbers(found)


def test_one_name_is_not_a_pose_and_a_movement(manifest):
    names = {"side": "knock"}
    rows = [replace(row, label=names.get(row.label, row.label)) for row in manifest.rows]
    data = read_examples(rewritten(manifest, rows, "twice.csv"))
    assert evaluate(data).parts
    with pytest.raises(UsageError, match="'left_knock' is a pose and a movement; expected one"):
        evaluate(data, wanted=Wanted(single_arms=True))


def test_what_is_learned_saved_and_loaded_recognises_as_before(data, tmp_path):
    vocabulary = learn(data.examples, kinds_of(data))
    save(tmp_path / "my.vocab", vocabulary)
    loaded = load_vocabulary(tmp_path / "my.vocab")
    for name in NAMES:
        person = shown(name, 9)
        decisions = stream_gestures(vocabulary, person)
        assert stream_gestures(loaded, person) == decisions
        assert {segment.label for segment in segments_of(decisions)} == ({name} - {NONE})


def test_a_vocabulary_is_judged_as_it_is(manifest, data):
    taught = learn([each for each in data.examples if each.user != "user0" and each.label != "clap"], kinds_of(data))
    found = evaluate(data, wanted=Wanted(vocabulary=taught, called="my.vocab"))
    movements = found.parts["movements"].shown
    assert found.plan.words.startswith("judged by my.vocab")
    assert movements.accuracy.count == 9 and movements.accuracy.right == 6
    assert found.parts["poses"].shown.accuracy.value == 1.0 and found.notes[0].endswith("wrong: clap.")
    apart = [replace(row, split="test" if row.user == "user0" else "train") for row in manifest.rows]
    learned = evaluate(read_examples(rewritten(manifest, [r for r in apart if r.label != "clap"], "apart.csv")))
    own = movements.predicted[(movements.users == "user0") & (movements.labels != "clap")]
    assert own.tolist() == learned.parts["movements"].shown.predicted.tolist()
    with pytest.raises(UsageError, match=r"my\.vocab has learned already; expected no --test"):
        evaluate(data, wanted=Wanted(vocabulary=taught, called="my.vocab", folds=2))


def test_what_the_data_do_not_allow_is_refused_in_one_line(manifest, data):
    one_user = read_examples(rewritten(manifest, [row for row in manifest.rows if row.user == "user1"], "one.csv"))
    with pytest.raises(UsageError, match=r"one\.csv: examples of one user \(user1\); expected two"):
        evaluate(one_user)
    assert evaluate(one_user, data).parts["poses"].shown.accuracy.value > 0.0
    with pytest.raises(UsageError, match="expected 2 to 18"):
        evaluate(data, wanted=Wanted(folds=19))
    with pytest.raises(UsageError, match="contradict"):
        evaluate(data, data, Wanted(folds=2))
    with pytest.raises(UsageError, match=r"expected one of all, nao_sim, .*k-NN"):
        evaluate(data, wanted=Wanted(learner="crystal ball"))
    nameless = [replace(row, user="") if row.label == "wave" else row for row in manifest.rows]
    with pytest.raises(RecordingError, match=r"nobody\.csv, line 2, column user"):
        evaluate(read_examples(rewritten(manifest, nameless, "nobody.csv")))
    partly = [replace(row, split="train") if row.label == "wave" else row for row in manifest.rows]
    with pytest.raises(RecordingError, match=r"partly\.csv, line 3, column split"):
        evaluate(read_examples(rewritten(manifest, partly, "partly.csv")))
    silent = [row for row in manifest.rows if row.label == NONE]
    with pytest.raises(UsageError, match="only negative examples"):
        evaluate(read_examples(rewritten(manifest, silent, "silent.csv")))


def test_a_movement_that_is_too_short_is_refused_with_its_line(manifest):
    rows = [replace(row, start=0.0, end=0.1) if row.path == "clap_1.csv" else row for row in manifest.rows]
    data = read_examples(rewritten(manifest, rows, "short.csv"))
    line = next(row.line for row in data.manifest.rows if row.path == "clap_1.csv")
    with pytest.raises(RecordingError, match=rf"short\.csv, line {line}: .*lasts 0\.10 s; expected a movement"):
        evaluate(data, wanted=Wanted("movements"))
