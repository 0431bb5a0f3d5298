"""The page about the guard: the right joints, the reasons at the right times, and what is off or wrong in red."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

from nao_sim.console import REASONS
from nao_sim.motion import JointTrajectory
from nao_sim.plotting.palette import REASON_COLOURS as COLOURS
from nao_sim.plotting.safety_page import MOST, safety_page, save_safety_plot, shown_joints
from nao_sim.plotting.style import styled
from nao_sim.robot import load_robot
from nao_sim.safety.change import Change
from nao_sim.safety.ledger import ledger
from nao_sim.simulation.performance import Performance, perform
from nao_sim.simulation.simulator import CONTROL_STEP, Simulator

ROBOT = load_robot()
SAFE = {"recording": "a.csv", "verdict": "as_requested", "wrong": [], "rules_off": [], "steps": 1, "changed_steps": 0}


@pytest.fixture(scope="module")
def run() -> tuple[Performance, Simulator]:
    """Half a second in which only the left arm moves, and nothing is changed."""
    times = np.linspace(0.0, 0.5, 11)
    positions = np.full((11, 26), np.nan)
    for number, joint in enumerate(("LShoulderPitch", "LElbowRoll"), 1):
        start = ROBOT.postures["StandInit"][ROBOT.index[joint]]
        positions[:, ROBOT.index[joint]] = start + 0.05 * number * np.sin(np.pi * times / 0.5) ** 2
    motion = JointTrajectory(times, positions, np.isfinite(positions).any(axis=0))
    simulator = Simulator()
    return perform(motion, simulator), simulator


def _changed(performance: Performance, *changes: tuple[str, str, float, range]) -> Performance:
    """The same run, had the guard changed these joints for these reasons, so much, in these steps."""
    interventions = [
        tuple(
            Change(reason, size * np.eye(26)[ROBOT.index[joint]])
            for reason, joint, size, steps in changes
            if step in steps
        )
        for step in range(len(performance.rollout))
    ]
    return replace(performance, interventions=interventions)


def _panels(performance: Performance, simulator: Simulator, every: bool = False):
    with styled():
        return {axes.get_title(loc="left"): axes for axes in safety_page(performance, simulator, every=every).axes}


def test_shown_are_the_joints_changed_most_in_their_order(run):
    performance, _ = run
    all_joints = [("limit", name, 0.001 * (i + 1), range(5)) for i, name in enumerate(ROBOT.joint_names)]
    book = ledger(_changed(performance, *all_joints).interventions)
    amount = 0.001 * np.arange(1, 27) / (ROBOT.upper - ROBOT.lower)
    shown = shown_joints(performance.rollout, book, ROBOT, every=False)
    assert len(shown) == MOST and shown == sorted(shown)
    assert amount[shown].min() >= np.delete(amount, shown).max()
    assert shown_joints(performance.rollout, book, ROBOT, every=True) == list(range(26))


def test_where_nothing_is_changed_the_joints_that_move_are_shown(run):
    performance, simulator = run
    panels = [title for title in _panels(performance, simulator) if ":" not in title and "(" not in title]
    assert sorted(panels) == ["LElbowRoll", "LShoulderPitch"]


def test_a_reason_is_seen_where_and_when_it_held(run):
    performance, simulator = run
    changed = _changed(
        performance,
        ("speed", "LElbowRoll", 0.1, range(10, 20)),
        ("balance", "LElbowRoll", 0.1, range(15, 18)),
        ("limit", "RHand", 0.1, range(3)),
    )
    panels = _panels(changed, simulator)
    assert _lanes(panels["LElbowRoll"]) == {COLOURS["speed"]: [(10, 20)], COLOURS["balance"]: [(15, 18)]}
    assert _lanes(panels["RHand"]) == {COLOURS["limit"]: [(0, 3)]}
    (balance,) = (axes for title, axes in panels.items() if title.startswith("balance"))
    assert _lanes(balance) == {COLOURS["balance"]: [(15, 18)]}


def _lanes(axes) -> dict[str, list[tuple[int, int]]]:
    """First control step and the one after the last of each spell, by colour."""
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import to_hex

    found = [each for each in axes.collections if isinstance(each, PolyCollection)]
    return {
        to_hex(each.get_facecolor()[0]).upper(): [
            tuple(np.round(np.array(path.get_extents().intervalx) / CONTROL_STEP).astype(int).tolist())
            for path in each.get_paths()
        ]
        for each in found
    }


def test_lines_do_not_run_into_the_lanes(run):
    performance, simulator = run
    changed = _changed(performance, *((reason, "LElbowRoll", 0.1, range(50)) for reason in COLOURS))
    axes = _panels(changed, simulator)["LElbowRoll"]
    lowest = min(np.nanmin(line.get_ydata()) for line in axes.lines[:2])
    bottom, top = axes.get_ylim()
    highest_lane = max(path.get_extents().y1 for each in axes.collections for path in each.get_paths())
    assert (lowest - bottom) / (top - bottom) > highest_lane


def test_self_distance_and_balance_are_there_with_their_lines_and_every_axis_has_a_unit(run):
    performance, simulator = run
    panels = _panels(performance, simulator)
    distance = next(axes for title, axes in panels.items() if title.startswith("self-distance"))
    levels = [line.get_ydata()[0] for line in distance.lines if len(line.get_xdata()) == 2]
    assert levels == [5.0, 10.0] and {5.0, 10.0} <= set(distance.get_yticks())
    assert any(title.startswith("balance") for title in panels)
    for axes in panels.values():
        assert all(label in ("", "opening") or label.endswith(")") for label in (axes.get_xlabel(), axes.get_ylabel()))


def test_a_robot_held_by_its_torso_has_no_balance(run):
    performance, _ = run
    assert not any(title.startswith("balance") for title in _panels(performance, Simulator(base="pinned")))


@pytest.mark.parametrize(
    ("what", "says", "red"),
    [
        ({}, "safe as requested", False),
        ({"verdict": "made_safe", "changed_steps": 1}, "made safe: 1 of 1 frames (50 Hz) changed", False),
        ({"rules_off": ["balance", "speed"]}, "switched off: balance, speed", True),
        ({"verdict": "unsafe", "wrong": ["the robot fell"]}, "NOT SAFE: the robot fell", True),
    ],
)
def test_the_title_says_the_verdict_and_in_red_what_is_off_or_wrong(run, tmp_path, monkeypatch, what, says, red):
    from nao_sim.plotting import style

    figures = []
    monkeypatch.setattr(style, "save", lambda figure, path: figures.append(figure))
    save_safety_plot(SAFE | what, *run, tmp_path / "a.png")
    title = figures[0].texts[0] if figures[0].texts else figures[0]._suptitle
    assert "a.csv" in title.get_text() and says in title.get_text()
    assert (title.get_color() != "black") == red


@pytest.mark.parametrize("kind", ["png", "svg", "pdf"])
def test_every_kind_of_picture_can_be_written(run, tmp_path, kind):
    performance, simulator = run
    changed = _changed(performance, *((reason, "LHand", 0.1, range(3)) for reason in [*COLOURS, "a reason to come"]))
    path = tmp_path / f"picture.{kind}"
    save_safety_plot(SAFE, changed, simulator, path, every=True)
    if kind == "svg":
        assert ET.parse(path).getroot().tag.endswith("svg")
    else:
        assert path.read_bytes().startswith(b"%PDF" if kind == "pdf" else b"\x89PNG")


def test_every_reason_has_words_and_a_colour_of_its_own():
    assert set(COLOURS) == set(REASONS)
    assert len(set(COLOURS.values())) == len(COLOURS)
