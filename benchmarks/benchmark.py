"""Measure nao_sim against its floors, side by side in one run, and note the figures in RESULTS.md.

    python benchmarks/benchmark.py [play] [physics] [startup] [--repeats 5]

Every figure is a ratio of medians of interleaved runs: both sides meet the same
noise.  Without names all three are measured.
"""

from __future__ import annotations

import argparse
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from datetime import date
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
RESULTS = HERE / "RESULTS.md"
MOTION_S, FILM_S = 9.0, 10.0  # half a second of approach before, half a second of rest after
Rows = list[tuple[str, ...]]


def interleaved(sides: dict[str, Callable[[], object]], repeats: int) -> dict[str, float]:
    """Median wall-clock seconds of each side, run in turns, the first turn not counted."""
    seconds: dict[str, list[float]] = {name: [] for name in sides}
    for turn in range(repeats + 1):
        for name, run in sides.items():
            began = time.perf_counter()
            run()
            if turn:
                seconds[name].append(time.perf_counter() - began)
    return {name: statistics.median(values) for name, values in seconds.items()}


def _command(*words: object, **environment: str) -> Callable[[], object]:
    env = os.environ | environment
    return lambda: subprocess.run([sys.executable, *map(str, words)], env=env, check=True, capture_output=True)


def ten_seconds(folder: Path) -> Path:
    """Nine seconds of arm circles, a film of ten seconds."""
    from nao_sim.motion import JointTrajectory
    from nao_sim.paths import TRAJECTORIES
    from nao_sim.recordings import load, write_joint_csv

    motion = load(TRAJECTORIES / "arm_circles.csv").motion
    times = np.arange(0.0, MOTION_S + 1e-9, 0.02)
    looped = motion.sample(motion.times[0] + times % motion.duration)
    path = folder / "ten_seconds.csv"
    write_joint_csv(path, JointTrajectory(times, looped, motion.given))
    return path


def play(repeats: int) -> tuple[str, Rows]:
    """`play` against the bare loop, whole commands with start-up, rendering and encoding."""
    from nao_sim.rendering import choose_backend

    backend = choose_backend()
    rows: Rows = [("quality", "play (s)", "bare loop (s)", "ratio", "play, frames/s overall")]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        recording, rollout = ten_seconds(folder), folder / "run.npz"
        base = ("-m", "nao_sim.play", recording, "-q", "--report", folder / "r.json")
        _command(*base, "--no-video", "--rollout", rollout)()
        for quality in ("draft", "standard", "fine"):
            bare = (HERE / "bare_loop.py", rollout, folder / "bare.mp4", quality)
            ours = (*base, "--quality", quality, "--video", folder / "ours.mp4")
            runs = max(2, repeats // 2) if quality == "fine" else repeats
            took = interleaved({"ours": _command(*ours), "bare": _command(*bare, MUJOCO_GL=backend.name)}, runs)
            ratio, speed = took["ours"] / took["bare"], 30 * FILM_S / took["ours"]
            rows.append((quality, f"{took['ours']:.2f}", f"{took['bare']:.2f}", f"{ratio:.2f}", f"{speed:.0f}"))
    return f"Ten seconds of motion, 640x480, 30 frames/s, {backend.name} ({backend.renderer})", rows


def physics(repeats: int) -> tuple[str, Rows]:
    """`Simulator.step` against bare mj_step of the same model and commands."""
    import mujoco

    from nao_sim.simulation.simulator import CONTROL_STEP, Simulator

    sim = Simulator()
    still = sim.robot.postures["StandInit"]
    arms = np.concatenate([sim.robot.limbs["LArm"], sim.robot.limbs["RArm"]])
    commands = np.tile(still, (500, 1))
    commands[:, arms] += 0.2 * np.sin(np.linspace(0, 20 * np.pi, 500))[:, None]
    substeps = round(CONTROL_STEP / sim.model.opt.timestep)
    ctrl = [sim.map.to_ctrl(command) for command in commands]

    def ours() -> None:
        sim.reset()
        for command in commands:
            sim.step(command)

    def bare() -> None:
        sim.reset()
        for targets in ctrl:
            sim.data.ctrl[:] = targets
            mujoco.mj_step(sim.model, sim.data, substeps)

    took = interleaved({"ours": ours, "bare": bare}, repeats)
    per_step = {name: 1e6 * seconds / (500 * substeps) for name, seconds in took.items()}
    ratio = f"{took['ours'] / took['bare']:.2f}"
    return "Ten seconds of physics, free-standing, contact and state noted at every step", [
        ("Simulator.step (µs/step)", "mj_step (µs/step)", "ratio", "times real time"),
        (f"{per_step['ours']:.0f}", f"{per_step['bare']:.0f}", ratio, f"{10 / took['ours']:.0f}"),
    ]


def startup(repeats: int) -> tuple[str, Rows]:
    """Commands that do next to nothing against a bare interpreter, and against importing what they need."""
    imports = "import mujoco, dm_control.mjcf, numpy, scipy.spatial"
    with tempfile.TemporaryDirectory() as name:
        pose = Path(name) / "pose.csv"
        pose.write_text("time,LShoulderPitch_deg\n0,80\n", encoding="utf-8")
        report = Path(name) / "r.json"
        took = interleaved(
            {
                "python -c pass": _command("-c", "pass"),
                "import nao_sim": _command("-c", "import nao_sim"),
                "nao-sim --help": _command("-m", "nao_sim.cli", "--help"),
                "importing MuJoCo, dm_control and SciPy": _command("-c", imports, MUJOCO_GL="disable"),
                "play a single pose, no video": _command(
                    "-m", "nao_sim.play", pose, "-q", "--no-video", "--report", report
                ),
            },
            2 * repeats,
        )
    floors = {"import nao_sim": "python -c pass", "nao-sim --help": "python -c pass"}
    floors["play a single pose, no video"] = "importing MuJoCo, dm_control and SciPy"
    rows: Rows = [("command", "s", "floor", "floor (s)", "ratio")]
    for command, floor in floors.items():
        ratio = took[command] / took[floor]
        rows.append((command, f"{took[command]:.2f}", floor, f"{took[floor]:.2f}", f"{ratio:.1f}"))
    return "Start-up", rows


BENCHMARKS = {"play": play, "physics": physics, "startup": startup}


def machine() -> str:
    """The machine in words."""
    model = platform.processor() or platform.machine()
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
            break
    load = os.getloadavg()[0]
    cores = len(os.sched_getaffinity(0))
    return f"{cores} cores of {model}, Linux, Python {platform.python_version()}, load {load:.1f} at the start"


def table(rows: Rows) -> str:
    head, *body = rows
    lines = ["| " + " | ".join(row) + " |" for row in (head, ("---",) * len(head), *body)]
    return "\n".join(lines)


def note(title: str, rows: Rows, command: str, where: str, only_print: bool = False) -> None:
    """Print a table of results, and add it to RESULTS.md."""
    section = f"\n## {title}\n\n{date.today()}, {where}. `python benchmarks/{command}`\n\n{table(rows)}\n"
    print(section)
    if not only_print:
        with RESULTS.open("a", encoding="utf-8") as file:
            file.write(section)


def main(words: Sequence[str] | None = None) -> None:
    """Measure and append."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"any of {', '.join(BENCHMARKS)}")
    parser.add_argument("--repeats", type=int, default=5, help="runs that count, of each side (default 5)")
    parser.add_argument("--print", action="store_true", help="print only, leave RESULTS.md alone")
    args = parser.parse_args(words)
    if unknown := set(args.names) - set(BENCHMARKS):
        parser.error(f"unknown benchmark {', '.join(sorted(unknown))}; expected any of {', '.join(BENCHMARKS)}")
    for name in args.names or BENCHMARKS:
        where = machine()
        title, rows = BENCHMARKS[name](args.repeats)
        note(title, rows, f"benchmark.py {name} --repeats {args.repeats}", where, args.print)


if __name__ == "__main__":
    main()
