"""Converting: what each format keeps, and that what is said of the loss is true."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.errors import UsageError
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.recordings import load
from nao_sim.recordings.angles import conversion
from nao_sim.recordings.angles.conversion import convert
from nao_sim.recordings.angles.writing import WRITERS, write_motion
from nao_sim.recordings.recording import Recording
from nao_sim.recordings.source import Source
from nao_sim.robot import load_robot
from tests.motions import trajectories

ROBOT = load_robot()
YAW, HAND = ROBOT.index["HeadYaw"], ROBOT.index["LHand"]
EXACT = (".csv", ".npz")


def trajectory(times, yaw, hand=None):
    positions = np.full((len(times), 26), np.nan)
    positions[:, YAW] = yaw
    if hand is not None:
        positions[:, HAND] = hand
    return JointTrajectory(np.array(times), positions, np.isin(np.arange(26), [YAW] if hand is None else [YAW, HAND]))


@pytest.fixture
def converted(tmp_path):
    """Write a trajectory as .npz, convert it, and return what was written and the loss in words."""

    def converted(motion, extension):
        write_motion(tmp_path / "in.npz", motion)
        _, after, loss = convert(Source(tmp_path / "in.npz"), tmp_path / f"out{extension}")
        assert load(tmp_path / f"out{extension}").frames == after.frames
        return after.motion, loss.told

    return converted


@settings(max_examples=30)
@given(motion=trajectories(first=-3.0), extension=st.sampled_from(EXACT))
def test_csv_and_npz_keep_everything_to_the_last_bit(tmp_path_factory, motion, extension):
    path = tmp_path_factory.mktemp("law") / f"x{extension}"
    write_motion(path, motion)
    read = load(path).motion
    for name in ("times", "positions", "given"):
        np.testing.assert_array_equal(getattr(read, name), getattr(motion, name))


@settings(max_examples=30)
@given(motion=trajectories())
def test_a_webots_motion_keeps_angles_exactly_and_times_to_half_a_millisecond(tmp_path_factory, motion):
    path = tmp_path_factory.mktemp("law") / "x.motion"
    write_motion(path, motion)
    read = load(path).motion
    np.testing.assert_allclose(read.times, motion.times, atol=0.5001e-3, rtol=0)
    expected = np.where(np.isfinite(motion.positions), motion.positions, np.nan)
    np.testing.assert_array_equal(read.positions[:, ~ROBOT.is_hand], expected[:, ~ROBOT.is_hand])
    np.testing.assert_allclose(read.positions, expected, atol=1e-15)
    np.testing.assert_array_equal(read.given, motion.given)


@settings(max_examples=25)
@given(
    motion=trajectories(gaps=False), chain=st.lists(st.sampled_from([".csv", ".npz", ".py"]), min_size=1, max_size=4)
)
def test_a_chain_of_exact_formats_changes_nothing(tmp_path_factory, motion, chain):
    path = tmp_path_factory.mktemp("law") / "0.npz"
    write_motion(path, motion)
    for number, extension in enumerate(chain, start=1):
        target = path.with_name(f"{number}{extension}")
        _, _, loss = convert(Source(path), target)
        assert loss.told == () or set(loss.told) == {"names of poses or gestures are not kept (1)"}
        path = target
    read = load(path).motion
    np.testing.assert_array_equal(read.times, motion.times)
    np.testing.assert_array_equal(read.positions, motion.positions)


@settings(max_examples=25)
@given(motion=trajectories(first=-3.0), extension=st.sampled_from(sorted(WRITERS)))
def test_converting_twice_loses_nothing_more(tmp_path_factory, motion, extension):
    folder = tmp_path_factory.mktemp("law")
    write_motion(folder / "in.npz", motion)
    try:
        _, once, _ = convert(Source(folder / "in.npz"), folder / f"once{extension}")
    except UsageError as error:
        assert extension == ".py" and "asks nothing" in str(error) and not np.isfinite(motion.positions).any()
        return
    _, twice, loss = convert(Source(folder / f"once{extension}"), folder / f"twice{extension}")
    assert (loss.joints, loss.filled, loss.emptied) == ((), 0, 0) and loss.angle == 0.0
    assert loss.time < 1e-12 and loss.opening < 1e-12 and len(once.motion) == len(twice.motion)


def test_nothing_lost_is_nothing_told(converted):
    for extension in (".csv", ".npz", ".py"):
        assert converted(trajectory([0.0, 0.0123456789], [0.1, -0.2], [0.3, 1.0]), extension)[1] == ()


def test_a_webots_motion_loses_parts_of_milliseconds(converted):
    motion, told = converted(trajectory([0.0, 0.0123456789], [0.1, -0.2]), ".motion")
    assert told == ("times moved by up to 0.346 ms",) and motion.times.tolist() == [0.0, 0.012]


def test_frames_within_one_millisecond_become_one(converted):
    motion, told = converted(trajectory([0.0, 0.0001, 0.0002, 1.0], [0.0, 1.0, 2.0, 3.0]), ".motion")
    assert "4 frames became 2" in told and motion.positions[:, YAW].tolist() == [0.0, 3.0]
    assert any(text.startswith("angles changed by up to 1.1e+02 deg") for text in told)


def test_openings_beyond_closed_and_open_are_cut_by_a_webots_motion(converted):
    assert converted(trajectory([0.0, 1.0], [0.0, 0.0], [1.25, 0.0]), ".motion")[1] == (
        "hand openings changed by up to 0.25",
    )


def test_times_before_zero_are_moved_where_there_are_none(converted):
    for extension in (".motion", ".py"):
        motion, told = converted(trajectory([-2.0, 1.0], [0.0, 0.5]), extension)
        assert motion.times.tolist() == [0.0, 3.0] and told == ("times moved by up to 2e+03 ms",)
    assert converted(trajectory([-2.0, 1.0], [0.0, 0.5]), ".csv")[1] == ()


def test_gaps_stay_but_in_python_lists_which_bridge_them(converted):
    holes = trajectory([0.0, 1.0, 2.0], [0.0, np.nan, 1.0], [0.5, 0.5, 0.5])
    assert converted(holes, ".motion")[1] == converted(holes, ".csv")[1] == ()
    motion, told = converted(holes, ".py")
    assert told == ("1 gaps bridged: the values beside them join",) and motion.positions[1, YAW] == pytest.approx(0.5)


def test_frames_and_joints_that_ask_nothing_are_no_keys(converted):
    motion, told = converted(trajectory([0.0, 1.0, 2.0], [0.0, np.nan, 1.0], [np.nan] * 3), ".py")
    assert "3 frames became 2" in told and "joints that ask nothing are not kept: LHand" in told
    assert motion.times.tolist() == [0.0, 2.0]


def test_names_of_poses_are_told_when_they_go(tmp_path):
    (tmp_path / "in.motion").write_text("#WEBOTS_MOTION,V1.0,HeadYaw\n00:00:000,a,0\n00:01:000,b,1\n")
    _, _, loss = convert(Source(tmp_path / "in.motion"), tmp_path / "out.csv")
    assert loss.told == ("names of poses or gestures are not kept (2)",)


@pytest.fixture
def wave(tmp_path):
    path = tmp_path / "wave.csv"
    path.write_text("time,HeadYaw_deg\n0,1\n1,2\n")
    return path


def test_the_recording_is_never_overwritten(wave, tmp_path):
    link = tmp_path / "link.csv"
    link.symlink_to(wave)
    for target in (wave, tmp_path / "." / "wave.csv", link):
        with pytest.raises(UsageError, match="would overwrite the recording"):
            convert(Source(wave), target)
    assert wave.read_text().startswith("time,HeadYaw_deg")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("out.xar", "extension '.xar'"),
        ("out", "extension ''"),
        ("gone/out.npz", "cannot write there"),
        (".", "extension"),
    ],
)
def test_a_target_that_cannot_be_is_told_and_nothing_is_left(wave, tmp_path, name, words):
    with pytest.raises(UsageError, match=words):
        convert(Source(wave), tmp_path / name)
    assert [path.name for path in tmp_path.iterdir()] == ["wave.csv"]


def test_a_folder_is_no_target(wave, tmp_path):
    (tmp_path / "a.npz").mkdir()
    with pytest.raises(UsageError, match="is a folder"):
        convert(Source(wave), tmp_path / "a.npz")


def test_a_target_is_replaced_whole(wave, tmp_path):
    target = tmp_path / "out.npz"
    target.write_text("old")
    convert(Source(wave), target)
    assert load(target).frames == 2 and len(list(tmp_path.iterdir())) == 2


def test_a_motion_that_a_format_cannot_hold_leaves_the_old_file(tmp_path):
    write_motion(tmp_path / "in.npz", trajectory([0.0], [np.nan]))
    (tmp_path / "out.py").write_text("old")
    with pytest.raises(UsageError, match="asks nothing"):
        convert(Source(tmp_path / "in.npz"), tmp_path / "out.py")
    assert (tmp_path / "out.py").read_text() == "old" and len(list(tmp_path.iterdir())) == 2


def test_a_persons_recording_is_sent_to_retarget(wave, tmp_path, monkeypatch):
    person = Skeleton(np.zeros(1), np.zeros((1, 1, 3)), ("head",))
    monkeypatch.setattr(conversion, "read", lambda source: Recording(source.path, "Kinect", "why", person, 1))
    with pytest.raises(UsageError, match=r"a person's recording \(Kinect\).*nao-sim retarget"):
        convert(Source(wave), tmp_path / "out.npz")
