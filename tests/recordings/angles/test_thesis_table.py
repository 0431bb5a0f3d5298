"""The thesis's training table: postures from features, shown one after the other."""

import numpy as np
import pytest

from nao_sim.errors import RecordingError
from nao_sim.paths import TRAJECTORIES
from nao_sim.recordings import load
from nao_sim.recordings.angles.thesis_table import COMFORTABLE, HOLD, RATE, in_sequence
from nao_sim.robot import load_robot

ROBOT = load_robot()
HEADER = "RSR,RSP,RER,REY,RH,LSR,LSP,LER,LEY,LH,Behavior\n"
FORWARD = "0,0,180,0,0,0,0,180,0,0,forward\n"
PI_UP = "60,0,90,0,90,-60,0,90,0,90,piUp\n"


@pytest.fixture
def table(tmp_path):
    def table(content):
        path = tmp_path / "table.csv"
        path.write_text(content)
        return path

    return table


def at(recording, label):
    """The posture in degrees half way through a hold."""
    positions = recording.motion.sample(np.array([(label.start + label.end) / 2.0]))[0]
    return {name: round(float(np.degrees(positions[i])), 6) + 0.0 for name, i in ROBOT.index.items()}


def test_rows_become_postures_with_labels(table):
    recording = load(table(HEADER + FORWARD + PI_UP))
    assert recording.format == "thesis table" and recording.frames == 2
    assert recording.reason == "the header names 10 of the thesis's ten features"
    assert [label.name for label in recording.labels] == ["forward", "piUp"]
    forward, pi_up = (at(recording, label) for label in recording.labels)
    assert forward["LShoulderPitch"] == forward["LShoulderRoll"] == forward["LElbowRoll"] == 0.0
    assert (pi_up["LShoulderPitch"], pi_up["LShoulderRoll"]) == (0.0, 60.0)
    assert (pi_up["RShoulderPitch"], pi_up["RShoulderRoll"]) == (0.0, -60.0)
    assert (pi_up["LElbowYaw"], pi_up["LElbowRoll"]) == (-90.0, -90.0)
    assert (pi_up["RElbowYaw"], pi_up["RElbowRoll"]) == (90.0, 90.0)
    assert recording.motion.given.sum() == 8


def test_the_motion_starts_with_the_first_hold_and_ends_with_the_last(table):
    recording = load(table(HEADER + FORWARD + PI_UP))
    motion, (first, last) = recording.motion, recording.labels
    assert motion.times[0] == first.start == 0.0 and first.end == HOLD
    assert last.end == pytest.approx(motion.times[-1]) and last.end - last.start == pytest.approx(HOLD)
    for label in (first, last):
        held = motion.positions[(motion.times >= label.start - 1e-9) & (motion.times <= label.end + 1e-9)]
        assert np.ptp(held[:, motion.given], axis=0).max() < 1e-12


def test_the_way_between_postures_is_comfortable_and_smooth(table):
    positions = load(TRAJECTORIES / "thesis_table_a1.csv").motion.positions
    speed = np.diff(positions[:, np.isfinite(positions).all(axis=0)], axis=0) * RATE
    assert np.abs(speed).max() <= COMFORTABLE * 1.001
    assert np.abs(np.diff(speed, axis=0) * RATE).max() < 5.7735 * COMFORTABLE / 1.875 / 0.8 * 1.05


def test_a_sequence_of_one_posture_is_its_hold():
    holds, motion = in_sequence(np.zeros((1, 26)))
    assert holds == [(0.0, HOLD)] and motion.duration == pytest.approx(HOLD) and motion.given.all()


def test_columns_come_in_any_order_and_case_and_labels_are_optional(table):
    names, cells = HEADER.strip().split(","), PI_UP.strip().split(",")
    expected = load(table(HEADER + PI_UP)).motion.positions
    shuffled = ",".join(name.lower() for name in names[::-1]) + "\n" + ",".join(cells[::-1]) + "\n"
    np.testing.assert_array_equal(load(table(shuffled)).motion.positions, expected)
    bare = load(table(",".join(names[:-1]) + "\n" + ",".join(cells[:-1]) + "\n"))
    np.testing.assert_array_equal(bare.motion.positions, expected)
    assert bare.labels == ()
    number = load(table(HEADER.replace("Behavior", "y") + PI_UP.replace("piUp", "2.237")))
    assert number.labels[0].name == "2.237"


def test_the_published_table_loads_and_tells_of_its_broken_rows():
    recording = load(TRAJECTORIES / "thesis_table_a1.csv")
    assert recording.frames == len(recording.labels) == 28
    assert [label.name for label in recording.labels[:5]] == ["side", "forward", "piUp", "up", "down"]
    (note,) = recording.notes
    lines = (TRAJECTORIES / "thesis_table_a1.csv").read_text().splitlines()
    broken = [lines.index("51,-7,40,-40,-28,-2,-46,37,-4,53,side") + 1]
    broken += [k + 1 for k, line in enumerate(lines) if line.startswith("5,-30,64,0,0,12,-48,37,-19,48")]
    assert len(broken) == 3 and all(f"{line} (" in note for line in broken) and note.count("(") == 3


def test_the_published_gestures_have_the_posture_of_their_name():
    recording = load(TRAJECTORIES / "thesis_table_a1.csv")
    side, forward, pi_up, up, down = (at(recording, label) for label in recording.labels[:5])
    assert side["LShoulderRoll"] > 70.0 and side["RShoulderRoll"] < -70.0
    assert abs(forward["RShoulderPitch"]) < 25.0 and forward["RElbowRoll"] < 30.0
    assert pi_up["LElbowRoll"] < -70.0 and pi_up["RElbowRoll"] > 70.0
    assert up["LShoulderPitch"] < -70.0 and up["RShoulderPitch"] < -70.0
    assert down["LShoulderPitch"] > 70.0 and down["RShoulderPitch"] > 70.0


MISTAKES = {
    "text": (HEADER + FORWARD.replace("180", "far", 1), 2, "RER", ["'far'", "a number"]),
    "empty": (HEADER + FORWARD.replace("180", "", 1), 2, "RER", ["an empty cell", "a finite angle"]),
    "not finite": (HEADER + FORWARD.replace("180", "nan", 1), 2, "RER", ["'nan'", "a finite angle"]),
    "short": (HEADER + FORWARD + "1,2,3\n", 3, None, ["3 values", "11 values"]),
    "no rows": (HEADER, 1, None, ["no rows", "at least one row"]),
    "missing": (HEADER.replace("RSP,", "") + FORWARD, 1, None, ["no column RSP", "all ten"]),
    "unknown": (HEADER.replace("Behavior", "mood") + FORWARD, 1, "mood", ["unknown column", "Behavior"]),
    "twice": (HEADER.replace("RSP", "rsr") + FORWARD, 1, "rsr", ["'rsr' twice", "once"]),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_with_its_place_and_what_was_expected(table, told, mistake):
    content, line, column, words = MISTAKES[mistake]
    told(table(content), line, column, *words)


@pytest.mark.parametrize(("options", "word"), [({"unit": "rad"}, "degrees"), ({"rate": 30.0}, "without times")])
def test_options_that_contradict_the_format_are_refused(table, options, word):
    path = table(HEADER + FORWARD)
    with pytest.raises(RecordingError, match=word):
        load(path, **options)
    assert load(path, unit="deg").frames == 1
