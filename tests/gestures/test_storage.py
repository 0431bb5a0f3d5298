import numpy as np
import pytest
from gestures.postures import held, readings, skeleton, thesis

from nao_sim.errors import UsageError
from nao_sim.gestures.movements import MovementRecogniser
from nao_sim.gestures.poses import PoseRecogniser
from nao_sim.gestures.storage import load_vocabulary, save
from nao_sim.gestures.vocabulary import Vocabulary, built_in_motions
from nao_sim.gestures.windows import window_of


@pytest.fixture(scope="module")
def vocabulary():
    rows, labels, _ = thesis()
    poses = PoseRecogniser.fit(rows, labels).taught("one up, one ahead", readings(held("up", "forward")))
    lift = np.linspace(held("down"), held("forward"), 30)
    motions = {name: motion for name, motion in built_in_motions().items() if name in ("side", "piUp")}
    return Vocabulary(poses, MovementRecogniser.fit([window_of(skeleton(lift))], ["lift"]), motions)


def test_what_is_loaded_decides_and_moves_as_what_was_saved(vocabulary, tmp_path):
    save(tmp_path / "mine.vocab", vocabulary)
    loaded = load_vocabulary(tmp_path / "mine.vocab")
    rows, _, _ = thesis()
    assert loaded.names == vocabulary.names
    assert np.array_equal(loaded.poses.probabilities(rows), vocabulary.poses.probabilities(rows))
    window = window_of(skeleton(np.linspace(held("down"), held("side"), 40)))
    assert loaded.movements.decide(window) == vocabulary.movements.decide(window)
    assert loaded.motions.keys() == vocabulary.motions.keys()
    for name, motion in vocabulary.motions.items():
        for part in ("times", "positions", "given"):
            np.testing.assert_array_equal(getattr(loaded.motions[name], part), getattr(motion, part))


def test_a_vocabulary_of_one_kind_is_loaded_as_such(vocabulary, tmp_path):
    for one in (Vocabulary(vocabulary.poses), Vocabulary(movements=vocabulary.movements)):
        save(tmp_path / "one.vocab", one)
        loaded = load_vocabulary(tmp_path / "one.vocab")
        assert loaded.names == one.names and not loaded.motions
        assert (loaded.poses is None, loaded.movements is None) == (one.poses is None, one.movements is None)


def test_a_file_holds_no_pickle(vocabulary, tmp_path):
    save(tmp_path / "mine.vocab", vocabulary)
    with np.load(tmp_path / "mine.vocab", allow_pickle=False) as file:
        assert all(not file[name].dtype.hasobject for name in file.files)


def test_any_damage_is_told_in_one_line(vocabulary, tmp_path):
    path = tmp_path / "mine.vocab"
    save(path, vocabulary)
    whole = path.read_bytes()
    for place in range(0, len(whole), len(whole) // 40):
        path.write_bytes(whole[:place])
        _refused(path)
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 0x55]) + whole[place + 1 :])
        try:
            assert load_vocabulary(path).names == vocabulary.names  # a byte that says nothing
        except UsageError as error:
            assert str(path) in str(error) and "\n" not in str(error)


def test_files_from_elsewhere_are_refused(vocabulary, tmp_path):
    path = tmp_path / "model.npz"
    _refused(path)
    for content in (b"", b"model\n", b"\x80\x04K\x01."):
        path.write_bytes(content)
        _refused(path)
    np.savez(path, means=np.zeros(3))
    _refused(path, "no vocabulary")
    np.save(tmp_path / "array.npy", np.zeros(3))
    _refused(tmp_path / "array.npy", "single array")
    np.savez(path, **{**_saved(vocabulary, tmp_path), "nao_sim_vocabulary": np.array(99)})
    _refused(path, "version 99")
    np.savez(path, **{**_saved(vocabulary, tmp_path), "poses.means": vocabulary.poses.means * 0.9})
    _refused(path, "damaged")


def test_objects_in_a_file_are_not_unpickled(tmp_path):
    np.savez(tmp_path / "evil.npz", names=np.array([{"a": 1}], dtype=object))
    _refused(tmp_path / "evil.npz")


def _saved(vocabulary, folder):
    save(folder / "good.npz", vocabulary)
    with np.load(folder / "good.npz") as file:
        return dict(file)


def _refused(path, said=""):
    with pytest.raises(UsageError) as error:
        load_vocabulary(path)
    assert str(path) in str(error.value) and "expected" in str(error.value) and said in str(error.value)
    assert "\n" not in str(error.value)
