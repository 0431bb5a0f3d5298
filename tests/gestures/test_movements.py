import numpy as np
import pytest
from gestures.postures import held, skeleton, slerp
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.errors import UsageError
from nao_sim.gestures.movement_stream import stream_movements
from nao_sim.gestures.movements import REJECT, MovementRecogniser
from nao_sim.gestures.poses import NONE
from nao_sim.gestures.streaming import segments_of
from nao_sim.gestures.windows import HAND_MEASURES, measures, window_of
from nao_sim.motion import Skeleton

MOVEMENTS = {  # from, to, cycles a second; of the left and right arm
    "wave": (("down", "piUp"), ("down", "side"), 1.3),
    "clap": (("forward", "forward"), ("side", "side"), 1.0),
    "lift": (("forward", "forward"), ("up", "up"), 0.7),
    "left_knock": (("forward", "down"), ("piUp", "down"), 1.6),
}


def shown(name, user=0, seconds=2.4, mirrored=False, **how):
    """A person who repeats a movement; each user differs in speed, phase, extent and noise."""
    start, end, speed = MOVEMENTS[name]
    random = np.random.default_rng(user)
    times = np.arange(0.0, seconds, 1.0 / 30.0)
    phase, speed = random.uniform(0.0, 2.0 * np.pi), speed * random.uniform(0.8, 1.25)
    share = 0.5 - random.uniform(0.35, 0.5) * np.cos(2.0 * np.pi * speed * times + phase)
    way = np.stack([slerp(held(*start), held(*end), value) for value in share])
    person = skeleton(way, **({"noise": 0.004, "seed": user} | how))
    return person.mirrored() if mirrored else person


@pytest.fixture(scope="module")
def examples():
    pairs = [(window_of(shown(name, user)), name) for name in MOVEMENTS for user in range(4)]
    return [window for window, _ in pairs], [name for _, name in pairs]


@pytest.fixture(scope="module")
def recogniser(examples):
    return MovementRecogniser.fit(*examples)


@settings(max_examples=30)
@given(st.sampled_from(sorted(MOVEMENTS)), st.integers(100, 999), st.floats(0.5, 1.5), st.floats(-np.pi / 6, np.pi / 6))
def test_strangers_of_any_size_who_stand_turned_are_recognised(recogniser, name, user, scale, turn):
    person = shown(name, user, height=1.7 * scale, turn=turn, noise=0.004 * scale)
    assert recogniser.decide(window_of(person)).label == name


@settings(max_examples=20)
@given(st.sampled_from(sorted(MOVEMENTS)), st.integers(100, 999))
def test_a_mirrored_person_gets_the_mirrored_label(recogniser, name, user):
    one = recogniser.decide(window_of(shown(name, user)))
    other = recogniser.decide(window_of(shown(name, user, mirrored=True)))
    assert other.label == {"left_knock": "right_knock"}.get(one.label, one.label)
    for label, score in one.scores.items():
        twin = {"left_knock": "right_knock", "right_knock": "left_knock"}.get(label, label)
        assert other.scores.get(twin, score) == pytest.approx(score, abs=1e-6)


def test_the_order_of_the_examples_changes_nothing(examples, recogniser):
    windows, names = examples
    order = np.random.default_rng(0).permutation(len(windows))
    other = MovementRecogniser.fit([windows[i] for i in order], [names[i] for i in order])
    for user in range(200, 206):
        for name in MOVEMENTS:
            window = window_of(shown(name, user))
            one, two = recogniser.decide(window).scores, other.decide(window).scores
            assert one.keys() == two.keys() and np.allclose(list(one.values()), list(two.values()), atol=1e-8)


@pytest.mark.parametrize("count", [1, 3])
def test_a_few_examples_teach_a_movement(examples, count):
    windows, names = examples
    known = [(window, name) for window, name in zip(windows, names, strict=True) if name != "lift"]
    recogniser = MovementRecogniser.fit(*map(list, zip(*known, strict=True)))
    strangers = [window_of(shown("lift", user)) for user in range(400, 406)]
    learned = recogniser.taught("lift", [window_of(shown("lift", user)) for user in range(count)])
    assert [learned.decide(window).nearest for window in strangers] == ["lift"] * 6
    assert learned.decide(window_of(shown("clap", 400))).nearest == "clap"


def test_a_single_movement_is_told_from_all_else():
    recogniser = MovementRecogniser.fit([window_of(shown("wave", user)) for user in range(3)], ["wave"] * 3)
    assert recogniser.decide(window_of(shown("wave", 500))).label == "wave"
    assert recogniser.decide(window_of(shown("lift", 500))).label == NONE
    assert recogniser.decide(window_of(skeleton(np.repeat(held("down")[None], 60, axis=0)))).label == NONE


def test_hands_that_are_not_tracked_are_done_without(recogniser):
    for name in MOVEMENTS:
        person = shown(name, 600)
        keep = [place for place, joint in enumerate(person.joints) if not joint.endswith("hand")]
        without = Skeleton(person.times, person.positions[:, keep], tuple(person.joints[place] for place in keep))
        window = window_of(without)
        assert not window.hands and recogniser.decide(window).label == name


def test_gaps_and_another_frame_rate_change_no_label(recogniser):
    for name in MOVEMENTS:
        person = shown(name, 700)
        positions = np.array(person.positions)
        positions[20:24] = np.nan
        assert recogniser.decide(window_of(Skeleton(person.times, positions, person.joints))).label == name
        halved = Skeleton(person.times[::2], person.positions[::2], person.joints)
        assert recogniser.decide(window_of(halved)).label == name


def test_noise_and_short_arms_change_no_label(recogniser):
    for name in MOVEMENTS:
        assert recogniser.decide(window_of(shown(name, 750, noise=0.015))).nearest == name
        person = shown(name, 760, height=1.1)
        points = np.array(person.positions)
        for side in ("left", "right"):
            places = [person.joints.index(f"{side}_{part}") for part in ("shoulder", "elbow", "wrist", "hand")]
            points[:, places[1:]] += 0.2 * (points[:, places[:1]] - points[:, places[1:]])
        assert recogniser.decide(window_of(Skeleton(person.times, points, person.joints))).label == name


def test_the_best_score_decides_about_none_and_confidence_goes_with_it(recogniser):
    found = [recogniser.decide(window_of(shown(name, user))) for name in MOVEMENTS for user in range(900, 903)]
    still = window_of(skeleton(np.repeat(held("down")[None], 60, axis=0)))
    for each in [*found, recogniser.decide(still), recogniser.decide(window_of(shown("lift", 3, seconds=0.5)))]:
        assert (each.label == NONE) == (max(each.scores.values()) <= REJECT) and 0.0 <= each.confidence <= 1.0
        assert each.nearest == max(each.scores, key=each.scores.get)
    assert recogniser.decide(still).confidence > 0.9 and recogniser.decide(still).label == NONE


def test_examples_of_one_person_do_not_shut_out_others():
    pairs = [(window_of(shown(name, 0, seed=seed)), name) for name in ("wave", "clap", "lift") for seed in range(3)]
    one_teacher = MovementRecogniser.fit([window for window, _ in pairs], [name for _, name in pairs])
    strangers = [(window_of(shown(name, user)), name) for name in ("wave", "clap", "lift") for user in range(500, 508)]
    assert np.mean([one_teacher.decide(window).label == name for window, name in strangers]) >= 0.75


def test_measures_of_hands_come_last():
    person = shown("wave", 1)
    window = window_of(person)
    changed = type(window)(np.concatenate([window.segments[:, :, :2], window.segments[:, :, 2:] * 0.5], axis=2), True)
    differs = measures(window) != measures(changed)
    assert differs[-HAND_MEASURES:].any() and not differs[:-HAND_MEASURES].any()


def test_what_cannot_be_learned_is_refused(examples):
    with pytest.raises(UsageError, match="0 examples"):
        MovementRecogniser.fit([], [])
    with pytest.raises(UsageError, match="none"):
        MovementRecogniser.fit(examples[0][:1], ["none"])
    with pytest.raises(ValueError, match="expected"):
        window_of(shown("wave", seconds=0.1))


def test_a_stream_announces_a_movement_while_it_lasts_and_nothing_at_rest(recogniser):
    rest = skeleton(np.repeat(held("down")[None], 45, axis=0), noise=0.004).positions
    moving = shown("clap", 800, seconds=3.0).positions
    positions = np.concatenate([rest, moving, rest])
    person = Skeleton(np.arange(len(positions)) / 30.0, positions, shown("clap").joints)
    found = segments_of(stream_movements(recogniser, person))
    assert [segment.label for segment in found] == ["clap"]
    assert 1.5 < found[0].start < 3.5 and found[0].end < 5.2
    cut = Skeleton(person.times[:90], positions[:90], person.joints)
    assert stream_movements(recogniser, cut) == stream_movements(recogniser, person)[:90]
