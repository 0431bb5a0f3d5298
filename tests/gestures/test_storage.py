import numpy as np
import pytest
from gestures.postures import held, readings, thesis

from nao_sim.errors import UsageError
from nao_sim.gestures.poses import PoseRecogniser
from nao_sim.gestures.storage import load_recogniser, save


@pytest.fixture(scope="module")
def recogniser():
    rows, labels, _ = thesis()
    return PoseRecogniser.fit(rows, labels).taught("one up, one ahead", readings(held("up", "forward")))


def test_what_is_loaded_predicts_what_was_saved(recogniser, tmp_path):
    save(tmp_path / "poses.npz", recogniser)
    loaded = load_recogniser(tmp_path / "poses.npz")
    rows, _, _ = thesis()
    assert loaded.names == recogniser.names
    assert np.array_equal(loaded.probabilities(rows), recogniser.probabilities(rows))


def test_a_file_holds_no_pickle(recogniser, tmp_path):
    save(tmp_path / "poses.npz", recogniser)
    with np.load(tmp_path / "poses.npz", allow_pickle=False) as file:
        assert all(not file[name].dtype.hasobject for name in file.files)


def test_any_damage_is_told_in_one_line(recogniser, tmp_path):
    path = tmp_path / "poses.npz"
    save(path, recogniser)
    whole = path.read_bytes()
    for place in range(0, len(whole), 97):
        path.write_bytes(whole[:place])
        _refused(path)
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 0x55]) + whole[place + 1 :])
        try:
            assert load_recogniser(path).names == recogniser.names  # a byte that says nothing
        except UsageError as error:
            assert str(path) in str(error) and "\n" not in str(error)


def test_files_from_elsewhere_are_refused(recogniser, tmp_path):
    path = tmp_path / "model.npz"
    _refused(path)
    for content in (b"", b"model\n", b"\x80\x04K\x01."):
        path.write_bytes(content)
        _refused(path)
    np.savez(path, means=np.zeros(3))
    _refused(path, "no recogniser")
    np.save(tmp_path / "array.npy", np.zeros(3))
    _refused(tmp_path / "array.npy", "single array")
    np.savez(path, **{**_saved(recogniser, tmp_path), "version": np.array(99)})
    _refused(path, "version 99")
    np.savez(path, **{**_saved(recogniser, tmp_path), "means": recogniser.means * 0.9})
    _refused(path, "damaged")


def test_objects_in_a_file_are_not_unpickled(tmp_path):
    np.savez(tmp_path / "evil.npz", names=np.array([{"a": 1}], dtype=object))
    _refused(tmp_path / "evil.npz")


def _saved(recogniser, folder):
    save(folder / "good.npz", recogniser)
    with np.load(folder / "good.npz") as file:
        return dict(file)


def _refused(path, said=""):
    with pytest.raises(UsageError) as error:
        load_recogniser(path)
    assert str(path) in str(error.value) and "expected" in str(error.value) and said in str(error.value)
    assert "\n" not in str(error.value)
