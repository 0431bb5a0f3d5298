"""Where models/, trajectories/ and render/ are, in a checkout and in a wheel."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent
_BUNDLED = _PACKAGE / "_data"  # the wheel carries the data folders here
_ROOT = _BUNDLED if _BUNDLED.is_dir() else _PACKAGE.parent

MODEL = _ROOT / "models" / "nao_h25"
TRAJECTORIES = _ROOT / "trajectories"
PRESETS = _ROOT / "render"
