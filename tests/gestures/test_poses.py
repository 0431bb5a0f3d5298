import numpy as np
import pytest
from gestures.postures import PLAIN, body, held, readings, skeleton, slerp, thesis
from hypothesis import given
from hypothesis import strategies as st

from nao_sim import body as joints
from nao_sim.errors import UsageError
from nao_sim.gestures.directions import ArmReadings, readings_of_skeleton
from nao_sim.gestures.poses import NONE, PoseRecogniser
from nao_sim.motion import Skeleton

RAISED = ("side", "forward", "piUp", "up")
GOOD = np.setdiff1d(np.arange(28), [15, 16, 17])  # rows whose numbers do not contradict each other
ROWS = st.lists(st.sampled_from(GOOD.tolist()), min_size=1, max_size=6)


@pytest.fixture(scope="module")
def recogniser():
    rows, labels, _ = thesis()
    return PoseRecogniser.fit(rows, labels)


def test_users_it_was_not_trained_on_are_recognised_up_to_the_rows_that_contradict_themselves():
    rows, labels, users = thesis()
    nearest, decided = [], []
    for user in np.unique(users):
        own = users == user
        found = PoseRecogniser.fit(rows[~own], labels[~own], single_arms=False).decide(rows[own])
        nearest += found.nearest
        decided += found.labels
    assert sum(np.array(nearest) == labels) >= 26
    assert [decided[row] for row in GOOD] == labels[GOOD].tolist()
    assert {decided[row] for row in (15, 16, 17)} == {NONE}


@given(st.permutations(range(28)))
def test_the_order_of_users_and_rows_changes_nothing(order):
    rows, labels, _ = thesis()
    one, other = PoseRecogniser.fit(rows, labels), PoseRecogniser.fit(rows[np.array(order)], labels[list(order)])
    assert one.names == other.names
    assert np.allclose(one.means, other.means) and np.allclose(one.spreads, other.spreads)


@given(ROWS, st.floats(0.5, 1.5), st.floats(-np.pi / 6, np.pi / 6), st.floats(-2.0, 2.0))
def test_size_turn_and_place_change_no_label(recogniser, chosen, scale, turn, place):
    rows, labels, _ = thesis()
    person = skeleton(rows.directions[chosen], height=1.7 * scale, turn=turn, place=(place, -place, 0.0))
    found = recogniser.decide(readings_of_skeleton(person))
    assert list(found.labels) == labels[chosen].tolist()


@given(st.integers(0, 2**16), st.booleans())
def test_a_mirrored_person_gets_the_mirrored_label(recogniser, seed, planar):
    random = np.random.default_rng(seed)
    directions = random.normal(size=(20, 2, 2, 3)) * ([0.0, 1.0, 1.0] if planar else 1.0)
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    known = [held(*random.choice(sorted(PLAIN), 2)) for _ in range(10)]
    everything = directions if planar else np.concatenate([directions, known])
    read = ArmReadings(everything, random.random((len(everything), 2, 2)), planar)
    one, other = recogniser.decide(read), recogniser.decide(read.mirrored())
    places = [recogniser.names.index(joints.twin(name)) for name in recogniser.names]
    assert np.allclose(other.probabilities[:, [*places, len(places)]], one.probabilities)


def test_one_raised_arm_is_not_both(recogniser):
    left, right = [held(pose, "down") for pose in RAISED], [held("down", pose) for pose in RAISED]
    found = recogniser.decide(readings(*left, *right))
    assert found.labels == (*(f"left_{pose}" for pose in RAISED), *(f"right_{pose}" for pose in RAISED))


@pytest.mark.parametrize("pose", RAISED)
def test_an_arm_out_of_sight_is_not_claimed_to_be_raised_but_may_hang(recogniser, pose):
    trust = np.ones((2, 2, 2))
    trust[:, 1] = 0.0
    found = recogniser.decide(ArmReadings(np.stack([held(pose), held("down")]), trust))
    assert found.labels == (f"left_{pose}", "down")


@pytest.mark.parametrize("pose", sorted(PLAIN))
def test_a_bad_forearm_that_is_not_trusted_spoils_nothing(recogniser, pose):
    directions, trust = held(pose), np.ones((2, 2))
    directions[0, 1], trust[0, 1] = -directions[0, 0], 0.0
    trust[1] = 0.7
    found = recogniser.decide(ArmReadings(directions[None], trust[None]))
    one_arm = {f"right_{pose}", pose}  # side and piUp differ in the forearm
    assert found.nearest[0] in one_arm | {"left_side", "side"} and found.labels[0] != NONE


def test_nothing_to_be_seen_is_none(recogniser):
    found = recogniser.decide(ArmReadings(np.full((1, 2, 2, 3), np.nan)))
    assert found.labels == (NONE,)


@pytest.mark.parametrize(("start", "end"), [("down", "side"), ("side", "up"), ("down", "forward"), ("forward", "up"),
                                            ("side", "piUp"), ("down", "up")])  # fmt: skip
def test_the_way_between_poses_passes_through_none(recogniser, start, end):
    way = np.stack([slerp(held(start), held(end), share) for share in np.linspace(0.0, 1.0, 91)])
    found = recogniser.decide(ArmReadings(way))
    assert found.labels[0] == start and found.labels[-1] == end and NONE in found.labels


def test_a_pose_that_nobody_taught_is_none_until_it_is_taught(recogniser):
    hips = np.array([[[-0.3, 0.75, -0.6], [0.3, -0.75, -0.6]], [[-0.3, -0.75, -0.6], [0.3, 0.75, -0.6]]])
    hips /= np.linalg.norm(hips, axis=-1, keepdims=True)
    salute = held("side", "down")
    salute[0, 1] = [0.0, -0.8, 0.6]
    assert recogniser.decide(readings(hips, salute)).labels == (NONE, NONE)
    learned = recogniser.taught("hands on hips", readings(hips)).taught("left_salute", readings(salute))
    shown = readings(hips, salute, salute[::-1] * [1.0, -1.0, 1.0], held("up"), held("side", "down"))
    assert learned.decide(shown).labels == ("hands on hips", "left_salute", "right_salute", "up", "left_side")


def test_teaching_a_known_pose_gives_it_a_new_meaning(recogniser):
    learned = recogniser.taught("up", readings(held("forward")))
    assert learned.names.count("up") == 1 and len(learned.names) == len(recogniser.names)


def test_examples_that_show_no_pose_are_refused(recogniser):
    with pytest.raises(UsageError, match="no example shows all segments"):
        recogniser.taught("odd", ArmReadings(held("up")[None], np.array([[[1.0, 1.0], [0.0, 1.0]]])))
    with pytest.raises(UsageError, match="none"):
        recogniser.taught("none", readings(held("up")))
    with pytest.raises(UsageError, match="at least one"):
        PoseRecogniser.fit(readings(held("up")), ["none"])


@pytest.mark.parametrize("pose", ["side", "piUp", "up", "down"])
def test_a_camera_without_depth_tells_poses_in_its_plane(recogniser, pose):
    flat = body(held(pose)[None]) * [0.0, 1.0, 1.0]
    seen = readings_of_skeleton(Skeleton(np.zeros(1), flat, skeleton(held(pose)[None]).joints, planar=True))
    assert recogniser.decide(seen).labels == (pose,)


def test_a_long_arm_in_a_picture_points_not_at_the_camera(recogniser):
    odd = held("side")
    odd[:, 0] = [[0.0, 0.7, -0.7], [0.0, -0.7, -0.7]]
    odd[:, 1] = [[0.0, -0.7, -0.7], [0.0, 0.7, -0.7]]
    flat = ArmReadings(odd[None], planar=True)
    short = ArmReadings(odd[None], planar=True, seen=np.full((1, 2, 2), 0.15))
    forward = recogniser.names.index("forward")
    assert recogniser.probabilities(short)[0, forward] > 10.0 * recogniser.probabilities(flat)[0, forward]
