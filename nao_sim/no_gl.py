"""Import MuJoCo and dm_control whatever OpenGL the machine has.

Both look for OpenGL when they are imported: an unusable `MUJOCO_GL` is an
exception there, a missing display a warning.  Physics needs none of it, and
rendering happens in processes of its own.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module

VARIABLE = "MUJOCO_GL"


def import_mujoco() -> None:
    """Import mujoco with the user's `MUJOCO_GL`, or without OpenGL where that cannot be had."""
    try:
        import_module("mujoco")
    except (ImportError, AttributeError, RuntimeError, OSError):
        with _disabled():
            import_module("mujoco")


def import_mjcf() -> None:
    """Import dm_control.mjcf without dm_control's own renderer."""
    import_mujoco()
    with _disabled():
        import_module("dm_control.mjcf")


@contextmanager
def _disabled() -> Iterator[None]:
    before = os.environ.get(VARIABLE)
    os.environ[VARIABLE] = "disable"
    try:
        yield
    finally:
        if before is None:
            del os.environ[VARIABLE]
        else:
            os.environ[VARIABLE] = before
