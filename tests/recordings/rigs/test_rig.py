"""Rigs: forward kinematics against a slow twin, and which joint is which by its name."""

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from nao_sim import body
from nao_sim.recordings.rigs import rig_joints
from nao_sim.recordings.rigs.rig import Frames, Rig, positions, track
from nao_sim.recordings.rigs.rig_joints import FACE, joints_of, unit_of, with_face


def turn(axis, angle):
    """The matrix of a turn about an axis, from first principles."""
    c, s = math.cos(angle), math.sin(angle)
    a, b = [k for k in range(3) if k != axis]
    matrix = np.eye(3)
    matrix[a, a] = matrix[b, b] = c
    matrix[a, b], matrix[b, a] = (-s, s) if axis != 1 else (s, -s)
    return matrix


def slowly(rig, orders, angles, places):
    """Positions (T, J, 3), one matrix at a time."""
    found = np.zeros((len(angles), len(rig.names), 3))
    for frame in range(len(angles)):
        matrices = []
        for joint, parent in enumerate(rig.parents):
            above, start = (np.eye(3), np.zeros(3)) if parent < 0 else (matrices[parent], found[frame, parent])
            found[frame, joint] = start + above @ places[frame, joint]
            for axis, angle in zip(orders[joint], angles[frame, joint], strict=False):
                above = above @ turn("XYZ".index(axis), angle)
            matrices.append(above)
    return found


@st.composite
def moving_trees(draw):
    """A tree, the channel order of each joint, angles (T, J, 3) rad and places (T, J, 3)."""
    joints, frames = draw(st.integers(1, 7)), draw(st.integers(1, 4))
    parents = [-1] + [draw(st.integers(-1, joint - 1)) for joint in range(1, joints)]
    orders = draw(st.lists(st.sampled_from(ORDERS), min_size=joints, max_size=joints))
    random = np.random.default_rng(draw(st.integers(0, 2**31)))
    rig = Rig(tuple(f"j{k}" for k in range(joints)), tuple(parents), random.uniform(-5, 5, (joints, 3)))
    places = np.tile(rig.offsets, (frames, 1, 1))
    moved = [joint for joint in range(joints) if draw(st.booleans())]
    places[:, moved] = random.uniform(-9, 9, (frames, len(moved), 3))
    return rig, orders, random.uniform(-7, 7, (frames, joints, 3)), places, moved


ORDERS = ["", "X", "Y", "Z", "XY", "ZX", "XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"]


def frames_of(orders, angles, places, moved):
    turns = {
        joint: Rotation.from_euler(order, angles[:, joint, : len(order)]) for joint, order in enumerate(orders) if order
    }
    return Frames(len(angles), turns, {joint: places[:, joint] for joint in moved})


@settings(max_examples=60)
@given(moving_trees(), st.data())
def test_any_tree_turned_in_any_order_is_where_the_slow_way_puts_it(moving, data):
    rig, orders, angles, places, moved = moving
    joints = data.draw(st.lists(st.integers(0, len(rig.names) - 1), min_size=1, unique=True))
    found = positions(rig, frames_of(orders, angles, places, moved), joints)
    np.testing.assert_allclose(found, slowly(rig, orders, angles, places)[:, joints], atol=1e-9)


@settings(max_examples=30)
@given(moving_trees())
def test_bones_keep_their_lengths(moving):
    rig, orders, angles, places, _ = moving
    found = positions(rig, frames_of(orders, angles, places, []), range(len(rig.names)))
    for joint, parent in enumerate(rig.parents):
        if parent >= 0:
            lengths = np.linalg.norm(found[:, joint] - found[:, parent], axis=1)
            np.testing.assert_allclose(lengths, np.linalg.norm(rig.offsets[joint]), atol=1e-9)


@settings(max_examples=30)
@given(moving_trees(), st.data())
def test_only_movers_move_a_joint(moving, data):
    rig, orders, angles, places, moved = moving
    joint = data.draw(st.integers(0, len(rig.names) - 1))
    some = [order if mover in rig.movers([joint]) else "" for mover, order in enumerate(orders)]
    every, few = (positions(rig, frames_of(turned, angles, places, moved), [joint]) for turned in (orders, some))
    np.testing.assert_array_equal(every, few)


def test_nothing_turned_is_the_rest_pose():
    rig = Rig(("a", "b", "c"), (-1, 0, 1), np.arange(9.0))
    np.testing.assert_array_equal(positions(rig, Frames(2), [2, 0]), np.tile(rig.rest[[2, 0]], (2, 1, 1)))
    np.testing.assert_array_equal(rig.rest[2], [9.0, 12.0, 15.0])


def test_chunks_follow_each_other():
    rig = Rig(("a",), (-1,), np.zeros(3))
    places = np.arange(15.0).reshape(5, 3)
    chunks = (Frames(len(piece), {}, {0: piece}) for piece in (places[:2], places[2:]))
    np.testing.assert_array_equal(track(rig, chunks, [0])[:, 0], places)


def test_a_joint_before_its_parent_is_no_rig():
    with pytest.raises(ValueError, match="before its parent"):
        Rig(("a", "b"), (1, -1), np.zeros((2, 3)))


# What programs call the joints of CHAIN (those of the left side), and last a joint that is none of them
SCHEMES = {
    "Mixamo": "Hips Spine1 Neck Head LeftArm LeftForeArm LeftHand LeftUpLeg LeftLeg LeftFoot LeftToeBase LeftShoulder",
    "CMU as BVH": "Hips Spine Neck Head LeftArm LeftForeArm LeftHand LeftUpLeg LeftLeg LeftFoot LeftToeBase LHipJoint",
    "CMU as ASF": "root upperback lowerneck head lhumerus lradius lwrist lfemur ltibia lfoot ltoes lclavicle",
    "joints": "Hips Chest Neck Head LeftShoulder LeftElbow LeftWrist LeftHip LeftKnee LeftAnkle LeftToe LeftCollar",
    "Up, Low": "Hips Chest Neck Head LeftUpArm LeftLowArm LeftHand LeftUpLeg LeftLowLeg LeftFoot LeftToes LeftCollar",
    "Rokoko": "Hips Spine2 Neck Head LeftArm LeftForeArm LeftHand LeftThigh LeftShin LeftFoot LeftToe LeftShoulder",
    "Xsens": "Pelvis L3 Neck Head LeftUpperArm LeftForeArm LeftHand LeftUpperLeg LeftLowerLeg LeftFoot LeftToe "
    "LeftShoulder",
    "Motive": "Hip Ab Neck Head LUArm LFArm LHand LThigh LShin LFoot LToe LShoulder",
    "Biped": "Bip01_Pelvis Bip01_Spine1 Bip01_Neck Bip01_Head Bip01_L_UpperArm Bip01_L_Forearm Bip01_L_Hand "
    "Bip01_L_Thigh Bip01_L_Calf Bip01_L_Foot Bip01_L_Toe0 Bip01_L_Clavicle",
    "Unreal": "pelvis spine_02 neck_01 head upperarm_l lowerarm_l hand_l thigh_l calf_l foot_l ball_l clavicle_l",
    "VRM": "J_Bip_C_Hips J_Bip_C_Spine J_Bip_C_Neck J_Bip_C_Head J_Bip_L_UpperArm J_Bip_L_LowerArm J_Bip_L_Hand "
    "J_Bip_L_UpperLeg J_Bip_L_LowerLeg J_Bip_L_Foot J_Bip_L_ToeBase J_Bip_L_Shoulder",
    "Rigify": "hips spine.001 neck head upper_arm.L forearm.L hand.L thigh.L shin.L foot.L toe.L shoulder.L",
    "MakeHuman": "root spine03 neck01 head upperarm01.L lowerarm01.L wrist.L upperleg01.L lowerleg01.L foot.L toe.L "
    "clavicle.L",
    "Poser": "hip abdomen neck head lShldr lForeArm lHand lThigh lShin lFoot lToe lCollar",
    "DAZ": "hip abdomenLower neckLower head lShldrBend lForearmBend lHand lThighBend lShin lFoot lToe lCollar",
    "iPi": "Hip MiddleSpine Neck Head LShoulder LForearm LHand LThigh LShin LFoot LToe LClavicle",
    "SMPL": "Pelvis Spine2 Neck Head L_Shoulder L_Elbow L_Wrist L_Hip L_Knee L_Ankle L_Foot L_Collar",
    "Bandai Namco": "Hips Spine Neck Head UpperArm_L LowerArm_L Hand_L UpperLeg_L LowerLeg_L Foot_L Toes_L Shoulder_L",
}
CHAIN = ("pelvis", "spine", "neck", "head", "shoulder", "elbow", "wrist", "hip", "knee", "ankle", "foot")
MIDLINE = ("pelvis", "spine", "neck", "head")


def mirrored(name):
    """The right-hand name for a left-hand one."""
    for left, right in (("Left", "Right"), ("_L_", "_R_"), ("L_", "R_")):
        if left in name:
            return name.replace(left, right)
    for left, right in (("_l", "_r"), ("_L", "_R"), (".L", ".R")):
        if name.endswith(left):
            return name.removesuffix(left) + right
    return {"l": "r", "L": "R"}[name[0]] + name[1:]


def person(scheme, prefix=""):
    """A person standing with arms out, y up, left at +x, and where the names of CHAIN and the clavicles are in it."""
    *names, clavicle = SCHEMES[scheme].split()
    names = dict(zip(CHAIN, names, strict=True))
    height = {
        "pelvis": 1.0,
        "spine": 1.2,
        "neck": 1.5,
        "head": 1.6,
        "hip": 0.95,
        "knee": 0.5,
        "ankle": 0.1,
        "foot": 0.0,
    }
    tree, places = {}, {}
    for part in MIDLINE:
        tree[part, ""] = (MIDLINE[MIDLINE.index(part) - 1], "") if part != "pelvis" else None
        places[part, ""] = [0.0, height[part], 0.0]
    for side, sign in (("left_", 1.0), ("right_", -1.0)):
        tree["clavicle", side], places["clavicle", side] = ("spine", ""), [0.02 * sign, 1.45, 0.0]
        for part, above, x in (("shoulder", "clavicle", 0.2), ("elbow", "shoulder", 0.5), ("wrist", "elbow", 0.75)):
            tree[part, side], places[part, side] = (above, side), [x * sign, 1.45, 0.0]
        for part, above in (("hip", "pelvis"), ("knee", "hip"), ("ankle", "knee"), ("foot", "ankle")):
            tree[part, side] = (above, "" if above == "pelvis" else side)
            places[part, side] = [0.1 * sign, height[part], 0.1 if part == "foot" else 0.0]
    order = list(tree)
    called = [names.get(part, clavicle) for part, _ in order]
    called = [mirrored(name) if side == "right_" else name for name, (_, side) in zip(called, order, strict=True)]
    parents = [-1 if tree[key] is None else order.index(tree[key]) for key in order]
    rest = np.array([places[key] for key in order])
    offsets = [rest[k] - (rest[parent] if parent >= 0 else 0.0) for k, parent in enumerate(parents)]
    expected = {side + part: k for k, (part, side) in enumerate(order) if part in CHAIN}
    return Rig(tuple(prefix + name for name in called), tuple(parents), np.array(offsets)), expected


@pytest.mark.parametrize("prefix", ["", "mixamorig:", "mixamorig1:", "Skeleton 001:", "Character1_", "Bip001 "])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_joints_of_every_naming_scheme_are_known(scheme, prefix):
    rig, expected = person(scheme, prefix)
    assert joints_of(rig) == expected


def test_a_prefix_without_a_mark_is_known():
    rig, expected = person("Mixamo", "mixamorig")
    assert joints_of(rig) == expected


@pytest.mark.parametrize("scheme", SCHEMES)
def test_left_and_right_are_by_the_names_and_not_by_the_place(scheme):
    rig, expected = person(scheme)
    assert joints_of(Rig(rig.names, rig.parents, rig.offsets * [-1.0, 1.0, 1.0])) == expected


def test_a_shoulder_is_the_clavicle_only_where_the_arm_has_a_name_of_its_own():
    rig = Rig(("Hips", "LeftShoulder", "LeftElbow"), (-1, 0, 1), np.ones((3, 3)))
    assert joints_of(rig)["left_shoulder"] == 1
    rig = Rig(("Hips", "LeftShoulder", "LeftArm", "LeftForeArm"), (-1, 0, 1, 2), np.ones((4, 3)))
    assert joints_of(rig)["left_shoulder"] == 2


def test_both_sides_take_the_same_name():
    rig = Rig(("Hips", "LeftShoulder", "LeftArm", "RightShoulder"), (-1, 0, 1, 0), np.ones((4, 3)))
    assert "right_shoulder" not in joints_of(rig)


def test_the_spine_is_the_joint_nearest_to_the_bodys():
    heights = [0.0, 0.5, 1.5, 2.5, 4.0]  # of 4: the body's is at 0.42 of the way
    rig = Rig(("Hips", "a", "b", "c", "Neck"), (-1, 0, 1, 2, 3), np.outer(np.diff([0.0, *heights]), [0, 1, 0]))
    assert joints_of(rig)["spine"] == 2


@pytest.mark.parametrize(
    ("name", "joint"),
    [
        ("LeftHandIndex1", "left_index_mcp"),
        ("LeftHandIndex3", "left_index_dip"),
        ("LeftHandIndex3_End", "left_index_tip"),
        ("RightHandThumb1", "right_thumb_cmc"),
        ("RightHandPinky4", "right_pinky_tip"),
        ("index_02_l", "left_index_pip"),
        ("f_ring.03.R", "right_ring_dip"),
        ("lMid1", "left_middle_mcp"),
        ("leftLittleProximal", "left_pinky_mcp"),
        ("L Finger0", "left_thumb_cmc"),
        ("L Finger11", "left_index_pip"),
        ("finger1-1.L", "left_thumb_cmc"),
        ("finger2-1.R", "right_index_mcp"),
    ],
)
def test_fingers_are_known(name, joint):
    assert joints_of(Rig(("Hips", name), (-1, 0), np.ones((2, 3)))).get(joint) == 1


def test_a_person_is_found_under_his_own_root_only():
    rig = Rig(("Hips", "LeftArm", "Hips", "LeftArm"), (-1, 0, -1, 2), np.ones((4, 3)))
    assert joints_of(rig, 0) == {"pelvis": 0, "left_shoulder": 1}
    assert joints_of(rig, 2) == {"pelvis": 2, "left_shoulder": 3}


def test_a_rig_of_something_else_has_no_joints():
    assert joints_of(Rig(("door", "handle"), (-1, 0), np.ones((2, 3)))) == {}


def test_the_table_names_joints_of_the_body_and_no_spelling_means_two_joints():
    table = tomllib.loads(Path(rig_joints.__file__).with_name("rigs.toml").read_text())
    assert set(table["midline"]) <= set(body.joints())
    assert {f"left_{part}" for part in table["paired"]} <= set(body.joints())
    sides = dict[str, str]()
    for places, spellings in rig_joints._parts():
        for spelling in spellings:
            for place, name in zip(places, spelling, strict=True):
                side = place.split("_")[0] if len(places) > 1 else ""
                assert sides.setdefault(name, side) == side, name


def test_ears_and_eyes_turn_with_the_head_and_say_where_it_looks():
    rig, joints = with_face(*person("Mixamo"))
    assert set(FACE) < set(joints)
    yaw = Rotation.from_euler("Y", [[0.0], [0.7]])  # y is up: to the left
    head, *face = (joints[name] for name in ("head", *FACE))
    found = positions(rig, Frames(2, {head: yaw}), face)
    left_ear, right_ear, left_eye, right_eye = np.moveaxis(found, 1, 0)
    ahead = (left_eye + right_eye - left_ear - right_ear) / 2.0
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    np.testing.assert_allclose(ahead, [[0.0, 0.0, 1.0], [math.sin(0.7), 0.0, math.cos(0.7)]], atol=1e-9)
    assert (left_ear - right_ear)[0, 0] > 0.0


def test_a_rest_pose_that_is_no_upright_person_gives_no_face():
    rig, joints = person("Mixamo")
    assert with_face(Rig(rig.names, rig.parents, np.abs(rig.offsets) @ np.eye(3)[[0, 0, 0]]), joints)[1] == joints
    backwards = np.array(rig.offsets)
    backwards[[joints["left_foot"], joints["right_foot"]]] *= [1.0, 1.0, -1.0]  # as in a mirrored file
    assert with_face(Rig(rig.names, rig.parents, backwards), joints)[1] == joints
    del joints["left_hip"]
    assert with_face(rig, joints)[1] == joints


def test_the_unit_is_known_by_the_rig_of_a_database_unless_it_was_scaled():
    names = ("LHipJoint", "RHipJoint", "LowerBack", "LeftFingerBase", "LeftArm", "LeftForeArm")
    joints = {"left_shoulder": 4, "left_elbow": 5}
    for scale, unit in ((1.0, 0.0254 / 0.45), (0.0564, None), (100.0, None)):
        offsets = np.zeros((6, 3))
        offsets[5, 0] = 4.98 * scale
        rig = Rig(names, (-1, 0, 0, 0, 0, 4), offsets)
        assert unit_of(rig, joints) == (pytest.approx(unit) if unit else None)
    assert unit_of(person("Mixamo")[0], person("Mixamo")[1]) is None
