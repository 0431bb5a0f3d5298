"""Points become the person they were, in the project's unit and axes, or are refused with a reason."""

from dataclasses import replace
from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim import body
from nao_sim.errors import RecordingError
from nao_sim.motion import Skeleton
from nao_sim.recordings.skeletons import points as module
from nao_sim.recordings.skeletons.layouts import Layout, axis, builtin, swapped
from nao_sim.recordings.skeletons.points import PLANAR, Points, understand
from nao_sim.recordings.source import Source
from tests.people import in_file, people, person

LAYOUTS = {layout.name: layout for layout in builtin()}
SOURCE = Source(Path("somebody.txt"), rate=30.0)
CAMERA = ("-z", "-x", "+y")
SIGNED = [
    tuple(sign + name for sign, name in zip(signs, names, strict=True))
    for names in permutations("xyz")
    for signs in [(a, b, c) for a in "+-" for b in "+-" for c in "+-"]
]


def _handed(axes):
    return np.linalg.det(np.array([axis(signed) for signed in axes]))


RIGHT_HANDED = [axes for axes in SIGNED if _handed(axes) > 0.0]
LEFT_HANDED = [axes for axes in SIGNED if _handed(axes) < 0.0]


def assert_same(found: Skeleton, expected: Skeleton, tolerance: float = 1e-6) -> None:
    for joint in found.joints:
        np.testing.assert_allclose(found.track(joint), expected.track(joint), atol=tolerance, err_msg=joint)


def refused(points: Points, source: Source = SOURCE) -> str:
    with pytest.raises(RecordingError) as caught:
        understand(source, points)
    assert str(caught.value).startswith(str(source.path)) and "\n" not in str(caught.value)
    return str(caught.value)


@settings(max_examples=60)
@given(
    someone=people(),
    layout=st.sampled_from(builtin()),
    unit=st.sampled_from([1.0, 0.01, 0.001, 0.0254]),
    axes=st.sampled_from(RIGHT_HANDED),
)
def test_whatever_order_unit_and_axes_the_person_is_the_same(someone, layout, unit, axes):
    understood = understand(SOURCE, Points(in_file(someone, layout.joints, unit, axes)))
    assert layout.name in understood.reason
    assert set(understood.skeleton.joints) == set(layout.columns)
    assert_same(understood.skeleton, someone)


@settings(max_examples=25)
@given(
    someone=people(facing=1.1),
    layout=st.sampled_from(builtin()),
    axes=st.sampled_from([*RIGHT_HANDED, *LEFT_HANDED]),
    unit=st.sampled_from([1.0, 0.001]),
)
def test_axes_that_a_format_tells_hold_even_left_handed_ones(someone, layout, axes, unit):
    understood = understand(SOURCE, Points(in_file(someone, layout.joints, unit, axes), axes=axes))
    assert_same(understood.skeleton, someone)


@settings(max_examples=25)
@given(someone=people(), axes=st.sampled_from(LEFT_HANDED), order=st.permutations(body.joints()))
def test_left_handed_axes_that_nobody_tells_are_found_by_toes_and_nose(someone, axes, order):
    understood = understand(SOURCE, Points(in_file(someone, tuple(order), axes=axes), names=tuple(order)))
    assert any("left-handed" in note for note in understood.notes)
    assert_same(understood.skeleton, someone)


@settings(max_examples=20)
@given(someone=people(), layout=st.sampled_from([LAYOUTS["Kinect v1 (SDK order)"], LAYOUTS["Kinect v2"]]))
def test_sides_named_as_the_viewer_sees_them_are_exchanged(someone, layout):
    values = in_file(someone, swapped(layout.joints), axes=CAMERA)
    for points in (Points(values), Points(values, names=layout.joints, axes=CAMERA)):
        understood = understand(SOURCE, points)
        assert any("viewer" in note for note in understood.notes)
        assert_same(understood.skeleton, someone)


@settings(max_examples=20)
@given(someone=people(arms=0.0), layout=st.sampled_from(builtin()), turn=st.sampled_from([0.5, 1.0, 1.5, 2.0]))
def test_whoever_faces_elsewhere_is_turned_to_face_forward(someone, layout, turn):
    angle = turn * np.pi
    turned = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    elsewhere = Skeleton(someone.times, someone.positions @ turned.T, someone.joints)
    assert_same(understand(SOURCE, Points(in_file(elsewhere, layout.joints))).skeleton, someone)


@settings(max_examples=20)
@given(seed=st.integers(0, 999), layout=st.sampled_from(builtin()), data=st.data())
def test_an_order_that_nobody_knows_is_refused(seed, layout, data):
    order = data.draw(st.permutations(range(len(layout))))
    moved = sum(layout.joints[a] != layout.joints[b] for a, b in enumerate(order))
    values = in_file(person(40, seed), layout.joints)[:, order]
    if moved > len(layout) / 2:
        message = refused(Points(values))
        assert "--layout" in message and layout.name in message


@settings(max_examples=20)
@given(someone=people(frames=90), layout=st.sampled_from(builtin()), seed=st.integers(0, 999))
def test_noise_spikes_and_dropouts_never_make_another_person_of_it(someone, layout, seed):
    random = np.random.default_rng(seed)
    values = in_file(someone, layout.joints) + random.normal(0.0, 0.01, (90, len(layout), 3))
    values[random.random((90, len(layout))) < 0.04] += random.normal(0.0, 1.0, 3)
    values[random.random((90, len(layout))) < 0.2] = 0.0
    values[random.random((90, len(layout))) < 0.1] = np.nan
    try:
        understood = understand(SOURCE, Points(values))
    except RecordingError as error:  # too spoilt to tell it from another order of as many points: both are named
        assert "several layouts" in str(error) and layout.name in str(error)
        return
    expected = someone.positions[:, [someone.joints.index(joint) for joint in understood.skeleton.joints]]
    assert layout.name in understood.reason and len(understood.skeleton) == 90
    assert np.nanmedian(np.abs(understood.skeleton.positions - expected)) < 0.02


@pytest.mark.parametrize(
    "layout", [LAYOUTS["Kinect v1 (SDK order)"], LAYOUTS["Azure Kinect"], LAYOUTS["MediaPipe pose"]]
)
@pytest.mark.parametrize("missing", [("knee", "ankle", "foot", "heel"), ("knee", "ankle", "foot", "heel", "hip")])
def test_an_upper_body_is_a_person(layout, missing):
    someone = person(60, 3)
    values = in_file(someone, layout.joints)
    gone = [place for place, joint in enumerate(layout.joints) if joint.partition("_")[2] in missing]
    values[:, gone] = 0.0
    understood = understand(SOURCE, Points(values))
    assert layout.name in understood.reason
    assert np.isnan(understood.skeleton.track("left_knee")).all()
    np.testing.assert_allclose(understood.skeleton.track("left_wrist"), someone.track("left_wrist"), atol=1e-9)


def test_weak_signs_of_the_front_change_nothing():
    still = person(40, 1, arms=0.0, joints=("head", "neck", "left_shoulder", "right_shoulder", "pelvis"))
    mirrored = in_file(still, still.joints, axes=("-z", "+x", "+y"))
    understood = understand(SOURCE, Points(mirrored, names=still.joints))
    assert understood.notes == ("no times: 30 frames a second, as told",)


def test_a_back_turned_to_axes_that_a_format_tells_is_a_back():
    joints = ("head", "neck", "left_shoulder", "right_shoulder", "left_elbow", "right_elbow", "pelvis")
    someone = person(40, 1, arms=0.0, facing=np.pi)
    understood = understand(SOURCE, Points(in_file(someone, joints), names=joints, axes=CAMERA))
    assert "the person faces away from -z" in understood.notes
    assert_same(understood.skeleton, someone)


def test_two_orders_that_fit_alike_are_both_named(monkeypatch):
    order = ("head", "neck", "spine", "left_shoulder", "right_shoulder", "left_elbow", "right_elbow", "left_hip")
    order += ("right_hip",)
    twins = (Layout("left first", order), Layout("right first", swapped(order)))
    monkeypatch.setattr(module, "builtin", lambda: twins)
    message = refused(Points(in_file(person(40, 1, arms=0.0), order)))
    assert "several layouts" in message and all(layout.name in message for layout in twins) and "--layout" in message


def test_numbers_that_are_no_body_are_refused_with_what_is_wrong():
    message = refused(Points(np.random.default_rng(0).normal(size=(50, 20, 3))))
    assert "no body by any layout" in message and "Kinect v1" in message and " m against " in message


def test_a_number_of_points_that_no_layout_has_names_those_that_are_known():
    message = refused(Points(np.ones((5, 7, 3))))
    assert "7 points a frame of no known layout" in message and "24, 25, 32" in message


def test_two_hands_are_no_skeleton():
    values = in_file(person(20, 0), ("left_hand", "right_hand"))
    assert "no two shoulders" in refused(Points(values, names=("left_hand", "right_hand")))


def test_names_that_are_no_joints_are_left_out_and_told():
    someone = person(30, 2)
    names = ("Head", "ShoulderLeft", "ShoulderRight", "HipCenter", "Sword", "ElbowLeft", "elbow_l")
    joints = ("head", "left_shoulder", "right_shoulder", "pelvis", "nose", "left_elbow", "left_wrist")
    understood = understand(SOURCE, Points(in_file(someone, joints), names=names))
    assert understood.skeleton.joints == ("head", "left_shoulder", "right_shoulder", "pelvis", "left_elbow")
    assert "left out, their names are not known: Sword" in understood.notes
    assert "left out, another point is that joint: elbow_l" in understood.notes
    assert "names" in refused(Points(in_file(someone, joints), names=tuple("abcdefg")))


def test_a_layout_of_ones_own_may_name_the_points_of_each_joint(tmp_path):
    path = tmp_path / "markers.toml"
    path.write_text(
        '[names]\nhead = "HDTP"\nleft_shoulder = "A"\nright_shoulder = "B"\npelvis = "C"\nleft_wrist = ["W1", "w2"]\n'
    )
    source = Source(Path("somebody.c3d"), rate=30.0, layout=path)
    someone = person(30, 2)
    values = in_file(someone, ("left_wrist", "left_wrist", "pelvis", "right_shoulder", "left_shoulder", "head"))
    values[:, 0, 0] += 0.02
    values[:, 1, 0] -= 0.02
    understood = understand(source, Points(values, names=("W1", "W2", "c", "b", "a", "hdtp")))
    assert set(understood.skeleton.joints) == {"head", "left_shoulder", "right_shoulder", "pelvis", "left_wrist"}
    assert_same(understood.skeleton, someone)
    assert "no points named A" in refused(Points(values[:, :4], names=("W1", "W2", "C", "HDTP")), source)


def test_the_reason_names_order_unit_axes_and_what_told_the_front():
    values = in_file(person(40, 1), LAYOUTS["Kinect v2"].joints, 0.001)
    reason = understand(SOURCE, Points(values)).reason
    assert reason.startswith("joints in the order of Kinect v2; unit mm (upper arm 0.29 m); forward -z, left -x, up +y")
    assert "front by toes" in reason


def test_the_bones_of_a_rig_begin_at_their_joints():
    joints = (
        "pelvis",
        "head",
        "left_shoulder",
        "left_elbow",
        "left_wrist",
        "right_shoulder",
        "right_elbow",
        "right_wrist",
    )
    names = ("Hips", "Head", "LeftArm", "LeftForeArm", "LeftHand", "RightArm", "RightForeArm", "RightHand")
    someone = person(30, 2)
    understood = understand(SOURCE, Points(in_file(someone, joints), names=names))
    assert understood.skeleton.joints == joints
    assert_same(understood.skeleton, someone)


def test_points_at_zero_are_missing_and_so_are_those_of_no_confidence():
    someone, layout = person(30, 2), LAYOUTS["Kinect v1 (SDK order)"]
    values, confidence = in_file(someone, layout.joints), np.full((30, 20), 0.5)
    values[5, 4], confidence[6, 4] = 0.0, 0.0
    skeleton = understand(SOURCE, Points(values, confidence=confidence)).skeleton
    missing = np.isnan(skeleton.track("left_shoulder")).any(axis=1)
    assert np.flatnonzero(missing).tolist() == [5, 6]
    assert skeleton.confidence[:, 4].tolist() == [0.0 if frame in (5, 6) else 0.5 for frame in range(30)]
    kept = understand(SOURCE, Points(values, frozen_is_missing=False)).skeleton
    assert np.isfinite(kept.positions).all()


def test_confidences_that_are_all_zero_are_not_believed():
    layout = LAYOUTS["Kinect v1 (SDK order)"]
    points = Points(in_file(person(30, 2), layout.joints), confidence=np.zeros((30, 20)))
    understood = understand(SOURCE, points)
    assert (understood.skeleton.confidence == 1.0).all() and any("not used" in note for note in understood.notes)


def test_frames_without_anybody_are_left_out_at_the_ends_and_stay_between():
    layout = LAYOUTS["Kinect v1 (SDK order)"]
    values = in_file(person(30, 2), layout.joints)
    values[[0, 1, 12, 29]] = 0.0
    understood = understand(SOURCE, Points(values))
    assert len(understood.skeleton) == 27 and understood.skeleton.times[0] == 0.0
    assert np.isnan(understood.skeleton.positions[10]).all()
    assert "3 frames at the ends without anybody left out" in understood.notes
    assert "no tracked point" in refused(Points(np.zeros((5, 20, 3))))
    assert "no frames" in refused(Points(np.zeros((0, 20, 3))))


def test_a_unit_that_the_bones_belie_is_corrected_and_told():
    layout = LAYOUTS["Kinect v2"]
    someone = person(30, 2)
    understood = understand(SOURCE, Points(in_file(someone, layout.joints, unit=0.001), unit=1.0))
    assert "not m but mm, by the bones" in understood.notes
    assert_same(understood.skeleton, someone)


def test_a_body_of_no_unit_is_made_an_adult():
    layout = LAYOUTS["Kinect v2"]
    someone = person(30, 2, height=1.7)
    understood = understand(SOURCE, Points(in_file(someone, layout.joints, unit=17.0)))
    assert any("scaled to an adult of 1.70 m" in note for note in understood.notes)
    assert_same(understood.skeleton, someone, 0.01)


def test_an_up_that_the_body_belies_is_corrected_and_told():
    someone, layout = person(30, 2), LAYOUTS["Kinect v2"]
    understood = understand(SOURCE, Points(in_file(someone, layout.joints, axes=("+x", "+y", "+z")), axes=CAMERA))
    assert "up is not +y but +z, from pelvis to head" in understood.notes
    assert_same(understood.skeleton, someone)


@pytest.mark.parametrize("unit", [0.003, 1.0, 100.0])
def test_one_camera_gives_the_frontal_plane_with_an_adults_trunk(unit):
    someone = person(40, 4)
    layout = LAYOUTS["OpenPose BODY_25"]
    values = in_file(someone, layout.joints, unit, ("-z", "+x", "-y"))
    for third in (0.0, np.nan, 5.0):
        values[:, :, 2] = third
        understood = understand(SOURCE, Points(values, planar=third == 5.0))
        skeleton = understood.skeleton
        assert skeleton.planar and PLANAR in understood.notes
        assert (skeleton.positions[:, :, 0] == 0.0).all()
        shoulders, hips = (
            (skeleton.track(f"left_{part}") + skeleton.track(f"right_{part}")) / 2 for part in ("shoulder", "hip")
        )
        assert np.median(np.linalg.norm(shoulders - hips, axis=1)) == pytest.approx(0.29 * 1.7)
        assert (skeleton.track("left_shoulder") - skeleton.track("right_shoulder"))[:, 1].min() > 0.0


def _timed(times, source=SOURCE, **told):
    layout = LAYOUTS["Kinect v1 (SDK order)"]
    values = in_file(person(len(times), 2), layout.joints)
    return understand(source, Points(values, times=np.array(times, float), **told))


SILENT = Source(Path("somebody.txt"))


@pytest.mark.parametrize(
    ("times", "seconds", "unit"),
    [
        (5.0 + np.arange(10) / 30.0, np.arange(10) / 30.0, None),
        (np.arange(10) * 33.0, np.arange(10) * 0.033, "ms"),
        (1e6 + np.arange(10) * 33_333.0, np.arange(10) * 0.033_333, "us"),
        (9e11 + np.arange(10) * 333_333.0, np.arange(10) * 0.033_333_3, "100ns"),
        (np.arange(10) * 33_333_333.0, np.arange(10) * 0.033_333_333, "ns"),
        (np.arange(10) * 0.9 + 0.5, np.arange(10) * 0.9, "seconds"),
    ],
)
def test_times_are_told_by_the_frame_rate_they_give(times, seconds, unit):
    understood = _timed(times, SILENT)
    np.testing.assert_allclose(understood.skeleton.times, seconds, atol=1e-9)
    assert any("times" in note for note in understood.notes) == (unit is not None)
    assert unit is None or any(unit in note for note in understood.notes)


def test_who_tells_the_rate_is_said(tmp_path):
    layout = LAYOUTS["Kinect v1 (SDK order)"]
    (tmp_path / "my.toml").write_text(f"joints = {list(layout.joints)}\nrate = 25")
    values = in_file(person(8, 2), layout.joints)
    (note,) = [note for note in understand(replace(SILENT, layout=tmp_path / "my.toml"), Points(values)).notes
               if "25 frames a second" in note]  # fmt: skip
    assert "my.toml" in note and "usual" not in note
    (note,) = [note for note in understand(SILENT, Points(values)).notes if "30 frames a second" in note]
    assert "usual" in note


def test_an_odd_unit_is_told_by_its_size():
    values = in_file(person(8, 2), LAYOUTS["Kinect v2"].joints, 0.0564444)
    reason = understand(SOURCE, Points(values, unit=0.0564444)).reason
    assert "; units of 0.0564444 m (" in reason and "unit units" not in reason


def test_frame_numbers_need_a_rate_and_may_jump():
    numbers = [5, 6, 8, 9, 11, 12, 14, 15]
    np.testing.assert_allclose(_timed(numbers).skeleton.times, (np.array(numbers) - 5) / 30.0)
    understood = _timed(numbers, SILENT)
    assert any("as usual for such files" in note for note in understood.notes)
    layout = Layout("no rate", LAYOUTS["Kinect v1 (SDK order)"].joints)
    values = in_file(person(8, 2), layout.joints)
    assert "--rate" in refused(Points(values, times=np.array(numbers, float), layout=layout), SILENT)
    assert "no times" in refused(Points(values, layout=layout), SILENT)


def test_times_that_may_be_in_two_units_are_refused():
    with pytest.raises(RecordingError, match=r"10 Hz in us or 100 Hz in 100ns; expected a time_unit"):
        _timed(np.arange(10) * 100_000.0, SILENT)
    np.testing.assert_allclose(
        _timed(np.arange(10) * 1e5, SILENT, time_unit=1e-7).skeleton.times, np.arange(10) / 100.0
    )


def test_a_unit_of_times_that_is_told_holds():
    np.testing.assert_allclose(_timed(np.arange(10), SILENT, time_unit=1.0).skeleton.times, np.arange(10))
    np.testing.assert_allclose(_timed(np.arange(10) * 40, time_unit=0.0).skeleton.times, np.arange(10) * 40 / 30.0)


def test_repeated_times_are_left_out_and_counted():
    understood = _timed([0.0, 0.1, 0.1, 0.1, 0.2], SILENT)
    np.testing.assert_allclose(understood.skeleton.times, [0.0, 0.1, 0.2])
    assert "2 frames at the time of the one before left out" in understood.notes


@pytest.mark.parametrize(("bad", "word"), [(0.05, "expected a time after 0.1"), (np.nan, "a finite time")])
def test_times_that_go_back_or_are_none_are_refused_with_their_line(bad, word):
    layout = LAYOUTS["Kinect v1 (SDK order)"]
    values = in_file(person(4, 2), layout.joints)
    points = Points(values, times=np.array([0.0, 0.1, bad, 0.3]), lines=(3, 4, 6, 7))
    message = refused(points, SILENT)
    assert "line 6, column time" in message and word in message


def test_times_and_a_rate_contradict_each_other():
    with pytest.raises(RecordingError, match="times and a rate of 30 Hz"):
        _timed([0.0, 0.1, 0.2])
