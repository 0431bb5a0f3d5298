"""Tables with one point a row."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.errors import RecordingError
from nao_sim.recordings import load
from tests.landmark_files import BODY, HANDS, dicts, numbers, same_places, seen
from tests.people import in_file, person

KINECT = {"head": "Head", "left_shoulder": "ShoulderLeft", "right_shoulder": "ShoulderRight", "left_elbow": "ElbowLeft",
          "right_elbow": "ElbowRight", "left_wrist": "WristLeft", "right_wrist": "WristRight", "pelvis": "SpineBase",
          "left_hip": "HipLeft", "right_hip": "HipRight"}  # fmt: skip
JOINTS = tuple(KINECT)


def rows(skeleton, order=tuple(range(10)), who=""):
    """Rows of frame, joint, x, y, z; frames are numbered from 3."""
    places = in_file(skeleton, JOINTS).tolist()
    return [[*([who] if who else []), str(3 + i), KINECT[JOINTS[j]], *map(repr, frame[j])]
            for i, frame in enumerate(places) for j in order]  # fmt: skip


def text(header, table):
    return "\n".join([header, *(",".join(row) for row in table)]) + "\n"


@settings(max_examples=12, deadline=None)
@given(seed=st.integers(0, 99), order=st.permutations(range(len(JOINTS))))
def test_joints_may_come_in_any_order(tmp_path_factory, seed, order):
    expected = person(5, seed)
    path = tmp_path_factory.mktemp("law") / "x.csv"
    path.write_text(text("frame,joint,x,y,z", rows(expected, order)))
    recording = load(path)
    assert recording.format == "table of one point a row" and recording.frames == 5
    same_places(recording.motion, expected, JOINTS)
    np.testing.assert_allclose(recording.motion.times, np.arange(5) / 30)


def test_a_frame_without_a_number_ends_where_a_point_comes_again(write):
    expected = person(4)
    table = [row[1:] for row in rows(expected)]
    same_places(load(write(text("joint,x,y,z", table))).motion, expected, JOINTS)


@pytest.mark.parametrize("mark", [", ", " ", "\t", ";"])
@pytest.mark.parametrize("state", [(), ("Tracked",)])
def test_rows_without_a_header_name_their_joints(write, mark, state):
    expected = person(5)
    table = [[str(33 * int(row[0])), row[1], *state, *row[2:]] for row in rows(expected)]
    skeleton = load(write("".join(mark.join(row) + "\n" for row in table))).motion
    same_places(skeleton, expected, JOINTS)
    np.testing.assert_allclose(skeleton.times, np.arange(5) * 0.033)
    same_places(load(write("".join(mark.join(row[1:]) + "\n" for row in table))).motion, expected, JOINTS)


def test_rows_of_several_people_without_a_header_are_refused(write):
    table = [row for i in range(4) for row in rows(person(4))[10 * i : 10 * i + 10] * 2]
    with pytest.raises(RecordingError, match="'Head' twice"):
        load(write("".join(",".join(row) + "\n" for row in table)))


def test_points_that_are_not_there_are_missing(write):
    table = [row for row in rows(person(4)) if row[:2] != ["5", "ElbowLeft"]]
    skeleton = load(write(text("frame,joint,x,y,z", table))).motion
    assert np.isfinite(skeleton.track("left_elbow")).all(axis=1).tolist() == [True, True, False, True]


def test_body_and_hands_of_mediapipe_by_type_and_number(write):
    expected = seen(6)
    table = [[str(i), kind, str(j), *(repr(point[axis]) for axis in "xyz")]
             for i in range(6)
             for kind, joints in (("pose", BODY), ("left_hand", HANDS["left"]), ("face", BODY[:5]))
             for j, point in enumerate(dicts(numbers(expected, joints)[i]))]  # fmt: skip
    skeleton = load(write(text("frame,type,landmark_index,x,y,z", table))).motion
    same_places(skeleton, expected, (*BODY, *HANDS["left"]), 5e-3)


def test_of_several_people_one_is_read(write):
    first, second = rows(person(6, 1), who="first"), rows(person(6, 2), who="second")[20:]
    table = sorted(first + second, key=lambda row: int(row[1]))
    path = write(text("person,frame,joint,x,y,z", table))
    same_places(load(path).motion, person(6, 1), JOINTS)
    assert len(load(path, person="second").motion) == 4
    with pytest.raises(RecordingError, match="no person 'ninth'"):
        load(path, person="ninth")


@pytest.mark.parametrize(
    ("change", "line", "words"),
    [
        (lambda t: t[7].__setitem__(2, "far"), 9, ["'far'", "column x"]),
        (lambda t: t[7].pop(), 9, ["4 values", "5 values"]),
        (lambda t: t[7].__setitem__(1, t[6][1]), 9, ["twice"]),
        (lambda t: t.clear(), 1, ["no rows"]),
        (lambda t: [row.__setitem__(0, str(-int(row[0]))) for row in t], 12, ["-4", "after -3"]),
    ],
)
def test_a_mistake_is_told_with_its_line(write, change, line, words):
    table = rows(person(4))
    change(table)
    with pytest.raises(RecordingError) as caught:
        load(write(text("frame,joint,x,y,z", table)))
    assert caught.value.line == line and all(word in str(caught.value) for word in words), str(caught.value)


def test_points_that_are_no_body_are_told(write):
    with pytest.raises(RecordingError, match="Ball"):
        load(write("frame,marker,x,y,z\n1,Ball,1,2,3\n2,Ball,1,2,3\n"))
