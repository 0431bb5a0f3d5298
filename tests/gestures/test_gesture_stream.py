"""Poses and movements recognised together."""

import numpy as np
import pytest
from gestures.postures import body, held, skeleton, slerp
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim import body as people
from nao_sim.gestures.examples import example_of
from nao_sim.gestures.gesture_stream import HELD, GestureStream, stream_gestures
from nao_sim.gestures.movements import MovementRecogniser
from nao_sim.gestures.poses import NONE
from nao_sim.gestures.streaming import segments_of, stream_poses
from nao_sim.gestures.vocabulary import Vocabulary, built_in
from nao_sim.motion import Skeleton
from nao_sim.smooth_step import minimum_jerk

RATE = 30
HANG = held("down")


def ways(*stops):
    """Directions (T, 2, 2, 3) through postures, each with the seconds to get there and those to stay."""
    parts, last = [HANG[None].repeat(10, axis=0)], HANG
    for posture, takes, stays in stops:
        u = np.linspace(0.0, 1.0, round(takes * RATE))[1:]
        parts += [np.stack([slerp(last, posture, share) for share in minimum_jerk(u)])]
        parts += [posture[None].repeat(round(stays * RATE), axis=0)]
        last = posture
    return np.concatenate(parts)


def flapping(times=3, seconds=0.7):
    """The right arm goes up and down beside the body."""
    low = held("down", "side") * 0.6 + HANG * 0.4
    low /= np.linalg.norm(low, axis=-1, keepdims=True)
    stops = [(each, seconds, 0.0) for _ in range(times) for each in (held("down", "up"), low)]
    return ways(*stops, (HANG, 0.8, 0.7))


@pytest.fixture(scope="module")
def vocabulary():
    flap = MovementRecogniser.fit(
        [example_of(skeleton(flapping(seconds=s))).window for s in (0.6, 0.7, 0.8)], ["right_flap"] * 3
    )
    return Vocabulary(built_in().poses, flap, built_in().motions)


POSES_THEN_FLAPS = np.concatenate(
    [ways((held("side"), 0.8, 1.0), (held("piUp"), 0.6, 1.0), (HANG, 0.9, 0.8)), flapping()]
)
SHOWN = ["side", "piUp", "down", "right_flap"]


def labels(vocabulary, person):
    found = [segment.label for segment in segments_of(stream_gestures(vocabulary, person))]
    found = [label for place, label in enumerate(found) if place == 0 or found[place - 1] != label]
    return found[found[0] == "down" :][: len(SHOWN)]


def test_poses_that_are_held_and_movements_are_told_apart(vocabulary):
    assert labels(vocabulary, skeleton(POSES_THEN_FLAPS, noise=0.004)) == SHOWN


@settings(max_examples=12, deadline=None)
@given(st.floats(0.5, 1.5), st.floats(-0.52, 0.52), st.integers(0, 99))
def test_the_size_and_the_turn_of_a_person_change_no_label(vocabulary, scale, turn, seed):
    person = skeleton(POSES_THEN_FLAPS, height=1.7 * scale, turn=turn, place=(2.0, -1.0, 0.3), seed=seed)
    assert labels(vocabulary, person) == SHOWN


def test_the_mirrored_person_shows_the_mirrored_gestures(vocabulary):
    person = skeleton(np.concatenate([ways((held("up", "down"), 0.8, 1.0), (HANG, 0.8, 0.8)), flapping()]), noise=0.004)
    plain, mirrored = stream_gestures(vocabulary, person), stream_gestures(vocabulary, person.mirrored())
    assert {"left_up", "right_flap"} <= {each.label for each in plain}
    assert [people.twin(each.label) for each in plain] == [each.label for each in mirrored]
    np.testing.assert_allclose([a.confidence for a in plain], [b.confidence for b in mirrored], atol=1e-6)


def test_the_future_is_not_known(vocabulary):
    person = skeleton(POSES_THEN_FLAPS, noise=0.004)
    whole = stream_gestures(vocabulary, person)
    for end in (7, 60, 111, 170):
        start = Skeleton(person.times[:end], person.positions[:end], person.joints)
        assert stream_gestures(vocabulary, start) == whole[:end]


def test_without_movements_poses_are_announced_as_by_their_own_stream(vocabulary):
    person = skeleton(POSES_THEN_FLAPS, noise=0.004)
    found = stream_gestures(Vocabulary(vocabulary.poses), person)
    alone = stream_poses(vocabulary.poses, person)
    assert [(each.label, each.confidence) for each in found] == [(each.label, each.confidence) for each in alone]


def test_with_movements_a_pose_counts_once_it_was_held(vocabulary):
    person = skeleton(ways((held("up"), 0.6, 1.5)))
    up = next(each for each in stream_gestures(vocabulary, person) if each.label == "up")
    alone = next(each for each in stream_poses(vocabulary.poses, person) if each.label == "up")
    assert 0.0 < up.time - alone.time <= HELD + 0.1 and up.since == up.time


def test_a_person_who_is_forgotten_is_a_new_one(vocabulary):
    frames = body(POSES_THEN_FLAPS[:90])
    stream = GestureStream(vocabulary, skeleton(POSES_THEN_FLAPS[:1]).joints)
    first = [stream.update(frame, time / RATE) for time, frame in enumerate(frames)]
    stream.reset()
    assert [stream.update(frame, time / RATE) for time, frame in enumerate(frames)] == first
    with pytest.raises(ValueError, match="increase"):
        stream.update(frames[0], 0.0)


def test_a_name_is_one_gesture_and_a_vocabulary_knows_some(vocabulary):
    with pytest.raises(ValueError, match="neither"):
        Vocabulary()
    flaps = MovementRecogniser.fit([example_of(skeleton(flapping())).window], ["side"])
    with pytest.raises(ValueError, match="'side' is a pose and a movement"):
        Vocabulary(vocabulary.poses, flaps)


def test_hanging_arms_are_none_of_a_vocabulary_of_movements(vocabulary):
    person = skeleton(HANG[None].repeat(60, axis=0))
    assert {each.label for each in stream_gestures(Vocabulary(movements=vocabulary.movements), person)} == {NONE}
