"""The balance rule: its slopes, its mirror, its stances, and that what it allows stands in physics."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.robot import VERSIONS, load_robot
from nao_sim.safety.balance import GRAVITY, LEANING_MARGIN, Balance
from nao_sim.safety.posed import PosedRobot
from nao_sim.safety.support import SOLES
from nao_sim.simulation.simulator import Simulator

ROBOT = load_robot()
STAND = np.where(  # upright on straight legs, which stay where they are in a sway
    np.isin(np.arange(26), [*ROBOT.limbs["LLeg"], *ROBOT.limbs["RLeg"]]),
    ROBOT.postures["StandZero"],
    ROBOT.postures["StandInit"],
)
STEP = 1e-6
SWAY = -0.3  # rad of hips and ankles, at which the left foot carries nearly all


def swayed(share, lifted=0.0):
    """The weight shifted toward the left foot, and the right foot lifted (rad of its knee)."""
    pose = STAND.copy()
    for side in "LR":
        pose[ROBOT.index[f"{side}HipRoll"]] += share * SWAY
        pose[ROBOT.index[f"{side}AnkleRoll"]] -= share * SWAY
    for joint, part in (("RKneePitch", 1.0), ("RHipPitch", -0.5), ("RAnklePitch", -0.5)):
        pose[ROBOT.index[joint]] += part * lifted
    return pose


class Watch:
    """A balance rule with its robot, told whole poses."""

    def __init__(self, version="v5", start=STAND):
        self.posed = PosedRobot(version=version)
        self.rule = Balance(load_robot(version), self.posed, start)

    def put(self, pose):
        self.posed.put(self.posed.map.to_qpos(pose))

    def allows(self, pose):
        self.put(pose)
        return not self.rule.broken()

    def look(self, pose):
        self.put(pose)
        return self.rule.look()

    def follows(self, start, end, steps=60):
        """How many steps of a straight way it allows."""
        for done, share in enumerate(np.linspace(0.0, 1.0, steps + 1)[1:]):
            if not self.allows(start + share * (end - start)):
                return done
            self.rule.moved()
        return steps


@st.composite
def stirred(draw):
    """A pose not far from one on both feet or on the left one."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    calm = swayed(1.0, 0.6) if draw(st.booleans()) else STAND
    pose = calm + random.normal(size=26) * draw(st.sampled_from([0.05, 0.3]))
    pose[ROBOT.index["RHipYawPitch"]] = pose[ROBOT.index["LHipYawPitch"]]
    return np.clip(pose, ROBOT.lower, ROBOT.upper)


def slopes(value, pose):
    columns = []
    for joint in range(26):
        offset = STEP * np.eye(26)[joint]
        columns.append((np.array(value(pose + offset)) - np.array(value(pose - offset))) / (2.0 * STEP))
    return np.stack(columns, axis=-1)


@settings(max_examples=8)
@given(stirred())
def test_margins_have_the_slopes_of_finite_differences(pose):
    watch = Watch()

    def values(changed):
        watch.put(changed)
        return [margin.value for margin in watch.rule.margins(np.inf)]

    watch.put(pose)
    margins = watch.rule.margins(np.inf)
    found = slopes(values, pose)
    assert len(found) == len(margins)
    assert np.array([margin.gradient for margin in margins]) == pytest.approx(found, abs=1e-6)


@settings(max_examples=8)
@given(stirred(), st.floats(0.01, 0.1))
def test_leaning_has_the_slopes_of_finite_differences(pose, dt):
    watch = Watch()
    before = watch.look(pose - 0.1 * dt * np.sin(np.arange(26)))

    def values(changed):
        look = watch.look(changed)
        return [margin.value for margin in watch.rule.leaning_margins(before, look, dt, np.inf)]

    look = watch.look(pose)
    margins = watch.rule.leaning_margins(before, look, dt, np.inf)
    assert min(margin.value for margin in margins) == pytest.approx(watch.rule.leaning(before, look, dt))
    found = np.array([margin.gradient for margin in margins])
    exact = 1e-6 if look.stance.both else 0.02  # on one sole what a step changes of its momentum is left out
    assert found == pytest.approx(slopes(values, pose), abs=exact, rel=0.02)


@given(stirred())
def test_a_mirrored_pose_is_as_far_inside(pose):
    watch = Watch()
    least = []
    for seen in (pose, ROBOT.mirror(pose)):
        watch.put(seen)
        least.append(min(margin.value for margin in watch.rule.margins(np.inf)))
    assert least[0] == pytest.approx(least[1], abs=0.002)  # left and right masses differ a little


@given(stirred())
def test_broken_is_a_negative_margin(pose):
    watch = Watch()
    broken = not watch.allows(pose)
    assert broken == any(margin.value < -1e-9 for margin in watch.rule.margins(np.inf))


@pytest.mark.parametrize("version", VERSIONS)
def test_the_robot_stands_as_it_starts(version):
    for name in ("Stand", "StandInit", "StandZero"):
        posture = ROBOT.postures[name]
        assert Watch(version, posture).allows(posture)


@pytest.mark.parametrize("version", VERSIONS)
def test_a_foot_is_lifted_only_where_the_other_carries(version):
    watch = Watch(version)
    assert watch.follows(STAND, swayed(0.0, 0.6)) < 30  # 2 mm off the floor
    watch = Watch(version)
    assert watch.follows(STAND, swayed(1.0)) == 60
    assert watch.follows(swayed(1.0), swayed(1.0, 0.6)) == 60
    assert watch.follows(swayed(1.0, 0.6), swayed(0.0, 0.6)) < 60
    assert watch.follows(swayed(1.0, 0.6), swayed(1.0)) == 60


def test_the_weight_changes_feet_only_where_both_stand():
    watch = Watch()
    watch.follows(STAND, swayed(1.0))
    watch.follows(swayed(1.0), swayed(1.0, 0.6))
    on_the_right = ROBOT.mirror(swayed(1.0, 0.6))
    assert not watch.allows(on_the_right)
    assert Watch().allows(on_the_right)


def test_soles_that_both_carry_do_not_slide():
    yawed = STAND.copy()
    yawed[[ROBOT.index["LHipYawPitch"], ROBOT.index["RHipYawPitch"]]] -= 0.3
    assert not Watch().allows(yawed)


def test_where_the_start_is_outside_it_may_only_get_better():
    start = swayed(0.6, 0.3)  # a foot in the air, and the weight not over the other one
    watch = Watch(start=start)
    assert watch.allows(start)
    assert watch.allows(swayed(0.65, 0.3))
    assert not watch.allows(swayed(0.55, 0.3))


def test_speed_leans_as_far_as_a_pendulum_goes():
    watch = Watch()
    ahead = STAND.copy()
    for side in "LR":
        ahead[ROBOT.index[f"{side}AnklePitch"]] -= 0.02
    still, moved = watch.look(STAND), watch.look(ahead)
    at_rest = watch.rule.leaning(moved, moved, 0.1)
    watch.put(ahead)
    inside = min(m.value for m in watch.rule.leaning_margins(moved, moved, 0.1, np.inf))
    assert at_rest == pytest.approx(inside)
    (x0, _, _), (x, _, z) = still.centres[0], moved.centres[0]
    front = moved.corners[0][0] - LEANING_MARGIN
    fast = watch.rule.leaning(still, moved, 0.02)
    assert fast == pytest.approx(front - x - (x - x0) / 0.02 * np.sqrt(z / GRAVITY), abs=1e-6)
    assert fast < at_rest


def edge_of(watch, calm, wild):
    """The pose farthest on the straight way from a calm pose to a wild one that is allowed, all the way to it."""
    share = 0.0
    while share < 1.0 and watch.allows(calm + (share + 0.02) * (wild - calm)):
        share += 0.02
    return calm + share * (wild - calm)


@pytest.fixture(scope="module")
def physics():
    """Robots free to fall, by version."""
    return {version: Simulator(load_robot(version)) for version in ("v5", "v6")}


@pytest.mark.parametrize("version", ["v5", "v6"])
@settings(max_examples=8)
@given(wild=stirred(), lifted=st.booleans())
def test_at_the_edge_of_the_rule_the_robot_still_stands(physics, version, wild, lifted):
    calm = swayed(1.0, 0.6) if lifted else STAND
    watch, simulator = Watch(version, calm), physics[version]
    pose = edge_of(watch, calm, wild)
    settle(simulator, watch, pose)
    mujoco.mj_step(simulator.model, simulator.data, 500)
    upright = simulator.data.geom(SOLES[0]).xmat[8]
    assert np.degrees(np.arccos(min(upright, 1.0))) < 3.0
    links = simulator.model.geom_bodyid[simulator.data.contact.geom[:, 1]]
    assert {simulator.model.body(link).name for link in links} <= {"l_ankle", "r_ankle"}


def settle(simulator, watch, pose):
    """Put a robot down on its left sole, gently."""
    watch.put(pose)
    data, model = watch.posed.data, watch.posed.model
    sole, torso = model.geom(SOLES[0]).id, model.body("torso").id
    turn = data.geom_xmat[sole].reshape(3, 3)
    place = (data.xpos[torso] - data.geom_xpos[sole]) @ turn + [0.0, 0.0, model.geom_size[sole, 2]]
    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, turn.T.ravel())
    mujoco.mj_resetData(simulator.model, simulator.data)
    simulator.data.qpos[:] = simulator.map.to_qpos(pose, np.concatenate([place, quaternion]))
    simulator.data.ctrl[:] = simulator.map.to_ctrl(pose)
    for damping in (*(500.0 * 0.5 ** np.arange(11)), 0.0):
        simulator.model.dof_damping[:6] = damping * np.array([1, 1, 1, 0.04, 0.04, 0.04])
        mujoco.mj_step(simulator.model, simulator.data, 50)
