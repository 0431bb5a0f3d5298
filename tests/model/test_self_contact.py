"""What touches touches, and nothing else: postures are free, reaching hands are caught, exclusions are needed."""

from __future__ import annotations

import json

import mujoco
import numpy as np
import pytest

from nao_sim.paths import MODEL
from nao_sim.robot import facts

from .contacts import ROBOT, Contacts, Pair, arm, hand_of, posed

CLEARANCE = 0.008  # m, what the safety guard keeps between links
# Pairs that are exempt though they never touch, because a closed hand has them nearer than the clearance.
NEVER_TOUCH = {frozenset({"l_wrist", "LFinger23_link"}), frozenset({"r_wrist", "RFinger13_link"})}
LEFT_HAND, RIGHT_HAND = "l_wrist", "r_wrist"
REACHES = {
    "the face": (arm("L", -55, 0, 10, -85, -75), "Head"),
    "the chest": (arm("L", 30, -15, 15, -75, 5), "torso"),
    "the thigh": (arm("L", 50, -10, 95, -50, -45), "LThigh"),
    "the other hand": (arm("L", 70, -10, -45, -70, 0) | arm("R", 30, 10, -45, 70, -85), RIGHT_HAND),
    "the other forearm": (arm("L", 65, -15, -15, -65, -90) | arm("R", 40, 10, 30, 60, 0), "RForeArm"),
    "the other forearm from above": (arm("L", 25, -15, -5, -60, 60) | arm("R", 40, 18, 0, 45, 0), "RForeArm"),
}


@pytest.fixture(scope="module")
def contacts(alone: mujoco.MjModel) -> Contacts:
    return Contacts(alone)


@pytest.fixture(scope="module")
def excluded() -> set[Pair]:
    spec = mujoco.MjSpec.from_file(str(MODEL / "nao_h25.xml"))
    return {frozenset({exclude.bodyname1, exclude.bodyname2}) for exclude in spec.excludes}


@pytest.fixture(scope="module")
def related(alone: mujoco.MjModel) -> set[Pair]:
    parents = alone.body_parentid
    return {frozenset({alone.body(i).name, alone.body(parents[i]).name}) for i in range(2, alone.nbody)}


@pytest.fixture(scope="module")
def touched(bare: mujoco.MjModel, random_poses: np.ndarray) -> dict[Pair, float]:
    """With no pair exempt: in what share of the random poses each pair touches."""
    everything = Contacts(bare)
    counts: dict[Pair, float] = {}
    for pose in random_poses:
        for pair in everything.touching(pose):
            counts[pair] = counts.get(pair, 0.0) + 1 / len(random_poses)
    return counts


@pytest.mark.parametrize("posture", ROBOT.postures)
def test_in_a_vendor_posture_nothing_touches(alone: mujoco.MjModel, posture: str) -> None:
    distances = Contacts(alone, within=0.05).distances(ROBOT.postures[posture])
    pair, nearest = min(distances.items(), key=lambda item: item[1])
    assert nearest > 0.005, f"{sorted(pair)} are {1000 * nearest:.1f} mm apart"


@pytest.mark.parametrize("posture", ROBOT.postures)
def test_in_a_vendor_posture_only_excluded_pairs_and_neighbours_touch(
    bare: mujoco.MjModel, excluded: set[Pair], related: set[Pair], posture: str
) -> None:
    assert Contacts(bare).touching(ROBOT.postures[posture]) <= excluded | related


@pytest.mark.parametrize("what", REACHES)
def test_a_hand_that_reaches_the_body_is_caught(contacts: Contacts, what: str) -> None:
    angles, link = REACHES[what]
    pairs = {frozenset(map(hand_of, pair)) for pair in contacts.touching(posed(angles))}
    assert frozenset({LEFT_HAND, link}) in pairs


@pytest.mark.parametrize("what", REACHES)
def test_the_mirrored_reach_is_caught_too(contacts: Contacts, what: str) -> None:
    pose, swap = posed(REACHES[what][0]), str.maketrans("LlRr", "RrLl")
    pairs = {frozenset(map(hand_of, pair)) for pair in contacts.touching(pose)}
    mirrored = {frozenset(map(hand_of, pair)) for pair in contacts.touching(ROBOT.mirror(pose))}
    assert mirrored == {frozenset(link[0].translate(swap) + link[1:] for link in pair) for pair in pairs}


def test_the_arms_that_reach_start_from_a_pose_in_which_nothing_touches(contacts: Contacts) -> None:
    assert contacts.touching(posed({})) == set()


def test_the_face_is_touched_in_front(contacts: Contacts) -> None:
    contacts.touching(posed(REACHES["the face"][0]))
    head = contacts.data.body("Head").xpos
    assert (contacts.data.contact.pos[: contacts.data.ncon] - head)[:, 0].min() > 0.03


def test_a_hand_deep_in_another_link_is_always_caught(contacts: Contacts, random_poses: np.ndarray) -> None:
    """The middle of the hand inside the documented bounds of head or torso, 1 cm or more: whatever the pose."""
    boxes = [("Head", *np.array(facts()["shells"]["bounds_m"]["Head"]))]
    for slab in facts()["shells"]["torso_slabs"][1:]:
        centre, half = np.array(slab["center_m"]), np.array(slab["half_size_m"])
        boxes.append(("torso", centre - half, centre + half))
    seen = 0
    for pose in random_poses:
        touching = {frozenset(map(hand_of, pair)) for pair in contacts.touching(pose)}
        for hand in (LEFT_HAND, RIGHT_HAND):
            frame = contacts.data.body(hand)
            middle = frame.xpos + frame.xmat.reshape(3, 3) @ [0.04, 0, 0]
            for link, low, high in boxes:
                body = contacts.data.body(link)
                local = body.xmat.reshape(3, 3).T @ (middle - body.xpos)
                if ((local > low + 0.01) & (local < high - 0.01)).all():
                    seen += 1
                    assert frozenset({hand, link}) in touching
    assert seen > 5


def test_excluded_pairs_touch_somewhere_in_their_range(touched: dict[Pair, float], excluded: set[Pair]) -> None:
    assert excluded - set(touched) == NEVER_TOUCH


def test_excluded_pairs_that_never_touch_are_near_by_construction(bare: mujoco.MjModel) -> None:
    near = Contacts(bare, within=0.01)
    low, high = ROBOT.lower, ROBOT.upper
    poses = [low, high, *np.random.default_rng(0).uniform(low, high, (200, 26))]
    least = dict.fromkeys(NEVER_TOUCH, np.inf)
    for pose in poses:
        for pair, distance in near.distances(pose).items():
            if pair in least:
                least[pair] = min(least[pair], distance)
    assert max(least.values()) < CLEARANCE


def test_most_exclusions_hide_links_that_always_overlap(touched: dict[Pair, float], excluded: set[Pair]) -> None:
    always = {pair for pair in excluded if touched.get(pair, 0.0) > 0.99}
    assert len(always) >= 28


def test_no_pair_that_may_touch_overlaps_by_construction(
    touched: dict[Pair, float], excluded: set[Pair], related: set[Pair]
) -> None:
    others = {pair: share for pair, share in touched.items() if pair not in excluded | related}
    assert max(others.values()) < 0.12


def test_exclusions_are_the_table_its_mirror_and_each_hand_with_its_fingers(excluded: set[Pair]) -> None:
    table = json.loads((MODEL / "collision.json").read_text(encoding="utf-8"))["exclusions"]
    swap = str.maketrans("Ll", "Rr")
    wanted = {frozenset({a, b}) for a, b, _ in table}
    wanted |= {frozenset({"l_wrist", f["child_link"]}) for f in facts()["hand"]["finger_joints"] if f["name"][0] == "L"}
    mirrored = {frozenset(link[0].translate(swap) + link[1:] for link in pair) for pair in wanted}
    wanted |= {pair for pair in mirrored if len(pair) == 2}  # both pelvises are a pair already
    assert excluded == wanted
    assert all(reason for _, _, reason in table)


def test_the_vendors_exclusions_are_the_models(excluded: set[Pair], related: set[Pair]) -> None:
    """But for the elbow, which has no shape, and four pairs that other published rules keep apart."""
    published = {frozenset(pair) for pair in facts()["exclusions_srdf"]}
    shaped = {pair for pair in published if not any("Elbow" in link or link == "Neck" for link in pair)}
    assert shaped <= excluded | related
    fingers = {pair for pair in excluded if any("Finger" in link or "Thumb" in link for link in pair)}
    ours = {("torso", "Head"), ("Head", "LShoulder"), ("Head", "RShoulder"), ("LPelvis", "RPelvis")}
    assert excluded - published - fingers == {frozenset(pair) for pair in ours}


def test_a_free_head_stays_off_the_shoulders_though_the_pair_is_exempt(bare: mujoco.MjModel) -> None:
    """Shoulder discs turn about their own axes, so HeadYaw and the limits that it sets HeadPitch decide alone."""
    everything, coupling = Contacts(bare), next(c for c in facts()["couplings"] if c["joint"] == "HeadPitch")
    for yaw, low, high in coupling["rows"]:
        for pitch in np.linspace(low, high, 7):
            touching = everything.touching(posed({"HeadYaw": np.degrees(yaw), "HeadPitch": np.degrees(pitch)}))
            assert not touching & {frozenset({"Head", f"{side}Shoulder"}) for side in "LR"}
