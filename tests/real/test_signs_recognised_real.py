"""Signs of ten people: signers left out are recognised."""

import tarfile
from pathlib import Path

import numpy as np
import pytest

from nao_sim.errors import RecordingError
from nao_sim.gestures.movements import MovementRecogniser
from nao_sim.gestures.windows import window_of
from nao_sim.recordings import load

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "recordings" / "isl_kinect_signs"
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason=f"no {FOLDER}")


def test_signers_left_out_are_recognised(tmp_path):
    with tarfile.open(FOLDER / "signs12_10people_3reps.tar.xz") as archive:
        archive.extractall(tmp_path, filter="data")
    windows, words, signers = [], [], []
    for path in sorted(tmp_path.rglob("*_1.txt")):
        try:
            windows.append(window_of(load(path).motion))
        except RecordingError:
            continue  # one file in which the sensor has lost the person
        word, signer, _ = path.stem.split("_")
        words.append(word)
        signers.append(signer)
    assert len(windows) >= 119
    words, signers = np.array(words), np.array(signers)
    right = []
    for pair in np.unique(signers).reshape(-1, 2)[:1]:  # more of them in benchmarks/movements.py
        rest = ~np.isin(signers, pair)
        recogniser = MovementRecogniser.fit([windows[i] for i in np.flatnonzero(rest)], words[rest])
        right += [recogniser.decide(windows[i]).nearest == words[i] for i in np.flatnonzero(~rest)]
    assert np.mean(right) >= 0.9  # of 8 signers each and one repetition of three
