"""The headers of optical motion capture's text files: Motive, Vicon Nexus, Qualisys and OpenSim.

All have several lines before the numbers; each function here reads one kind and says where the coordinates are.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice, pairwise

from nao_sim.recordings.skeletons.layout_file import LENGTHS
from nao_sim.recordings.source import Line, Source

MOTIVE, VICON, QUALISYS, TRC = "Motive CSV", "Vicon Nexus CSV", "Qualisys TSV", "OpenSim TRC"
LONGEST = 60  # lines of a header
TRAJECTORIES = "Trajectories"
SECTIONS = (TRAJECTORIES, "Model Outputs", "Devices", "Joints", "Segments", "Events", "Gait Cycle Parameters")  # Vicon
_UNITS = {"m": "m", "meter": "m", "meters": "m", "metres": "m", "mm": "mm", "millimeters": "mm", "millimetres": "mm",
          "cm": "cm", "centimeters": "cm", "centimetres": "cm", "inches": "in", "in": "in"}  # fmt: skip
_MOTIVE_TYPES = ("bone", "bone marker", "marker", "rigid body", "rigid body marker", "marker set")


@dataclass(frozen=True)
class Mocap:
    """Where a file's numbers are.

    Attributes:
        kind: the program, or the format.
        line: the last line of the header.
        separator: between two cells; None for any spaces.
        width: how many cells a row has; None where rows may be of any length.
        names: (M,) what the markers or bones are called.
        columns: (M,) the columns of x, y and z of each.
        unit: metres in one unit.
        time: the column of times (s), or None.
        frame: the column of frame numbers, or None.
        rate: Hz, or None.
        ends: whether a blank line ends the numbers.
        bones: whether the names are of a skeleton's bones, each at its beginning.
    """

    kind: str
    line: int
    separator: str | None
    width: int | None
    names: tuple[str, ...]
    columns: tuple[tuple[int, int, int], ...]
    unit: float
    time: int | None = None
    frame: int | None = None
    rate: float | None = None
    ends: bool = False
    bones: bool = False


def kind_of(source: Source) -> str | None:
    """Which kind of file this is, by its first lines; None for any other."""
    start = source.start.decode("utf-8-sig", errors="replace")
    first = next((line.strip() for line in start.splitlines() if line.strip()), "")
    if (first.startswith("Format Version") and "Take Name" in first) or re.match(r"Format Version,\d", first):
        return MOTIVE
    if first.startswith("PathFileType"):
        return TRC
    if first.startswith(("NO_OF_FRAMES", "FILE_VERSION")) and "MARKER_NAMES" in start:
        return QUALISYS
    return VICON if first.strip(',;\t" ') in SECTIONS else None


def header_of(source: Source, kind: str) -> Mocap:
    """Read the header.

    Raises:
        RecordingError: it is not as files of this kind have it.
    """
    return {MOTIVE: motive, VICON: vicon, QUALISYS: qualisys, TRC: trc}[kind](source)


def motive(source: Source) -> Mocap:
    """Motive: pairs of key and value, a blank line, then rows of types, names, ids and quantities above X, Y, Z."""
    lines = list(islice(source.lines(), LONGEST))
    told = _split(lines[0][1])
    about = dict(pairwise(told))  # a take's name may have commas
    place = next((i for i, (_, text) in enumerate(lines) if _is_axes(_split(text))), None)
    if place is None:
        raise source.error("no row Frame,Time (Seconds),X,Y,Z", "the columns of a Motive export", 1)
    axes = _split(lines[place][1])
    above = [_padded(_split(text), len(axes)) for _, text in lines[1:place] if text.strip(", \t")]
    types = next((row for row in above if any(cell.lower() in _MOTIVE_TYPES for cell in row)), None)
    quantities = next((row for row in reversed(above) if "Position" in row), None)
    if types is None or quantities is None:
        raise source.error("no row of types or no positions", "bones or markers with positions", lines[place][0])
    named = next((row for row in above if "Name" in row[:2]), above[min(above.index(types) + 1, len(above) - 1)])
    bones = [i for i in range(2, len(axes)) if types[i].lower() == "bone" and quantities[i] == "Position"]
    points = bones or [i for i in range(2, len(axes)) if "marker" in types[i].lower() and quantities[i] == "Position"]
    names, columns = _triples([named[i] for i in points], [axes[i] for i in points], points)
    time = next((i for i, name in enumerate(axes) if name.lower().startswith("time (")), None)
    rate = _number(about.get("Export Frame Rate") or about.get("Capture Frame Rate"))
    unit = _unit(source, about.get("Length Units", "Meters"), 1)
    return Mocap(MOTIVE, lines[place][0], ",", len(axes), names, columns, unit, time, 0, rate, bones=bool(bones))


def vicon(source: Source) -> Mocap:
    """Vicon Nexus: `Trajectories`, the rate, the names above their X, axes, units; other sections before or after."""
    lines = source.lines()
    mark = next((line for line in lines if line[1].strip(',;\t" ').lower() == TRAJECTORIES.lower()), None)
    if mark is None:
        raise source.error("no section Trajectories", "the trajectories of markers (export them)")
    head = list(islice(lines, 4))
    separator = next((sign for sign in "\t;," if sign in head[2][1]), ",") if len(head) > 2 else ","  # noqa: PLR2004
    rows = [_split(text, separator) for _, text in head]
    if len(rows) < 4 or not rows[0] or _number(rows[0][0]) is None or "Frame" not in rows[2][:1]:  # noqa: PLR2004
        raise source.error("a section Trajectories that breaks off", "rate, names, axes and units below it", mark[0])
    names_row, axes = _padded(rows[1], len(rows[2])), rows[2]
    names, columns = _triples(_filled(names_row), axes, range(len(axes)))
    units = sorted({cell for cell in rows[3] if cell and "/" not in cell})
    if len(units) > 1:
        raise source.error(f"units {', '.join(units[:3])}", "one unit for all trajectories", head[3][0])
    unit = _unit(source, next(iter(units), "mm"), head[3][0])
    return Mocap(VICON, head[3][0], separator, len(axes), names, columns, unit, None, 0, _number(rows[0][0]), ends=True)


def qualisys(source: Source) -> Mocap:
    """Qualisys Track Manager: a key and its values a line, perhaps column names, then the numbers in millimetres."""
    about: dict[str, list[str]] = {}
    line: Line = (0, "")
    for line in islice(source.lines(), LONGEST):
        cells = [cell.strip() for cell in line[1].split("\t")]
        if _number(cells[0]) is not None:
            break
        about[cells[0]] = cells[1:]
    if (included := about.get("DATA_INCLUDED", ["3D"])[:1]) != ["3D"]:
        raise source.error(f"DATA_INCLUDED {' '.join(included)}", "3D: the positions of markers")
    names = tuple(name for name in about.get("MARKER_NAMES", []) if name)
    cells = line[1].rstrip("\t\r ").split("\t")
    before = len(cells) - 3 * len(names)
    if not names or before not in (0, 1, 2):
        raise source.error(f"{len(names)} names and rows of {len(cells)}", "three numbers for each marker", line[0])
    columns = tuple((i, i + 1, i + 2) for i in range(before, len(cells), 3))
    rate = _number(next(iter(about.get("FREQUENCY", [])), None))
    time, frame = (1 if before == 2 else None), (0 if before else None)  # noqa: PLR2004
    return Mocap(QUALISYS, line[0] - 1, "\t", len(cells), names, columns, LENGTHS["mm"], time, frame, rate)


def trc(source: Source) -> Mocap:
    """OpenSim's TRC: keys and values in two lines, the names above their X, and `X1 Y1 Z1 X2 ...`."""
    lines = list(islice(source.lines(), LONGEST))
    place = next((i for i, (_, text) in enumerate(lines) if text.lower().lstrip().startswith("frame#")), None)
    if place is None or place < 2:  # noqa: PLR2004
        raise source.error("no line Frame#, Time and names", "the header of a TRC file", 1)
    separator = "\t" if "\t" in lines[place][1] else None
    keys, values = (text.split(separator) for _, text in lines[place - 2 : place])
    about = {key.strip(): value.strip() for key, value in zip(keys, values, strict=False)}
    names = tuple(cell.strip() for cell in lines[place][1].split(separator) if cell.strip())[2:]
    axes = len(lines) > place + 1 and re.match(r"\s*X1\b", lines[place + 1][1])
    last = place + 1 if axes else place
    columns = tuple((i, i + 1, i + 2) for i in range(2, 2 + 3 * len(names), 3))
    unit = _unit(source, about.get("Units", "mm"), lines[place - 1][0])
    width = 2 + 3 * len(names)
    return Mocap(TRC, lines[last][0], separator, width, names, columns, unit, 1, 0, _number(about.get("DataRate")))


def _triples(names: Sequence[str], axes: Sequence[str], places: Sequence[int]) -> tuple[
    tuple[str, ...], tuple[tuple[int, int, int], ...]
]:  # fmt: skip
    """The names that have X, Y and Z side by side, and their columns."""
    found = {}
    for i in range(len(axes) - 2):
        if [axis.upper() for axis in axes[i : i + 3]] == ["X", "Y", "Z"] and names[i] and names[i] not in found:
            found[names[i]] = (places[i], places[i + 1], places[i + 2])
    return tuple(found), tuple(found.values())


def _is_axes(cells: Sequence[str]) -> bool:
    return len(cells) > 2 and cells[0].lower() == "frame" and "X" in cells  # noqa: PLR2004


def _split(text: str, separator: str = ",") -> list[str]:
    """The cells of a line that may have quotation marks."""
    return [cell.strip() for cell in next(csv.reader([text], delimiter=separator), [])]


def _padded(cells: list[str], width: int) -> list[str]:
    return cells[:width] + [""] * (width - len(cells))


def _filled(cells: Sequence[str]) -> list[str]:
    """Names that stand above the first of their columns, above all of them."""
    found = list(cells)
    for i in range(1, len(found)):
        found[i] = found[i] or found[i - 1]
    return found


def _number(text: str | None) -> float | None:
    try:
        value = float((text or "").strip())
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _unit(source: Source, name: str, line: int) -> float:
    unit = _UNITS.get(name.strip().lower())
    if unit is None:
        raise source.error(f"unit '{name}'", "mm, cm, m or inches", line)
    return LENGTHS[unit]
