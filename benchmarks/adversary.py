"""Try to make the simulated robot break a safety law, by chance and by search, and tell how near it came.

    python benchmarks/adversary.py [--random 1000000] [--searched 100000] [--seed 0] [--jobs N]
                                   [--minutes M] [--state FILE] [--keep tests/safety/worst] [--note]

A request is one row of 26 values at 50 Hz.  They go through the guard into the
physics, 150 in a row from the start posture without any approach, of all
versions, free-standing and pinned.  Random ones come from the families of
`attacks.py`, noise, and the tests' own wild motions; searched ones from an
evolution strategy with recombination (Rechenberg 1973) over a family's
parameters for the smallest margin of one law.  The laws and how they are measured, at every
physics step, stand in `tests/safety/trial.py`.

The same seed gives the same requests, whatever the number of processes.  With
--state a run that was stopped, or ran out of --minutes, goes on where it was
(remove the file when the guard changes).
"""

from __future__ import annotations

import os

os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")

import argparse
import json
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cache
from multiprocessing import Pool
from pathlib import Path
from typing import Any

import numpy as np
from attacks import EPISODE, FAMILIES, Dials, random_requests, wild_requests
from benchmark import Rows, machine, note

from nao_sim.console import ProgressBar
from nao_sim.robot import VERSIONS, Array, load_robot
from nao_sim.simulation.simulator import Simulator
from tests.safety.trial import LAWS, Case, play

EPISODES = 10  # of a random job, one in five of them a wild motion
EVALUATIONS, BY_CHANCE, ELITE = 22, 7, 3  # episodes of a search, of those the first, and the parents of the others
CHANGED, SHIFTS = 0.3, (0.03, 0.1, 0.3)  # share of an episode's dials that differ from its parents', and how far
BASES = ("free", "pinned")
LARGEST = 20_000  # bytes of a kept file
OF_STANDING = ("balance", "fell")


@dataclass(frozen=True)
class Job:
    """A piece of work: a batch of random episodes, or one search.

    Attributes:
        number: which, among all of its kind.
        seed: of the run.
        family: what is searched; empty for random requests.
        law: that the search goes after.
    """

    number: int
    seed: int
    family: str = ""
    law: str = ""

    @property
    def key(self) -> str:
        """Its name in the state file."""
        return f"{self.seed} {self.number} {self.family} {self.law}"

    @property
    def base(self) -> str:
        """Free or pinned, in turns; what only a free robot has is searched on a free one."""
        return BASES[0] if self.law in OF_STANDING else BASES[self.number % 2]

    @property
    def version(self) -> str:
        """Each in turn."""
        return VERSIONS[self.number // 2 % len(VERSIONS)]

    def random(self) -> np.random.Generator:
        """Its own source of chance."""
        return np.random.default_rng([self.seed, self.number, *map(ord, self.family + self.law)])


@dataclass
class Worst:
    """Of one law and family, all requests of a job or run.

    Attributes:
        requests: how many were judged by the law.
        violations: how many broke it.
        value: the worst that was measured, in the law's unit.
        job: who found it.
        episode: which episode of that job.
        dials: parameters of the family, where the episode was searched.
    """

    requests: int = 0
    violations: int = 0
    value: float = np.inf
    job: dict[str, Any] = field(default_factory=dict)
    episode: int = 0
    dials: list[float] = field(default_factory=list)

    def add(self, other: Worst) -> None:
        """Count another's requests, too."""
        self.requests += other.requests
        self.violations += other.violations
        if not other.value >= self.value:
            self.value, self.job, self.episode, self.dials = other.value, other.job, other.episode, other.dials


Found = dict[tuple[str, str], Worst]  # by family and law


@cache
def simulator(version: str, base: str) -> Simulator:
    """Compiled once a process."""
    return Simulator(load_robot(version), base)


def episodes(job: Job) -> Iterator[tuple[str, Array]]:
    """What a random job asks: family and requests."""
    random = job.random()
    wild = EPISODES // 5
    yield from (random_requests(random) for _ in range(EPISODES - wild))
    yield from (("wild", requests) for requests in wild_requests(wild, int(random.integers(2**31))))


def judged(requests: Array, case: Worst, family: str, found: Found) -> dict[str, float]:
    """The worst of each law that the episode of a case came to, which is added to what was found."""
    job = Job(**case.job)
    try:
        trial = play(requests.astype(np.float32), simulator(job.version, job.base))
    except Exception as error:
        raise RuntimeError(f"{family}, {case}: {error}") from error
    worst = {law: float(np.where(np.isnan(values), -np.inf, values).min()) for law, values in trial.measured.items()}
    if trial.warnings:
        worst = dict.fromkeys(worst, -np.inf)
    for law, value in worst.items():
        count = trial.violations(law) or int(trial.warnings > 0)
        judgement = replace(case, requests=len(requests), violations=count, value=value)
        found.setdefault((family, law), Worst()).add(judgement)
    return worst


def search(job: Job, found: Found) -> None:
    """Parameters that come ever nearer to breaking the job's law."""
    random, family = job.random(), FAMILIES[job.family]
    tried: list[tuple[float, Array]] = []
    for episode in range(EVALUATIONS):
        dials = random.random(family.size)
        if episode >= BY_CHANCE:
            parents = np.array([best for _, best in sorted(tried, key=lambda pair: pair[0])[:ELITE]])
            inherited = parents[random.integers(len(parents), size=family.size), np.arange(family.size)]
            shift = random.normal(0.0, random.choice(SHIFTS), family.size) * (random.random(family.size) < CHANGED)
            dials = np.clip(inherited + shift, 0.0, 1.0)
        case = Worst(job=asdict(job), episode=episode, dials=dials.tolist())
        tried.append((judged(family.requests(Dials(dials)), case, job.family, found)[job.law], dials))


def done(job: Job) -> tuple[Job, list[tuple[str, str, dict[str, Any]]]]:
    """Do a job: what it found, ready to be written."""
    found: Found = {}
    if job.family:
        search(job, found)
    else:
        for episode, (family, requests) in enumerate(episodes(job)):
            judged(requests, Worst(job=asdict(job), episode=episode), family, found)
    return job, [(*key, asdict(worst)) for key, worst in found.items()]


def again(case: Worst) -> Array:
    """The requests of a case once more."""
    job = Job(**case.job)
    if job.family:
        return FAMILIES[job.family].requests(Dials(np.array(case.dials)))
    return next(requests for i, (_, requests) in enumerate(episodes(job)) if i == case.episode)


def jobs(random: int, searched: int, seed: int) -> list[Job]:
    """All the work for so many requests of each kind."""
    chance = [Job(i, seed) for i in range(-(-random // (EPISODES * EPISODE)))]
    goals = [(family, law) for family, kind in FAMILIES.items() for law in kind.laws]
    count = -(-searched // (EVALUATIONS * EPISODE))
    hunts = [Job(i, seed, *goals[i % len(goals)]) for i in range(count)]  # other bases and versions in each round
    share = {id(job): i / len(kind) for kind in (chance, hunts) for i, job in enumerate(kind)}
    return sorted(chance + hunts, key=lambda job: share[id(job)])  # a run cut short has done as much of either


def results(work: Sequence[Job], processes: int, minutes: float, state: Path | None) -> Iterator[tuple[Job, list[Any]]]:
    """What the jobs found, of those in the state file at once."""
    finished = {}
    if state and state.exists():
        rows = [json.loads(line) for line in state.read_text(encoding="utf-8").splitlines()]
        finished = {row["job"]: row["found"] for row in rows}
    yield from ((job, finished[job.key]) for job in work if job.key in finished)
    left, until = [job for job in work if job.key not in finished], time.monotonic() + 60.0 * minutes
    with Pool(processes) as pool:
        for job, found in pool.imap_unordered(done, left):
            if state:
                with state.open("a", encoding="utf-8") as file:
                    file.write(json.dumps({"job": job.key, "found": found}) + "\n")
            yield job, found
            if time.monotonic() > until:
                return


def collected(parts: Iterator[tuple[Job, list[Any]]], total: int) -> tuple[Found, Found]:
    """All that random requests and searches found."""
    sums: tuple[Found, Found] = {}, {}
    with ProgressBar(quiet=False) as bar:
        for number, (job, found) in enumerate(parts, 1):
            for family, law, worst in found:
                sums[bool(job.family)].setdefault((family, law), Worst()).add(Worst(**worst))
            bar("attacking", number, total)
    return sums


def of(found: Found, law: str = "", family: str = "") -> Worst:
    """The sum over the families of a law, or the laws of a family."""
    total = Worst()
    for (its_family, its_law), worst in sorted(found.items()):
        if law in ("", its_law) and family in ("", its_family):
            total.add(worst)
    return total


def told(worst: Worst, law: str) -> str:
    """The worst that was measured, in words."""
    return f"{worst.value:.2f}{'' if LAWS[law].unit == '°' else ' '}{LAWS[law].unit}" if worst.requests else "-"


def law_table(random: Found, searched: Found) -> Rows:
    """One row a law."""
    head = ("what must hold", "at least", "random requests", "violations", "worst")
    rows: Rows = [(*head, "searched requests", "violations", "worst", "in the worst case")]
    for name, law in LAWS.items():
        cells = []
        for found in (random, searched):
            worst = of(found, name)
            cells += [f"{worst.requests:,}", f"{worst.violations:,}", told(worst, name)]
        least = Worst(1, 0, law.least)
        rows.append((law.title, told(least, name), *cells, _where(random, searched, name)))
    return rows


def _where(random: Found, searched: Found, law: str) -> str:
    key, worst = min(
        ((key, worst) for found in (random, searched) for key, worst in found.items() if key[1] == law),
        key=lambda pair: pair[1].value,
        default=(("", ""), Worst()),
    )
    return f"{key[0]}, {Job(**worst.job).version} {Job(**worst.job).base}" if worst.job else "-"


def family_table(random: Found, searched: Found) -> Rows:
    """One row a family: how near it came to each law."""
    rows: Rows = [
        ("requests", "number", *(f"{law.title} ({law.unit}, at least {law.least:g})" for law in LAWS.values()))
    ]
    for family in sorted({family for found in (random, searched) for family, _ in found}):
        cells, count = [], 0
        for law in LAWS:
            both = of(random, law, family)
            both.add(of(searched, law, family))
            cells.append(f"{both.value:.2f}" if both.requests else "-")
            count = max(count, both.requests)
        rows.append((family, f"{count:,}", *cells))
    return rows


def keep(folder: Path, random: Found, searched: Found) -> None:
    """Write the requests that were worst for each law, and for each family's first law."""
    folder.mkdir(parents=True, exist_ok=True)
    wanted = [(law, "") for law in LAWS] + [(kind.laws[0], family) for family, kind in FAMILIES.items()]
    kept: set[str] = set()
    for law, family in wanted:
        worst = of(random, law, family)
        worst.add(of(searched, law, family))
        same = json.dumps([worst.job, worst.episode])
        if not worst.job or same in kept:
            continue
        kept.add(same)
        job = Job(**worst.job)
        path = folder / f"{law}-{(family or 'all').replace(' ', '_')}.npz"
        Case(again(worst), job.base, job.version).save(path)
        if path.stat().st_size > LARGEST:
            print(f"{path}: {path.stat().st_size} bytes; expected at most {LARGEST}", file=sys.stderr)


def main(words: Sequence[str] | None = None) -> int:
    """Attack, tell, keep; exit status 1 where a law was broken."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--random", type=int, default=1_000_000, help="requests by chance (default 1000000)")
    parser.add_argument("--searched", type=int, default=100_000, help="requests of searches (default 100000)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="processes (default: all cores)")
    parser.add_argument("--minutes", type=float, default=np.inf, help="stop after this time")
    parser.add_argument("--state", type=Path, help="file of what is finished; written, and read to go on")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="write the worst requests here")
    parser.add_argument("--note", action="store_true", help="add the tables to RESULTS.md")
    args, where = parser.parse_args(words), machine()
    work = jobs(args.random, args.searched, args.seed)
    random, searched = collected(results(work, args.jobs, args.minutes, args.state), len(work))
    command = f"adversary.py --random {args.random} --searched {args.searched} --seed {args.seed}"
    note("Attacks on the guard, by law", law_table(random, searched), command, where, not args.note)
    note("Attacks on the guard, by family", family_table(random, searched), command, where, not args.note)
    if args.keep:
        keep(args.keep, random, searched)
    return int(any(of(found).violations for found in (random, searched)))


if __name__ == "__main__":
    sys.exit(main())
