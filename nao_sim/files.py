"""Files appear whole or not at all."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from nao_sim.errors import UsageError


@contextmanager
def beside(target: Path) -> Iterator[Path]:
    """A temporary name in the same folder that becomes `target` at the end, and is removed after any error.

    What is written there may be a file or a folder.  Drafts that a killed
    process left for the same target are cleared away.

    Raises:
        UsageError: the folder is missing or cannot be written.
    """
    _clear_abandoned(target)
    draft = target.with_name(f".{target.stem}-{os.getpid()}{target.suffix}")
    try:
        draft.touch()  # says now, not after the work, that the folder cannot be written
        draft.unlink()
    except OSError as error:
        raise UsageError(f"{target}: cannot write there: {error.strerror}") from None
    try:
        yield draft
        if target.is_dir():
            shutil.rmtree(target)
        draft.replace(target)
    finally:
        remove(draft)


def check_results(results: Iterable[Path | None], *sources: Path) -> None:
    """Say before the work what cannot be written.

    Raises:
        UsageError: a result would overwrite a source or another result, or is a folder.
    """
    read = {source.resolve() for source in sources}
    taken: set[Path] = set()
    for path in results:
        if path is None:
            continue
        if path.resolve() in read:
            raise UsageError(f"{path}: would overwrite the recording; expected another name")
        if path.is_dir():
            raise UsageError(f"{path}: is a folder; expected the name of a file")
        if path.resolve() in taken:
            raise UsageError(f"{path}: named for two results; expected a name for each")
        taken.add(path.resolve())


def make_folder(folder: Path) -> None:
    """Make a folder for results; a new one keeps itself out of version control.

    Raises:
        UsageError: it cannot be made, or is something else.
    """
    if folder.is_dir():
        return
    try:
        folder.mkdir(parents=True)
        (folder / ".gitignore").write_text("*\n", encoding="utf-8")
    except OSError as error:
        raise UsageError(f"{folder}: cannot make this folder: {error.strerror}") from None


def remove(path: Path) -> None:
    """Remove a file or folder, if it is there."""
    if path.is_dir():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)


def _clear_abandoned(target: Path) -> None:
    """Remove drafts of processes that are no more."""
    if not target.parent.is_dir():
        return
    for path in target.parent.iterdir():
        pid = path.name.removeprefix(f".{target.stem}-").removesuffix(target.suffix)
        if path.name == f".{target.stem}-{pid}{target.suffix}" and pid.isdecimal() and not _runs(int(pid)):
            remove(path)


def _runs(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        return True
    return True
