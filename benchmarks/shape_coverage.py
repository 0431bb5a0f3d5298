"""Measure how true the collision shapes of models/nao_h25 are, and note the tables in RESULTS.md.

    python benchmarks/shape_coverage.py [--readme] [--print]

One row a link; right links are left ones in a mirror.  What the columns mean
stands in models/nao_h25/scripts/coverage_of_shapes.py, which measures; the random points
are the same in every run.  `--readme` also puts the table into part 7 of the
model's README.
"""

from __future__ import annotations

import argparse
import sys

from benchmark import Rows, machine, note, table

from nao_sim.paths import MODEL

sys.path.insert(0, str(MODEL / "scripts"))
import coverage_of_shapes as coverage

README = MODEL / "README.md"
HEAD = (
    "link",
    "shapes",
    "farthest outside (mm)",
    "own shapes alone (mm)",
    "> 3 mm outside (%)",
    "air (% of the hull)",
    "air over the surface (mm)",
    "deepest air (mm)",
    "short of published bounds (mm)",
)
BEGIN, END = "<!-- coverage: written by benchmarks/shape_coverage.py -->", "<!-- /coverage -->"


def main() -> None:
    """Measure and note."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--readme", action="store_true", help="put the table into the model's README, too")
    parser.add_argument("--print", action="store_true", help="print only, leave RESULTS.md alone")
    args, where = parser.parse_args(), machine()
    rows: Rows = [HEAD, *map(row, coverage.links()), hand(0.0), hand(1.0), shod()]
    note("How true the collision shapes are", rows, "coverage.py", where, args.print)
    if args.readme:
        text = README.read_text(encoding="utf-8")
        before, rest = text.split(BEGIN)
        README.write_text(f"{before}{BEGIN}\n{table(rows)}\n{END}{rest.split(END)[1]}", encoding="utf-8")


def row(link: str) -> tuple[str, ...]:
    """A link's figures as cells."""
    found = coverage.measure(link)
    alone = f"{1e3 * found.alone:.1f}" if coverage.shapes(link) else "-"
    short = f"{1e3 * max(found.short, 0.0):.1f}" if coverage.shapes(link) else "-"
    return (
        link.removesuffix("_link"),
        str(len(coverage.shapes(link))),
        f"{1e3 * found.farthest:.1f}",
        alone,
        f"{100 * found.outside:.1f}",
        f"{100 * found.air:.1f}",
        f"{1e3 * found.thickness:.1f}",
        f"{1e3 * found.deepest:.1f}",
        short,
    )


def hand(opening: float) -> tuple[str, ...]:
    """The hand with its fingers, as one."""
    outside = coverage.hand(opening)
    return _whole(f"l_wrist and fingers, {'open' if opening else 'closed'}", outside)


def shod() -> tuple[str, ...]:
    """The foot as the world meets it: with the sole's box, that other links do not touch."""
    return _whole("l_ankle and its sole", coverage.with_sole())


def _whole(name: str, outside: coverage.Array) -> tuple[str, ...]:
    share = 100 * (outside > coverage.TOLERANCE).mean()
    far = f"{1e3 * outside.max():.1f}"
    return (name, "-", far, far, f"{share:.1f}", *["-"] * 4)


if __name__ == "__main__":
    main()
