import numpy as np
import pytest
from gestures.postures import JOINTS, PLAIN, body, held, skeleton, slerp, thesis
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.gestures.poses import NONE, PoseRecogniser
from nao_sim.gestures.streaming import PoseStream, segments_of, stream_poses
from nao_sim.motion import Skeleton

RATE = 30.0
LATENCY = 0.150  # s


@pytest.fixture(scope="module")
def recogniser():
    rows, labels, _ = thesis()
    return PoseRecogniser.fit(rows, labels)


def going(start, end, lasts, rest=1.0, rate=RATE):
    """Times (T,), 0 where the end is reached, and directions on the way there by minimum jerk."""
    times = np.arange(-rest - lasts, rest, 1.0 / rate)
    u = np.clip(times / lasts + 1.0, 0.0, 1.0)
    way = 10 * u**3 - 15 * u**4 + 6 * u**5
    return times, np.stack([slerp(held(start), held(end), share) for share in way])


@settings(max_examples=40)
@given(st.sampled_from(sorted(PLAIN)), st.sampled_from(sorted(PLAIN)), st.floats(0.3, 1.5), st.integers(0, 999))
def test_a_pose_is_announced_within_150_ms_and_no_other_on_the_way(recogniser, start, end, lasts, seed):
    times, directions = going(start, end, lasts)
    frames = body(directions, noise=0.007, seed=seed)
    stream = PoseStream(recogniser, JOINTS)
    found = [stream.update(frame, time) for frame, time in zip(frames, times, strict=True)]
    reached = next(each.time for each in found if each.label == end and each.time > -lasts)
    assert reached <= LATENCY
    assert all(each.label == end for each in found if each.time > LATENCY)
    opposite = {start, end} == {"up", "down"}  # the shortest way leads through forward or side
    assert {each.label for each in found} <= {start, end, NONE} | ({"forward"} if opposite else set())


def test_waving_through_a_pose_does_not_announce_it(recogniser):
    times = np.arange(0.0, 4.0, 1.0 / RATE)
    share = 0.5 - 0.5 * np.cos(2.0 * np.pi * times / 1.2)
    swing = np.stack([slerp(held("down"), held("up"), value) for value in share])  # through forward, in 0.6 s
    labels = {decision.label for decision in stream_poses(recogniser, skeleton(swing))}
    assert "forward" not in labels


@pytest.mark.parametrize("seconds", [0.5, 0.65, 0.8])
def test_arms_that_turn_round_in_a_pose_do_not_hold_it(recogniser, seconds):
    times = np.arange(0.0, 4.0, 1.0 / RATE)
    share = 1.0 - 0.6 * (0.5 - 0.5 * np.cos(2.0 * np.pi * times / seconds))  # up, and 108 degrees down again
    swing = np.stack([slerp(held("down"), held("up"), value) for value in share])
    for noise in (0.0, 0.001):
        found = stream_poses(recogniser, skeleton(swing, noise=noise))
        assert "up" not in {decision.label for decision in found if decision.time > 0.3}


def test_a_single_bad_frame_changes_nothing(recogniser):
    directions = np.repeat(held("up")[None], 40, axis=0)
    directions[20] = held("side", "forward")
    labels = [decision.label for decision in stream_poses(recogniser, skeleton(directions))]
    assert set(labels[10:]) == {"up"}


def test_a_camera_without_depth_announces_poses_in_its_plane(recogniser):
    directions = np.repeat(np.stack([held("down"), held("piUp"), held("up", "down")]), 20, axis=0)
    person = skeleton(directions)
    flat = Skeleton(person.times, person.positions * [0.0, 1.0, 1.0], person.joints, planar=True)
    found = segments_of(stream_poses(recogniser, flat))
    assert [segment.label for segment in found] == ["down", "piUp", "left_up"]


def test_the_future_is_not_known(recogniser):
    _, directions = going("side", "up", 0.7)
    whole = stream_poses(recogniser, skeleton(directions))
    for cut in (5, 25, 45):
        assert stream_poses(recogniser, skeleton(directions[:cut])) == whole[:cut]


def test_segments_are_the_stretches_of_what_was_announced(recogniser):
    directions = np.repeat(np.stack([held("down"), held("up")]), 30, axis=0)
    decisions = stream_poses(recogniser, skeleton(directions))
    found = segments_of(decisions)
    assert [segment.label for segment in found] == ["down", "up"]
    assert found[0].end <= found[1].start <= 1.0 + LATENCY and found[1].end == decisions[-1].time
    assert segments_of(()) == ()


def test_after_a_pause_what_was_before_does_not_count(recogniser):
    stream, up, side = PoseStream(recogniser, JOINTS), body(held("up")[None])[0], body(held("side")[None])[0]
    for frame in range(10):
        assert stream.update(up, frame / RATE).time == frame / RATE
    after = stream.update(side, 5.0)
    assert after.label == NONE
    assert stream.update(side, 5.05).label == NONE  # not held long enough yet
    assert stream.update(side, 5.1).label == stream.update(side, 5.15).label == "side"


def test_times_that_go_back_and_other_joints_are_refused(recogniser):
    stream = PoseStream(recogniser, JOINTS)
    stream.update(body(held("up")[None])[0], 1.0)
    with pytest.raises(ValueError, match="increase"):
        stream.update(body(held("up")[None])[0], 1.0)
    with pytest.raises(ValueError, match="expected"):
        stream.update(np.zeros((3, 3)), 2.0)
