"""Joint-angle CSV: what is read, and what a mistake is told as."""

import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.errors import UsageError
from nao_sim.motion import JointTrajectory
from nao_sim.recordings import joint_csv_text, load, table
from nao_sim.robot import load_robot

ROBOT = load_robot()
JOINTS = ROBOT.joint_names
ELBOW, HAND = ROBOT.index["LElbowRoll"], ROBOT.index["LHand"]
GOOD = "time,LElbowRoll_deg,LHand\n0,-30,0.5\n0.1,-45,1\n"


@pytest.fixture
def write(tmp_path):
    def write(content, name="arm.csv"):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


def test_a_file_loads_with_its_times_units_and_joints(write):
    recording = load(write(GOOD))
    motion = recording.motion
    assert recording.format == "joint-angle CSV"
    assert recording.reason == "column 'LElbowRoll_deg' is a NAOqi joint"
    assert recording.frames == 2 and recording.notes == ()
    np.testing.assert_allclose(motion.times, [0.0, 0.1])
    np.testing.assert_allclose(motion.positions[:, ELBOW], np.radians([-30.0, -45.0]))
    np.testing.assert_allclose(motion.positions[:, HAND], [0.5, 1.0])
    assert np.flatnonzero(motion.given).tolist() == sorted([ELBOW, HAND])
    assert np.isnan(motion.positions[:, ~motion.given]).all()


@pytest.mark.parametrize(
    "content",
    [
        GOOD.replace("\n", "\r\n"),
        GOOD.replace("\n", "\r"),
        GOOD.rstrip("\n"),
        b"\xef\xbb\xbf" + GOOD.encode(),
        GOOD.replace(",", ";"),
        GOOD.replace(",", "\t"),
        GOOD.replace(",", " , "),
        "# a comment, with a comma\n\n  \n" + GOOD.replace("\n0.1", "\n\n   \n# between\n0.1") + "\n\n",
        '"time","LElbowRoll_deg","LHand"\n"0","-30","0.5"\n"0.1","-45","1"\n',
        "# unit: deg\n" + GOOD.replace("_deg", ""),
        "#Units = Degrees\n" + GOOD.replace("_deg", ""),
        "# unit: deg\n" + GOOD,
        "# the sign of Zoë\n" + GOOD,
        "LHand,time,LElbowRoll_deg\n0.5,0,-30\n1,0.1,-45",
        "time,LElbowRoll_rad,LHand\n0,-0.5235987756,5e-1\n1e-1,-0.7853981634,1.0\n",
    ],
)
def test_every_way_to_write_the_same_motion_reads_the_same(write, content):
    motion, expected = load(write(content)).motion, load(write(GOOD, "good.csv")).motion
    np.testing.assert_allclose(motion.times, expected.times)
    np.testing.assert_allclose(motion.positions, expected.positions, atol=1e-9)
    np.testing.assert_array_equal(motion.given, expected.given)


def test_the_caller_may_say_unit_and_rate_where_the_file_does_not(write):
    path = write("LElbowRoll,LHand\n-30,0\n-45,1\n-60,1\n")
    recording = load(path, unit="deg", rate=20.0)
    np.testing.assert_allclose(recording.motion.times, [0.0, 0.05, 0.1])
    np.testing.assert_allclose(recording.motion.positions[:, ELBOW], np.radians([-30.0, -45.0, -60.0]))
    assert any("20 frames a second" in note for note in recording.notes)
    assert any("taken as deg" in note for note in recording.notes)
    np.testing.assert_allclose(load(path, unit="rad", rate=20.0).motion.positions[:, ELBOW], [-30.0, -45.0, -60.0])


def test_a_unit_by_caller_and_file_that_agree_is_no_contradiction(write):
    recording = load(write(GOOD), unit="deg")
    assert recording.notes == ()


def test_hands_alone_need_no_unit(write):
    assert load(write("time,LHand,RHand\n0,0,1\n")).motion.positions[0, HAND] == 0.0


def test_one_row_is_a_motion(write):
    assert len(load(write("time,HeadYaw_rad\n5,0.1\n")).motion) == 1


def test_both_hip_yaw_pitch_joints_may_be_given(write):
    motion = load(write("time,LHipYawPitch_deg,RHipYawPitch_deg\n0,-10,5\n")).motion
    assert motion.given.sum() == 2


@pytest.mark.parametrize("cell", ["", " ", "nan", "NaN", "inf", "-inf", "Infinity", "1e999"])
def test_a_cell_that_is_empty_or_not_finite_asks_nothing(write, cell):
    motion = load(write(f"time,HeadYaw_deg,LElbowRoll_deg\n0,1,{cell}\n1,{cell},-20\n")).motion
    assert np.isfinite(motion.positions[:, [ROBOT.index["HeadYaw"], ELBOW]]).tolist() == [[True, False], [False, True]]
    assert motion.given[ELBOW]


def test_a_row_of_empty_cells_is_a_frame_whatever_the_delimiter(write):
    for delimiter in ",;\t":
        text = "HeadYaw_deg,LElbowRoll_deg\n1,-20\n,\n2,-30\n".replace(",", delimiter)
        assert len(load(write(text), rate=10.0).motion) == 3


@settings(max_examples=40, deadline=None)
@given(data=st.data())
def test_what_is_written_is_read(tmp_path_factory, data):
    joints = data.draw(st.lists(st.sampled_from(range(len(JOINTS))), min_size=1, unique=True))
    frames = data.draw(st.integers(1, 5))
    value = st.floats(-7.0, 7.0) | st.sampled_from([np.nan, np.inf, -np.inf])
    steps = data.draw(st.lists(st.floats(1e-3, 10.0), min_size=frames, max_size=frames))
    positions = np.full((frames, len(JOINTS)), np.nan)
    positions[:, joints] = data.draw(
        st.lists(st.lists(value, min_size=len(joints), max_size=len(joints)), min_size=frames, max_size=frames)
    )
    motion = JointTrajectory(np.cumsum(steps), positions, np.isin(np.arange(len(JOINTS)), joints))
    path = tmp_path_factory.mktemp("law") / "x.csv"
    path.write_text(joint_csv_text(motion))
    read = load(path).motion
    np.testing.assert_allclose(read.times, motion.times, rtol=1e-11)
    np.testing.assert_allclose(read.positions, motion.positions, atol=6e-5)
    np.testing.assert_array_equal(read.given, motion.given)


@settings(max_examples=40, deadline=None)
@given(names=st.lists(st.sampled_from(JOINTS), min_size=1, unique=True), seed=st.integers(0, 99))
def test_columns_may_come_in_any_number_and_order(tmp_path_factory, names, seed):
    values = np.random.default_rng(seed).uniform(-1.0, 1.0, (3, len(names)))
    header = [name if name.endswith("Hand") else f"{name}_rad" for name in names]
    path = tmp_path_factory.mktemp("law") / "x.csv"
    np.savetxt(path, values, delimiter=",", header=",".join(header), comments="", fmt="%.17g")
    motion = load(path, rate=30.0).motion
    assert motion.given.sum() == len(names)
    for column, name in enumerate(names):
        np.testing.assert_array_equal(motion.positions[:, ROBOT.index[name]], values[:, column])


# What a mistake is told as: (content, line, column, words of what was found and expected)
MISTAKES = {
    "text in a cell": ("time,HeadYaw_deg\n0,1\n0.1,fast\n", 3, "HeadYaw_deg", ["'fast'", "a number"]),
    "a number with underscores": ("time,HeadYaw_deg\n0,1_0\n", 2, "HeadYaw_deg", ["'1_0'", "a number"]),
    "a number in another script": ("time,HeadYaw_deg\n0,٣\n", 2, "HeadYaw_deg", ["'٣'", "a number"]),
    "a decimal comma": ("time;HeadYaw_deg\n0;1,5\n", 2, "HeadYaw_deg", ["'1,5'", "decimal point"]),
    "a short row": ("time,HeadYaw_deg\n0,1\n0.1\n", 3, None, ["1 value;", "2 values"]),
    "a long row": ("time,HeadYaw_deg\n0,1\n0.1,2,3\n", 3, None, ["3 values", "2 values"]),
    "rows that are all too long": ("time,HeadYaw_deg\n0,1,2\n1,2,3\n", 2, None, ["3 values", "2 values"]),
    "a truncated last line": ("time,HeadYaw_deg,LHand\n0,1,0\n0.1,2,1\n0.2,1.", 4, None, ["2 values", "3 values"]),
    "time that goes back": ("time,HeadYaw_deg\n0,1\n0.2,1\n0.1,1\n", 4, "time", ["0.1", "after 0.2 s"]),
    "time that stands still": ("time,HeadYaw_deg\n0,1\n0,1\n", 3, "time", ["0", "after 0 s"]),
    "time that is nan": ("time,HeadYaw_deg\n0,1\nnan,1\n", 3, "time", ["nan", "finite time"]),
    "time that is inf": ("time,HeadYaw_deg\ninf,1\n", 2, "time", ["inf", "finite time"]),
    "no time in a cell": ("time,HeadYaw_deg\n0,1\n,1\n", 3, "time", ["nan", "finite time"]),
    "a column twice": ("time,HeadYaw_deg,HeadYaw_deg\n0,1,1\n", 1, "HeadYaw_deg", ["twice", "once"]),
    "a joint twice": ("time,HeadYaw_deg,HeadYaw_rad\n0,1,1\n", 1, "HeadYaw_rad", ["'HeadYaw_deg'", "once"]),
    "a column without a name": ("time,HeadYaw_deg,\n0,1,\n", 1, 3, ["without a name", "a name for each"]),
    "a joint misspelt": ("time,HeadYaw_deg,LSholderPitch_deg\n0,1,1\n", 1, "LSholderPitch_deg", ["LShoulderPitch?"]),
    "every joint misspelt": ("time,LSholderPitch_deg\n0,1\n", 1, "LSholderPitch_deg", ["LShoulderPitch?"]),
    "a joint in lower case": ("time,headyaw_deg\n0,1\n", 1, "headyaw_deg", ["did you mean HeadYaw?"]),
    "time in upper case": ("Time,HeadYaw_deg\n0,1\n", 1, "Time", ["did you mean time?"]),
    "an unknown column": ("time,HeadYaw_deg,confidence\n0,1,1\n", 1, "confidence", ["unknown", "NAOqi joint name"]),
    "two suffixes": ("time,HeadYaw_rad_deg\n0,1\n", 1, "HeadYaw_rad_deg", ["unknown", "did you mean HeadYaw?"]),
    "no joints": ("time\n0\n", 1, None, ["no joint column", "LShoulderPitch_deg"]),
    "a header and no rows": ("time,HeadYaw_deg\n", 1, None, ["no rows", "at least one row"]),
    "no times": ("HeadYaw_deg\n1\n", 1, None, ["no times", "'time'", "--rate HZ"]),
    "no unit": ("time,HeadYaw\n0,1\n", 1, "HeadYaw", ["_deg or _rad", "# unit: deg", "--unit deg"]),
    "a unit for one joint only": ("time,HeadYaw_deg,HeadPitch\n0,1,1\n", 1, "HeadPitch", ["no unit", "suffix"]),
    "suffix against comment": (
        "# unit: rad\ntime,HeadYaw_deg\n0,1\n",
        2,
        "HeadYaw_deg",
        ["'deg' by suffix", "'rad' by"],
    ),
    "comment against comment": ("# unit: rad\n# unit: deg\ntime,HeadYaw\n0,1\n", 2, None, ["deg", "rad", "one unit"]),
    "an unknown unit": ("# unit: grad\ntime,HeadYaw\n0,1\n", 1, None, ["'grad'", "deg or rad"]),
    "a hand in degrees": ("time,LHand_deg\n0,1\n", 1, "LHand_deg", ["hand with a unit", "0 closed to 1 open"]),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_with_its_place_and_what_was_expected(refused, mistake):
    content, line, column, words = MISTAKES[mistake]
    error = refused(content)
    assert (error.line, error.column) == (line, column)
    assert f"line {line}" in str(error) and all(word in str(error) for word in words), str(error)
    assert column is None or f"column {column}:" in str(error)


def test_a_unit_by_caller_that_contradicts_the_file_is_refused(refused):
    assert "'deg' by suffix but 'rad' by unit option" in str(refused(GOOD, unit="rad"))
    comment = refused("# unit: deg\n" + GOOD.replace("_deg", ""), unit="rad")
    assert "'deg' by comment but 'rad' by unit option" in str(comment)


def test_a_rate_for_a_file_with_times_is_refused(refused):
    assert "a time column and a rate of 30 Hz" in str(refused(GOOD, rate=30.0))


@pytest.mark.parametrize("options", [{"unit": "grad"}, {"rate": 0.0}, {"rate": -5.0}, {"rate": float("nan")}])
def test_an_option_that_is_no_unit_or_rate_is_a_usage_error(write, options):
    with pytest.raises(UsageError, match="expected"):
        load(write(GOOD), **options)


def test_a_mistake_deep_in_a_long_file_has_its_own_line(refused):
    rows = [f"{k / 50:.2f},{k % 90}" for k in range(2 * table.CHUNK + 100)]
    rows[2 * table.CHUNK + 50] = rows[2 * table.CHUNK + 50] + "x"
    error = refused("# a comment\n\ntime,HeadYaw_deg\n" + "\n".join(rows))
    assert error.line == 2 * table.CHUNK + 50 + 4 and error.column == "HeadYaw_deg"


def test_time_is_checked_across_chunks(refused):
    rows = [f"{k},1" for k in range(table.CHUNK)] + [f"{table.CHUNK - 1},1"]
    assert refused("time,HeadYaw_deg\n" + "\n".join(rows)).line == table.CHUNK + 2


def test_a_long_recording_loads_in_memory_of_the_order_of_its_result(write):
    frames = 40_000
    row = ",".join(f"{angle:.3f}" for angle in np.linspace(0.0, 1.0, len(JOINTS)))
    header = ",".join(["time", *(name if name.endswith("Hand") else f"{name}_deg" for name in JOINTS)])
    path = write(header + "\n" + "".join(f"{k / 50:.2f},{row}\n" for k in range(frames)))
    tracemalloc.start()
    try:
        motion = load(path).motion
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert len(motion) == frames
    assert peak < 2.5 * motion.positions.nbytes + 20e6
