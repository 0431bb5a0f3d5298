"""The robot's numbers, read from `models/nao_h25/facts.json` and typed nowhere else.

The joint vector is the 26 NAOqi `Body` names in NAOqi order and NAOqi signs:
radians, but `LHand` and `RHand` run from 0 (closed) to 1 (open).
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nao_sim.errors import UsageError
from nao_sim.paths import MODEL

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
LEGS = ("LLeg", "RLeg")
VERSIONS = ("v4", "v5", "v6")
START_POSTURE = "StandInit"  # the vendor's posture from which the robot performs
# Of the leg joints of a robot on its feet: as gentle as it takes not to rock it off them.
STANDING_SPEED = 0.7  # rad/s
STANDING_ACCELERATION = 1.2  # rad/s^2


def read_only(values: ArrayLike, dtype: type = np.float64) -> NDArray[Any]:
    """A read-only copy of `values`, or `values` itself where nobody can write to it any more."""
    if isinstance(values, np.ndarray) and values.dtype == dtype and values.flags.owndata and not values.flags.writeable:
        return values
    array: NDArray[Any] = np.array(values, dtype=dtype)
    array.setflags(write=False)
    return array


@dataclass(frozen=True, eq=False)
class Coupling:
    """A joint whose limits depend on another joint's angle (Aldebaran joint pages).

    Attributes:
        joint: index of the limited joint.
        by: index of the joint that the limits depend on.
        knots: (K,) rad, angles of `by` at which the vendor prints limits.
        lower: (K,) rad, lower limit of `joint` there.
        upper: (K,) rad, upper limit of `joint` there.
    """

    joint: int
    by: int
    knots: Array
    lower: Array
    upper: Array

    def bounds(self, angle: ArrayLike) -> tuple[Array, Array]:
        """Limits of `joint` at `angle` of `by` (rad), linear between the knots."""
        angle = np.asarray(angle, np.float64)
        return np.interp(angle, self.knots, self.lower), np.interp(angle, self.knots, self.upper)


@dataclass(frozen=True, eq=False)
class Robot:
    """One NAO H25 version.

    Attributes:
        version: `v4`, `v5` or `v6`.
        title: the name a person would use.
        joint_names: the 26 NAOqi names in NAOqi order.
        lower: (26,) documented lower limits, rad (hands 0..1).
        upper: (26,) documented upper limits, rad (hands 0..1).
        no_load_speed: (26,) rad/s (hands 1/s), no joint is driven faster.
        max_torque: (26,) N m.
        max_speed: (26,) rad/s (hands 1/s), fastest command that a motor follows in every pose.
        max_acceleration: (26,) rad/s^2 (hands 1/s^2), greatest one.
        couplings: limits that depend on another joint.
        postures: the vendor's eight postures, each (26,).
        limbs: joint indices of Head, LArm, LLeg, RLeg and RArm.
        mirror_of: (26,) index of each joint's twin on the other side.
        mirror_sign: (26,) sign its angle takes there.
    """

    version: str
    title: str
    joint_names: tuple[str, ...]
    lower: Array
    upper: Array
    no_load_speed: Array
    max_torque: Array
    max_speed: Array
    max_acceleration: Array
    couplings: tuple[Coupling, ...]
    postures: Mapping[str, Array]
    limbs: Mapping[str, NDArray[np.int_]]
    mirror_of: NDArray[np.int_]
    mirror_sign: Array

    @cached_property
    def index(self) -> Mapping[str, int]:
        """Position of each joint name in the joint vector."""
        return MappingProxyType({name: i for i, name in enumerate(self.joint_names)})

    @cached_property
    def is_hand(self) -> NDArray[np.bool_]:
        """(26,) true where the value is an opening (0..1) and not an angle."""
        return read_only([name.endswith("Hand") for name in self.joint_names], np.bool_)

    def joints_of(self, *limbs: str) -> Mask:
        """(26,) true for the joints of limbs."""
        return np.isin(np.arange(len(self.joint_names)), np.concatenate([self.limbs[limb] for limb in limbs]))

    def mirror(self, positions: Array) -> Array:
        """The pose (..., 26) seen in a mirror: left and right change places."""
        return positions[..., self.mirror_of] * self.mirror_sign

    def report_unit(self, joint: int) -> float:
        """Factor from a joint's inner unit to the reported one (degrees, or hand opening)."""
        return 1.0 if self.is_hand[joint] else float(np.degrees(1.0))


@cache
def facts() -> Mapping[str, Any]:
    """The table the model was built from, as parsed JSON."""
    return MappingProxyType(json.loads((MODEL / "facts.json").read_text(encoding="utf-8")))


@cache
def gains(version: str) -> Mapping[str, Mapping[str, float]]:
    """Servo gains by joint name, and the row `finger` for all finger joints."""
    return MappingProxyType(json.loads((MODEL / "gains.json").read_text(encoding="utf-8"))[version])


@cache
def load_robot(version: str = "v5") -> Robot:
    """The numbers of one robot version.

    Raises:
        UsageError: no such version.
    """
    if version not in VERSIONS:
        raise UsageError(f"robot '{version}' is not known; expected one of {', '.join(VERSIONS)}")
    table = facts()
    joints = table["joints"]
    names = tuple(joint["name"] for joint in joints)
    index = {name: i for i, name in enumerate(names)}
    mirror_of = [index[_twin(name)] for name in names]
    return Robot(
        version=version,
        title=table["versions"][version]["name"],
        joint_names=names,
        lower=read_only([joint["lower"] for joint in joints]),
        upper=read_only([joint["upper"] for joint in joints]),
        no_load_speed=read_only([joint["no_load_speed"][version] for joint in joints]),
        max_torque=read_only([joint["max_torque_Nm"][version] for joint in joints]),
        max_speed=read_only([gains(version)[name]["speed"] for name in names]),
        max_acceleration=read_only([gains(version)[name]["acceleration"] for name in names]),
        couplings=tuple(_coupling(row, index) for row in table["couplings"]),
        postures=MappingProxyType(
            {name: read_only([angles[n] for n in names]) for name, angles in table["postures"].items()}
        ),
        limbs=_limbs(joints),
        mirror_of=read_only(mirror_of, np.int_),
        mirror_sign=read_only([_mirror_sign(joints[i], joints[j]) for i, j in enumerate(mirror_of)]),
    )


def _coupling(row: Mapping[str, Any], index: Mapping[str, int]) -> Coupling:
    knots, lower, upper = np.array(row["rows"]).T
    return Coupling(index[row["joint"]], index[row["by"]], read_only(knots), read_only(lower), read_only(upper))


def _twin(name: str) -> str:
    """The joint of the same name on the other side (the head's joints are their own)."""
    other = {"L": "R", "R": "L"}.get(name[0])
    return other + name[1:] if other else name


def _mirror_sign(joint: Mapping[str, Any], twin: Mapping[str, Any]) -> float:
    """An axis is a pseudovector: mirrored in the x-z plane its x and z change sign."""
    if joint["name"].endswith("Hand"):
        return 1.0
    mirrored = np.array(joint["axis"]) * [-1.0, 1.0, -1.0]
    return float(np.sign(mirrored @ np.array(twin["axis"])))


def _limbs(joints: list[Mapping[str, Any]]) -> Mapping[str, NDArray[np.int_]]:
    """Follow the kinematic tree from the torso; a limb is named by its first joint."""
    first = {"HeadYaw": "Head", "LShoulderPitch": "LArm", "RShoulderPitch": "RArm",
             "LHipYawPitch": "LLeg", "RHipYawPitch": "RLeg"}  # fmt: skip
    limb_of_link: dict[str, str] = {}
    members: dict[str, list[int]] = {}
    for i, joint in enumerate(joints):
        limb = first[joint["name"]] if joint["parent"] == "torso" else limb_of_link[joint["parent"]]
        limb_of_link[joint["child"]] = limb
        members.setdefault(limb, []).append(i)
    return MappingProxyType({limb: read_only(indices, np.int_) for limb, indices in members.items()})
