"""Families of requests that try to make the robot break a safety law, for `adversary.py`.

Each family turns parameters in 0..1 into requests, so that chance can pick
them or a search improve them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from hypothesis import HealthCheck, Phase, given, seed, settings

from nao_sim.robot import START_POSTURE, Array, load_robot
from nao_sim.safety.self_distance import SelfDistance
from nao_sim.simulation.simulator import CONTROL_STEP
from tests.motions import wild_motions

ROBOT = load_robot()
START = ROBOT.postures[START_POSTURE]
MIDDLE, HALF = (ROBOT.lower + ROBOT.upper) / 2.0, (ROBOT.upper - ROBOT.lower) / 2.0
LEFT, RIGHT = ROBOT.limbs["LArm"], ROBOT.limbs["RArm"]
EPISODE = 150  # requests
TIMES = CONTROL_STEP * np.arange(1, EPISODE + 1)
BANK = 3000  # arm poses tried, to find those that meet something


class Dials:
    """Parameters in 0..1, taken one after the other; beyond the last they read 0.5."""

    def __init__(self, values: Array) -> None:
        self._values, self._next = values, 0

    def take(self, count: int) -> Array:
        """The next `count` of them."""
        taken = self._values[self._next : self._next + count]
        self._next += count
        return np.concatenate([taken, np.full(count - len(taken), 0.5)])

    def between(self, low: float, high: float) -> float:
        """The next one, scaled."""
        return low + (high - low) * float(self.take(1)[0])

    def spread(self, low: float, high: float, count: int) -> Array:
        """The next `count`, scaled."""
        return low + (high - low) * self.take(count)

    def chosen(self, count: int) -> int:
        """The next one, as a choice of `count`."""
        return min(int(self.take(1)[0] * count), count - 1)


@dataclass(frozen=True)
class Family:
    """A kind of request.

    Attributes:
        size: number of parameters.
        requests: makes (EPISODE, 26) of them.
        laws: whom a search with it goes after.
    """

    size: int
    requests: Callable[[Dials], Array]
    laws: tuple[str, ...]


def _swing(rate: Array | float, phase: Array | float, square: float) -> Array:
    """Between -1 and 1: a sine (square 0), or nearly a square wave (square 1)."""
    sine = np.sin(2.0 * np.pi * (np.multiply.outer(TIMES, rate) + phase))
    return np.clip(sine * (1.0 + 30.0 * square**3), -1.0, 1.0)


def _held() -> Array:
    return np.tile(START, (EPISODE, 1))


def _both(asked: Array, left: dict[str, Array | float], twist: float = 1.0) -> Array:
    """Angles of the left side's joints, and their mirror images times `twist` on the right one."""
    for name, values in left.items():
        joint = ROBOT.index["L" + name]
        twin = ROBOT.mirror_of[joint]
        asked[:, joint] = values
        asked[:, twin] = ROBOT.mirror_sign[joint] * (START[joint] + twist * (np.asarray(values) - START[joint]))
    return asked


def jumps(dials: Dials) -> Array:
    """From pose to pose at one blow, anywhere in the joints' ranges and a little beyond."""
    poses = MIDDLE + HALF * np.clip(dials.spread(-2.0, 2.0, 78), -1.1, 1.1).reshape(3, 26)
    first, second = sorted((dials.between(0.1, 1.5), dials.between(0.1, 2.5)))
    which = (first < TIMES).astype(int) + (second < TIMES)
    return poses[which]


def shaking(dials: Dials) -> Array:
    """Some joints swing together about the start posture, at a frequency that may suit the robot's own."""
    rate, square, wide = dials.between(0.3, 12.0), dials.between(0.0, 1.0), dials.between(0.05, 1.5)
    reach = wide * np.maximum(dials.spread(-1.0, 1.0, 26), 0.0) * HALF
    phase = np.round(2.0 * dials.take(26)) / 2.0 + dials.between(0.0, 0.25) * dials.take(26)
    return START + reach * _swing(np.full(26, rate), phase, square)


def single(dials: Dials) -> Array:
    """One joint from end to end, ever faster."""
    asked, joint = _held(), dials.chosen(26)
    rate = dials.between(0.2, 2.0) + dials.between(0.0, 3.0) * TIMES
    swing = np.sin(2.0 * np.pi * np.cumsum(rate) * CONTROL_STEP + dials.between(0.0, 6.28))
    asked[:, joint] = MIDDLE[joint] + dials.between(0.5, 1.3) * HALF[joint] * np.clip(
        swing * dials.between(1.0, 20.0), -1.0, 1.0
    )
    return asked


def together(dials: Dials) -> Array:
    """All joints go to their ends and back in step, or in mirrored step."""
    share = np.sign(dials.spread(-1.0, 1.0, 26)) * dials.between(0.5, 1.1)
    return MIDDLE + HALF * share * _swing(dials.between(0.2, 6.0), dials.take(1)[0], dials.take(1)[0])[:, None]


def squats(dials: Dials) -> Array:
    """Both knees bend and stretch, upright or leaning, while the arms swing along."""
    rate, square, depth = dials.between(0.2, 5.0), dials.between(0.0, 1.0), dials.between(0.1, 1.0)
    down = depth * (0.5 - 0.5 * _swing(rate, 0.25, square))
    hip, ankle = dials.between(0.0, 1.5), dials.between(0.0, 1.5)
    asked = _both(
        _held(),
        {
            "HipPitch": START[ROBOT.index["LHipPitch"]] - hip * down,
            "KneePitch": START[ROBOT.index["LKneePitch"]] + 2.0 * down,
            "AnklePitch": START[ROBOT.index["LAnklePitch"]] - ankle * down,
            "ShoulderPitch": dials.between(-2.0, 2.0) + dials.between(-2.0, 2.0) * down,
            "ShoulderRoll": dials.between(0.0, 1.3),
        },
        twist=float(np.sign(dials.between(-0.2, 1.0))),  # seldom: one knee bends while the other stretches
    )
    return asked


def leans(dials: Dials) -> Array:
    """The whole body leans to some side, at once or swaying, arms stretched out."""
    sway = _swing(dials.between(0.05, 4.0), dials.take(1)[0], dials.take(1)[0])
    asked = _held()
    for side in "LR":
        for name, most in (("HipRoll", 0.8), ("HipPitch", 1.5), ("AnklePitch", 1.2), ("AnkleRoll", 0.8)):
            asked[:, ROBOT.index[side + name]] += dials.between(-most, most) * sway
    arms = np.concatenate([LEFT, RIGHT])
    asked[:, arms] = MIDDLE[arms] + HALF[arms] * np.clip(dials.spread(-1.5, 1.5, len(arms)), -1.0, 1.0)
    asked[:, [ROBOT.index["LHipYawPitch"], ROBOT.index["RHipYawPitch"]]] += dials.between(-0.8, 0.8) * sway[:, None]
    return asked


def one_leg(dials: Dials) -> Array:
    """The weight goes to one leg, then the other one lifts, kicks or swings."""
    asked, side = _held(), "LR"[dials.chosen(2)]
    away = 1.0 if side == "L" else -1.0
    shift = dials.between(0.0, 0.6) * np.clip(TIMES / dials.between(0.02, 1.0), 0.0, 1.0)
    lift = np.clip((TIMES - dials.between(0.0, 1.5)) / dials.between(0.02, 1.0), 0.0, 1.0)
    for leg in "LR":
        asked[:, ROBOT.index[leg + "HipRoll"]] += away * shift
        asked[:, ROBOT.index[leg + "AnkleRoll"]] -= away * shift * dials.between(0.0, 1.5)
    for name, most in (("HipPitch", 1.5), ("KneePitch", 2.0), ("AnklePitch", 1.0), ("HipRoll", 0.8)):
        asked[:, ROBOT.index[side + name]] += dials.between(-most, most) * lift
    asked[:, [ROBOT.index["LShoulderRoll"], ROBOT.index["RShoulderRoll"]]] += dials.spread(-1.3, 1.3, 2) * lift[:, None]
    return asked


def couplings(dials: Dials) -> Array:
    """Each coupled joint swings at its ends while the joint that limits it sweeps its range."""
    asked = _held()
    for rule in ROBOT.couplings:
        by = _swing(dials.between(0.1, 5.0), dials.take(1)[0], dials.take(1)[0])
        joint = _swing(dials.between(0.0, 5.0), dials.take(1)[0], dials.between(0.3, 1.0))
        asked[:, rule.by] = MIDDLE[rule.by] + dials.between(0.3, 1.1) * HALF[rule.by] * by
        asked[:, rule.joint] = MIDDLE[rule.joint] + dials.between(0.3, 1.1) * HALF[rule.joint] * joint
    return asked


def stop_and_go(dials: Dials) -> Array:
    """All at speed, then frozen or silent, then on or back, at a rhythm."""
    period, share, back = dials.between(0.06, 1.2), dials.between(0.2, 0.9), dials.between(0.0, 1.0) > 0.5
    silent = dials.between(0.0, 1.0) > 0.5
    going = (TIMES % period) < share * period
    way = np.where((TIMES // period) % 2 > 0, -1.0, 1.0) if back else np.ones(EPISODE)
    travelled = np.cumsum(np.where(going, way, 0.0)) * CONTROL_STEP
    asked = START + np.outer(travelled, dials.spread(-8.0, 8.0, 26))
    if silent:
        asked[~going] = np.nan
    return asked


def switches(dials: Dials) -> Array:
    """Two sources take turns, perhaps with silence between; one of them freezes now and then."""
    rates, phases = dials.spread(0.1, 2.0, 2), dials.take(52).reshape(2, 26)
    reach = dials.spread(0.2, 1.1, 2)
    sources = [
        MIDDLE + r * HALF * _swing(np.full(26, rate), phase, 0.0)
        for rate, phase, r in zip(rates, phases, reach, strict=True)
    ]
    period, gap, frozen = dials.between(0.04, 1.5), dials.between(-0.3, 0.6), dials.between(0.0, 1.0)
    sources[1] = sources[1][
        (frozen * (np.arange(EPISODE) // 25 * 25) + (1.0 - frozen) * np.arange(EPISODE)).astype(int)
    ]
    asked = np.where(((TIMES // period) % 2 > 0)[:, None], sources[0], sources[1])
    asked[(TIMES % period) < gap] = np.nan
    return asked


def hunt(goal: str) -> Callable[[Dials], Array]:
    """The hands go for something, from pose to pose that would be in it."""

    def requests(dials: Dials) -> Array:
        bank = meeting(goal)
        stops = [START]
        for _ in range(3):
            pose = bank[dials.chosen(len(bank))].copy()
            arms = np.concatenate([LEFT, RIGHT])
            pose[arms] += dials.spread(-0.4, 0.4, len(arms))
            stops.append(pose)
        ends = np.cumsum(dials.spread(0.1, 1.0, 3))
        takes = dials.spread(0.02, 1.2, 3)
        asked = _held()
        for end, take, pose in zip(ends, takes, stops[1:], strict=True):
            share = np.clip((TIMES - end + 0.1) / take, 0.0, 1.0)[:, None]
            asked += share * (pose - asked)
        asked += (
            dials.between(-0.3, 0.3) * _swing(dials.between(0.5, 8.0), 0.0, 0.0)[:, None] * np.isin(np.arange(26), LEFT)
        )
        return asked

    return requests


GOALS: Mapping[str, tuple[str, ...]] = {
    "face": ("Head", "Neck"),
    "chest": ("torso",),
    "thighs": ("Thigh", "Hip", "Pelvis", "Tibia"),
    "each other": ("Shoulder", "Bicep", "Elbow", "ForeArm", "_wrist"),
}


@cache
def meeting(goal: str) -> Array:
    """Poses (N, 26) in which an arm is inside the goal, in the order of the left shoulder's pitch."""
    random, distance = np.random.default_rng(7), SelfDistance(0.0)
    found = []
    for _ in range(BANK):
        pose = START.copy()
        arms = np.concatenate([LEFT, RIGHT])
        pose[arms] = random.uniform(ROBOT.lower, ROBOT.upper)[arms]
        if goal == "each other":  # seldom by chance: hands meet in the middle
            pose[RIGHT] = (ROBOT.mirror(pose) + random.normal(0.0, 0.3, 26))[RIGHT]
        if goal == "thighs":
            pose[ROBOT.index["LHipPitch"]] = pose[ROBOT.index["RHipPitch"]] = random.uniform(-1.0, 0.0)
        if any(_meets(pair.links, goal) for pair in distance.pairs(pose, 0.0)):
            found.append(pose)
    poses = np.array(found)
    return poses[np.argsort(poses[:, ROBOT.index["LShoulderPitch"]])]


def _meets(links: tuple[str, ...], goal: str) -> bool:
    arms = [any(word in link for word in GOALS["each other"]) for link in links]
    if goal == "each other":
        return all(arms) and len({link[0].upper() for link in links}) == 2
    return any(arms) and any(word in link for link in links for word in GOALS[goal])


FAMILIES: Mapping[str, Family] = {
    "jumps": Family(80, jumps, ("limit", "speed", "fell", "touch")),
    "shaking": Family(82, shaking, ("limit", "speed", "fell")),
    "single": Family(6, single, ("limit", "speed")),
    "together": Family(30, together, ("fell", "touch", "coupling")),
    "squats": Family(9, squats, ("balance", "fell", "touch")),
    "leans": Family(24, leans, ("balance", "fell")),
    "one leg": Family(13, one_leg, ("balance", "fell")),
    "couplings": Family(8 * len(ROBOT.couplings), couplings, ("coupling", "limit")),
    "stop and go": Family(30, stop_and_go, ("limit", "touch")),
    "switches": Family(59, switches, ("touch", "fell")),
    **{f"hands to {goal}": Family(47, hunt(goal), ("touch",)) for goal in GOALS},
}


def random_requests(random: np.random.Generator) -> tuple[str, Array]:
    """A family's name, and requests of it with parameters by chance, perhaps mirrored, spoilt or noisy."""
    name = str(random.choice([*FAMILIES, "noise"]))
    if name == "noise":
        return name, _noise(random)
    values = random.random(FAMILIES[name].size)
    if random.random() < 0.3:
        values = np.round(values)  # the corners
    asked = FAMILIES[name].requests(Dials(values))
    if random.random() < 0.3:
        asked = ROBOT.mirror(asked)
    return name, _spoilt(asked, random)


def _noise(random: np.random.Generator) -> Array:
    """White or wandering noise, up to far beyond anything a number means."""
    noise = random.normal(size=(EPISODE, 26)) * 10.0 ** random.uniform(-2.0, 0.5)
    noise = START + (np.cumsum(noise, axis=0) if random.random() < 0.5 else noise)
    huge = random.random(noise.shape) < random.choice([0.0, 0.02, 0.5])
    noise[huge] *= 10.0 ** random.uniform(1.0, 30.0, noise.shape)[huge]
    return _spoilt(noise, random)


def _spoilt(asked: Array, random: np.random.Generator) -> Array:
    """Cells, joints or stretches that are no number."""
    asked = asked.copy()
    kind = random.integers(8)
    if kind == 0:
        asked[random.random(asked.shape) < 0.1] = random.choice([np.nan, np.inf, -np.inf])
    elif kind == 1:
        asked[:, random.random(26) < 0.5] = np.nan
    elif kind == 2:
        first = random.integers(EPISODE)
        asked[first : first + random.integers(1, 40)] = np.nan
    return asked


def wild_requests(count: int, number: int) -> list[Array]:
    """Requests (EPISODE, 26) of the tests' own wild motions, the same for the same number."""
    motions = []

    @seed(number)
    @settings(max_examples=count + 1, phases=[Phase.generate], database=None, deadline=None,
              suppress_health_check=list(HealthCheck))  # fmt: skip
    @given(wild_motions(seconds=EPISODE * CONTROL_STEP))
    def keep(motion: object) -> None:
        motions.append(motion)

    keep()
    return [motion.sample(motion.times[0] + TIMES) for motion in motions[1:]]  # the first is always the simplest
