"""Recordings inside archives: a path goes on into a tar or ZIP file as if it were a folder.

signs.tar.xz/anna/wave.csv
"""

from __future__ import annotations

import lzma
import shutil
import tarfile
import tempfile
import zipfile
import zlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import IO

from nao_sim.errors import RecordingError

WANTED = "a tar or ZIP archive"
_DAMAGED = (tarfile.TarError, zipfile.BadZipFile, lzma.LZMAError, zlib.error, EOFError, NotImplementedError,
            RuntimeError, OSError)  # fmt: skip


def held_by(path: Path) -> Path | None:
    """The file that a path goes on into; None where there is none on the way."""
    return next((parent for parent in path.parents if parent.is_file()), None)


@contextmanager
def unpacked(paths: Iterable[Path]) -> Iterator[dict[Path, Path | RecordingError]]:
    """Where recordings are to be read from, those in archives unpacked for as long as the context lasts.

    Args:
        paths: of files, some of them inside archives.

    Yields:
        Where each is, or why it is nowhere.
    """
    wanted: dict[Path, dict[str, Path]] = {}
    found: dict[Path, Path | RecordingError] = {}
    for path in paths:
        archive = held_by(path)
        if archive is None:
            found[path] = path
        else:
            wanted.setdefault(archive, {})[path.relative_to(archive).as_posix()] = path
    with tempfile.TemporaryDirectory(prefix="nao_sim-") as folder:
        for number, (archive, members) in enumerate(wanted.items()):
            found |= _unpack(archive, members, Path(folder) / str(number))
        yield found


def _unpack(archive: Path, members: dict[str, Path], folder: Path) -> dict[Path, Path | RecordingError]:
    """The wanted members of an archive, each by the name under which it is wanted."""
    places: dict[Path, Path | RecordingError] = {
        path: RecordingError(path, f"not in {archive.name}", "a member of the archive") for path in members.values()
    }
    try:
        for number, (name, stream) in enumerate(_members(archive, members)):
            place = folder / str(number) / PurePosixPath(name).name
            place.parent.mkdir(parents=True)
            with stream, place.open("wb") as file:
                shutil.copyfileobj(stream, file)
            places[members[name]] = place
    except _DAMAGED as error:
        said = f"cannot be unpacked ({str(error).partition(chr(10))[0].lower() or type(error).__name__})"
        broken = RecordingError(archive, said, WANTED)
        return {path: place if isinstance(place, Path) else broken for path, place in places.items()}
    return places


def _members(archive: Path, wanted: Iterable[str]) -> Iterator[tuple[str, IO[bytes]]]:
    """The wanted files of an archive, in its own order."""
    if zipfile.is_zipfile(archive):
        with zipfile.ZipFile(archive) as packed:
            for name in packed.namelist():
                if name in wanted:
                    yield name, packed.open(name)
        return
    with tarfile.open(archive) as packed:
        for member in packed:
            name = member.name.removeprefix("./")
            stream = packed.extractfile(member) if member.isfile() and name in wanted else None
            if stream is not None:
                yield name, stream
