"""The safety light says in a sentence whether the robot does what the person does."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim.live.light import STAYS, Signal, Situation
from nao_sim.safety.change import Change


def _changed(robot, reason: str, links: tuple[str, ...] = (), **degrees: float) -> Change:
    size = np.zeros(26)
    for joint, angle in degrees.items():
        size[robot.index[joint]] = np.radians(angle)
    return Change(reason, size, links)


@pytest.mark.parametrize(
    ("situation", "colour", "words"),
    [
        (Situation(silence=0.02), "green", "does what the person does"),
        (Situation(), "amber", "waiting for the first frame"),
        (Situation(silence=0.02, learning=True), "amber", "what the numbers mean"),
        (Situation(silence=5.0, paused=True), "amber", "paused"),
        (Situation(silence=0.02, delay=0.6), "amber", "frames come 0.6 s late"),
        (Situation(silence=0.02, slow=True), "amber", "too slow"),
        (Situation(silence=0.5), "red", "no frames: it waits"),
        (Situation(silence=4.2), "red", "no frame for 4 s"),
        (Situation(silence=0.02, seen=False), "red", "no arm of a person is seen"),
        (Situation(silence=0.02, fell=True), "red", "the robot fell"),
        (Situation(fell=True, paused=True), "red", "the robot fell"),
    ],
)
def test_each_situation_has_its_colour_and_its_reason(robot, situation, colour, words):
    light = Signal(robot).show(situation, (), 0.0)
    assert light.colour == colour
    assert words in light.reason


def test_what_the_guard_changed_noticeably_is_named_with_joints_or_links(robot):
    signal, well = Signal(robot), Situation(silence=0.02)
    small = _changed(robot, "speed", RElbowYaw=0.5)
    assert signal.show(well, (small,), 0.0).colour == "green"
    fast = _changed(robot, "speed", RElbowYaw=5.0, LElbowYaw=20.0)
    hit = _changed(robot, "self_collision", ("l_wrist", "torso"), LShoulderRoll=10.0)
    light = signal.show(well, (fast, hit), 0.0)
    assert light.colour == "amber"
    assert light.reason == (
        "faster or jerkier than the motors (LElbowYaw, RElbowYaw); into the robot itself (l_wrist and torso)"
    )


def test_a_warning_stays_long_enough_to_be_seen_and_no_longer(robot):
    signal, well = Signal(robot), Situation(silence=0.02)
    signal.show(well, (_changed(robot, "speed", RElbowYaw=9.0),), 1.0)
    assert signal.show(well, (), 1.0 + STAYS - 0.01).colour == "amber"
    assert signal.show(well, (), 1.0 + STAYS).colour == "green"
