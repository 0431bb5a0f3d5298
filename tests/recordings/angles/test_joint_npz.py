"""Joint angles in NumPy archives: names, units, times, rollouts, and archives that are none."""

import io
import zipfile

import numpy as np
import pytest
from hypothesis import given, settings

from nao_sim.recordings import load
from nao_sim.recordings.angles.writing import write_motion
from nao_sim.robot import load_robot
from tests.motions import trajectories

ROBOT = load_robot()
YAW, HAND = ROBOT.index["HeadYaw"], ROBOT.index["RHand"]
GOOD = {
    "joint_names": np.array(["RHand", "HeadYaw"]),
    "positions": np.array([[0.5, 0.1], [1.0, np.nan], [0.0, -0.3]]),
    "times": np.array([0.0, 0.5, 2.0]),
    "unit": np.array("rad"),
}


def archive(**arrays):
    """The bytes of GOOD with some arrays replaced; None leaves one out."""
    stream = io.BytesIO()
    np.savez(stream, **{name: array for name, array in {**GOOD, **arrays}.items() if array is not None})
    return stream.getvalue()


def test_arrays_load_with_their_times_and_joints(write):
    recording = load(write(archive()))
    motion = recording.motion
    assert recording.format == "joint-angle NPZ" and recording.reason == "a ZIP archive of NumPy arrays"
    assert recording.frames == 3 and recording.notes == ()
    assert motion.times.tolist() == [0.0, 0.5, 2.0] and motion.positions[:, HAND].tolist() == [0.5, 1.0, 0.0]
    np.testing.assert_array_equal(motion.positions[:, YAW], [0.1, np.nan, -0.3])
    assert np.flatnonzero(motion.given).tolist() == sorted([YAW, HAND])


@pytest.mark.parametrize(
    "arrays",
    [
        {"names": GOOD["joint_names"], "joint_names": None},
        {"joint_names": GOOD["joint_names"].astype("S10")},
        {"angles": GOOD["positions"], "positions": None},
        {"time": GOOD["times"], "times": None},
        {"positions": GOOD["positions"] * [1.0, 180.0 / np.pi], "unit": np.array("deg")},
        {"units": np.array("rad"), "unit": None},
        {"notes": np.zeros((4, 4)), "extra": np.array("by hand")},
    ],
)
def test_every_way_to_store_the_same_motion_reads_the_same(write, arrays):
    motion, expected = load(write(archive(**arrays))).motion, load(write(archive(), "good")).motion
    np.testing.assert_allclose(motion.positions, expected.positions, atol=1e-12)
    np.testing.assert_array_equal(motion.times, expected.times)


def test_a_compressed_archive_and_whole_numbers(write):
    stream = io.BytesIO()
    np.savez_compressed(
        stream, names=["HeadYaw"], angles=np.array([[1], [2]], np.int16), time=np.array([0, 1]), unit="deg"
    )
    np.testing.assert_allclose(load(write(stream.getvalue())).motion.positions[:, YAW], np.radians([1.0, 2.0]))


def test_the_caller_may_say_rate_and_unit_where_the_file_does_not(write):
    path = write(archive(times=None, unit=None))
    recording = load(path, rate=20.0, unit="deg")
    np.testing.assert_allclose(recording.motion.times, [0.0, 0.05, 0.1])
    assert recording.motion.positions[0, YAW] == pytest.approx(np.radians(0.1))
    assert recording.notes == ("angles taken as deg, as told", "no times: 20 frames a second, as told")


def test_without_a_unit_angles_are_radians_as_long_as_they_can_be(write, told):
    assert load(write(archive(unit=None))).notes == ("no array unit: angles taken as radians",)
    degrees = write(archive(unit=None, positions=GOOD["positions"] * [1.0, 100.0]))
    told(degrees, None, "positions", "angles up to 30", "--unit deg")
    assert load(degrees, unit="deg").motion.positions[0, YAW] == pytest.approx(np.radians(10.0))


def test_a_rollout_gives_what_its_joints_did(write):
    frames = np.arange(4.0)
    rollout = dict.fromkeys(("requested", "command", "joint_velocities"), np.ones((4, 26)))
    content = archive(
        joint_names=np.array(ROBOT.joint_names), positions=None, unit=None, times=None, time=frames,
        joint_positions=np.full((4, 26), 0.5), base_pose=np.zeros((4, 7)), **rollout,
    )  # fmt: skip
    recording = load(write(content))
    assert set(recording.motion.positions.ravel()) == {0.5}
    assert recording.notes == ("a rollout: read is what the simulated joints did, not what was asked of them",)


@settings(max_examples=40)
@given(motion=trajectories(first=-3.0))
def test_what_is_written_is_read_to_the_last_bit(tmp_path_factory, motion):
    path = tmp_path_factory.mktemp("law") / "x.npz"
    write_motion(path, motion)
    recording = load(path)
    np.testing.assert_array_equal(recording.motion.times, motion.times)
    np.testing.assert_array_equal(recording.motion.positions, motion.positions)
    np.testing.assert_array_equal(recording.motion.given, motion.given)
    assert recording.notes == ()


OBJECTS = np.array([{"a": 1}, None], dtype=object)
MISTAKES = {
    "pickled names": ({"joint_names": OBJECTS}, None, ["unreadable", "allow_pickle=False"]),
    "pickled angles": ({"positions": OBJECTS}, None, ["unreadable", "plain arrays"]),
    "no names": ({"joint_names": None}, "joint_names", ["positions, times, unit", "an array joint_names or names"]),
    "no angles": ({"positions": None}, "positions", ["an array positions or angles"]),
    "no times": ({"times": None}, "times", ["no times", "--rate HZ"]),
    "names that are numbers": ({"joint_names": np.arange(2)}, "joint_names", ["int64", "NAOqi joint names"]),
    "one name": ({"joint_names": np.array("HeadYaw")}, "joint_names", ["shape ()"]),
    "an unknown joint": ({"joint_names": np.array(["RHand", "Tail"])}, "Tail", ["unknown joint"]),
    "a joint twice": ({"joint_names": np.array(["RHand", "RHand"])}, "RHand", ["named twice", "once"]),
    "a column too few": ({"positions": np.zeros((3, 1))}, "positions", ["shape (3, 1)", "(T, 2)"]),
    "no frames": ({"positions": np.zeros((0, 2)), "times": np.zeros(0)}, "positions", ["shape (0, 2)"]),
    "three dimensions": ({"positions": np.zeros((3, 2, 1))}, "positions", ["(3, 2, 1)", "2 dimensions"]),
    "complex angles": ({"positions": np.zeros((3, 2), complex)}, "positions", ["complex128", "real numbers"]),
    "text for angles": ({"positions": np.full((3, 2), "a")}, "positions", ["real numbers"]),
    "times too few": ({"times": np.zeros(2)}, "times", ["2 times for 3 frames"]),
    "times in a table": ({"times": np.zeros((3, 1))}, "times", ["(3, 1)", "1 dimension"]),
    "time goes back": ({"times": np.array([0.0, 2.0, 1.0])}, "times", ["1 s in frame 2", "after 2 s"]),
    "time is nan": ({"times": np.array([np.nan, 2.0, 3.0])}, "times", ["nan s in frame 0", "finite time"]),
    "time is inf": ({"times": np.array([0.0, 2.0, np.inf])}, "times", ["inf s in frame 2"]),
    "an unknown unit": ({"unit": np.array("grad")}, "unit", ["'grad'", "rad or deg"]),
    "a list for a unit": ({"unit": np.array(["rad", "deg"])}, "unit", ["rad or deg"]),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_with_its_array_and_what_was_expected(write, told, mistake):
    arrays, column, words = MISTAKES[mistake]
    told(write(archive(**arrays)), None, column, *words)


def test_options_that_contradict_the_file_are_refused(write, told):
    path = write(archive())
    told(path, None, "unit", "'rad' by the file but 'deg' by unit option", unit="deg")
    told(path, None, "times", "a rate of 30 Hz", "no rate", rate=30.0)


def test_an_array_that_says_more_than_it_holds(write, told):
    """A header may promise petabytes."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as file:
        for name, shape in (("positions", "(100000000, 100000000)"), ("joint_names", "(2,)")):
            header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
            file.writestr(f"{name}.npy", b"\x93NUMPY\x01\x00\x76\x00" + header.encode() + b"\0" * 64)
    told(write(stream.getvalue()), None, None, "damaged or unreadable archive")


def test_a_zip_of_other_things_is_not_taken_for_arrays(write, told):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as file:
        file.writestr("xl/workbook.xml", "<a/>")
    told(write(stream.getvalue()), None, None, "a ZIP archive or spreadsheet")
