"""The files that the documentation's commands name, and what is left out of these commands here.

| in the documents | here |
|---|---|
| `./run X`, `nao-sim X` | `nao_sim.cli.main` in this process |
| `trajectories/...` | the repository's own, as they are |
| `kinect.csv`, `session.csv`, `anna.csv`, `ben.csv` | 1.6 s of `trajectories/person_wave.csv`, in which the hand is raised |
| `sign.json` | 20 landmarks files' frames of a made-up person |
| `trial.amc` | 3 frames of a made-up rig, its skeleton beside it |
| `motion.csv` | `trajectories/wave.csv`'s second second without times and units |
| `TaiChi.motion` | the same second, as Webots has it |
| `legs.csv` | bent knees |
| `gestures.csv` | `trajectories/thesis_users.csv` |
| films and pictures | 2 frames a second of 64x48 pixels, `draft` |
| `*.csv` | the stand-ins: the folder has no other |
| commands of `ELSEWHERE` | not run here; the table says where they are |
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from nao_sim.motion import JointTrajectory
from nao_sim.paths import TRAJECTORIES
from tests.docs.shown import ROOT, Step

PERSON = TRAJECTORIES / "person_wave.csv"
PLAIN = " --size 64x48 --quality draft"
SMALL = {"play": f" --fps 2{PLAIN}", "still": PLAIN, "dictionary": PLAIN}

# What is not run here, and why.
ELSEWHERE = {
    "./run test": "this is it",
    "pip install .": "tests/packaging/test_wheel.py installs the wheel",
    "pip install --no-deps -r requirements.lock && pip install --no-deps .": "likewise, and test_run_script.py",
    "PYTHON=python3.12 ./run": "tests/packaging/test_run_script.py",
    "python -m mujoco.viewer": "needs a display",
    "mkdocs build --strict": "tests/docs/test_site.py",
    "mkdocs serve": "goes on until it is ended; test_site.py builds the same",
    "python render/gallery/make.py": "two minutes; test_gallery.py compares its page",
    "python docs/tools/reference.py": "test_reference.py runs it with --check",
    "python trajectories/make_trajectories.py": "tests/recordings/test_trajectories.py",
    "python benchmarks/": "minutes to hours",
}


def elsewhere(step: Step) -> bool:
    """Whether a command is tried in another place, or cannot be."""
    return step.command.replace(".venv/bin/", "").startswith(tuple(ELSEWHERE))


def adapted(step: Step) -> str:
    """The command, with small and coarse pictures."""
    return re.sub(r"^(\S+ (\w+)[^#]*?)(?= *(#|&&|$))", lambda found: found[1] + SMALL.get(found[2], ""), step.command)


def furnish(folder: Path) -> None:
    """Put the stand-ins and what else a checkout has into a folder."""
    for name in ("trajectories", "models"):
        (folder / name).symlink_to(ROOT / name)
    lines = PERSON.read_text(encoding="utf-8").splitlines(keepends=True)
    raised = "".join(lines[15:63])
    for name in ("kinect.csv", "session.csv", "anna.csv", "ben.csv"):
        (folder / name).write_text(raised, encoding="utf-8")
    _people(folder)
    _robots(folder)
    manifest = (TRAJECTORIES / "thesis_users.csv").read_text(encoding="utf-8")
    (folder / "gestures.csv").write_text(manifest.replace("thesis_table", "trajectories/thesis_table"), encoding="utf-8")


def _people(folder: Path) -> None:
    from tests.landmark_files import SHAPES, numbers, seen
    from tests.recordings.rigs.test_acclaim import amc_text, asf_text, some_frames

    landmarks = SHAPES["tables with pose_landmarks"](numbers(seen(20)))
    (folder / "sign.json").write_text(landmarks, encoding="utf-8")
    (folder / "trial.asf").write_text(asf_text(), encoding="utf-8")
    (folder / "trial.amc").write_text(amc_text(some_frames(3, size=5.0)), encoding="utf-8")


def _robots(folder: Path) -> None:
    from nao_sim.recordings import load, write_motion

    wave = load(TRAJECTORIES / "wave.csv").motion
    second = (wave.times >= 1.0) & (wave.times < 2.0)
    cut = JointTrajectory(wave.times[second] - wave.times[second][0], wave.positions[second], wave.given)
    write_motion(folder / "TaiChi.motion", cut)
    header = "LShoulderPitch,RShoulderPitch\n"
    rows = "".join(f"{80 - 10 * np.sin(at):.3f},80\n" for at in np.arange(30) / 30)
    (folder / "motion.csv").write_text(header + rows, encoding="utf-8")
    (folder / "legs.csv").write_text("time,LKneePitch_deg,RKneePitch_deg\n0,40,40\n0.5,45,45\n", encoding="utf-8")
