"""What the window shows, without a window."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from nao_sim.errors import RenderingError
from nao_sim.viewing.playback import Layer, Playback
from nao_sim.viewing.stage import COLLISION_GROUP, PERSON_GROUP
from nao_sim.viewing.window import Showing, check_display


@pytest.mark.parametrize("step", [0, 60, -1])
def test_the_scene_is_in_the_pose_of_the_moment(stage, step):
    rollout, player = stage.rollout, Playback(stage.duration)
    showing = Showing(stage, player)
    player.seek(float(rollout.time[step]))
    showing.update(mujoco.MjvOption())
    robot = stage.performed.simulator.map
    assert np.allclose(showing.data.qpos[: robot.nq][robot.qpos], rollout.joint_positions[step], atol=1e-9)
    assert np.allclose(showing.data.qpos[:7], rollout.base_pose[step], atol=1e-9)
    at = np.array([rollout.time[step] - rollout.motion_start])
    assert np.array_equal(showing.data.qpos[robot.nq :], stage.figure.at(at)[0])


def test_layers_say_what_is_drawn(stage):
    player, options = Playback(stage.duration), mujoco.MjvOption()
    showing = Showing(stage, player)
    drawn = {
        Layer.person: lambda: options.geomgroup[PERSON_GROUP],
        Layer.collision: lambda: options.geomgroup[COLLISION_GROUP],
        Layer.contacts: lambda: options.flags[mujoco.mjtVisFlag.mjVIS_CONTACTPOINT],
    }
    for layer in drawn:
        player.shown = frozenset({layer})
        showing.update(options)
        assert [bool(is_drawn()) for is_drawn in drawn.values()] == [layer is each for each in drawn]


def test_limbs_take_colour_while_the_guard_slows_them_and_only_where_that_is_shown(stage):
    player = Playback(stage.duration, [Layer.safety])
    showing, plain = Showing(stage, player), stage.model.geom_rgba.copy()
    player.seek(float(stage.rollout.time[stage.tinted.rows.sum(axis=1).argmax()]))
    showing.update(mujoco.MjvOption())
    assert (stage.model.geom_rgba != plain).any()
    assert dict(showing.lines())["guard"] == "too fast"
    player.show(Layer.safety)
    showing.update(mujoco.MjvOption())
    assert (stage.model.geom_rgba == plain).all() and "guard" not in dict(showing.lines())


def test_times_told_are_those_of_the_recording(stage):
    player = Playback(stage.duration)
    showing = Showing(stage, player)
    assert dict(showing.lines())["recording"] == "on the way to the first pose"
    player.seek(stage.rollout.motion_start + 1.0)
    lasts = stage.performed.task.recording.motion.duration
    assert dict(showing.lines())["recording"] == f"1.00 of {lasts:.2f} s"
    player.jump(stage.duration)
    assert dict(showing.lines()) == {"recording": f"{lasts:.2f} of {lasts:.2f} s", "speed": "1 x, paused"}


def test_where_there_is_no_display_the_way_to_a_browser_is_told(monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    with pytest.raises(RenderingError, match=r"there is no display.*--web.*--export"):
        check_display()
