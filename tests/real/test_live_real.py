"""Recordings of other people, streamed: what is asked is what the file path asks after the same filter."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from nao_sim.imitation.filters import Kalman
from nao_sim.imitation.retarget import one_to_one
from nao_sim.imitation.stream import stream_imitation
from nao_sim.motion import Skeleton
from nao_sim.recordings import load

RECORDINGS = Path(__file__).resolve().parents[3] / "shared" / "recordings"
FILES = (
    "labanotation_kinect/samples/Ges06_chickenwing.csv",
    "isl_kinect_signs/samples/strong_s01_1.txt",
    "turkish_signs/samples/anne.json",
)


@pytest.mark.skipif(not RECORDINGS.is_dir(), reason="../shared/recordings is absent")
@pytest.mark.parametrize("name", FILES)
def test_a_real_recording_streamed_asks_the_same_to_1e_9_but_for_the_nod_of_the_faceless(robot, name):
    person = load(RECORDINGS / name).motion
    assert isinstance(person, Skeleton)
    streamed, whole = stream_imitation(person, robot), one_to_one(Kalman().filter(person), robot)
    faceless = {"nose", "left_eye"}.isdisjoint(person.joints)
    same = np.arange(26) != (robot.index["HeadPitch"] if faceless else -1)
    np.testing.assert_allclose(streamed[:, same], whole[:, same], rtol=0.0, atol=1e-9)
