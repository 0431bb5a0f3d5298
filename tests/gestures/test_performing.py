"""What the robot does for gestures: smooth, within limits, and as long as it should."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from nao_sim import body
from nao_sim.gestures.performing import PATIENCE, SHOWN, STEP, perform_gestures, posture_of
from nao_sim.gestures.poses import NONE
from nao_sim.gestures.streaming import Decision
from nao_sim.gestures.vocabulary import MOTIONS, Vocabulary, built_in
from nao_sim.motion import JointTrajectory
from nao_sim.recordings import load
from nao_sim.robot import START_POSTURE, load_robot

ROBOT = load_robot()
REST = ROBOT.postures[START_POSTURE]
BUILT_IN = built_in()
WAVE = load(MOTIONS.parent / "wave.csv").motion
VOCABULARY = Vocabulary(BUILT_IN.poses, motions={**BUILT_IN.motions, "right_wave": WAVE})


def decisions(*stretches, rate=30.0):
    """Decisions of labels, each for so many seconds."""
    found, since = [], 0.0
    for label, lasts in stretches:
        times = since + np.arange(round(lasts * rate)) / rate
        found += [Decision(float(time), label, 0.9, since) for time in times]
        since = float(times[-1]) + 1.0 / rate
    return found


def performed(*stretches, vocabulary=VOCABULARY):
    return perform_gestures(vocabulary, decisions(*stretches), ROBOT, REST)


def held_in(motion, label, tolerance=1e-6):
    """When (s) the robot is in the posture of a pose."""
    posture = posture_of(BUILT_IN.motions[label])
    known = np.isfinite(posture.positions[0])
    off = np.abs(motion.positions[:, known] - posture.positions[0, known]).max(axis=1)
    return motion.times[off < tolerance]


SPANS = st.lists(
    st.tuples(st.sampled_from([*BUILT_IN.names, "right_wave", NONE, "unknown"]), st.floats(0.1, 2.5)),
    min_size=1,
    max_size=8,
)


@settings(max_examples=25, deadline=None)
@example([("down", 1.0), ("right_wave", 1.0)])  # once a hair too fast
@given(SPANS)
def test_whatever_is_announced_the_motion_is_smooth_and_within_limits_and_ends_at_rest(spans):
    motion = performed(*spans)
    positions = motion.positions
    np.testing.assert_allclose(positions[[0, -1]], [REST, REST], atol=0.02)
    assert (positions >= ROBOT.lower - 1e-9).all() and (positions <= ROBOT.upper + 1e-9).all()
    assert (np.abs(np.diff(positions, axis=0)) / STEP <= ROBOT.max_speed).all()
    assert (np.abs(np.diff(positions, 2, axis=0)) / STEP**2 <= ROBOT.max_acceleration).all()


@settings(max_examples=10, deadline=None)
@given(SPANS)
def test_the_mirrored_gestures_are_the_mirrored_motion(spans):
    vocabulary = Vocabulary(VOCABULARY.poses, None, {**VOCABULARY.motions, "left_wave": WAVE.mirrored()})
    plain = performed(*spans, vocabulary=vocabulary)
    mirrored = performed(*((body.twin(label), lasts) for label, lasts in spans), vocabulary=vocabulary)
    np.testing.assert_allclose(ROBOT.mirror(mirrored.positions), plain.positions, atol=1e-9)


@settings(max_examples=10, deadline=None)
@given(SPANS, st.floats(0.1, 0.9))
def test_the_future_is_not_known(spans, share):
    whole = decisions(*spans)
    some = whole[: max(1, round(share * len(whole)))]
    one, two = (perform_gestures(VOCABULARY, each, ROBOT, REST) for each in (whole, some))
    known = int((two.times <= some[-1].time).sum())
    np.testing.assert_array_equal(one.positions[:known], two.positions[:known])


def test_a_pose_is_held_as_long_as_it_is_shown_then_the_robot_rests():
    motion = performed(("none", 0.5), ("side", 5.0), ("none", 3.0))
    held = held_in(motion, "side")
    assert held[0] < 2.5 and held[-1] == pytest.approx(5.5 + PATIENCE, abs=0.05)
    assert np.abs(motion.sample(np.array([8.3]))[0] - REST).max() < 0.01


def test_a_pose_that_was_shown_briefly_is_reached_all_the_same():
    motion = performed(("up", 0.3), ("none", 6.0))
    assert np.ptp(held_in(motion, "up")) >= SHOWN - 2 * STEP


def test_the_next_gesture_interrupts_at_once():
    motion = performed(("up", 0.6), ("right_side", 4.0))
    assert not len(held_in(motion, "up")) and held_in(motion, "right_side")[0] < 3.0


def test_a_movement_is_played_once_for_each_announcement():
    def swings(motion):
        elbow = motion.positions[:, ROBOT.index["RElbowRoll"]]
        turns = np.diff(np.sign(np.diff(elbow[np.abs(np.gradient(elbow)) > 1e-4])))
        return int((turns != 0).sum())

    once, long, twice = (
        swings(performed(*spans))
        for spans in (
            [("right_wave", 1.0), (NONE, 9.0)],
            [("right_wave", 12.0)],
            [("right_wave", 8.0), (NONE, 0.5), ("right_wave", 1.0), (NONE, 9.0)],
        )
    )
    assert once == long > 4 and twice > 1.5 * once


def test_what_has_no_motion_is_rest():
    assert np.abs(performed(("unknown", 2.0)).positions - REST).max() < 1e-9


def test_a_gesture_of_the_other_side_alone_is_done_in_the_mirror():
    one = JointTrajectory(np.zeros(1), posture_of(BUILT_IN.motions["left_up"]).positions)
    vocabulary = Vocabulary(BUILT_IN.poses, motions={"left_up": one})
    np.testing.assert_allclose(vocabulary.motion_of("right_up").positions[0], ROBOT.mirror(one.positions)[0])
    assert vocabulary.motion_of("side") is None
