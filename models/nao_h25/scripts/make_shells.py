"""Draws the visual shells of the NAO H25: `assets/*.obj` and `assets/shells.json`.

    python models/nao_h25/scripts/make_shells.py           # write the files
    python models/nao_h25/scripts/make_shells.py --check   # compare them with what would be written

The shapes are made here from numbers (sections, ellipsoids, outlines): nothing is read, and the same
bytes come out on every run. Needs the extra `model`: numpy, scipy, scikit-image.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from shells import arm, foot, hand, head, leg, torso
from shells.parts import MATERIALS, Part

ASSETS = Path(__file__).resolve().parent.parent / "assets"
REGIONS = (head, torso, arm, hand, leg, foot)


def draw() -> dict[str, str]:
    """All files of the drawing, by name.

    Returns:
        The text of each OBJ file and of `shells.json`; phalanges of one shape share one file.
    """
    files: dict[str, str] = {}
    names: dict[str, str] = {}
    shells = []
    for part in (part for region in REGIONS for part in region.parts()):
        text = part.mesh.obj()
        name = names.setdefault(text, part.file)
        files[name] = text
        shells.append(_entry(part, name))
    files["shells.json"] = _table(shells)
    return files


def main(arguments: list[str] | None = None) -> int:
    """Writes or checks the files; returns the exit status."""
    parser = argparse.ArgumentParser(description="Draw the visual shells of the NAO H25.")
    parser.add_argument("--check", action="store_true", help="write nothing, fail where a file differs")
    check = parser.parse_args(arguments).check
    files = draw()
    if check:
        return _report(_stale(files))
    ASSETS.mkdir(exist_ok=True)
    for path in ASSETS.glob("*.obj"):
        if path.name not in files:
            path.unlink()
    for name, text in files.items():
        (ASSETS / name).write_text(text, encoding="utf-8", newline="\n")
    return 0


def _entry(part: Part, name: str) -> dict[str, str | None]:
    return {"link": part.link, "material": part.material, "file": name, "mirror_to": part.mirror_to}


def _table(shells: list[dict[str, str | None]]) -> str:
    """`shells.json`, one shell a line."""
    rows = ",\n".join("    " + json.dumps(shell) for shell in shells)
    looks = ",\n".join(f"    {json.dumps(name)}: {json.dumps(look)}" for name, look in MATERIALS.items())
    return f'{{\n  "materials": {{\n{looks}\n  }},\n  "shells": [\n{rows}\n  ]\n}}\n'


def _stale(files: dict[str, str]) -> list[str]:
    """Names of files that are missing, different or left over."""
    found = {
        path.name: path.read_text(encoding="utf-8") for path in ASSETS.glob("*") if path.suffix in (".obj", ".json")
    }
    return sorted(name for name in files.keys() | found.keys() if files.get(name) != found.get(name))


def _report(stale: list[str]) -> int:
    for name in stale:
        print(f"{name}: differs from the drawing; run make_shells.py", file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    raise SystemExit(main())
