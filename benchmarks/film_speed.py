"""Measure how fast films are made, beside a bare loop of mujoco.Renderer, and how much memory long ones take.

    python benchmarks/film_speed.py [speed] [memory] [--repeats 5]

Both sides show the same poses of the same robot from the same camera at 640x480, 30 frames a second, and write the
same kind of file.  The bare loop is one process: set the pose, render, read back, encode.  It renders the scene as it
stands in the model's folder ("as shipped": 2048 texels of shadow, reflection, 4 samples a pixel), and with what the
quality draws ("same drawn": its shadows, no reflection, no multisampling), without supersampling.  Ours is
`write_video` with start-up of its processes, and warm, as in `play`, where they start while the robot performs.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from benchmark import HERE, Rows, machine, note

FPS, WIDTH, HEIGHT = 30, 640, 480
FRAMES = 300
CAMERA = "three-quarter"
AIMS = {"draft": "100 frames/s", "standard": "1.6 times the bare loop"}


def poses(frames: int) -> np.ndarray:
    """Configurations (N, nq) of a standing robot that circles its arms; no two frames alike."""
    from nao_sim.paths import TRAJECTORIES
    from nao_sim.recordings import load
    from nao_sim.simulation.simulator import Simulator

    simulator = Simulator()
    motion = load(TRAJECTORIES / "arm_circles.csv").motion
    times = np.arange(frames) / FPS
    joints = motion.sample(motion.times[0] + times % motion.duration)
    start = simulator.robot.postures["StandInit"]
    joints = np.where(np.isfinite(joints), joints, start) + 1e-3 * np.sin(0.01 * times)[:, None]
    return simulator.map.to_qpos(joints, simulator.base_pose())


def processor_s() -> float:
    """Seconds of processor time that this process and its children, as far as they live, have used."""
    own = os.getpid()
    children = Path(f"/proc/{own}/task/{own}/children").read_text(encoding="utf-8").split()
    ticks = 0
    for process in (str(own), *children):
        fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
        ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def bare(qpos: np.ndarray, path: Path, quality_name: str, as_shipped: bool) -> tuple[float, float]:
    """Frames a second of the bare loop, and milliseconds of processor time a frame."""
    import av
    import mujoco

    from nao_sim.paths import MODEL
    from nao_sim.rendering.presets import load_camera, load_quality

    quality, view = load_quality(quality_name), load_camera(CAMERA)
    model = mujoco.MjModel.from_xml_path(str(MODEL / "scene.xml"))
    model.vis.global_.offwidth, model.vis.global_.offheight, model.vis.global_.fovy = WIDTH, HEIGHT, view.fovy_deg
    if not as_shipped:
        model.vis.quality.shadowsize, model.vis.quality.offsamples = quality.shadow_map, quality.msaa
        model.mat_reflectance[:] = 0
        model.light_castshadow[np.flatnonzero(model.light_castshadow)[quality.shadow_lights :]] = 0
    camera, data = mujoco.MjvCamera(), mujoco.MjData(model)
    camera.lookat[:], camera.distance = view.lookat, view.distance
    camera.azimuth, camera.elevation = view.azimuth_deg, view.elevation_deg
    with av.open(str(path), "w") as output, mujoco.Renderer(model, HEIGHT, WIDTH) as eye:
        stream = output.add_stream("libx264", rate=FPS, options=dict(quality.mp4))
        stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT, "yuv420p"
        began, used = time.perf_counter(), processor_s()
        for pose in qpos:
            data.qpos[:] = pose
            mujoco.mj_forward(model, data)
            eye.update_scene(data, camera)
            output.mux(stream.encode(av.VideoFrame.from_ndarray(eye.render(), format="rgb24")))
        output.mux(stream.encode())
        return len(qpos) / (time.perf_counter() - began), 1e3 * (processor_s() - used) / len(qpos)


def ours(qpos: np.ndarray, path: Path, quality: str, warm: bool) -> tuple[float, float]:
    """The same of `write_video`; `warm` with processes that are ready, otherwise no processor time is told."""
    from nao_sim.rendering import start_pool, write_video
    from nao_sim.simulation.scene import compile_scene

    model = compile_scene()
    if not warm:
        return len(qpos) / write_video(model, qpos, path, fps=FPS, camera=CAMERA, quality=quality).seconds, 0.0
    with start_pool(model, len(qpos), (WIDTH, HEIGHT), CAMERA, quality) as pool:
        for _ in pool.paint(qpos[:8]):
            pass
        used = processor_s()
        made = write_video(model, qpos, path, fps=FPS, camera=CAMERA, quality=quality, pool=pool)
        return len(qpos) / made.seconds, 1e3 * (processor_s() - used) / len(qpos)


SIDES: dict[str, Callable[[np.ndarray, Path, str], tuple[float, float]]] = {
    "warm": lambda qpos, path, quality: ours(qpos, path, quality, True),
    "cold": lambda qpos, path, quality: ours(qpos, path, quality, False),
    "same": lambda qpos, path, quality: bare(qpos, path, quality, False),
    "shipped": lambda qpos, path, quality: bare(qpos, path, quality, True),
}


def _in_a_process(side: str, quality: str, frames: int, backend: str) -> tuple[float, float]:
    words = [sys.executable, str(HERE / "film_speed.py"), "--side", side, quality, str(frames)]
    env = os.environ | {"MUJOCO_GL": backend}
    said = subprocess.run(words, env=env, check=True, capture_output=True, text=True).stdout.split()
    return float(said[-2]), float(said[-1])


def speed(repeats: int) -> tuple[str, Rows]:
    """Frames a second of all sides, interleaved, the median of each."""
    from nao_sim.rendering import choose_backend

    backend = choose_backend()
    names = ("ours, warm", "ours, with start-up", "bare, same drawn", "bare, as shipped")
    rows: Rows = [
        ("quality", "side", "frames/s", "processor ms a frame", "ours, warm, times as fast", "aim", "outcome")
    ]
    for quality, aim in AIMS.items():
        found: dict[str, list[tuple[float, float]]] = {side: [] for side in SIDES}
        for _ in range(repeats):
            for side, runs in found.items():
                runs.append(_in_a_process(side, quality, FRAMES // (3 if side == "shipped" else 1), backend.name))
        median = {side: np.median(runs, axis=0) for side, runs in found.items()}
        warm = median["warm"][0]
        met = warm >= 100.0 if quality == "draft" else warm >= 1.6 * median["same"][0]
        for name, (side, (rate, used)) in zip(names, median.items(), strict=True):
            outcome = (aim, "met" if met else "missed") if side == "warm" else ("", "")
            told = f"{used:.1f}" if used else ""
            rows.append((quality, name, f"{rate:.0f}", told, f"{warm / rate:.2f}", *outcome))
    return f"Films, 640x480, 30 frames/s, encoding included, {backend.name} ({backend.renderer})", rows


def memory(repeats: int) -> tuple[str, Rows]:
    """Most memory that long films take, of the parent and of the largest rendering process."""
    from nao_sim.rendering import choose_backend

    rows: Rows = [("film", "frames", "parent (MiB)", "largest rendering process (MiB)")]
    for minutes in (2, 10):
        frames = minutes * 60 * FPS
        words = [sys.executable, str(HERE / "film_speed.py"), "--side", "memory", "draft", str(frames)]
        env = os.environ | {"MUJOCO_GL": choose_backend().name}
        said = subprocess.run(words, env=env, check=True, capture_output=True, text=True).stdout.split()
        rows.append((f"{minutes} min, draft, 160x120", str(frames), *said[-2:]))
    return "Memory of long films", rows


def _most_memory(frames: int, path: Path) -> str:
    import resource

    from nao_sim.rendering import write_video
    from nao_sim.simulation.scene import compile_scene

    qpos = poses(frames)
    write_video(compile_scene(), qpos, path, fps=FPS, size=(160, 120), camera=CAMERA, quality="draft")
    who = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    return " ".join(f"{resource.getrusage(each).ru_maxrss / 1024:.0f}" for each in who)


BENCHMARKS = {"speed": speed, "memory": memory}


def main(words: Sequence[str] | None = None) -> None:
    """Measure and append."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"any of {', '.join(BENCHMARKS)}")
    parser.add_argument("--repeats", type=int, default=5, help="runs of each side (default 5)")
    parser.add_argument("--print", action="store_true", help="print only, leave RESULTS.md alone")
    parser.add_argument("--side", nargs=3, metavar=("SIDE", "QUALITY", "FRAMES"), help=argparse.SUPPRESS)
    args = parser.parse_args(words)
    if args.side:
        side, quality, frames = args.side
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "film.mp4"
            if side == "memory":
                print(_most_memory(int(frames), path))
            else:
                print(*SIDES[side](poses(int(frames)), path, quality))
        return
    for name in args.names or BENCHMARKS:
        where = machine()
        title, rows = BENCHMARKS[name](args.repeats)
        note(title, rows, f"film_speed.py {name} --repeats {args.repeats}", where, args.print)


if __name__ == "__main__":
    main()
