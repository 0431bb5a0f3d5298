"""The rival of `play`: step, render, encode, one after the other in one process, as any script would.

    python benchmarks/bare_loop.py ROLLOUT.npz FILM.mp4 QUALITY

It replays the commands of a rollout with mj_step and mujoco.Renderer and writes
the same film: scene, frames, picture size, shadows, supersampling and encoder
settings are those of the quality preset.  No guard, no report.
"""

from __future__ import annotations

import sys

import av
import mujoco
import numpy as np
from av.video.reformatter import Interpolation

from nao_sim.mujoco_model import JointMap
from nao_sim.paths import MODEL
from nao_sim.rendering.presets import load_camera, load_quality

FPS, WIDTH, HEIGHT = 30, 640, 480
CONTROL_STEP = 0.02


def main(rollout: str, film: str, quality_name: str) -> None:
    """Write the film."""
    quality, view = load_quality(quality_name), load_camera("three-quarter")
    with np.load(rollout) as file:
        time, commands = file["time"], file["command"]
    model = mujoco.MjModel.from_xml_path(str(MODEL / "scene.xml"))
    big = round(WIDTH * quality.supersample), round(HEIGHT * quality.supersample)
    model.vis.global_.offwidth, model.vis.global_.offheight = big
    model.vis.quality.shadowsize, model.vis.quality.offsamples = quality.shadow_map, quality.msaa
    if not quality.reflection:
        model.mat_reflectance[:] = 0
    if quality.shadow_map == 0:
        model.light_castshadow[:] = 0
    data, joints = mujoco.MjData(model), JointMap(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("StandInit").id)
    camera = mujoco.MjvCamera()
    camera.lookat[:], camera.distance = view.lookat, view.distance
    camera.azimuth, camera.elevation = view.azimuth_deg, view.elevation_deg
    model.vis.global_.fovy = view.fovy_deg
    substeps = round(CONTROL_STEP / model.opt.timestep)
    frames = round(float(time[-1]) * FPS)
    with av.open(film, "w", options={"movflags": "faststart"}) as output, mujoco.Renderer(model, big[1], big[0]) as eye:
        stream = output.add_stream("libx264", rate=FPS, options=dict(quality.mp4))
        stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT, "yuv420p"
        shown = 0
        for command in commands:
            data.ctrl[:] = joints.to_ctrl(command)
            mujoco.mj_step(model, data, substeps)
            while shown < frames and shown / FPS <= data.time:
                eye.update_scene(data, camera)
                frame = av.VideoFrame.from_ndarray(eye.render(), format="rgb24")
                shrunk = frame.reformat(WIDTH, HEIGHT, format="yuv420p", interpolation=Interpolation.AREA)
                output.mux(stream.encode(shrunk))
                shown += 1
        output.mux(stream.encode())


if __name__ == "__main__":
    main(*sys.argv[1:4])
