"""How a person stands in a file's numbers: the unit, the axes, the sides, and how much of a body it makes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from nao_sim.body import Bone, bones
from nao_sim.recordings.skeletons import plausibility
from nao_sim.recordings.skeletons.anatomy import Body, median, middle
from nao_sim.recordings.skeletons.facing import Told, evidence, orientation
from nao_sim.recordings.skeletons.layout_file import LENGTHS
from nao_sim.recordings.skeletons.layouts import axis_name
from nao_sim.robot import Array

ADULT = 1.70  # m, what a body of unknown scale is made
TALLEST, SMALLEST = 2.15, 0.70  # m, a tall adult and a small child, with the errors of a sensor's bones
SMALLEST_IN_CM = 0.85  # m, else a giant in inches would do as well
MOST = 2.5  # of a cost, of a body
UNUSUAL = {"m": 0.0, "cm": 0.0, "mm": 0.0, "in": 0.1, "dm": 0.3, "ft": 0.3}  # of a cost; no unit at all costs as much
# Of each measure of `plausibility`, in a body that is one.
WORST = {"disproportion": 0.5, "wobble": 0.25, "lopsidedness": 0.4, "upside_down": 0.3, "crookedness": 0.3}


@dataclass(frozen=True, eq=False)
class Fit:
    """Points taken as a body.

    Attributes:
        joints: (J,) names, sides as they turned out to be.
        scale: metres in one unit.
        axes: (3, 3) rows forward, left, up.
        cost: how unlike a body, 0 for a perfect one.
        reasons: unit and axes in words.
        notes: what was changed.
        problems: why it is no body; empty for a plausible one.
    """

    joints: tuple[str, ...]
    scale: float
    axes: Array
    cost: float
    reasons: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    problems: tuple[str, ...] = ()

    def apply(self, values: Array) -> Array:
        """Positions (..., 3) m in the project's axes of values (..., 3) as the file has them."""
        found: Array = values @ (self.axes.T * self.scale)
        return found


def fit(joints: tuple[str, ...], values: Array, told: Told) -> Fit:
    """Take a sample of points as a body.

    Args:
        joints: (J,) names.
        values: (S, J, 3) as in the file, nan where missing.
        told: what is known beforehand.

    Returns:
        The fit, plausible or not.
    """
    body = Body(joints, values)
    up = middle(body.upward)
    if not 0.0 < body.height < np.inf or not np.isfinite(up).all() or not np.isfinite(middle(body.leftward)).all():
        return Fit(joints, 1.0, np.eye(3), np.inf, problems=("no two shoulders with a head or hips",))
    scale, scale_reason, scale_notes = _scale(body, told)
    axes, joints, axes_notes = orientation(body, up, told)
    costs = {
        "disproportion": plausibility.disproportion(body),
        "wobble": plausibility.wobble(body),
        "lopsidedness": plausibility.lopsidedness(body),
        "upside_down": plausibility.upside_down(body, axes[2]),
        "crookedness": plausibility.crookedness(body),
    }
    cost = sum(costs[name] / worst for name, worst in WORST.items())
    problems = _problems(body, costs, scale, told.planar)
    cost += UNUSUAL.get(unit_name(scale), max(UNUSUAL.values()))
    named = "forward {}, left {}, up {}".format(*(axis_name(row) for row in axes))
    reasons = (scale_reason, named, evidence(Body(joints, values), axes))
    return Fit(joints, scale, axes, cost, reasons, (*scale_notes, *axes_notes), problems)


def _problems(body: Body, costs: Mapping[str, float], scale: float, planar: bool) -> tuple[str, ...]:
    """What no body has; in one camera's view bones may have any length."""
    words = {
        "wobble": f"bones change their length by {costs['wobble']:.0%}",
        "lopsidedness": "left and right bones differ",
        "upside_down": "head, shoulders, hips and feet are not above each other",
        "crookedness": "shoulders, trunk and limbs stand as in no body",
    }
    counted = ("upside_down", "crookedness") if planar else tuple(words)
    found = tuple(words[name] for name in counted if costs[name] > WORST[name])
    if planar:
        return found
    misfits = plausibility.misfits(body)
    total = sum(costs[name] / worst for name, worst in WORST.items())
    if misfits or costs["disproportion"] > WORST["disproportion"] or (total > MOST and not found):
        found = (_worst_bone(body, misfits, scale), *found)
    return (*found, "it has no depth") if plausibility.is_flat(body) else found


def _scale(body: Body, told: Told) -> tuple[float, str, tuple[str, ...]]:
    """Metres in one unit, why, and notes."""
    height = body.height
    if told.planar and not (told.unit and told.firm):
        return _planar_scale(body)
    if told.unit and (told.firm or SMALLEST <= height * told.unit <= TALLEST):
        odd = not SMALLEST <= height * told.unit <= TALLEST
        note = f"in {unit_name(told.unit)}, as told, the person is {height * told.unit:.3g} m tall"
        return told.unit, _unit_reason(body, told.unit), (note,) * odd
    fits = [name for name, metres in LENGTHS.items() if _smallest(name) <= height * metres <= TALLEST]
    if not fits:
        note = f"no unit makes the bones a person's: scaled to an adult of {ADULT:.2f} m"
        return ADULT / height, "no unit", (note,)
    name = min(fits, key=lambda name: abs(np.log(height * LENGTHS[name] / ADULT)))
    notes = (f"not {unit_name(told.unit)} but {name}, by the bones",) if told.unit else ()
    return LENGTHS[name], _unit_reason(body, LENGTHS[name]), notes


def _planar_scale(body: Body) -> tuple[float, str, tuple[str, ...]]:
    """The scale that makes the trunk, or if it is not seen the width of the shoulders, an adult's.

    Every other bone may be shortened by pointing to the camera or away from it.
    """
    typical = {(bone.start, bone.end): bone.length for bone in bones()}
    trunk = median(np.linalg.norm(body.shoulders - body.hips, axis=1))
    if trunk > 0.0:
        length = ADULT * typical["pelvis", "chest"]
        return length / trunk, f"trunk scaled to {length:.2f} m, an adult's", ()
    length = ADULT * typical["left_shoulder", "right_shoulder"]
    return length / body.width, f"shoulders scaled to {length:.2f} m, an adult's", ()


def _smallest(unit: str) -> float:
    return SMALLEST_IN_CM if unit == "cm" else SMALLEST


def _unit_reason(body: Body, scale: float) -> str:
    """The unit, and the bone that makes it likely."""
    lengths = {f"{bone.start} to {bone.end}": length * scale for bone, length in body.medians.items()}
    arm = lengths.get("left_shoulder to left_elbow", lengths.get("right_shoulder to right_elbow"))
    seen = f"upper arm {arm:.2f} m" if arm else f"bones of a person of {body.height * scale:.2f} m"
    name = unit_name(scale)
    return f"unit {name} ({seen})" if name in LENGTHS else f"{name} ({seen})"


def unit_name(metres: float) -> str:
    """A unit's name, or its size."""
    return next((name for name, size in LENGTHS.items() if np.isclose(size, metres)), f"units of {metres:g} m")


def _worst_bone(body: Body, misfits: Mapping[Bone, float], scale: float) -> str:
    """The bone that is least like a body's, against what it should be."""
    ratio = {bone: length / bone.length / body.height for bone, length in body.medians.items()}
    off = misfits or {bone: abs(float(np.log(max(ratio[bone], 1e-6)))) for bone in ratio}
    worst = max(off, key=lambda bone: off[bone])
    expected = worst.length * body.height * scale
    where = f"{worst.start} to {worst.end}".replace("_", " ")
    return f"{where} {body.medians[worst] * scale:.2f} m against {expected:.2f} m"
