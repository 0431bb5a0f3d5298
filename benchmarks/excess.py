"""How far one-to-one retargeting is from the best that NAO's joints allow, on every recording of people in folders.

    python benchmarks/excess.py FOLDER [FOLDER ...] [--raw]

Nothing is simulated: what is asked of the robot is compared with the recording
as it is, and with NAO's nearest pose in each frame.  What the filters smooth
away counts as error; `--raw` leaves them out.  One row a folder of recordings.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from pathlib import Path

import numpy as np
from benchmark import Rows, machine, note

from nao_sim.errors import NaoSimError
from nao_sim.imitation.retarget import retarget
from nao_sim.imitation.similarity import similarity
from nao_sim.motion import Skeleton
from nao_sim.recordings import load


def errors(path: Path, raw: bool) -> tuple[float, float] | None:
    """Mean angle (°) of NAO's nearest poses, and how much more is asked; None where nobody's arms are recorded."""
    try:
        motion = load(path).motion
        if not isinstance(motion, Skeleton):
            return None
        score = similarity(motion, retarget(motion, raw=raw).motion)
    except NaoSimError:
        return None
    excess = score.stages["requested"].excess
    if not np.isfinite(excess).any():
        return None
    return float(np.degrees(np.nanmean(score.limits))), float(np.degrees(np.nanmean(excess)))


def main() -> None:
    """Measure and note."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", type=Path, metavar="FOLDER")
    parser.add_argument("--raw", action="store_true", help="leave out the filters")
    parser.add_argument("--print", action="store_true", help="print only, leave RESULTS.md alone")
    args, where = parser.parse_args(), machine()
    found: dict[str, list[tuple[float, float]]] = defaultdict(list)
    for folder in args.folders:
        for path in sorted(path for path in folder.rglob("*") if path.is_file()):
            if (pair := errors(path, args.raw)) is not None:
                found[(Path(folder.name) / path.relative_to(folder).parent).as_posix()].append(pair)
    rows: Rows = [("recordings", "how many", "nearest (°)", "asked beyond it, mean (°)", "median", "largest")]
    found["all"] = [pair for pairs in found.values() for pair in pairs]
    for name, pairs in found.items():
        nearest, excess = np.array(pairs).T
        cells = (nearest.mean(), excess.mean(), np.median(excess), excess.max())
        rows.append((name, str(len(pairs)), *(f"{cell:.2f}" for cell in cells)))
    command = f"excess.py {' '.join(folder.name for folder in args.folders)}{' --raw' * args.raw}"
    note("What one-to-one retargeting asks, against NAO's nearest poses", rows, command, where, args.print)


if __name__ == "__main__":
    main()
