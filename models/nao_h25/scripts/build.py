"""Rebuild the model from its tables: gains.json, nao_h25.xml, keyframes.json and nao_h25.urdf.

    python models/nao_h25/scripts/build.py            rebuild
    python models/nao_h25/scripts/build.py --check    say what would change, exit status 1 if anything

The shells in assets/ are made by make_shells.py, which needs the extra `model`.
"""

from __future__ import annotations

import argparse
import json
from typing import Any

import gains
import mjcf
import rest
import urdf
from tables import MODEL, table

VERSIONS = ("v4", "v5", "v6")


def main() -> int:
    """Rebuild or check; returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing, report differences")
    parser.add_argument("--settle", action="store_true", help="also simulate anew where the postures rest")
    args = parser.parse_args()
    changed = _put("gains.json", _rows({v: gains.gains(v) for v in VERSIONS}), args.check)
    changed += _put("nao_h25.xml", mjcf.build(table("gains.json")["v5"]), args.check)
    if args.settle:
        changed += _put("keyframes.json", _rows({"base_pose": rest.base_poses()}), args.check)
        changed += _put("nao_h25.xml", mjcf.build(table("gains.json")["v5"]), args.check)
    changed += _put("nao_h25.urdf", urdf.build(), args.check)
    print(f"{len(changed)} files {'differ' if args.check else 'changed'}{': ' if changed else ''}{', '.join(changed)}")
    return int(args.check and bool(changed))


def _rows(tables: dict[str, Any]) -> str:
    """JSON with one row a line."""
    blocks = []
    for name, rows in tables.items():
        lines = ",\n".join(f"    {json.dumps(key)}: {json.dumps(row)}" for key, row in rows.items())
        blocks.append(f"  {json.dumps(name)}: {{\n{lines}\n  }}")
    return "{\n" + ",\n".join(blocks) + "\n}\n"


def _put(name: str, text: str, check: bool) -> list[str]:
    path = MODEL / name
    if path.exists() and path.read_text(encoding="utf-8") == text:
        return []
    if not check:
        path.write_text(text, encoding="utf-8")
    return [name]


if __name__ == "__main__":
    raise SystemExit(main())
