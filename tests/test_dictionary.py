"""A page of all gestures."""

from __future__ import annotations

import signal
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from nao_sim.cli import main
from nao_sim.dictionary import key_poses
from nao_sim.errors import UsageError
from nao_sim.gestures.storage import save
from nao_sim.gestures.vocabulary import Vocabulary, built_in
from nao_sim.robot import START_POSTURE, load_robot
from tests.pictures import needs_gl

ROBOT = load_robot()
PLAIN = ["--size", "40x48", "--quality", "draft"]


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """Run in an empty folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(signal, "signal", lambda *_: None)


def test_every_gesture_with_a_motion_is_shown_at_a_pose_of_it_and_its_twin_in_the_mirror():
    known = built_in()
    poses = key_poses(known, ROBOT)
    assert set(poses) >= set(known.motions) | set(known.names)
    for name, pose in poses.items():
        motion = known.motion_of(name)
        assert ((motion.positions == pose) | ~motion.given).all(axis=1).any(), name
        if name.startswith("left_"):
            twin = poses[name.replace("left_", "right_")]
            np.testing.assert_allclose(ROBOT.mirror(pose), twin, atol=1e-6)
    assert np.abs(poses["up"] - ROBOT.postures[START_POSTURE]).max() > 1.0


def test_a_vocabulary_without_motions_is_refused_in_one_line(capsys):
    with pytest.raises(UsageError, match="no gesture has a motion"):
        key_poses(Vocabulary(built_in().poses), ROBOT)
    save(Path("bare.vocab"), Vocabulary(built_in().poses))
    assert main(["dictionary", "--vocabulary", "bare.vocab", "-o", "d.png", *PLAIN]) == 2
    assert capsys.readouterr().err.count("\n") == 1 and not Path("d.png").exists()


@needs_gl
def test_the_page_has_a_picture_for_each(capsys):
    assert main(["dictionary", "-o", "d.png", "--columns", "4", *PLAIN]) == 0
    count = len(key_poses(built_in(), ROBOT))
    assert f"({count} gestures)" in capsys.readouterr().out
    with Image.open("d.png") as page:
        assert page.width // 4 in range(40, 46) and page.height // -(-count // 4) in range(48, 70)
