"""Points in NumPy's files: any order of axes, times, rates, names; what is refused."""

import io
import zipfile

import numpy as np
import pytest

from nao_sim.errors import RecordingError
from nao_sim.recordings import load
from nao_sim.recordings.skeletons.layouts import builtin
from tests.people import in_file, person

JOINTS = next(layout.joints for layout in builtin() if layout.name == "Kinect v2")
NAME = "NumPy arrays of points"


@pytest.fixture
def write(tmp_path):
    def write(**arrays):
        path = tmp_path / ("points.npz" if arrays.keys() != {"alone"} else "points.npy")
        np.savez(path, **arrays) if path.suffix == ".npz" else np.save(path, arrays["alone"])
        return path

    return write


@pytest.mark.parametrize("change", [
    lambda v: v, lambda v: v.transpose(1, 2, 0), lambda v: v[None], lambda v: v.reshape(len(v), -1),
    lambda v: np.hstack([np.arange(len(v))[:, None] / 30, v.reshape(len(v), -1)]), lambda v: v.astype("f4"),
    lambda v: np.dstack([v, np.full(v.shape[:2], 2)]).reshape(len(v), -1),
])  # fmt: skip
@pytest.mark.parametrize("name", ["alone", "positions", "joints"])
def test_every_order_of_axes_reads_the_same(write, change, name):
    expected = person(40, joints=JOINTS)
    recording = load(write(**{name: change(in_file(expected, JOINTS))}))
    assert recording.format == NAME and recording.motion.joints == JOINTS
    np.testing.assert_allclose(recording.motion.positions, expected.positions, atol=1e-6)
    np.testing.assert_allclose(recording.motion.times, expected.times, atol=1e-6)


def test_times_rates_and_names_beside_the_points(write):
    expected = person(40, joints=JOINTS)
    values = in_file(expected, JOINTS, 0.001)
    assert load(write(points=values, fps=60.0)).motion.times[-1] == pytest.approx(39 / 60)
    assert load(write(points=values, times=np.arange(40) * 0.1)).motion.times[-1] == pytest.approx(3.9)
    named = load(write(points=values[:, ::-1], names=np.array(JOINTS[::-1]), other=np.zeros(4))).motion
    np.testing.assert_allclose(named.track("left_wrist"), expected.track("left_wrist"), atol=1e-9)


def test_one_of_several_people_is_asked_for(write):
    path = write(**{name: in_file(person(40, seed), JOINTS) for seed, name in enumerate("ab")})
    with pytest.raises(RecordingError, match=r"several people: a .*, b .*--person"):
        load(path)
    assert len(load(path, person="b").motion) == 40


def test_what_is_no_person_is_told(write):
    with pytest.raises(RecordingError, match=r"array .40 x 25 x 7."):
        load(write(alone=np.zeros((40, 25, 7))))
    with pytest.raises(RecordingError, match=r"array as .*no tracked point"):
        load(write(alone=np.zeros((40, 25, 3))))
    with pytest.raises(RecordingError, match="Object arrays"):
        load(write(alone=np.array([{"joints": 3}, None], object)))


def test_joint_angles_are_another_format(write):
    path = write(
        joint_names=np.array(["HeadYaw"]), positions=np.zeros((3, 1)), times=np.arange(3.0), points=np.zeros((3, 25, 3))
    )
    assert load(path).format == "joint-angle NPZ"


@pytest.mark.parametrize("save", [np.save, lambda stream, points: np.savez_compressed(stream, points=points)])
@pytest.mark.parametrize("share", [0.01, 0.3, 0.7, 0.99])
def test_a_file_cut_off_anywhere_is_one_clear_line(tmp_path, save, share):
    stream = io.BytesIO()
    save(stream, in_file(person(20), JOINTS))
    path = tmp_path / "cut"
    path.write_bytes(stream.getvalue()[: int(len(stream.getvalue()) * share) + 8])
    with pytest.raises(RecordingError) as caught:
        load(path)
    assert "\n" not in str(caught.value)


def test_an_archive_whose_arrays_are_none_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "other.npz", "w") as archive:
        archive.writestr("points.npy", b"no array")
    with pytest.raises(RecordingError):
        load(tmp_path / "other.npz")
