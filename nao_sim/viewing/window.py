"""MuJoCo's own viewer with a performance in it: a thin skin over the player."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from queue import SimpleQueue
from typing import Any

import mujoco
import numpy as np

from nao_sim.errors import RenderingError
from nao_sim.rendering.backend import probe
from nao_sim.rendering.presets import load_quality, load_shadow
from nao_sim.rendering.stage import apply_quality
from nao_sim.rendering.tint import Tinter
from nao_sim.viewing.keys import press
from nao_sim.viewing.playback import Layer, Playback
from nao_sim.viewing.stage import COLLISION_GROUP, PERSON_GROUP, Stage

_FRAME = 1 / 60  # s, at most between two pictures
_PATIENCE = 10.0  # s, for a window to close
_ANY_SIZE = (640, 480)  # of what MuJoCo draws off-screen, which a window does not use
_CONTACTS = mujoco.mjtVisFlag.mjVIS_CONTACTPOINT


class Showing:
    """Puts a player's moment into a scene: its pose, its colours, what is drawn of it.

    Args:
        stage: what is shown.
        player: which moment, and which layers.

    Attributes:
        data: the scene in the pose of the moment.
    """

    def __init__(self, stage: Stage, player: Playback) -> None:
        self._stage, self._player = stage, player
        self._tinter = Tinter(stage.model, stage.tinted.tint)
        self.data = mujoco.MjData(stage.model)

    def update(self, options: mujoco.MjvOption) -> None:
        """Bring the scene and what is drawn of it to the player's moment; the model's colours change, too."""
        stage, player, data = self._stage, self._player, self.data
        data.qpos[:] = stage.qpos(np.array([player.time]))[0]
        data.time = player.time
        mujoco.mj_forward(stage.model, data)
        if Layer.safety in player.shown:
            self._tinter.colour(stage.tint(player.time))
        else:
            self._tinter.clear()
        options.geomgroup[PERSON_GROUP] = Layer.person in player.shown
        options.geomgroup[COLLISION_GROUP] = Layer.collision in player.shown
        options.flags[_CONTACTS] = Layer.contacts in player.shown

    def lines(self) -> list[tuple[str, str]]:
        """Words beside the picture: what, and how it is."""
        stage, player = self._stage, self._player
        last = stage.recording_lasts
        at = min(stage.recording_time(player.time), last)
        told = [
            ("recording", f"{at:.2f} of {last:.2f} s" if at >= 0.0 else "on the way to the first pose"),
            ("speed", f"{player.speed:g} x" if player.playing else f"{player.speed:g} x, paused"),
        ]
        if Layer.safety in player.shown and (words := stage.words(stage.tint(player.time))):
            told.append(("guard", ", ".join(words)))
        return told


def check_display() -> None:
    """Say before any work where no window can be opened.

    Raises:
        RenderingError: there is no display, or it cannot draw.
    """
    has_display = any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))
    failure = probe("glfw").failure if has_display else "there is no display"
    if failure:
        raise RenderingError(
            f"no window can be opened here ({failure}); look at it in a browser with nao-sim view --web, "
            "or write a page to keep with --export page.html"
        )


def open_window(stage: Stage, player: Playback) -> None:
    """Show a stage in a window until it is closed."""
    import mujoco.viewer

    keys: SimpleQueue[int] = SimpleQueue()  # they come from the window's own thread
    _light(stage)
    showing = Showing(stage, player)
    showing.update(mujoco.MjvOption())
    with (
        _threads_ended(),
        mujoco.viewer.launch_passive(
            stage.model, showing.data, key_callback=keys.put, show_left_ui=False, show_right_ui=False
        ) as viewer,
    ):
        _look_from(viewer.cam, stage)
        viewer.opt.flags[mujoco.mjtVisFlag.mjVIS_RANGEFINDER] = False  # yellow rays of the sonars
        before = time.perf_counter()
        while viewer.is_running():
            began = time.perf_counter()
            while not keys.empty():
                press(keys.get(), player)
            player.advance(began - before)
            before = began
            with viewer.lock():
                showing.update(viewer.opt)
            _write(viewer, showing.lines())
            viewer.sync()
            time.sleep(max(0.0, _FRAME - (time.perf_counter() - began)))


@contextmanager
def _threads_ended() -> Iterator[None]:
    """Wait at the end for threads that were started meanwhile: Python must not end under one that still draws."""
    before = set(threading.enumerate())
    try:
        yield
    finally:
        for thread in set(threading.enumerate()) - before:
            thread.join(_PATIENCE)


def _light(stage: Stage) -> None:
    """Draw as in films of the usual quality, with sharp shadows round the robot: software can draw that, too."""
    model, camera, quality = stage.model, stage.camera, load_quality("standard")
    shadow = replace(load_shadow(), reach=2.0 * load_shadow().reach)  # at its edge the floor would get speckles
    apply_quality(model, _ANY_SIZE, replace(quality, shadow_map=2 * quality.shadow_map), shadow)
    model.light_pos[:] = -2.0 * shadow.reach * model.light_dir  # of lights from afar: what their shadow maps cover
    model.vis.global_.fovy = camera.fovy_deg


def _look_from(camera: mujoco.MjvCamera, stage: Stage) -> None:
    preset = stage.camera
    camera.lookat[:] = preset.lookat
    camera.distance, camera.azimuth, camera.elevation = preset.distance, preset.azimuth_deg, preset.elevation_deg


def _write(viewer: Any, lines: list[tuple[str, str]]) -> None:
    names, values = ("\n".join(column) for column in zip(*lines, strict=True))
    viewer.set_texts((mujoco.mjtFontScale.mjFONTSCALE_150, mujoco.mjtGridPos.mjGRID_BOTTOMLEFT, names, values))
