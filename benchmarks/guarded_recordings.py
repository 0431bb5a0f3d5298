"""What the guard changes of every recording of a folder, and how safe the simulated robot was, into SAFETY.md.

    python benchmarks/guarded_recordings.py RECORDINGS [--base pinned] [--body whole] [--only WORD] [--jobs 2]

Each recording, and trajectories/stress.csv, goes through guard and physics as
`nao-sim play` lets it.  A file without times that asks for a frame rate gets
30 Hz.  Files that cannot be played are listed with the reason.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import date
from functools import cache, partial
from multiprocessing import Pool
from pathlib import Path

import numpy as np
from benchmark import HERE, machine
from benchmark import table as markdown
from similarity import ASSUMED_RATE, recordings_in

from nao_sim.console import REASONS
from nao_sim.errors import NaoSimError
from nao_sim.imitation.retarget import retarget
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.paths import TRAJECTORIES
from nao_sim.recordings import Recording, Source, read
from nao_sim.robot import START_POSTURE, load_robot
from nao_sim.safety.change import Intervention
from nao_sim.simulation.performance import perform
from nao_sim.simulation.simulator import Simulator
from tests.safety.trial import LAWS, Trial, measured

TABLE = HERE / "SAFETY.md"
INTRODUCTION = """# What the guard changes of real recordings

Each recording as `nao-sim play` plays it. "Changed" is the share of control steps in which the guard changed anything
by more than 0.1°. The columns of rules hold how far the joint that a rule moved most was moved, in the mean over the
steps in which it acted, and at most (°; hands left out). Distances are the smallest between parts of the robot that are
not neighbours, up to 30 mm; balance is how far the centre of mass is inside the feet. Violations are control steps of
the simulated robot, by law.
"""
NOTICEABLE = np.radians(0.1)


@dataclass(frozen=True)
class Guarded:
    """What came of one recording.

    Attributes:
        name: of the file.
        note: what had to be assumed, or why it was not played.
        cells: of the table, from the frames on; empty if it was not played.
        rules: mean and largest change (deg) by reason.
    """

    name: str
    note: str
    cells: tuple[str, ...] = ()
    rules: dict[str, tuple[float, float]] = field(default_factory=dict)


@cache
def simulator(base: str) -> Simulator:
    """Compiled once a process."""
    return Simulator(base=base)


def opened(path: Path) -> tuple[Recording, str]:
    """The recording; once more at a usual frame rate where it asks for one."""
    try:
        return read(Source(path)), ""
    except NaoSimError:
        return read(Source(path, rate=ASSUMED_RATE)), f"at {ASSUMED_RATE:g} Hz"


def followed(recording: Recording, body: str) -> JointTrajectory:
    """What the robot is asked to do."""
    if isinstance(recording.motion, Skeleton):
        robot = load_robot()
        return retarget(recording.motion, robot, body=body, start=robot.postures[START_POSTURE]).motion
    return recording.motion


def guarded(named: tuple[str, Path], base: str, body: str) -> Guarded:
    """Play a recording."""
    name, path = named
    try:
        recording, assumed = opened(path)
        motion = followed(recording, body)
    except NaoSimError as error:
        return Guarded(name, str(error).replace(str(path), "").lstrip(":, "))
    robot = simulator(base)
    robot.reset()
    performance = perform(motion, robot)
    warnings = sum(warning.number for warning in robot.data.warning)
    trial = Trial(
        performance.rollout.command,
        performance.interventions,
        measured(robot, performance.rollout, performance.states),
        warnings,
    )
    return Guarded(name, assumed, figures(recording, trial), changes(trial.interventions))


def figures(recording: Recording, trial: Trial) -> tuple[str, ...]:
    """The cells that every recording has."""
    worst = {law: float(values.min()) for law, values in trial.measured.items()}
    changed = np.mean([any(_size(change.size) > NOTICEABLE for change in step) for step in trial.interventions])
    broken = [f"{law} {trial.violations(law)}" for law in trial.broken]
    broken += [f"physics warnings {trial.warnings}"] if trial.warnings else []
    balance = f"{worst['balance']:.0f}" if "balance" in worst else "-"
    fell = {True: "yes", False: "no"}[worst.get("fell", 0.0) < LAWS["fell"].least]
    return (
        str(recording.frames), f"{100.0 * changed:.1f}", f"{worst['command']:.1f}", f"{worst['touch']:.1f}",
        balance, ", ".join(broken) or "0", fell,
    )  # fmt: skip


def changes(interventions: Sequence[Intervention]) -> dict[str, tuple[float, float]]:
    """Mean and largest change (deg) of the joint that each rule moved most."""
    sizes: dict[str, list[float]] = {}
    for step in interventions:
        for change in step:
            if (size := _size(change.size)) > 0.0:
                sizes.setdefault(change.reason, []).append(np.degrees(size))
    return {reason: (float(np.mean(of)), float(np.max(of))) for reason, of in sizes.items()}


def _size(change: np.ndarray) -> float:
    return float(np.abs(change[~load_robot().is_hand]).max())


def table(results: Sequence[Guarded]) -> str:
    """The Markdown of all that was tried."""
    played = [result for result in results if result.cells]
    acted = {reason for result in played for reason in result.rules}
    rules = [*(reason for reason in REASONS if reason in acted), *sorted(acted - set(REASONS))]
    head = ("recording", "frames", "changed (%)", "distance of commands (mm)", "simulated (mm)", "balance (mm)")
    rows: list[tuple[str, ...]] = [(*head, "violations", "fell", *(f"{rule} (°)" for rule in rules))]
    for result in played:
        by_rule = [result.rules.get(rule) for rule in rules]
        sizes = ["-" if size is None else f"{size[0]:.1f}, {size[1]:.1f}" for size in by_rule]
        rows.append((f"{result.name} ({result.note})" if result.note else result.name, *result.cells, *sizes))
    failed = [f"- {result.name}: {result.note}" for result in results if not result.cells]
    lines = [markdown(rows), "", f"Played: {len(played)}. Not played: {len(failed)}.", "", *failed]
    return "\n".join(lines).rstrip() + "\n"


def main(words: Sequence[str] | None = None) -> None:
    """Play everything and write the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="RECORDINGS")
    parser.add_argument("--base", choices=("free", "pinned"), default="free")
    parser.add_argument("--body", choices=("arms", "whole"), default="arms")
    parser.add_argument("--only", default="", metavar="WORD", help="only recordings whose path holds this")
    parser.add_argument("--jobs", type=int, default=2, help="processes (default 2)")
    parser.add_argument("--out", type=Path, default=TABLE, help=f"default {TABLE.name} beside this script")
    args, where = parser.parse_args(words), machine()
    paths = [(path.relative_to(args.folder).as_posix(), path) for path in recordings_in(args.folder)]
    paths += [("trajectories/stress.csv", TRAJECTORIES / "stress.csv")]
    chosen, results = [(name, path) for name, path in paths if args.only in name], []
    with Pool(args.jobs) as pool:
        for result in pool.imap(partial(guarded, base=args.base, body=args.body), chosen):
            results.append(result)
            print(result.name, "played" if result.cells else result.note, file=sys.stderr)
    command = f"`python benchmarks/guarded_recordings.py RECORDINGS --base {args.base} --body {args.body}`"
    args.out.write_text(f"{INTRODUCTION}\n{date.today()}, {where}. {command}\n\n{table(results)}", encoding="utf-8")


if __name__ == "__main__":
    main()
