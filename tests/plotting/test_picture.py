"""Pictures of recordings: of the right size, about the recording, and drawn without a display."""

from __future__ import annotations

import subprocess
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from PIL import Image

from nao_sim.errors import UsageError
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.paths import TRAJECTORIES
from nao_sim.plotting import save_picture
from nao_sim.plotting.angles_page import angles_page
from nao_sim.plotting.panels import bones_seen, columns
from nao_sim.plotting.person_page import person_page
from nao_sim.plotting.stick_figures import key_frames, spacing
from nao_sim.plotting.style import styled
from nao_sim.recordings import Recording, load
from nao_sim.robot import load_robot
from tests.people import person
from tests.tracking import JOINTS, spoiled, tracked

ROBOT = load_robot()
WIDTH = 1440  # pixels


def recorded(motion: Skeleton | JointTrajectory, name: str = "some.txt") -> Recording:
    return Recording(Path(name), "a format", "a reason", motion, len(motion))


def pixels(motion: Skeleton | JointTrajectory, folder: Path, name: str = "some.txt") -> np.ndarray:
    path = folder / "picture.png"
    save_picture(recorded(motion, name), path)
    with Image.open(path) as picture:
        return np.asarray(picture.convert("RGB"))


def wave(frames: int = 50) -> JointTrajectory:
    positions = np.full((frames, 26), np.nan)
    positions[:, ROBOT.index["LShoulderPitch"]] = np.linspace(-1.0, 3.0, frames)
    positions[:, ROBOT.index["RShoulderPitch"]] = 0.5
    positions[:, ROBOT.index["HeadYaw"]] = 0.1
    return JointTrajectory(np.arange(frames) / 50.0, positions, np.isfinite(positions).any(axis=0))


def test_a_picture_of_a_person_has_the_pages_width_and_something_on_it(tmp_path: Path) -> None:
    picture = pixels(person(40, joints=JOINTS), tmp_path)
    assert picture.shape[1] == WIDTH and 800 < picture.shape[0] < 1800
    assert 0.01 < (picture.min(axis=2) < 250).mean() < 0.6
    assert list(tmp_path.iterdir()) == [tmp_path / "picture.png"]


def test_the_same_recording_gives_the_same_picture_and_another_another(tmp_path: Path) -> None:
    first = pixels(person(1, seed=1, joints=JOINTS), tmp_path)
    assert np.array_equal(first, pixels(person(1, seed=1, joints=JOINTS), tmp_path))
    other = pixels(person(1, seed=2, joints=JOINTS), tmp_path)
    assert first.shape != other.shape or not np.array_equal(first, other)


def test_dropouts_can_be_seen(tmp_path: Path) -> None:
    whole = person(200, joints=JOINTS)
    positions = np.array(whole.positions)
    positions[80:120, JOINTS.index("head")] = np.nan
    dark = [(pixels(each, tmp_path).max(axis=2) < 60).sum() for each in (whole, replace(whole, positions=positions))]
    assert dark[1] > dark[0] + 1000


def test_left_and_right_are_of_different_colours(tmp_path: Path) -> None:
    blue, orange = (np.array([0, 114, 178]), np.array([213, 94, 0]))

    def coloured(joint: str, colour: np.ndarray) -> int:
        with styled():
            figure = person_page(person(1, joints=(f"{joint}_shoulder", f"{joint}_elbow", f"{joint}_wrist")))
            axes = figure.axes[0]
            axes.get_legend().remove()
            figure.savefig(tmp_path / "strip.png")
        with Image.open(tmp_path / "strip.png") as picture:
            return int((np.abs(np.asarray(picture.convert("RGB")).astype(int) - colour).max(axis=2) < 8).sum())

    assert coloured("left", blue) > 100 and coloured("left", orange) == 0
    assert coloured("right", orange) > 100 and coloured("right", blue) == 0


def panels(skeleton: Skeleton) -> list[str]:
    with styled():
        return [axes.get_title(loc="left") for axes in person_page(skeleton).axes if axes.get_title(loc="left")]


def test_what_is_on_the_page_depends_on_what_is_in_the_recording() -> None:
    views, bones = ["from the front", "from the right side"], ["upper arm", "forearm"]
    assert panels(person(40, joints=JOINTS)) == [*views, "confidence", *bones]
    assert panels(person(40)) == [*views, "confidence", *bones, "thigh", "shank"]
    assert panels(person(1, joints=JOINTS)) == views
    assert panels(person(40, joints=("left_hand", "right_hand"))) == [*views, "confidence"]
    flat = person(40, joints=JOINTS)
    flat = replace(flat, positions=flat.positions * [0.0, 1.0, 1.0], planar=True)
    assert panels(flat) == ["from the front", "confidence", *bones]


def test_every_axis_has_a_unit() -> None:
    with styled():
        figures = [person_page(person(40)), angles_page(wave(), ROBOT)]
    for axes in (axes for figure in figures for axes in figure.axes):
        labels = [axes.get_xlabel(), axes.get_ylabel()]
        assert all(label == "" or label.endswith(")") or label == "opening" for label in labels)
    assert [axes.get_title(loc="left") for axes in figures[1].axes] == ["HeadYaw", "ShoulderPitch"]


@pytest.mark.parametrize("kind", [".png", ".svg", ".pdf", ".PNG"])
def test_the_names_ending_says_the_kind_of_picture(kind: str, tmp_path: Path) -> None:
    path = tmp_path / f"picture{kind}"
    save_picture(recorded(person(1, joints=JOINTS)), path)
    start = path.read_bytes()[:8]
    if kind == ".svg":
        assert ET.parse(path).getroot().tag.endswith("svg")
    else:
        assert start.startswith(b"%PDF" if kind == ".pdf" else b"\x89PNG")


@pytest.mark.parametrize("name", ["$x_{.txt", "grüße 手.txt", "a\nb.txt", "%s {0} \\frac.txt"])
def test_any_name_of_a_file_can_be_a_title(name: str, tmp_path: Path) -> None:
    assert pixels(person(1, joints=JOINTS), tmp_path, name).shape[1] == WIDTH


@settings(max_examples=3)
@given(tracked())
def test_any_person_can_be_drawn(skeleton: Skeleton) -> None:
    with styled():
        person_page(skeleton).canvas.draw()


@pytest.mark.parametrize("frames", [1, 2, 50])
def test_any_length_of_joint_angles_can_be_drawn(frames: int, tmp_path: Path) -> None:
    assert pixels(wave(frames), tmp_path).shape[1] == WIDTH


def test_a_person_of_whom_nothing_is_seen_can_be_drawn(tmp_path: Path) -> None:
    nobody = Skeleton(np.arange(5) / 30.0, np.full((5, 2, 3), np.nan), ("head", "left_wrist"))
    assert pixels(nobody, tmp_path).shape[1] == WIDTH


def test_neither_a_display_nor_the_users_settings_matter(tmp_path: Path) -> None:
    (tmp_path / "matplotlibrc").write_text("backend: tkagg\nfigure.facecolor: red\nfont.size: 30\n", encoding="utf-8")
    sample, path = TRAJECTORIES / "wave.csv", tmp_path / "other.png"
    script = (
        "import sys; from nao_sim.cli import main\n"
        f"assert main(['inspect', {str(sample)!r}, '--plot', {str(path)!r}, '-q']) == 0\n"
        "assert 'matplotlib' in sys.modules and 'matplotlib.pyplot' not in sys.modules\n"
    )
    environment = {"PATH": "", "MPLCONFIGDIR": str(tmp_path), "MATPLOTLIBRC": str(tmp_path / "matplotlibrc")}
    subprocess.run([sys.executable, "-c", script], check=True, env=environment)
    save_picture(load(sample), tmp_path / "picture.png")
    with Image.open(path) as other, Image.open(tmp_path / "picture.png") as picture:
        assert np.array_equal(np.asarray(other), np.asarray(picture))


def test_where_nothing_can_be_written_the_message_names_the_place(tmp_path: Path) -> None:
    path = tmp_path / "missing" / "picture.png"
    with pytest.raises(UsageError, match=str(path)):
        save_picture(recorded(person(2, joints=JOINTS)), path)


@settings(max_examples=20)
@given(tracked())
def test_key_frames_are_of_the_recording_in_order_from_beginning_to_end(skeleton: Skeleton) -> None:
    frames = key_frames(skeleton)
    assert 1 <= len(frames) <= min(6, len(skeleton)) and (np.diff(frames) > 0).all()
    span = skeleton.times[-1] - skeleton.times[0]
    assert skeleton.times[frames[0]] - skeleton.times[0] <= span / 4
    assert skeleton.times[-1] - skeleton.times[frames[-1]] <= span / 4


def test_key_frames_avoid_dropouts() -> None:
    skeleton = spoiled(person(300, joints=JOINTS), np.random.default_rng(0), dropouts=0.1)
    seen = np.isfinite(skeleton.positions).all(axis=(1, 2))
    assert seen.mean() < 0.5 and seen[key_frames(skeleton)].all()


def test_figures_side_by_side_do_not_touch() -> None:
    skeleton = person(60, joints=JOINTS)
    frames = np.arange(60)
    reach = np.ptp(skeleton.positions[:, :, :2], axis=1).max()
    assert spacing(skeleton, frames) > reach


@pytest.mark.parametrize(("frames", "most"), [(2, 10), (10, 10), (11, 10), (1000, 7)])
def test_columns_hold_every_frame_once_and_leave_pauses_free(frames: int, most: int) -> None:
    times = np.arange(frames) / 30.0
    times[frames // 2 :] += 1.0
    edges, members = columns(times, most)
    assert len(members) <= most and len(edges) == 2 * len(members) and (np.diff(edges) >= -1e-12).all()
    assert members[0, 0] == 0 and members[-1, 1] == frames and np.array_equal(members[1:, 0], members[:-1, 1])
    if frames == most:
        free = np.diff(edges)[1::2]
        assert free.max() > 0.9 and (free > 1e-9).sum() == 1


def test_bones_that_are_never_seen_have_no_panel() -> None:
    skeleton = person(10, joints=JOINTS)
    positions = np.array(skeleton.positions)
    positions[:, [JOINTS.index("left_wrist"), JOINTS.index("right_wrist")]] = np.nan
    assert bones_seen(replace(skeleton, positions=positions)) == ["upper arm"]
