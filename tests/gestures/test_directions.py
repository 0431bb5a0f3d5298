import numpy as np
import people
import pytest
from gestures.postures import body, held, skeleton
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.gestures.directions import ArmReadings, joined, readings_of_features, readings_of_skeleton
from nao_sim.gestures.reader import FrameReader
from nao_sim.gestures.training_table import thesis_table
from nao_sim.imitation.features import features_of
from nao_sim.motion import Skeleton


@given(people.people(frames=6), st.integers(0, 2**16), st.booleans())
def test_a_frame_by_itself_reads_as_in_its_recording(person, seed, planar):
    random = np.random.default_rng(seed)
    positions = np.where(random.random((*person.positions.shape[:2], 1)) < 0.2, np.nan, person.positions)
    confidence = random.random(positions.shape[:2])
    positions = positions * [0.0, 1.0, 1.0] if planar else positions
    hurt = Skeleton(person.times, positions, person.joints, confidence, planar)
    whole, reader = readings_of_skeleton(hurt), FrameReader(hurt.joints, planar)
    for frame in range(len(hurt)):
        directions, trust, seen = reader.read(hurt.positions[frame], hurt.confidence[frame])
        assert np.allclose(directions, whole.directions[frame], atol=1e-9, equal_nan=True)
        assert np.allclose(trust, whole.trust[frame]) and np.allclose(seen, whole.seen[frame])


def test_an_unsure_or_missing_joint_takes_the_trust_of_its_segments_alone():
    positions, confidence = body(held("side")[None]), np.ones((1, 10))
    joints = skeleton(held("side")[None]).joints
    confidence[0, joints.index("left_elbow")] = 0.1
    confidence[0, joints.index("right_elbow")] = 0.6
    positions[0, joints.index("right_wrist")] = positions[0, joints.index("right_hand")] = np.nan
    trust = readings_of_skeleton(Skeleton(np.zeros(1), positions, joints, confidence)).trust[0]
    assert trust.tolist() == [[0.0, 0.0], [0.6, 0.0]]


def test_a_forearm_on_its_upper_arm_is_no_arm():
    folded = held("side")
    folded[0, 1] = -folded[0, 0]
    assert readings_of_skeleton(skeleton(folded[None])).trust[0].tolist() == [[0.0, 0.0], [1.0, 1.0]]


def test_rows_of_the_thesis_whose_elbow_contradicts_them_are_trusted_less():
    table = thesis_table()
    trust = readings_of_features(table.features).trust
    bad = np.flatnonzero((trust < 1.0).any(axis=(1, 2))) + 1
    assert bad.tolist() == [16, 17, 18] and (trust[bad - 1] < 0.4).all()


def test_features_and_a_skeleton_of_the_same_pose_read_alike():
    directions = np.stack([held("side"), held("piUp", "down"), held("forward", "up")])
    of_rows = readings_of_features(features_of(directions))
    of_body = readings_of_skeleton(skeleton(directions, turn=0.7, height=1.2))
    assert np.allclose(of_rows.directions, of_body.directions) and np.allclose(of_rows.trust, of_body.trust)


def test_short_segments_in_a_picture_count_less():
    directions = np.stack([held("side"), held("side")])
    slanted = np.array([np.sqrt(1 - 0.3**2), 0.3, 0.0])
    directions[1, 0, 1] = slanted
    flat = body(directions) * [0.0, 1.0, 1.0]
    read = readings_of_skeleton(Skeleton(np.arange(2.0), flat, skeleton(directions).joints, planar=True))
    assert np.allclose(read.seen[0], 1.0) and read.seen[1, 0, 1] == pytest.approx(0.3)
    assert read.trust[1, 0].tolist() == pytest.approx([1.0, 0.3])


@given(people.people(frames=4))
def test_mirroring_twice_changes_nothing_and_mirrors_the_person(person):
    read = readings_of_skeleton(person)
    assert np.allclose(read.mirrored().mirrored().directions, read.directions)
    assert np.allclose(readings_of_skeleton(person.mirrored()).directions, read.mirrored().directions, atol=1e-9)


def test_readings_join_and_refuse_other_shapes():
    one = ArmReadings(held("up")[None])
    assert len(joined([one, one])) == 2
    with pytest.raises(ValueError, match="expected"):
        ArmReadings(np.zeros((2, 2, 3)))
