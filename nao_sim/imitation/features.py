"""The ten arm features of I. I. Itauma's MSc thesis (Istanbul Technical University, 2012).

Five an arm, right arm first, in the person's frame:

* `SR`, `SP`: azimuth (0 forward, + to the right) and elevation (+ up) of the
  upper arm;
* `EY`, `H`: azimuth and elevation of the forearm;
* `ER`: interior angle of the elbow, pi where it is straight.

Two directions say all of it, so `ER` is redundant: it measures the error of a
row of the thesis's table.  Radians here, degrees only in files.
"""

from __future__ import annotations

import numpy as np

from nao_sim.robot import Array

FEATURES = ("RSR", "RSP", "RER", "REY", "RH", "LSR", "LSP", "LER", "LEY", "LH")
LEFT, RIGHT = 0, 1  # sides of a directions array
UPPER_ARM, FOREARM = 0, 1  # segments of a directions array


def directions_of(features: Array) -> Array:
    """The segment directions that features describe.

    Args:
        features: (..., 10) rad, in the order of `FEATURES`; `ER` is not used.

    Returns:
        (..., 2, 2, 3) unit vectors, x forward, y left, z up: side (`LEFT`,
        `RIGHT`), segment (`UPPER_ARM`, `FOREARM`), coordinate.
    """
    azimuth_upper, elevation_upper, _, azimuth_forearm, elevation_forearm = _by_side(features)
    upper = _direction(azimuth_upper, elevation_upper)
    return np.stack([upper, _direction(azimuth_forearm, elevation_forearm)], axis=-2)


def features_of(directions: Array) -> Array:
    """The features of segment directions, the inverse of `directions_of`.

    Args:
        directions: (..., 2, 2, 3) vectors of any length, as `directions_of` returns.

    Returns:
        (..., 10) rad: azimuths in [-pi, pi], elevations in [-pi/2, pi/2], interior
        angles in [0, pi].
    """
    x, y, z = np.moveaxis(np.asarray(directions, float), -1, 0)
    azimuth, elevation = np.arctan2(-y, x), np.arctan2(z, np.hypot(x, y))
    upper, forearm = (..., UPPER_ARM), (..., FOREARM)
    arms = np.stack(
        [azimuth[upper], elevation[upper], interior_angle(directions), azimuth[forearm], elevation[forearm]], axis=-1
    )
    return arms[..., ::-1, :].reshape(*arms.shape[:-2], len(FEATURES))


def interior_angle(directions: Array) -> Array:
    """Interior elbow angles (..., 2) rad, left and right, of directions (..., 2, 2, 3).

    pi - atan2(|u x f|, u . f): exact near 0 and pi, where acos is not.
    """
    upper, forearm = directions[..., UPPER_ARM, :], directions[..., FOREARM, :]
    across = np.linalg.norm(np.cross(upper, forearm), axis=-1)
    bend: Array = np.arctan2(across, np.sum(upper * forearm, axis=-1))
    return np.pi - bend


def elbow_disagreement(features: Array) -> Array:
    """How far `ER` is from the angle between the row's own directions.

    Args:
        features: (..., 10) rad.

    Returns:
        (..., 2) rad, left and right, never negative.
    """
    error: Array = _by_side(features)[2] - interior_angle(directions_of(features))
    return np.abs(error)


def _by_side(features: Array) -> Array:
    """(5, ..., 2): each feature by side, left first, out of the thesis's right-first row."""
    features = np.asarray(features, float)
    arms = features.reshape(*features.shape[:-1], 2, len(FEATURES) // 2)
    return np.moveaxis(arms[..., ::-1, :], -1, 0)


def _direction(azimuth: Array, elevation: Array) -> Array:
    level = np.cos(elevation)
    return np.stack([level * np.cos(azimuth), -level * np.sin(azimuth), np.sin(elevation)], axis=-1)
