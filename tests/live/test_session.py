"""One person and one robot, without sockets and clock: what comes wrong leaves the robot safe and standing."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from nao_sim.gestures.recognised import recognise
from nao_sim.imitation.filters import Kalman
from nao_sim.imitation.retarget import one_to_one
from nao_sim.live.problem import LiveError
from nao_sim.live.protocol import Angles, Frame, Hello
from nao_sim.live.session import Session
from nao_sim.motion import JointTrajectory
from nao_sim.paths import TRAJECTORIES
from nao_sim.recordings import load
from nao_sim.robot import START_POSTURE
from nao_sim.safety.position import command_bounds
from nao_sim.safety.speed import speed_limits
from tests.live.senders import STEP, at_their_times, frames, run
from tests.people import person


def _recorded(world, skeleton, seconds, **hello):
    """A recording streamed to a robot as its frames are due."""
    session = Session(world, Hello(**hello), joints=skeleton.joints)
    times = (skeleton.times - skeleton.times[0]).tolist()
    sent = [Frame(*each) for each in zip(times, skeleton.positions, skeleton.confidence, strict=True)]
    return list(run(session, [(frame.time, frame) for frame in sent], seconds))


def _check_safe(moments, robot):
    """Commands that the robot can do, from first to last, and a robot on its feet."""
    commands = np.array([robot.postures[START_POSTURE], *(moment.commanded for moment in moments)])
    lower, upper = command_bounds(robot)
    assert (commands >= lower - 1e-9).all()
    assert (commands <= upper + 1e-9).all()
    speed = np.abs(np.diff(commands, axis=0)) / STEP
    assert (speed <= speed_limits(robot, 0.8) + 1e-6).all()
    last = moments[-1]
    assert last.base_pose[2] > 0.28
    assert abs(last.base_pose[3]) > 0.98
    assert "fell" not in last.light.reason


def test_requests_are_those_of_the_file_path_with_the_causal_filter_a_frame_behind(world):
    skeleton = person(60, 3)
    moments = _recorded(world, skeleton, 1.8)
    asked = JointTrajectory(skeleton.times, one_to_one(Kalman().filter(skeleton), world.robot))
    times = np.arange(len(moments)) * STEP
    begun = times >= 1 / 30 + 1e-9
    expected = asked.sample(times - 1 / 30)
    requested = np.array([moment.requested for moment in moments])
    np.testing.assert_allclose(requested[begun], expected[begun], rtol=0.0, atol=1e-9)


def test_gestures_ask_for_what_the_file_path_asks_for(world):
    whole = load(TRAJECTORIES / "person_wave.csv").motion
    skeleton = replace(
        whole, times=whole.times[:130], positions=whole.positions[:130], confidence=whole.confidence[:130]
    )
    moments = _recorded(world, skeleton, float(skeleton.times[-1]), mode="gestures")
    played = recognise(skeleton, world.vocabulary).performed(world.robot, world.robot.postures[START_POSTURE])
    requested = np.array([moment.requested for moment in moments])
    assert np.ptp(requested, axis=0).max() > 0.5, "no gesture was played"
    np.testing.assert_allclose(requested, played.positions[: len(requested)], rtol=0.0, atol=1e-9)


def test_a_sensor_that_says_nothing_of_unit_and_axes_is_found_out_as_a_file_is(world):
    sent = frames(40, 1, layout="kinect_v2")
    session = Session(world, Hello(layout="Kinect v2", unit=None))
    mm = [replace(frame, points=1000.0 * frame.points) for frame in sent]
    moments = list(run(session, at_their_times(mm), 1.3))
    assert "unit mm" in (session.reader.understood or "")
    assert "forward -z, left -x, up +y" in (session.reader.understood or "")
    assert moments[-1].light.colour in {"green", "amber"}
    assert np.isfinite(moments[-1].requested[2:6]).all()


def test_a_mirrored_person_moves_the_other_side(world):
    plain, mirrored = (_recorded(world, person(15, 5), 0.4, mirror=mirror)[-1].requested for mirror in (False, True))
    np.testing.assert_allclose(mirrored, world.robot.mirror(plain), rtol=0.0, atol=1e-6)


def _shuffled(sent):
    random = np.random.default_rng(0)
    return [(frame.time - 100.0 + random.uniform(0.0, 0.15), frame) for frame in sent]


def _absurd(sent):
    random = np.random.default_rng(1)
    bad = np.array([np.nan, np.inf, -np.inf, 1e300, -1e5, 0.0])
    for frame in sent:
        hit = random.random(frame.points.shape) < 0.2
        points = np.where(hit, random.choice(bad, frame.points.shape), frame.points)
        yield frame.time - 100.0, replace(frame, points=np.where(np.abs(points) < 1e6, points, np.nan))


FAULTS = {
    "lost": lambda sent: [each for i, each in enumerate(at_their_times(sent)) if i % 5 < 2],
    "late, and so out of order": _shuffled,
    "all twice": lambda sent: [each for each in at_their_times(sent) for _ in range(2)],
    "in bursts": lambda sent: [(math.ceil((t + 1e-9) / 0.3) * 0.3, frame) for t, frame in at_their_times(sent)],
    "absurd": lambda sent: list(_absurd(sent)),
    "of two people in turns": lambda sent: [
        each for pair in zip(at_their_times(sent), at_their_times(frames(len(sent), 9, facing=3.0)), strict=True)
        for each in (pair[0], (pair[1][0] + 0.01, replace(pair[1][1], time=pair[1][1].time + 0.01)))
    ],
    "of clocks that jump": lambda sent: [
        (t, replace(frame, time=frame.time + 50.0 * (i // 7 % 2))) for i, (t, frame) in enumerate(at_their_times(sent))
    ],
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_frames_that_come_wrong_leave_the_robot_safe_and_standing(world, fault):
    session = Session(world, Hello())
    moments = list(run(session, FAULTS[fault](frames(40, 4)), 1.6))
    _check_safe(moments, world.robot)


def test_what_is_lost_late_and_twice_is_counted(world):
    session = Session(world, Hello())
    sent = frames(40, 4)
    order = [*sent[:20], sent[18], sent[19], *sent[23:40]]
    for place, frame in enumerate(order):
        session.receive(frame, place / 30)
    counts = session.step(2.0).counts
    assert (counts.received, counts.late, counts.duplicate, counts.lost) == (39, 1, 1, 3)


def test_a_source_that_stops_is_told_in_red_and_one_that_returns_is_followed_again(world):
    session = Session(world, Hello())
    sent = frames(25, 6)
    list(run(session, at_their_times(sent), 0.9))
    waiting = list(run(session, [], 2.0, start=0.9))
    assert (waiting[-1].light.colour, waiting[-1].light.reason) == ("red", "no frame for 2 s: it waits")
    np.testing.assert_allclose(waiting[-1].commanded, waiting[-20].commanded, atol=1e-9)
    _check_safe(waiting[-1:] * 2, replace(world.robot, postures={START_POSTURE: waiting[-1].commanded}))
    back = [(3.0 + i / 30, replace(frame, time=frame.time + 500.0)) for i, frame in enumerate(frames(25, 7))]
    again = list(run(session, back, 0.8, start=2.9))
    assert again[-1].light.colour != "red"
    assert np.abs(again[-1].commanded - waiting[-1].commanded).max() > 0.02


def test_a_sensor_of_five_frames_a_second_is_followed_without_a_stop(world):
    session = Session(world, Hello())
    slow = [(i / 5, replace(frame, time=i / 5)) for i, frame in enumerate(frames(14, 6))]
    moments = list(run(session, slow, 2.6))[-20:]
    assert all(np.isfinite(moment.requested[2:6]).all() for moment in moments)
    assert "red" not in {moment.light.colour for moment in moments}


def test_a_frame_of_another_size_is_refused_and_changes_nothing(world):
    session = Session(world, Hello())
    for frame in frames(12):
        session.receive(frame, 0.0)
    with pytest.raises(LiveError, match=r"32 points; expected 33, as MediaPipe pose has"):
        session.receive(Frame(200.0, np.zeros((32, 3)), np.ones(32)), 0.1)
    moment = session.step(0.1)
    assert moment.counts.refused == 1
    assert moment.frame_time == pytest.approx(100.0 + 11 / 30)


def test_first_frames_with_nobody_in_them_are_refused_with_the_reason(world):
    session = Session(world, Hello())
    random = np.random.default_rng(0)
    with pytest.raises(LiveError, match=r"no body by MediaPipe pose: .*; expected a person"):
        for i in range(30):
            session.receive(Frame(i / 30, random.normal(0.0, 1.0, (33, 3)), np.ones(33)), i / 30)
    assert session.step(1.0).light.colour == "amber"


def test_a_paused_robot_waits_and_then_goes_on(world):
    session = Session(world, Hello())
    sent = at_their_times(frames(60, 8))
    list(run(session, sent[:15], 0.5))
    session.pause(True)
    paused = list(run(session, sent[15:40], 0.8, start=0.5))
    assert paused[-1].light.reason == "paused"
    assert paused[-1].flags == ("paused",)
    np.testing.assert_allclose(paused[-1].commanded, paused[-10].commanded, atol=1e-9)
    session.pause(False)
    assert np.isfinite(list(run(session, sent[40:], 0.5, start=1.3))[-1].requested[2:6]).all()


def test_the_last_seconds_are_done_again_and_then_the_person_is_followed(world):
    session = Session(world, Hello())
    sent = at_their_times(frames(30, 2))
    first = list(run(session, sent, 1.0))
    session.replay(True, 2.0)
    again = list(run(session, [], 1.2, start=2.0))
    assert again[0].flags == ("replaying",)
    assert again[-1].flags == ()
    asked, repeated = (np.array([moment.requested for moment in moments]) for moments in (first[22:45], again[22:45]))
    assert np.nanmax(np.abs(asked - repeated)) < 0.1
    assert again[30].light.colour != "red"


def test_what_was_recorded_is_the_file_that_play_reads(world, tmp_path):
    kept = tmp_path / "kept.csv"
    session = Session(world, Hello(layout="kinect_v2"), record=kept)
    sent = frames(30, 3, layout="kinect_v2")
    session.record(True)
    list(run(session, at_their_times(sent), 1.0))
    text, count = session.recording()
    assert kept.read_bytes() == text, "is on disk before anything is closed"
    recording = load(kept)
    assert count == len(recording.motion) == 30
    file = _recorded(world, recording.motion, 0.9)[-1].requested
    live = session.step(0.9 - STEP).requested
    np.testing.assert_allclose(np.nan_to_num(file), np.nan_to_num(live), atol=2e-3)
    session.close()


def test_nothing_that_was_received_is_overwritten(world, tmp_path):
    for _ in range(3):
        Session(world, Hello(), record=tmp_path / "kept.csv").close()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["kept-2.csv", "kept-3.csv", "kept.csv"]


def test_a_robot_that_fell_says_so_in_red_and_gets_up_when_it_is_reset(world):
    session = Session(world, Hello())
    session._simulator.data.qpos[3:7] = [math.cos(0.8), math.sin(0.8), 0.0, 0.0]
    assert session.step(0.0).light.reason == "the robot fell; reset it"
    session.reset()
    assert session.step(0.02).light.colour == "amber"


def test_joint_angles_of_a_recording_are_done_as_they_are(world):
    motion = load(TRAJECTORIES / "wave.csv").motion
    session = Session(world, Hello(), joints=())
    for i in range(20):
        session.receive_angles(Angles(float(motion.times[i]), motion.positions[i]), float(motion.times[i]))
    moment = session.step(float(motion.times[19]))
    known = np.isfinite(moment.requested)
    np.testing.assert_allclose(moment.requested[known], motion.positions[18][known], atol=0.05)
