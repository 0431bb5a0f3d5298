"""The files that the documentation's commands name, and what is left out of these commands here.

| in the documents | here |
|---|---|
| `./run X`, `nao-sim X` | `nao_sim.cli.main` in this process, its model compiled once, and one process that draws |
| `person_wave.csv`, `wave.csv`, `stress.csv` of `trajectories` | a piece; whole where output is shown, or `--start` |
| `kinect.csv`, `session.csv` | that piece of `person_wave.csv` |
| `sign.json` | 20 frames of MediaPipe's landmarks of a made-up person |
| `trial.amc` | 3 frames of a made-up rig, its skeleton beside it |
| `motion.csv` | one second without times and units |
| `TaiChi.motion` | the piece of `wave.csv`, as Webots has it |
| `mine.csv` | the first table of docs/tutorials/student.md |
| `legs.csv` | knees that bend a little |
| `lab.txt`, `my.toml` | what docs/layouts.md says of them |
| `gestures.csv` | `trajectories/thesis_users.csv` |
| `recordings/*.csv` | this piece, twice |
| films | 2 frames a second of 64x48 pixels; none where neither the command nor what is shown speaks of it |
| pictures | 64x48 pixels, `draft` |
| a command that another document shows, too | runs once, with what it prints if one shows that |
| commands of `ELSEWHERE` | not here; the table says where, or why not |
"""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import numpy as np

from nao_sim.paths import TRAJECTORIES
from tests.docs.shown import ROOT, Step, blocks

PLAIN = "--size 64x48 --quality draft"
SMALL = {"play": f"--fps 2 {PLAIN}", "still": PLAIN, "dictionary": PLAIN}
OF_A_FILM = ("--video", "--arrange", "--overlay", "--camera", "--look", "--theme", "--show-safety", "--mode both")
PIECES = {"person_wave.csv": (0.5, 2.1), "wave.csv": (1.0, 2.0), "stress.csv": (8.5, 9.2)}  # s
RATE = {"person_wave.csv": 30.0}  # Hz, of those that are not at 50 Hz

# What is not run here (a pattern of how the command begins), and why.
ELSEWHERE = {
    r"\./run test": "this is it",
    r"pip install": "tests/packaging/test_wheel.py installs the wheel",
    r"(mkdocs|python docs/tools/reference\.py|python render/gallery/make\.py)": "the other tests of this folder",
    r"\S+ view (?!.*--export)": "a window, or a server that goes on: tests/viewing",
    r"\S+ live": "a server that goes on: tests/live",
    r"(ssh|printf) ": "another machine, another program",
}


def elsewhere(step: Step) -> bool:
    """Whether a command is tried in another place, or cannot be."""
    return any(re.match(pattern, step.command.replace(".venv/bin/", "")) for pattern in ELSEWHERE)


def adapted(step: Step) -> list[list[str]]:
    """The words of its commands, with small and coarse pictures, or none."""
    commands = []
    for command in re.sub(r"(?<=\s)#.*", "", step.command).split("&&"):
        extra = SMALL.get(command.split()[1], "")
        if " play " in command and "--help" not in command and not any(word in command for word in OF_A_FILM):
            extra = extra if "\nvideo " in (step.shown or "") else "--no-video" * ("--no-video" not in command)
        words = [*shlex.split(command), *extra.split()]
        if step.shown is None and "--start" not in words and "evaluate" not in words:
            words = [word.replace("trajectories/", "pieces/") if Path(word).name in PIECES else word for word in words]
        commands.append(words)
    return commands


def adapted_code(code: str) -> str:
    """Python on short recordings, and with small films."""
    short = re.sub(rf"trajectories/(?={'|'.join(map(re.escape, PIECES))})", "pieces/", code)
    return short.replace("fps=50)", 'fps=2, size=(64, 48), quality="draft")')


def furnish(folder: Path) -> None:
    """Put the stand-ins and what else a checkout has into a folder."""
    for name in ("trajectories", "models"):
        (folder / name).symlink_to(ROOT / name)
    _pieces(folder)
    _people(folder)
    _robots(folder)
    _documented(folder)
    manifest = (TRAJECTORIES / "thesis_users.csv").read_text(encoding="utf-8")
    (folder / "gestures.csv").write_text(
        manifest.replace("thesis_table", "trajectories/thesis_table"), encoding="utf-8"
    )


def _pieces(folder: Path) -> None:
    (folder / "pieces").mkdir()
    for name, (start, end) in PIECES.items():
        lines = (TRAJECTORIES / name).read_text(encoding="utf-8").splitlines(keepends=True)
        head = [line for line in lines if line.startswith(("#", "time"))]
        rows = lines[len(head) :]
        clock = [float(re.split(r"[,\s]", row, maxsplit=1)[0]) for row in rows]
        unit = (clock[-1] - clock[0]) / (len(rows) - 1) * RATE.get(name, 50.0)
        kept = [row for row, at in zip(rows, clock, strict=True) if start <= (at - clock[0]) / unit <= end]
        (folder / "pieces" / name).write_text("".join(head + kept), encoding="utf-8")
    person = (folder / "pieces" / "person_wave.csv").read_bytes()
    (folder / "recordings").mkdir()
    for name in ("kinect.csv", "session.csv", "recordings/anna.csv", "recordings/ben.csv"):
        (folder / name).write_bytes(person)


def _people(folder: Path) -> None:
    from tests.landmark_files import SHAPES, numbers, seen
    from tests.recordings.rigs.test_acclaim import amc_text, asf_text, some_frames

    landmarks = SHAPES["tables with pose_landmarks"](numbers(seen(20)))
    (folder / "sign.json").write_text(landmarks, encoding="utf-8")
    (folder / "trial.asf").write_text(asf_text(), encoding="utf-8")
    (folder / "trial.amc").write_text(amc_text(some_frames(3, size=5.0)), encoding="utf-8")


def _robots(folder: Path) -> None:
    from nao_sim.recordings import load, write_motion

    write_motion(folder / "TaiChi.motion", load(folder / "pieces" / "wave.csv").motion)
    rows = "".join(f"{80 - 10 * np.sin(at):.3f},80\n" for at in np.arange(30) / 30)
    (folder / "motion.csv").write_text(f"LShoulderPitch,RShoulderPitch\n{rows}", encoding="utf-8")
    (folder / "legs.csv").write_text("time,LKneePitch_deg,RKneePitch_deg\n0,40,40\n0.5,45,45\n", encoding="utf-8")


def _documented(folder: Path) -> None:
    """Files that the documents show themselves."""
    student, layouts = (ROOT / "docs" / name for name in ("tutorials/student.md", "layouts.md"))
    (table,) = blocks(student.read_text(encoding="utf-8"), "csv")
    (folder / "mine.csv").write_text(table["text"], encoding="utf-8")
    (layout,) = blocks(layouts.read_text(encoding="utf-8"), "toml")
    (folder / "my.toml").write_text(layout["text"], encoding="utf-8")
    (folder / "lab.txt").write_text(_laboratory(folder / "my.toml"), encoding="utf-8")


def _laboratory(path: Path) -> str:
    from nao_sim.recordings.skeletons.layout_file import read_layout
    from tests.people import in_file, person
    from tests.skeleton_text import text_of

    layout, someone = read_layout(path), person(20, 4)
    values = in_file(someone, layout.joints, 0.01, layout.axes)
    times = {"time": np.round(12040 + someone.times * 1000)}
    return "LabTracker 3 export\n" + text_of(values, layout.rows[0], times, np.full((20, len(layout)), 2.0), ";")
