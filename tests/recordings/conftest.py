"""Shared by the readers' tests: files written on the fly, and what a mistake must be told as."""

from __future__ import annotations

from pathlib import Path

import pytest

from nao_sim.errors import RecordingError
from nao_sim.recordings import load
from tests.refusals import refusal


@pytest.fixture
def write(tmp_path):
    """Write a file and return its path."""

    def write(content, name="recording"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


@pytest.fixture
def refused(write):
    """Write what must be refused, load it and return the error, whose one line names the file."""
    return lambda content, **options: refusal(write(content), **options)


@pytest.fixture
def told():
    """Load a file that must be refused, and check place and words of the one-line message."""

    def told(path: Path, line: int | None, column: str | int | None, *words: str, **options) -> str:
        with pytest.raises(RecordingError) as caught:
            load(path, **options)
        message = str(caught.value)
        assert (caught.value.line, caught.value.column) == (line, column), message
        assert "\n" not in message and message.startswith(f"{path}{'' if line is None else f', line {line}'}")
        assert all(word in message for word in words), message
        return message

    return told
