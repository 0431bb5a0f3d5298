"""Optical motion capture of people: CMU's database as AMC and as BVH, and signs on a Mixamo rig."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from nao_sim.errors import RecordingError
from nao_sim.imitation.head import head_positions
from nao_sim.imitation.person import arm_directions
from nao_sim.recordings import load
from nao_sim.recordings.rigs.acclaim_skeleton import TYPICAL
from nao_sim.robot import load_robot

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "recordings"
CMU, SIGNS = FOLDER / "cmu_mocap6", FOLDER / "turkish_signs" / "bvh"
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason=f"no {FOLDER}")
LIMBS = [(f"{side}_{start}", f"{side}_{end}") for side in ("left", "right")
         for start, end in (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle"))]  # fmt: skip
CONVERTED = 0.05644444444444444  # m, one unit of CMU's lengths


def bone(person, start, end):
    return person.track(end) - person.track(start)


def angle(a, b):
    """Degrees between vectors (..., 3)."""
    a, b = (v / np.linalg.norm(v, axis=-1, keepdims=True) for v in (a, b))
    return np.degrees(2.0 * np.arcsin(np.clip(np.linalg.norm(a - b, axis=-1) / 2.0, 0.0, 1.0)))


def test_amc_and_bvh_of_one_trial_show_the_same_motion():
    """The BVH has a rest pose more, at its start, and is without the bones `thorax` and `wrist`."""
    amc, bvh = load(CMU / "asf" / "01_01.amc.xz").motion, load(CMU / "bvh" / "01_01.bvh.xz").motion
    assert len(bvh) == len(amc) + 1
    for start, end in LIMBS:
        one, other = bone(amc, start, end), bone(bvh, start, end)[1:]
        assert angle(one, other).max() < 0.001
        np.testing.assert_allclose(np.linalg.norm(one, axis=1), np.linalg.norm(other, axis=1), atol=1e-6)
    for joint in ("left_knee", "right_ankle", "left_foot"):
        one, other = (bone(person, "pelvis", joint) for person in (amc, bvh))
        np.testing.assert_allclose(one, other[1:], atol=1e-5)
    faces = [bone(person, "right_ear", "left_ear") for person in (amc, bvh)]
    assert angle(faces[0], faces[1][1:]).max() < 0.001


@pytest.mark.parametrize(
    ("name", "format_", "frames", "seconds", "upper_arm", "note"),
    [
        ("asf/01_01.amc.xz", "Acclaim AMC", 2751, 22.917, 4.983, "skeleton 01.asf"),
        ("asf/11_01.amc", "Acclaim AMC", 597, 4.967, 5.671, "skeleton 11.asf"),
        ("amc/13_30.amc", "Acclaim AMC", 2465, 20.533, None, "no skeleton 13.asf"),
        ("amc/13_31.amc.xz", "Acclaim AMC", 3017, 25.133, None, "no skeleton 13.asf"),
        ("amc/14_14.amc.xz", "Acclaim AMC", 4653, 38.767, None, "no skeleton 14.asf"),
        ("bvh/01_01.bvh.xz", "BVH", 2752, 22.925, 4.983, "first frame is far from the second"),
    ],
)
def test_cmus_files_load_as_upright_people_of_their_size(name, format_, frames, seconds, upper_arm, note):
    recording = load(CMU / name)
    person = recording.motion
    assert (recording.format, recording.frames, len(person)) == (format_, frames, frames)
    assert person.duration == pytest.approx(seconds, abs=0.001)
    assert any(note in told for told in recording.notes), recording.notes
    for start, end in LIMBS:
        lengths = np.linalg.norm(bone(person, start, end), axis=1)
        np.testing.assert_allclose(lengths, lengths[0], atol=1e-9)
    length = np.linalg.norm(bone(person, "left_shoulder", "left_elbow")[0])
    assert length == pytest.approx(upper_arm * CONVERTED, abs=1e-3) if upper_arm else 0.27 < length < 0.33
    assert np.median(bone(person, "pelvis", "neck")[:, 2]) > 0.2
    assert np.isfinite(arm_directions(person)).all()


@pytest.mark.parametrize(("name", "own"), [("01_01.amc.xz", "01.asf"), ("11_01.amc", "11.asf")])
def test_without_its_skeleton_a_motion_keeps_its_directions(name, own):
    right, typical = (load(CMU / "asf" / name, rig=rig).motion for rig in (CMU / "asf" / own, TYPICAL))
    for start, end in LIMBS:
        assert angle(bone(right, start, end), bone(typical, start, end)).max() < 0.01
    assert angle(arm_directions(right), arm_directions(typical)).max() < 2.0  # the trunk is another's


def test_the_head_turns():
    robot = load_robot()
    for name in ("asf/01_01.amc.xz", "bvh/01_01.bvh.xz"):
        yaw = np.degrees(head_positions(load(CMU / name).motion)[:, robot.index["HeadYaw"]])
        assert np.isfinite(yaw).all() and np.ptp(yaw) > 60.0 and abs(np.median(yaw)) < 20.0


def test_a_skeleton_alone_is_refused_with_advice():
    with pytest.raises(RecordingError, match=r"\.amc"):
        load(CMU / "asf" / "01.asf")


@pytest.mark.parametrize("name", ["abla", "anne", "ev"])
def test_signs_on_a_mixamo_rig_load_with_their_fingers(name):
    recording = load(SIGNS / f"{name}.bvh")
    person = recording.motion
    assert recording.format == "BVH" and len(person) == 30 and "cm" in recording.reason
    for side in ("left", "right"):
        assert np.linalg.norm(bone(person, f"{side}_shoulder", f"{side}_elbow"), axis=1) == pytest.approx(
            0.278, abs=0.002
        )
        for finger in ("index", "middle", "ring", "pinky"):
            chain = [f"{side}_wrist", *(f"{side}_{finger}_{joint}" for joint in ("mcp", "pip", "dip", "tip"))]
            lengths = [np.linalg.norm(bone(person, *pair), axis=1).mean() for pair in pairwise(chain)]
            assert 0.05 < lengths[0] < 0.12 and all(0.01 < length < 0.06 for length in lengths[1:])
    assert np.isfinite(arm_directions(person)).all()
