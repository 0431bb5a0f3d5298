"""Files of joint angles that are cut off or have a few wrong bytes: an error of ours or a recording, nothing else."""

import io

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.errors import RecordingError
from nao_sim.recordings import Recording, load
from nao_sim.recordings.angles.choregraphe_python import python_text
from nao_sim.recordings.angles.webots_motion import motion_text
from nao_sim.recordings.angles.writing import joint_csv_text
from tests.recordings.samples import BEHAVIOUR, EXPORT, MOTION, TABLE


def _npz():
    stream = io.BytesIO()
    np.savez_compressed(stream, joint_names=["HeadYaw"], positions=np.zeros((3, 1)), times=np.arange(3.0), unit="rad")
    return stream.getvalue()


SAMPLES = {
    "x.csv": joint_csv_text(MOTION).encode(),
    "x.motion": motion_text(MOTION).encode(),
    "x.npz": _npz(),
    "x.py": python_text(MOTION).encode(),
    "export.py": EXPORT.encode(),
    "x.xar": BEHAVIOUR.encode(),
    "table.csv": TABLE.encode(),
}


@pytest.mark.parametrize("name", SAMPLES)
def test_the_samples_are_whole(write, name):
    assert load(write(SAMPLES[name], name)).frames > 0


def outcome(path):
    try:
        recording = load(path)
    except RecordingError as error:
        assert str(error).startswith(str(path)) and "\n" not in str(error) and "; expected " in str(error)
    else:
        assert isinstance(recording, Recording) and len(recording.motion) > 0


@pytest.mark.parametrize("name", SAMPLES)
@settings(max_examples=60)
@given(data=st.data())
def test_any_beginning_of_a_file(write, name, data):
    content = SAMPLES[name]
    outcome(write(content[: data.draw(st.integers(0, len(content) - 1))], name))


@pytest.mark.parametrize("name", SAMPLES)
@settings(max_examples=60)
@given(data=st.data())
def test_wrong_bytes_anywhere(write, name, data):
    content = bytearray(SAMPLES[name])
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(
            st.sampled_from(b"\0\n\"'()[]<>,;-9eE*#\xff") | st.integers(0, 255)
        )
    outcome(write(bytes(content), name))
