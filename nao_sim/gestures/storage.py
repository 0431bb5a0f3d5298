"""Vocabularies as files: arrays in an NPZ, no pickle, so that reading one runs no code.

A file holds the arrays of both recognisers' `tables` and of the robot's
motions, the version of this layout and a digest of all of it.
"""

from __future__ import annotations

import hashlib
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.files import beside
from nao_sim.gestures.movements import MovementRecogniser
from nao_sim.gestures.poses import PoseRecogniser
from nao_sim.gestures.vocabulary import Vocabulary, built_in
from nao_sim.motion import JointTrajectory

VERSION = 1
WANTED = "a vocabulary that nao-sim teach or train saved"
_VERSION, _DIGEST = "nao_sim_vocabulary", "sha256"
_POSES, _MOVEMENTS, _MOTIONS = "poses", "movements", "motions"
_Recogniser = TypeVar("_Recogniser", PoseRecogniser, MovementRecogniser)


def save(path: Path, vocabulary: Vocabulary) -> None:
    """Write a vocabulary; the same one always makes the same tables.

    Raises:
        UsageError: the file cannot be written there.
    """
    tables = _tables_of(vocabulary)
    with beside(path) as draft, draft.open("wb") as file:
        np.savez_compressed(file, allow_pickle=False, **tables, **{_DIGEST: np.array(_digest(tables))})


def vocabulary_of(path: Path | None) -> Vocabulary:
    """The vocabulary of a file; the built-in one where None.

    Raises:
        UsageError: see `load_vocabulary`.
    """
    return load_vocabulary(path) if path else built_in()


def load_vocabulary(path: Path) -> Vocabulary:
    """Read what `save` wrote.

    Raises:
        UsageError: it cannot be read, is damaged, of another version or no vocabulary at all.
    """
    tables = _read(path)
    if _VERSION not in tables or _DIGEST not in tables:
        raise UsageError(f"{path}: no vocabulary in it; expected {WANTED}")
    if (version := str(tables[_VERSION])) != str(VERSION):
        raise UsageError(f"{path}: version {version} of the file; expected {VERSION}")
    if str(tables.pop(_DIGEST)) != _digest(tables):
        raise UsageError(f"{path}: damaged, its digest does not fit; expected {WANTED}")
    try:
        return _vocabulary_of(tables)
    except KeyError as error:
        raise UsageError(f"{path}: no table {error}; expected {WANTED}") from None
    except (TypeError, ValueError) as error:
        raise UsageError(f"{path}: {error}; expected {WANTED}") from None


def _tables_of(vocabulary: Vocabulary) -> dict[str, Any]:
    found: dict[str, Any] = {_VERSION: np.array(VERSION), _MOTIONS: np.array(sorted(vocabulary.motions), str)}
    for kind, recogniser in ((_POSES, vocabulary.poses), (_MOVEMENTS, vocabulary.movements)):
        if recogniser is not None:
            found |= {f"{kind}.{name}": table for name, table in recogniser.tables().items()}
    for place, name in enumerate(found[_MOTIONS].tolist()):
        motion = vocabulary.motions[name]
        parts = {"times": motion.times, "positions": motion.positions, "given": motion.given}
        found |= {f"{_MOTIONS}.{place}.{part}": table for part, table in parts.items()}
    return found


def _vocabulary_of(tables: Mapping[str, Any]) -> Vocabulary:
    motions = {
        str(name): JointTrajectory(
            **{part: tables[f"{_MOTIONS}.{i}.{part}"] for part in ("times", "positions", "given")}
        )
        for i, name in enumerate(tables[_MOTIONS])
    }
    poses, movements = _part(tables, _POSES, PoseRecogniser), _part(tables, _MOVEMENTS, MovementRecogniser)
    return Vocabulary(poses, movements, motions)


def _part(tables: Mapping[str, Any], kind: str, made: type[_Recogniser]) -> _Recogniser | None:
    own = {name.removeprefix(f"{kind}."): table for name, table in tables.items() if name.startswith(f"{kind}.")}
    return made.of_tables(own) if own else None


def _read(path: Path) -> dict[str, Any]:
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


def _digest(tables: Mapping[str, Any]) -> str:
    """Of names, kinds, shapes and bytes, in the order of the names."""
    found = hashlib.sha256()
    for name in sorted(tables):
        array = np.ascontiguousarray(tables[name])
        found.update(f"{name} {array.dtype.str} {array.shape} ".encode())
        found.update(array.tobytes())
    return found.hexdigest()
