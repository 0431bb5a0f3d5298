"""Off-screen video and stills of poses, with or without a GPU.

Importing this loads neither MuJoCo nor OpenGL nor an encoder: rendering happens in child processes, and what the
parent needs is loaded at the first call.
"""

from nao_sim.rendering.backend import Backend, choose_backend, start_probe
from nao_sim.rendering.presets import camera_names, quality_names
from nao_sim.rendering.still import render_still, render_stills, save_png
from nao_sim.rendering.tint import Tint, Tinted
from nao_sim.rendering.video import RenderReport, check_film, start_pool, write_video

__all__ = [
    "Backend",
    "RenderReport",
    "Tint",
    "Tinted",
    "camera_names",
    "check_film",
    "choose_backend",
    "quality_names",
    "render_still",
    "render_stills",
    "save_png",
    "start_pool",
    "start_probe",
    "write_video",
]
