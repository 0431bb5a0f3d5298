"""The balance rule: its slopes, its mirror, and that what it allows stands in physics."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.robot import VERSIONS, load_robot
from nao_sim.safety.balance import CREEP, NEAR, SLIP, Balance
from nao_sim.safety.bearing import GRAVITY
from nao_sim.safety.posed import PosedRobot
from nao_sim.safety.support import SOLES
from nao_sim.simulation.simulator import Simulator
from tests.safety.standing_robots import ROBOT, STAND, bent, putter, slopes, standing


class Watch:
    """A balance rule with its robot, told whole poses."""

    def __init__(self, start=STAND, version="v5"):
        self.posed = PosedRobot(version=version)
        self.posed.put(self.posed.map.to_qpos(start))
        self.rule = Balance(load_robot(version), self.posed)
        self.put = putter(self.posed, self.rule.update)

    def allows(self, pose):
        self.put(pose)
        return not self.rule.broken()

    def look(self, pose):
        self.put(pose)
        return self.rule.look()

    def least(self, pose):
        self.put(pose)
        return min(margin.value for margin in self.rule.margins(np.inf))

    def follows(self, start, end, steps=60):
        """How many steps of a straight way it allows."""
        for done, share in enumerate(np.linspace(0.0, 1.0, steps + 1)[1:]):
            if not self.allows(start + share * (end - start)):
                return done
            self.rule.moved()
        return steps


def lifted(pose, angle):
    """The right foot lifted."""
    pose = pose.copy()
    for joint, part in (("RKneePitch", 1.0), ("RHipPitch", -0.5), ("RAnklePitch", -0.5)):
        pose[ROBOT.index[joint]] += part * angle
    return pose


@settings(max_examples=6)
@given(standing())
def test_margins_have_the_slopes_of_finite_differences(pose):
    watch = Watch()
    watch.put(pose)
    margins = watch.rule.margins(np.inf)
    found = slopes(lambda: [margin.value for margin in watch.rule.margins(np.inf)], pose, watch.put)
    felt = np.array([margin.value for margin in margins]) < NEAR - 1e-4  # shapes higher above the floor are not told
    assert felt.sum() >= 12
    assert np.array([margin.gradient for margin in margins])[felt] == pytest.approx(found[felt], abs=1e-5)


@settings(max_examples=6)
@given(standing(), st.floats(0.01, 0.1))
def test_steadiness_has_nearly_the_slopes_of_finite_differences(pose, dt):
    watch, rest = Watch(), np.zeros(2)
    before = watch.look(pose - 0.1 * dt * np.sin(np.arange(26)))

    def values():
        return [margin.value for margin in watch.rule.steady_margins(before, watch.rule.look(), dt, rest, np.inf)]

    look = watch.look(pose)
    margins = watch.rule.steady_margins(before, look, dt, rest, np.inf)
    momentum = watch.rule.momentum(before, look, dt)
    steady = watch.rule.steady(watch.rule.inside(before), look, momentum, momentum / dt)
    assert min(margin.value for margin in margins) == pytest.approx(steady)
    found = np.array([margin.gradient for margin in margins])
    # what a step changes of the lever of its own momentum is left out
    assert found == pytest.approx(slopes(values, pose, watch.put), abs=0.05, rel=0.03)


@given(standing())
def test_a_mirrored_pose_is_as_far_inside(pose):
    watch = Watch()
    assert watch.least(pose) == pytest.approx(watch.least(ROBOT.mirror(pose)), abs=2e-4)


@given(standing())
def test_broken_is_a_negative_margin(pose):
    watch = Watch()
    assert watch.allows(pose) == (watch.least(pose) >= -1e-9)


@pytest.mark.parametrize("version", VERSIONS)
def test_the_robot_stands_as_it_starts(version):
    for name in ("Stand", "StandInit", "StandZero"):
        assert Watch(ROBOT.postures[name], version).least(ROBOT.postures[name]) >= 0.0


@pytest.mark.parametrize("version", VERSIONS)
def test_it_bends_its_knees_and_keeps_both_feet_on_the_floor(version):
    assert Watch(version=version).follows(STAND, bent(STAND, -0.4, 0.8, 0.0)) == 60
    assert Watch(version=version).follows(STAND, lifted(STAND, 0.6)) < 30
    swayed = bent(STAND, 0.0, 0.0, -0.15)
    watch = Watch(version=version)
    assert watch.follows(STAND, swayed) == 60
    assert watch.follows(swayed, lifted(swayed, 0.6)) < 30


def test_soles_do_not_slide_but_creep():
    yawed = STAND.copy()
    yawed[[ROBOT.index["LHipYawPitch"], ROBOT.index["RHipYawPitch"]]] -= 0.2
    yawed = bent(yawed, 0.1, 0.0, 0.0)
    assert not Watch().allows(yawed)
    apart = STAND.copy()  # feet farther apart, both flat
    for side, sign in (("L", 1.0), ("R", -1.0)):
        apart[ROBOT.index[f"{side}HipRoll"]] += 0.05 * sign
        apart[ROBOT.index[f"{side}AnkleRoll"]] -= 0.05 * sign
    steps = 600
    assert not Watch().allows(apart)
    assert Watch().follows(STAND, apart, steps) == steps
    assert Watch().follows(STAND, apart, 10) < 10
    assert steps * CREEP > SLIP


def test_where_the_start_is_outside_it_may_only_get_better():
    start = lifted(STAND, 0.3)
    watch = Watch(start)
    assert watch.allows(start)
    assert watch.allows(lifted(STAND, 0.25))
    assert not watch.allows(lifted(STAND, 0.35))


def test_momentum_takes_it_as_far_as_a_pendulum_goes():
    """Hips and ankles that turn against each other carry all but the legs straight ahead."""
    watch = Watch()
    still, moved = watch.look(STAND), watch.look(bent(STAND, -0.02, 0.0, 0.0))
    (x0, _, _), (x, _, z) = still.centre, moved.centre
    assert x < x0  # backward, where the edge is nearest
    assert led(watch, still, moved) == pytest.approx((x0 - x) / 0.02 * np.sqrt(z / GRAVITY), rel=0.25)  # thighs turn


def test_an_arm_that_flies_leads_it_farther_than_its_own_weight_does():
    watch = Watch()
    raised, back = STAND.copy(), STAND.copy()
    shoulders = [ROBOT.index["LShoulderPitch"], ROBOT.index["RShoulderPitch"]]
    raised[shoulders], back[shoulders] = -1.0, -1.1
    still, moved = watch.look(raised), watch.look(back)
    weight = (still.centre - moved.centre)[0] / 0.02 * np.sqrt(moved.centre[2] / GRAVITY)
    assert led(watch, still, moved) > 1.2 * weight > 0.0


def test_who_sets_it_in_motion_pushes_the_floor_the_other_way():
    watch, rest = Watch(), np.zeros(2)
    stands = watch.look(STAND)
    assert stands.centre[0] < 0.0  # nearer to the heels
    at_ease, ahead, back = (
        watch.rule.steady(watch.rule.inside(stands), stands, rest, np.array([x, 0.0])) for x in (0.0, 0.3, -0.3)
    )
    assert ahead < at_ease - 0.01
    assert back == pytest.approx(at_ease)


@pytest.mark.parametrize("hip", [-0.6, -0.7])
def test_who_leans_too_far_may_come_back_and_not_lean_farther(hip):
    watch, rest = Watch(), np.zeros(2)
    tipped, back, farther = (watch.look(bent(STAND, hip + more, 0.0, 0.0)) for more in (0.0, 0.02, -0.02))
    assert watch.rule.steady(watch.rule.inside(tipped), tipped, rest, rest) == 0.0
    assert watch.rule.steady(watch.rule.inside(tipped), back, rest, rest) > 0.0
    assert watch.rule.steady(watch.rule.inside(tipped), farther, rest, rest) < 0.0


def led(watch, before, look):
    """How much farther (m) momentum takes the centre of mass toward the nearest edge than at rest."""
    momentum, rest = watch.rule.momentum(before, look, 0.02), np.zeros(2)
    return watch.rule.steady(watch.rule.inside(look), look, rest, rest) - watch.rule.steady(
        watch.rule.inside(look), look, momentum, rest
    )


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
@given(wild=standing(), noise=st.integers(0, 2**32 - 1))
def test_at_the_edge_of_the_rule_the_robot_still_stands(physics, version, wild, noise):
    wild = wild + np.random.default_rng(noise).normal(size=26) * 0.02
    wild[ROBOT.index["RHipYawPitch"]] = wild[ROBOT.index["LHipYawPitch"]]
    watch, simulator = Watch(version=version), physics[version]
    settle(simulator, watch, edge_of(watch, STAND, np.clip(wild, ROBOT.lower, ROBOT.upper)))
    mujoco.mj_step(simulator.model, simulator.data, 500)
    upright = simulator.data.geom(SOLES[0]).xmat[8]
    assert np.degrees(np.arccos(min(upright, 1.0))) < 3.0
    first, second = simulator.model.geom_bodyid[simulator.data.contact.geom].T
    assert {simulator.model.body(link).name for link in second[first == 0]} == {"l_ankle", "r_ankle"}  # on the floor


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
