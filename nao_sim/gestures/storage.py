"""Recognisers as files: arrays in an NPZ, no pickle, so that reading one runs no code.

A file holds the arrays of the recogniser's `tables`, its kind, the version of
this layout and a digest of all of it.
"""

from __future__ import annotations

import hashlib
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.files import beside
from nao_sim.gestures.movements import MovementRecogniser
from nao_sim.gestures.poses import PoseRecogniser
from nao_sim.robot import Array

VERSION = 1
WANTED = "a recogniser that nao_sim saved"
Recogniser = PoseRecogniser | MovementRecogniser
KINDS: Mapping[str, type[PoseRecogniser] | type[MovementRecogniser]] = {
    "poses": PoseRecogniser,
    "movements": MovementRecogniser,
}
_KIND, _VERSION, _DIGEST = "nao_sim_recogniser", "version", "sha256"


def save(path: Path, recogniser: Recogniser) -> None:
    """Write a recogniser; the same recogniser always makes the same tables.

    Raises:
        UsageError: the file cannot be written there.
    """
    kind = next(name for name, made in KINDS.items() if isinstance(recogniser, made))
    tables = recogniser.tables() | {_KIND: np.array(kind), _VERSION: np.array(VERSION)}
    with beside(path) as draft, draft.open("wb") as file:
        np.savez_compressed(file, allow_pickle=False, **tables, **{_DIGEST: np.array(_digest(tables))})


def load_recogniser(path: Path) -> Recogniser:
    """Read what `save` wrote.

    Raises:
        UsageError: it cannot be read, is damaged, of another version or no recogniser at all.
    """
    tables = _tables(path)
    kind, version, digest = (str(tables.pop(name, "")) for name in (_KIND, _VERSION, _DIGEST))
    if kind not in KINDS:
        raise UsageError(f"{path}: no recogniser in it; expected {WANTED}")
    if version != str(VERSION):
        raise UsageError(f"{path}: version {version} of the file; expected {VERSION}")
    if digest != _digest(tables | {_KIND: np.array(kind), _VERSION: np.array(VERSION)}):
        raise UsageError(f"{path}: damaged, its digest does not fit; expected {WANTED}")
    try:
        return KINDS[kind].of_tables(tables)
    except KeyError as error:
        raise UsageError(f"{path}: no table {error}; expected {WANTED}") from None
    except ValueError as error:
        raise UsageError(f"{path}: {error}; expected {WANTED}") from None


def _tables(path: Path) -> dict[str, Array]:
    try:
        file = np.load(path, allow_pickle=False)
        if not isinstance(file, np.lib.npyio.NpzFile):
            raise UsageError(f"{path}: a single array; expected {WANTED}")
        with file:
            return {name: file[name] for name in file.files}
    except OSError as error:
        raise UsageError(f"{path}: cannot read it: {error.strerror or error}; expected {WANTED}") from None
    except (ValueError, EOFError, KeyError, zipfile.BadZipFile, zlib.error, NotImplementedError) as error:
        said = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise UsageError(f"{path}: {said}; expected {WANTED}") from None


def _digest(tables: Mapping[str, Array]) -> str:
    """Of names, kinds, shapes and bytes, in the order of the names."""
    found = hashlib.sha256()
    for name in sorted(tables):
        array = np.ascontiguousarray(tables[name])
        found.update(f"{name} {array.dtype.str} {array.shape} ".encode())
        found.update(array.tobytes())
    return found.hexdigest()
