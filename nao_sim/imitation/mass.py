"""Where the robot's weight is, for any number of poses at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Any

import numpy as np

from nao_sim.robot import Array, Robot, facts, read_only

LEG_LINKS = ("Pelvis", "Hip", "Thigh", "Tibia", "AnklePitch", "ankle")
_MIRROR = np.array([1.0, -1.0, 1.0])


@dataclass(frozen=True, eq=False)
class Link:
    """A part of the robot.

    Attributes:
        mass: kg.
        centre: (3,) m, its centre of mass in its own frame.
    """

    mass: float
    centre: Array


def masses(robot: Robot) -> tuple[float, float]:
    """The mass, kg, of all but the legs, and of the legs."""
    links = _links(robot.version)
    legs = sum(link.mass for name, link in links.items() if name.endswith(LEG_LINKS))
    return sum(link.mass for link in links.values()) - legs, legs


def centre_of_mass(positions: Array, robot: Robot, legs: bool) -> Array:
    """The centre of mass of the legs, or of all the rest.

    Args:
        positions: (T, 26) rad.
        robot: whose masses count.
        legs: whether to weigh the legs or the rest.

    Returns:
        (T, 3) m, in the torso's frame.
    """
    links = {name: link for name, link in _links(robot.version).items() if name.endswith(LEG_LINKS) == legs}
    frames = link_frames(positions, robot, frozenset(links))
    moments = [link.mass * (frames[name][0] @ link.centre + frames[name][1]) for name, link in links.items()]
    return np.asarray(np.sum(moments, axis=0) / masses(robot)[legs])


def link_frames(positions: Array, robot: Robot, links: frozenset[str]) -> Mapping[str, tuple[Array, Array]]:
    """Rotation (T, 3, 3) and place (T, 3), m, in the torso's frame, of some links and those between them and the torso.

    Args:
        positions: (T, 26) rad.
        robot: the order of the joints.
        links: names as in `models/nao_h25/facts.json`.
    """
    frames = {"torso": (np.broadcast_to(np.eye(3), (len(positions), 3, 3)), np.zeros((len(positions), 3)))}
    for joint in _joints_to(links):
        rotation, place = frames[joint["parent"]]
        turned = rotation @ turns(np.array(joint["axis"]), positions[:, robot.index[joint["name"]]])
        frames[joint["child"]] = turned, place + rotation @ np.array(joint["origin_m"])
    return MappingProxyType(frames)


def turns(axis: Array, angles: Array) -> Array:
    """Rotations (T, 3, 3) by angles (T,) rad about a unit axis (3,): I + sin K + (1 - cos) K^2 (Rodrigues)."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    sine, rest = np.sin(angles)[:, None, None], 1.0 - np.cos(angles)[:, None, None]
    return np.eye(3) + sine * cross + rest * (cross @ cross)


@cache
def _joints_to(links: frozenset[str]) -> tuple[Mapping[str, Any], ...]:
    """The joints on the ways from the torso to links, parents first."""
    needed = set(links)
    for joint in reversed(facts()["joints"]):  # parents come first there
        if joint["child"] in needed:
            needed.add(joint["parent"])
    return tuple(joint for joint in facts()["joints"] if joint["child"] in needed)


@cache
def _links(version: str) -> Mapping[str, Link]:
    """Every link that weighs something.

    Left and right differ by up to 1.5 mm in the published centres (the V6
    head); planning takes the mean of both, so that a mirrored person makes a
    mirrored robot.
    """
    changes = facts()["versions"][version]["links"]
    rows = {row["name"]: row | changes.get(row["name"], {}) for row in facts()["links"]}
    return MappingProxyType({name: _symmetric(row, rows[_twin(name)]) for name, row in rows.items()})


def _symmetric(row: Mapping[str, Any], twin: Mapping[str, Any]) -> Link:
    centre = (np.array(row["com_m"]) + np.array(twin["com_m"]) * _MIRROR) / 2.0
    return Link((row["mass_kg"] + twin["mass_kg"]) / 2.0, read_only(centre))


def _twin(link: str) -> str:
    other = {"L": "R", "R": "L", "l_": "r_", "r_": "l_"}
    prefix = link[:2] if link[:2] in other else link[:1]
    return other[prefix] + link.removeprefix(prefix) if prefix in other else link
