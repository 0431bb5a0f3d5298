"""Webots motions: times, radians, phalanges and poses that leave a joint alone."""

import numpy as np
import pytest

from nao_sim.errors import RecordingError
from nao_sim.recordings import load
from nao_sim.robot import facts, load_robot

ROBOT = load_robot()
OPEN = facts()["hand"]["finger_joints"][0]["multiplier"]
GOOD = (
    "#WEBOTS_MOTION,V1.0,HeadYaw,LElbowRoll,RPhalanx1,RPhalanx2\n"
    "00:00:500,start,0.1,-0.5,0,0\n"
    f"01:02:003,end,*,-1.0,{OPEN},{OPEN / 2}\n"
)


@pytest.fixture
def motion(tmp_path):
    def motion(content):
        path = tmp_path / "x.motion"
        path.write_bytes(content.encode())
        return path

    return motion


@pytest.mark.parametrize("content", [GOOD, GOOD.replace("\n", "\r\n"), "\ufeff" + GOOD, GOOD + "\n\n"])
def test_poses_become_frames_at_their_times(motion, content):
    recording = load(motion(content))
    read = recording.motion
    assert recording.format == "Webots motion" and recording.frames == 2
    assert recording.reason == "the first line starts with #WEBOTS_MOTION"
    assert [(label.name, label.start) for label in recording.labels] == [("start", 0.5), ("end", 62.003)]
    np.testing.assert_allclose(read.times, [0.5, 62.003])
    np.testing.assert_allclose(read.positions[:, ROBOT.index["LElbowRoll"]], [-0.5, -1.0])
    np.testing.assert_allclose(read.positions[:, ROBOT.index["HeadYaw"]], [0.1, np.nan])
    np.testing.assert_allclose(read.positions[:, ROBOT.index["RHand"]], [0.0, 0.75])
    assert read.given.sum() == 3


def test_an_opening_stays_between_closed_and_open(motion):
    path = motion("#WEBOTS_MOTION,V1.0,LPhalanx1\n00:00:000,a,-0.2\n00:01:000,b,1.3\n")
    np.testing.assert_array_equal(load(path).motion.positions[:, ROBOT.index["LHand"]], [0.0, 1.0])


LINE = "00:00:500,start,0.1,-0.5,0,0"
MISTAKES = {
    "version": (GOOD.replace("V1.0", "V2.0"), 1, None, ["#WEBOTS_MOTION,V2.0", "#WEBOTS_MOTION,V1.0"]),
    "only the magic word": ("#WEBOTS_MOTION\n", 1, None, ["'#WEBOTS_MOTION'", "V1.0"]),
    "no joints": ("#WEBOTS_MOTION,V1.0\n00:00:000,a\n", 1, None, ["no joints", "joint names"]),
    "unknown joint": (GOOD.replace("HeadYaw", "Tail"), 1, "Tail", ["unknown joint", "NAOqi names"]),
    "a hand": (GOOD.replace("HeadYaw", "LHand"), 1, "LHand", ["unknown joint", "LPhalanx1"]),
    "a joint twice": (GOOD.replace("HeadYaw", "LElbowRoll"), 1, "LElbowRoll", ["twice", "once"]),
    "no poses": (GOOD.splitlines()[0] + "\n", 1, None, ["no poses", "at least one pose"]),
    "bad time": (GOOD.replace("00:00:500", "0.5"), 2, "time", ["'0.5'", "MM:SS:mmm"]),
    "time goes back": (GOOD.replace("01:02:003", "00:00:400"), 3, "time", ["0.4 s", "after 0.5 s"]),
    "text": (GOOD.replace("-0.5", "far"), 2, "LElbowRoll", ["'far'", "a number"]),
    "empty": (GOOD.replace("-0.5", ""), 2, "LElbowRoll", ["an empty cell", "radians, or *"]),
    "nan": (GOOD.replace("-0.5", "nan"), 2, "LElbowRoll", ["'nan'", "radians, or *"]),
    "short": (GOOD.replace(LINE, LINE[:-2]), 2, None, ["5 values", "6 values"]),
    "truncated": (GOOD[:-30], 3, None, ["2 values", "6 values"]),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_with_its_place_and_what_was_expected(motion, told, mistake):
    content, line, column, words = MISTAKES[mistake]
    told(motion(content), line, column, *words)


@pytest.mark.parametrize(("options", "word"), [({"unit": "deg"}, "radians"), ({"rate": 30.0}, "no rate")])
def test_options_that_contradict_the_format_are_refused(motion, options, word):
    path = motion(GOOD)
    with pytest.raises(RecordingError, match=word):
        load(path, **options)
    assert load(path, unit="rad").frames == 2
