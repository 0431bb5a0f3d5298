"""The same person again as others would be and as other sensors would see them: what robustness is measured with."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from nao_sim.body import SIDES
from nao_sim.motion import Skeleton
from nao_sim.robot import Array

Change = Callable[[Skeleton, np.random.Generator], Skeleton]
SHOULDERS = 0.36  # m between an adult's; noise in metres is scaled by it where a recording has no metres


def unchanged(person: Skeleton, _: np.random.Generator) -> Skeleton:
    return person


def seen_from_elsewhere(person: Skeleton, random: np.random.Generator) -> Skeleton:
    """Yaw up to 30 and pitch up to 15 degrees, by a camera that errs about depth by up to 30 %."""
    turn = Rotation.from_euler("zy", [random.uniform(-30.0, 30.0), random.uniform(-15.0, 15.0)], degrees=True)
    points = person.positions @ turn.as_matrix().T
    middle = np.nanmean(points, axis=(0, 1))
    return _with(person, (points - middle) * [random.uniform(0.7, 1.3), 1.0, 1.0] + middle)


def at_another_speed(person: Skeleton, random: np.random.Generator) -> Skeleton:
    """0.7 to 1.4 times as fast."""
    times = person.times / random.uniform(0.7, 1.4)
    return Skeleton(times, person.positions, person.joints, person.confidence)


def unevenly(person: Skeleton, random: np.random.Generator) -> Skeleton:
    """Half as fast to twice as fast (two standard deviations), changing about every quarter of the movement."""
    count = len(person.times)
    rates = gaussian_filter1d(random.normal(size=count), count / 8.0, mode="nearest")
    rates = np.exp(np.log(2.0) / 2.0 * rates / max(float(rates.std()), 1e-9))
    steps = np.diff(person.times) * rates[1:]
    return Skeleton(np.concatenate([[0.0], np.cumsum(steps)]), person.positions, person.joints, person.confidence)


def noisy(metres: float) -> Change:
    """White noise of every coordinate of every joint, of a standard deviation."""

    def change(person: Skeleton, random: np.random.Generator) -> Skeleton:
        spread = metres * _size(person)
        return _with(person, person.positions + random.normal(0.0, spread, person.positions.shape))

    return change


def with_gaps(person: Skeleton, random: np.random.Generator) -> Skeleton:
    """A third of the frames lost, and a tenth of the joints of the others."""
    lost = random.random(person.positions.shape[:2]) < 0.1
    lost[random.random(len(lost)) < 1.0 / 3.0] = True
    lost[[0, -1]] = False
    return _with(person, np.where(lost[..., None], np.nan, person.positions))


def as_a_child(person: Skeleton, _: np.random.Generator) -> Skeleton:
    """0.65 times the size, arms 15 % shorter beside the trunk, head 1.4 times as large beside it."""
    place = {name: number for number, name in enumerate(person.joints)}
    points = np.array(person.positions)
    for side in SIDES:
        arm = [f"{side}_shoulder", f"{side}_elbow", f"{side}_wrist"]
        if not set(arm) <= set(place):
            continue
        whole = np.array(points)
        shoulder = whole[:, place[arm[0]]]
        for name in (name for name in person.joints if name.startswith(f"{side}_") and _of_the_arm(name)):
            points[:, place[name]] = shoulder + 0.85 * (whole[:, place[name]] - shoulder)
    neck = (person.track("left_shoulder") + person.track("right_shoulder"))[:, None] / 2.0
    head = [number for name, number in place.items() if name in ("head", "nose")]
    points[:, head] = neck + 1.4 * (points[:, head] - neck)
    return _with(person, 0.65 * points)


def mirrored(person: Skeleton, _: np.random.Generator) -> Skeleton:
    return person.mirrored()


def seated(person: Skeleton, _: np.random.Generator) -> Skeleton:
    """Knees and feet out of sight."""
    legs = np.array([any(part in name for part in ("knee", "ankle", "foot", "toe", "heel")) for name in person.joints])
    return _with(person, np.where(legs[:, None], np.nan, person.positions))


def without_hips(person: Skeleton, _: np.random.Generator) -> Skeleton:
    """A table hides all below the chest: no hips, pelvis, spine, legs."""
    parts = ("knee", "ankle", "foot", "toe", "heel", "hip", "pelvis", "spine")
    low = np.array([any(part in name for part in parts) for name in person.joints])
    return _with(person, np.where(low[:, None], np.nan, person.positions))


def with_a_hidden_left_arm(person: Skeleton, _: np.random.Generator) -> Skeleton:
    """Elbow, wrist and hand of the left arm out of sight throughout."""
    hidden = np.array([name.startswith("left_") and _of_the_arm(name) for name in person.joints])
    return _with(person, np.where(hidden[:, None], np.nan, person.positions))


def like_kinect_v1(person: Skeleton, random: np.random.Generator) -> Skeleton:
    """Noise of 2 cm that lasts about 0.1 s, 4 cm along the view, and a wrist that is thrown off now and then.

    Made up in the manner of structured light, whose error grows along the view; no sensor's own figures.
    """
    spread = _size(person) * np.array([0.04, 0.02, 0.02])
    noise = gaussian_filter1d(random.normal(size=person.positions.shape), 1.5, axis=0)
    points = person.positions + noise / noise.std() * spread
    wrists = [number for number, name in enumerate(person.joints) if name.endswith(("_wrist", "_hand"))]
    thrown = random.random((len(points), len(wrists))) < 0.03
    far = random.normal(0.0, 0.25 * _size(person), (len(points), len(wrists), 3))
    points[:, wrists] += np.where(thrown[..., None], far, 0.0)
    return _with(person, points)


def all_of(*changes: Change) -> Change:
    """One after the other."""

    def change(person: Skeleton, random: np.random.Generator) -> Skeleton:
        for each in changes:
            person = each(person, random)
        return person

    return change


def _of_the_arm(name: str) -> bool:
    return not any(part in name for part in ("shoulder", "clavicle", "hip", "knee", "ankle", "foot", "toe", "heel",
                                             "eye", "ear", "mouth"))  # fmt: skip


def _size(person: Skeleton) -> float:
    """What a metre is of an adult in the recording's unit."""
    across = np.linalg.norm(person.track("left_shoulder") - person.track("right_shoulder"), axis=1)
    return float(np.nanmedian(across)) / SHOULDERS


def _with(person: Skeleton, positions: Array) -> Skeleton:
    return Skeleton(person.times, positions, person.joints, person.confidence, person.planar)
