"""What a test that renders needs."""

from __future__ import annotations

import pytest

from nao_sim.errors import RenderingError
from nao_sim.rendering import choose_backend


def _renders() -> bool:
    try:
        choose_backend()
    except RenderingError:
        return False
    return True


needs_gl = pytest.mark.skipif(not _renders(), reason="no OpenGL back end renders on this machine")
