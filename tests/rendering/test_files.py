"""Files appear whole or not at all."""

from pathlib import Path

import pytest

from nao_sim.errors import UsageError
from nao_sim.rendering.files import draft_of, target_of


def test_an_unknown_kind_is_refused_with_the_known_ones():
    with pytest.raises(UsageError, match=r"cannot write '.avi' files; expected one of .mp4, .webm, .gif, .png"):
        target_of(Path("wave.avi"))


def test_a_result_replaces_an_older_one_at_the_end(tmp_path):
    film = tmp_path / "a.mp4"
    film.write_text("old")
    with draft_of(film) as draft:
        draft.write_text("new")
        assert film.read_text() == "old" and draft.suffix == ".mp4"
    assert film.read_text() == "new" and list(tmp_path.iterdir()) == [film]


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt])
@pytest.mark.parametrize("name", ["a.mp4", "a.png"])
def test_after_an_error_nothing_is_left(tmp_path, error, name):
    with pytest.raises(error), draft_of(tmp_path / name) as draft:
        if name.endswith(".png"):
            draft.mkdir()
            (draft / "frame_00001.png").write_text("half")
        else:
            draft.write_text("half")
        raise error
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("where", ["missing/a.mp4", "file/a.mp4"])
def test_a_folder_that_cannot_be_written_is_refused_at_once(tmp_path, where):
    (tmp_path / "file").write_text("")
    with pytest.raises(UsageError, match=r"a.mp4: cannot write there"), draft_of(tmp_path / where):
        pytest.fail("must not get here")


def test_frames_replace_frames_but_nothing_else(tmp_path):
    folder = tmp_path / "a"
    folder.mkdir()
    (folder / "frame_00007.png").write_text("old")
    with draft_of(tmp_path / "a.png") as draft:
        draft.mkdir()
        (draft / "frame_00001.png").write_text("new")
    assert [path.name for path in folder.iterdir()] == ["frame_00001.png"]
    (folder / "thesis.txt").write_text("dear")
    with pytest.raises(UsageError, match=r"other things than frames"), draft_of(tmp_path / "a.png"):
        pytest.fail("must not get here")


def test_a_film_does_not_replace_a_folder(tmp_path):
    (tmp_path / "a.mp4").mkdir()
    with pytest.raises(UsageError, match=r"is a folder"), draft_of(tmp_path / "a.mp4"):
        pytest.fail("must not get here")
