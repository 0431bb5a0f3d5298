"""What is shown over a film, and how it is laid out."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.errors import UsageError
from nao_sim.filming import Film
from nao_sim.limit_captions import LimitCaptions, at_limits
from nao_sim.moments import Moments
from nao_sim.rendering.arrangements import load_arrangement, load_limits, load_overlay, overlay_names, with_safety
from nao_sim.requested_poses import FEET, requested_poses, standing_bases
from nao_sim.robot import LEGS, load_robot
from nao_sim.safety.position import command_bounds
from nao_sim.simulation.rollout import Rollout
from nao_sim.simulation.simulator import CONTROL_STEP, Simulator

ROBOT = load_robot()
START = ROBOT.postures["StandInit"]
STEPS = 100
TIMES = CONTROL_STEP * np.arange(1.0, STEPS + 1.0)


@pytest.fixture(scope="module")
def simulator():
    return Simulator(ROBOT)


def commands(joint, first, last, share):
    """A run in which a joint is at a share of its range, 0 to 1, from step `first` to `last`."""
    lowest, highest = command_bounds(ROBOT)
    run = np.tile(START, (STEPS, 1))
    run[first : last + 1, joint] = lowest[joint] + share * (highest[joint] - lowest[joint])
    return run


@given(st.integers(0, 25), st.integers(1, 60), st.integers(0, 30), st.sampled_from([0.0, 1.0]))
@settings(deadline=None, max_examples=40)
def test_a_joint_at_its_limit_is_named_with_it_at_its_time_for_long_enough(joint, first, length, end):
    captions = LimitCaptions(ROBOT)
    run = commands(joint, first, first + length, end)
    shown = captions.at(TIMES, run, TIMES)
    words = [label.word for label, seen in zip(captions.labels, shown.any(axis=0), strict=True) if seen]
    if ROBOT.is_hand[joint]:
        assert not words
        return
    limit = np.degrees((ROBOT.lower, ROBOT.upper)[int(end)][joint])
    assert f"{ROBOT.joint_names[joint]} at its limit {limit:.1f}°" in words
    assert all(word.startswith((ROBOT.joint_names[joint], "HeadPitch", "LAnkle", "RAnkle")) for word in words)
    visible = TIMES[shown.any(axis=1)]
    assert visible[0] == TIMES[first] and visible[-1] >= TIMES[first] + load_limits().hold - 2.0 * CONTROL_STEP


@given(st.integers(0, 25), st.floats(0.06, 0.94))
@settings(deadline=None, max_examples=20)
def test_joints_inside_their_range_or_never_moved_are_not_named(joint, share):
    own = f"{ROBOT.joint_names[joint]} at its limit"
    found = at_limits(ROBOT, commands(joint, 20, 60, share), np.radians(load_limits().within_deg))
    assert not any(at.any() for words, at in found.items() if words.startswith(own))
    resting = at_limits(ROBOT, commands(joint, 0, STEPS, 1.0), np.radians(load_limits().within_deg))
    assert not any(at.any() for at in resting.values())


def test_there_are_never_more_captions_than_can_be_read():
    run = np.stack([START, command_bounds(ROBOT)[1]])[np.arange(STEPS) // 50]
    assert LimitCaptions(ROBOT).at(TIMES, run, TIMES).sum(axis=1).max() == load_limits().most


def test_overlays_add_up():
    nothing, everything = load_overlay("none"), load_overlay("all")
    flags = ("gestures", "limits", "time", "safety")
    assert not any(getattr(nothing, flag) for flag in flags) and all(getattr(everything, flag) for flag in flags)
    assert {name: with_safety(name) for name in overlay_names() if name != "none"} == {
        "gestures": "safety", "labels": "all", "safety": "safety", "all": "all"
    }  # fmt: skip
    with pytest.raises(UsageError, match="--show-safety and --overlay none contradict each other"):
        with_safety("none")


@given(st.integers(0, 1000))
@settings(deadline=None, max_examples=10)
def test_what_was_requested_is_shown_joint_by_joint_with_the_lower_foot_where_it_stood(simulator, seed):
    random = np.random.default_rng(seed)
    asked = np.where(random.uniform(size=(STEPS, 26)) < 0.2, np.nan, START + random.normal(0.0, 0.5, (STEPS, 26)))
    rollout = Rollout(TIMES, asked, *[np.tile(START, (STEPS, 1))] * 3, np.tile(simulator.base_pose(), (STEPS, 1)))
    poses = requested_poses(rollout, TIMES, simulator)
    known = np.isfinite(asked)
    np.testing.assert_allclose(poses[:, simulator.map.qpos][known], asked[known])
    np.testing.assert_allclose(np.linalg.norm(poses[:, 3:7], axis=1), 1.0)


def test_a_robot_that_is_asked_to_move_its_arms_alone_stands_where_it_stood(simulator):
    arms = START + np.where(ROBOT.joints_of(*LEGS), 0.0, np.random.default_rng(0).normal(0.0, 1.0, (5, 26)))
    simulator.reset()
    np.testing.assert_allclose(standing_bases(arms, simulator), np.tile(simulator.base_pose(), (5, 1)), atol=1e-9)


def test_a_robot_that_is_asked_to_squat_comes_down_with_its_feet_on_the_floor(simulator):
    import mujoco

    squat = START.copy()
    for side in "LR":
        for name, angle in (("HipPitch", -0.9), ("KneePitch", 1.6), ("AnklePitch", -0.7)):
            squat[ROBOT.index[side + name]] = angle
    base = standing_bases(squat[None], simulator)
    data = mujoco.MjData(simulator.model)
    data.qpos[:] = simulator.map.to_qpos(squat, base[0])
    mujoco.mj_kinematics(simulator.model, data)
    simulator.reset()
    for foot in FEET:
        np.testing.assert_allclose(data.body(foot).xpos, simulator.data.body(foot).xpos, atol=0.01)
    assert base[0, 2] < simulator.base_pose()[2] - 0.03


@pytest.mark.parametrize(
    ("changes", "second", "said"),
    [
        ({"arrangement": "best"}, False, "arrangement 'best' is not known; expected one of beside"),
        ({"overlay": "best"}, False, "overlay 'best' is not known; expected one of none"),
        ({"arrangement": "eyes", "camera": "head"}, False, "--arrange eyes shows in a part what --camera head sees"),
        ({"arrangement": "behind", "camera": "head"}, False, "--camera head does not see the person"),
        ({"arrangement": "behind", "person": False}, False, "whom --hide-person hides"),
        ({"arrangement": "compare"}, True, "--arrange compare: is for one robot"),
    ],
)
def test_what_cannot_be_laid_out_is_refused(tmp_path, changes, second, said):
    with pytest.raises(UsageError, match=said):
        Film(tmp_path / "a.png", moments=Moments((0.0,)), **changes).check(second)


def test_where_a_rule_is_off_nothing_is_called_safe():
    titles = [pane.title(False) for pane in load_arrangement("compare").panes]
    assert titles == ["requested", "simulated"]
