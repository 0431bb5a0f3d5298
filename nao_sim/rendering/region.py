"""Which part of a picture a robot and its shadow can touch; the rest never changes while the camera stands still."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_MARGIN = 3  # pixels
_GRID = 16  # pixels; software OpenGL works in tiles


@dataclass(frozen=True)
class View:
    """A pinhole camera at rest.

    Attributes:
        position: (3,) m.
        forward: (3,) unit vector of view.
        up: (3,) unit vector, upright in the picture.
        slope: tangent of half the vertical field of view.
        size: (width, height) of the picture in pixels.
    """

    position: Array
    forward: Array
    up: Array
    slope: float
    size: tuple[int, int]


@dataclass(frozen=True)
class Region:
    """A rectangle of pixels; `bottom` counts from the picture's lower edge, as OpenGL does."""

    left: int
    bottom: int
    width: int
    height: int


def shadow_spheres(centres: Array, radii: Array, light: Array, floor: float) -> tuple[Array, Array]:
    """Spheres that hold the shadows which spheres cast on a floor.

    Args:
        centres: (N, 3) m.
        radii: (N,) m.
        light: (3,) unit vector along which the light shines, downwards.
        floor: m, the floor's height.

    Returns:
        (N, 3) m centres on the floor and (N,) m radii: a shadow is an ellipse of half axes r and r / |light_z|.
    """
    away = (floor - centres[:, 2:]) / light[2]
    return centres + away * light, radii / abs(light[2])


def region_of(view: View, centres: Array, radii: Array) -> Region | None:
    """The smallest rectangle, on a coarse grid, that holds all spheres in the picture.

    A sphere at (x, z) of radius r is seen between the angles atan2(x, z) -/+ asin(r / hypot(x, z)).

    Args:
        view: the camera.
        centres: (N, 3) m.
        radii: (N,) m.

    Returns:
        The rectangle, or None where the whole picture is concerned (a sphere reaches beside the camera).
    """
    offset = centres - view.position
    depth = offset @ view.forward
    right = np.cross(view.forward, view.up)
    width, height = view.size
    spans = []
    for axis, half, pixels in ((right, view.slope * width / height, width), (view.up, view.slope, height)):
        span = _span(offset @ axis, depth, radii, half, pixels)
        if span is None:
            return None
        spans.append(span)
    (left, end), (bottom, top) = spans
    return Region(left, bottom, end - left, top - bottom)


def _span(across: Array, depth: Array, radii: Array, half: float, pixels: int) -> tuple[int, int] | None:
    """First and one past the last pixel along one axis; None where a sphere reaches beside the camera."""
    distance = np.hypot(across, depth)
    if len(across) == 0 or np.any(distance <= radii):
        return None
    angle, spread = np.arctan2(across, depth), np.arcsin(radii / distance)
    low, high = float((angle - spread).min()), float((angle + spread).max())
    if low <= -np.pi / 2 or high >= np.pi / 2:
        return None
    first, last = ((np.tan(edge) / half + 1.0) / 2.0 * pixels for edge in (low, high))
    start = int(np.clip((first - _MARGIN) // _GRID * _GRID, 0, pixels - 1))
    end = int(np.clip(-((-last - _MARGIN) // _GRID) * _GRID, start + 1, pixels))
    return start, end
