"""How readers refuse."""

from __future__ import annotations

from pathlib import Path

import pytest

from nao_sim.errors import RecordingError
from nao_sim.recordings import load


def refusal(path: Path, **options: object) -> RecordingError:
    """The error of a file that must be refused; its message is one line that names the file."""
    with pytest.raises(RecordingError) as caught:
        load(path, **options)  # type: ignore[arg-type]
    assert str(caught.value).startswith(f"{path}")
    assert "\n" not in str(caught.value)
    return caught.value
