"""Exported Python lists: read as literals, never run; written exactly."""

import numpy as np
import pytest
from hypothesis import given, settings

from nao_sim.errors import UsageError
from nao_sim.motion import JointTrajectory
from nao_sim.recordings import load
from nao_sim.recordings.angles.choregraphe_python import python_text
from nao_sim.robot import load_robot
from tests.motions import trajectories
from tests.recordings.samples import EXPORT

ROBOT = load_robot()
YAW, ELBOW, HAND = (ROBOT.index[name] for name in ("HeadYaw", "LElbowRoll", "LHand"))
BEZIER = """\
# Choregraphe bezier export in Python.
names = list()
times = list()
keys = list()

names.append("LElbowRoll")
times.append([0.92, 1.52, 2.36])
keys.append([[-0.829141, [3, -0.32, 0], [3, 0.2, 0]], [0.150098, [3, -0.2, -0.287302], [3, 0.28, 0.402222]], \
[1.23943, [3, -0.28, 0], [3, 0, 0]]])
"""


def straight(names, times, keys):
    """The three lists, straight between keys."""
    linear = [[[value, [1, 0, 0], [1, 0, 0]] for value in row] for row in keys]
    return f"names = {names}\ntimes = {times}\nkeys = {linear}\n"


def test_a_simplified_export_loads_with_its_times_and_joints(write):
    recording = load(write(EXPORT))
    motion = recording.motion
    assert recording.format == "Choregraphe Python lists" and recording.frames == 2
    assert recording.reason == "it fills lists called names, times and keys"
    assert (motion.times[0], motion.times[-1], len(motion)) == (0.4, 1.4, 51)
    assert motion.positions[[0, -1], YAW].tolist() == [0.1, -0.2] and set(motion.positions[:, HAND]) == {0.5}
    assert motion.given.sum() == 2
    assert recording.notes == ("curves between keys sampled at 50 Hz", "joints hold their first key until its time")


def test_handles_are_followed_and_are_those_of_keys_without(write):
    """Choregraphe writes out the handles that NAOqi gives to keys that have none."""
    plain = BEZIER[: BEZIER.index("keys.append")] + "keys.append([-0.829141, 0.150098, 1.23943])\n"
    with_handles, without = load(write(BEZIER)).motion, load(write(plain, "plain")).motion
    np.testing.assert_allclose(with_handles.positions[:, ELBOW], without.positions[:, ELBOW], atol=1e-6)


def test_lists_of_joints_on_the_first_line_are_no_header_of_a_table(write):
    motion = load(write("names = ['HeadYaw', 'LHand']\ntimes = [[1.0], [2.0]]\nkeys = [[0.5], [1]]\n")).motion
    assert motion.given.sum() == 2 and motion.positions[-1, HAND] == 1.0


def test_linear_and_constant_handles(write):
    motion = load(write(straight(["HeadYaw"], [[0, 1, 3]], [[0, 0.5, 0.1]]))).motion
    assert motion.times.tolist() == [0.0, 1.0, 3.0] and motion.positions[:, YAW].tolist() == [0.0, 0.5, 0.1]
    held = load(write("names=['HeadYaw']; times=[[0, 1]]; keys=[[[0.2, [0, 0, 0], [0, 0, 0]], 0.9]]")).motion
    assert set(held.positions[:-1, YAW]) == {0.2} and held.positions[-1, YAW] == 0.9


ONE = "names = ['HeadYaw']\ntimes = [[1.0]]\nkeys = [[0.5]]\n"
TWENTY = "names = ['HeadYaw']\ntimes = [[1.0]]\nkeys = [[{}]]\n"


@pytest.mark.parametrize(
    "content",
    [
        ONE,
        ONE.replace("\n", "\r\n"),
        "\ufeff" + ONE,
        ONE.replace("\n", "; "),
        ONE.replace("[[", "[ # the first\n  [  \n").replace("]]", ",],\n]"),
        ONE.replace("[[", "((").replace("]]", ",),)"),
        "class Motion(object):\n    def __init__(self):\n"
        + "".join(f"        self.{row}\n" for row in ONE.split("\n")[:3]),
        "import sys\n" + "x = 1\n" * 3000 + ONE,
        "#!/usr/bin/env python\n" + "# long ago\n" * 900 + ONE,
        "names = list(); names.append(u'HeadYaw')\ntimes = []\ntimes += [[1.0]]\nkeys = []\nkeys.extend([[0.5]])",
        "jointNames = ['HeadYaw']\ntimeLists = [[1.0]]\nangleLists = [[0.5]]\nisAbsolute = True",
        ONE.replace("names", "wave_names2").replace("times", "wave_times2").replace("keys", "wave_keys2"),
        ONE + "# motion.angleInterpolation(names, keys, times, False)\n",
        ONE + 'text = """names.append("Tail")\n"""\nother = \'keys = [1\'\n',
        "timestamps = time.time()\nkeys_pressed = input()\n" + ONE,
        b"import naoqi\n# Zo\xeb\n" + ONE.encode(),
        ONE.replace("'HeadYaw'", '"Head" "Yaw"'),
        TWENTY.format("1/2."),
        TWENTY.format("+0.25 - -.25"),
        TWENTY.format("1e0*5E-1"),
    ],
)
def test_every_way_to_write_the_same_lists_reads_the_same(write, content):
    motion = load(write(content)).motion
    assert motion.times.tolist() == [1.0] and motion.positions[0, YAW] == 0.5


@pytest.mark.parametrize(
    "angle", ["math.radians(20)", "20*almath.TO_RAD", "-20 * -math.pi / 180", "np.deg2rad(20.0)", "radians(+20)"]
)
def test_angles_in_degrees_may_be_turned_to_radians_on_the_spot(write, angle):
    assert load(write(TWENTY.format(angle))).motion.positions[0, YAW] == pytest.approx(np.radians(20.0))


def test_of_several_motions_the_longest_is_read_and_the_others_are_named(write):
    rows = "".join(f"    {row}\n" for row in EXPORT.splitlines()[2:13])
    content = f"def nod():\n{rows}\ndef wave():\n{rows.replace('1.4', '5.4')}\n" + ONE.replace(
        "names", "names1"
    ).replace("times", "times1").replace("keys", "keys1")
    recording = load(write(content))
    assert recording.motion.times[-1] == 5.4 and recording.labels[0].name == "wave"
    assert (
        recording.notes[0]
        == "the longest of 3 motions, line 15 in wave(); not read: line 2 in nod(), line 27 in wave()"
    )


def test_the_program_is_never_run(write, tmp_path):
    mark = tmp_path / "ran"
    run = f"__import__('pathlib').Path({str(mark)!r}).touch()"
    path = write(f"import os\n{run}\nos.system('touch {mark}')\n{ONE}{run}\nif __name__ == '__main__':\n    {run}\n")
    assert load(path).frames == 1
    assert not mark.exists()


def lists(names='["HeadYaw"]', times="[[0.5, 1.0]]", keys="[[0.1, 0.2]]"):
    return f"names = {names}\ntimes = {times}\nkeys = {keys}\n"


MISTAKES = {
    "a call": (lists(keys='[[os.system("touch x"), 0.2]]'), 3, "keys", ["'os.system('touch x')'", "not run"]),
    "an import": (lists(keys="[[__import__('os'), 0.2]]"), 3, "keys", ["'__import__('os')'"]),
    "a call on a line of its own": (lists(keys="[[0.1,\n  f(x)]]"), 4, "keys", ["'f(x)'", "literal"]),
    "a name": (lists(names="joints"), 1, "names", ["'joints'", "literal"]),
    "a comprehension": (lists(times="[[t for t in range(2)]]"), 2, "times", ["literal"]),
    "a lambda": (lists(times="(lambda: [[0.5, 1.0]])()"), 2, "times", ["literal"]),
    "a power": (lists(keys="[[9**9**9, 0.1]]"), 3, "keys", ["'9 ** 9 ** 9'"]),
    "a text times a number": (lists(keys="[['a'*9999999, 0.1]]"), 3, "keys", ["'a'"]),
    "a truth": (lists(keys="[[True, 0.1]]"), 3, "keys", ["'True'"]),
    "a format": (lists(names="[f'{x}']"), 1, "names", ["literal"]),
    "a division by zero": (lists(keys="[[1/0, 0.1]]"), 3, "keys", ["cannot be read"]),
    "too large": (lists(keys=f"[[1{'0' * 400}*1, 0.1]]"), 3, "keys", ["cannot be read"]),
    "not finite": (lists(keys="[[1e999, 0.1]]"), 3, "HeadYaw", ["inf", "finite"]),
    "deep": (lists(keys="[" * 5000 + "]" * 5000), 3, "keys", []),
    "many signs": (lists(keys=f"[[{'-' * 20000}1, 0.1]]"), 3, "keys", []),
    "not Python": (lists(keys="[[0.1 0.2]]"), 3, "keys", ["literal list"]),
    "brackets that do not match": (lists(keys="[[0.1, 0.2)]"), 3, "keys", ["literal list"]),
    "truncated": (lists()[:-4], 3, "keys", ["end of the file", "closing bracket"]),
    "truncated between": (EXPORT[: EXPORT.index("keys.append([0.5")], 3, None, ["2 names", "2 lists of times", "1 of"]),
    "one list missing": (lists().replace("times", "instants"), None, None, ["no list of all three", "names"]),
    "empty lists": ("names = list()\ntimes = list()\nkeys = list()\n", None, None, ["no list of all three"]),
    "no joints": (lists("[]", "[]", "[[]][:0]"), 3, "keys", ["literal"]),
    "unknown joint": (lists('["Tail"]'), 1, "Tail", ["unknown joint", "NAOqi"]),
    "a chain": (lists('["LArm"]'), 1, "LArm", ["unknown joint"]),
    "names that are numbers": (lists("[3]"), 1, "3.0", ["unknown joint"]),
    "names that are one text": (lists('"HeadYaw"'), 1, "names", ["'HeadYaw'", "a list"]),
    "a joint twice": (lists('["LHand", "LHand"]', "[[1], [1]]", "[[1], [1]]"), 1, "LHand", ["another list", "once"]),
    "fewer times": (lists(times="[[0.5]]"), 3, "HeadYaw", ["1 times and 2 keys"]),
    "no keys": (lists(times="[[]]", keys="[[]]"), 3, "HeadYaw", ["0 times and 0 keys"]),
    "a number for a list": (lists(times="[1.0]"), 3, "HeadYaw", ["no list of times"]),
    "time goes back": (lists(times="[[1.0, 0.5]]"), 2, "HeadYaw", ["0.5 s", "after 1 s"]),
    "time stands still": (lists(times="[[1.0, 1.0]]"), 2, "HeadYaw", ["1 s", "after 1 s"]),
    "time before 0": (lists(times="[[-1.0, 1.0]]"), 2, "HeadYaw", ["-1 s", "from 0 s on"]),
    "a time that is text": (lists(times="[['1', 2]]"), 2, "HeadYaw", ["'1'", "finite number"]),
    "a key of two": (lists(keys="[[[0.1, 0.2], 0.1]]"), 3, "HeadYaw", ["key [0.1, 0.2]", "[type, s, rad]"]),
    "an empty key": (lists(keys="[[[], 0.1]]"), 3, "HeadYaw", ["None", "finite"]),
    "one handle": (lists(keys="[[[0.1, [3, 0, 0]], 0.1]]"), 3, "HeadYaw", ["[type, s, rad]"]),
    "a short handle": (lists(keys="[[[0.1, [3, 0], [3, 0, 0]], 0.1]]"), 3, "HeadYaw", ["[type, s, rad]"]),
    "a handle of type 7": (lists(keys="[[[0.1, [7, 0, 0], [3, 0, 0]], 0.1]]"), 3, "HeadYaw", ["type 7", "0, 1, 2"]),
    "a handle backwards": (lists(keys="[[[0.1, [3, 0.5, 0], [3, 0, 0]], 0.1]]"), 3, "HeadYaw", ["0.5 s", "away"]),
    "relative angles": (lists() + "m.angleInterpolation(names, keys, times, False)", 4, None, ["isAbsolute"]),
    "relative by name": (lists() + "isAbsolute = False", 4, None, ["isAbsolute", "absolute"]),
}  # fmt: skip


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_with_its_place_and_what_was_expected(write, told, mistake):
    content, line, column, words = MISTAKES[mistake]
    told(write(content), line, column, *words)


@pytest.mark.parametrize(("options", "word"), [({"unit": "deg"}, "radians"), ({"rate": 30.0}, "no rate")])
def test_options_that_contradict_the_format_are_refused(write, told, options, word):
    path = write(EXPORT)
    told(path, None, None, word, **options)
    assert load(path, unit="rad").frames == 2


def test_other_python_is_not_taken_for_lists(write, told):
    told(write("import os\nprint('hello')\n"), 1, None, "which no reader knows")


@settings(max_examples=40)
@given(motion=trajectories(gaps=False))
def test_what_is_written_is_read_to_the_last_bit(write, motion):
    read = load(write(python_text(motion), "law.py")).motion
    np.testing.assert_array_equal(read.times, motion.times)
    np.testing.assert_array_equal(read.positions, motion.positions)
    np.testing.assert_array_equal(read.given, motion.given)


@settings(max_examples=30)
@given(motion=trajectories(gaps=True))
def test_a_gap_is_no_key_and_every_value_stays(write, motion):
    finite = np.isfinite(motion.positions)
    if not finite.any():
        with pytest.raises(UsageError, match="asks nothing"):
            python_text(motion)
        return
    read = load(write(python_text(motion), "law.py")).motion
    asked = finite.any(axis=1)
    np.testing.assert_array_equal(read.times, motion.times[asked])
    np.testing.assert_array_equal(read.positions[finite[asked]], motion.positions[finite])
    assert np.isfinite(read.positions[:, read.given]).all()


def test_a_long_motion_is_written_in_lines_that_people_can_read():
    positions = np.full((2000, 26), 0.123456789012345)
    text = python_text(JointTrajectory(np.arange(2000) / 50.0, positions))
    assert max(map(len, text.splitlines())) < 220
