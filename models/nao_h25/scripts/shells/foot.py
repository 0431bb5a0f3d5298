"""The foot: a low rounded shoe over a grey sole."""

from __future__ import annotations

import numpy as np

from .inlays import Plane, panel
from .lathe import stacked
from .meshes import Mesh, skin
from .parts import Part
from .solids import Array, Solid, half_space, loft, smooth_outline

ABOVE = Plane(origin=(0, 0, 0), outward=(0, 0, 1), right=(1, 0, 0))

# the outline of the left foot, x and y in the frame of the ankle
FOOTPRINT = smooth_outline(
    [
        (0.1022, 0.000),
        (0.0985, 0.020),
        (0.0865, 0.0370),
        (0.0660, 0.0480),
        (0.0450, 0.0500),
        (0.0150, 0.0455),
        (-0.0100, 0.0455),
        (-0.0300, 0.0512),
        (-0.0480, 0.0425),
        (-0.0575, 0.0200),
        (-0.0577, -0.0080),
        (-0.0500, -0.0260),
        (-0.0330, -0.0350),
        (-0.0050, -0.0350),
        (0.0250, -0.0365),
        (0.0550, -0.0387),
        (0.0790, -0.0355),
        (0.0955, -0.0210),
    ]
)
# x, height, roundness: the white shell is a long low dome over the outline
WAIST = -0.0400
DOME = (
    (-0.0566, -0.0380, 2.0),
    (-0.0556, -0.0285, 2.1),
    (-0.0530, -0.0195, 2.2),
    (-0.0470, -0.0070, 2.4),
    (-0.0370, 0.0045, 2.5),
    (-0.0280, 0.0110, 2.5),
    (-0.0150, 0.0170, 2.5),
    (0.0000, 0.0197, 2.5),
    (0.0120, 0.0180, 2.5),
    (0.0220, 0.0135, 2.5),
    (0.0350, 0.0060, 2.5),
    (0.0500, -0.0035, 2.5),
    (0.0660, -0.0105, 2.5),
    (0.0800, -0.0155, 2.5),
    (0.0900, -0.0200, 2.4),
    (0.0970, -0.0255, 2.2),
    (0.0995, -0.0310, 2.1),
    (0.1007, -0.0370, 2.0),
)


def parts() -> list[Part]:
    """The parts of link `l_ankle`."""
    shoe = _shoe()
    return [
        Part("l_ankle", "shell", skin(shoe, 620, cell=0.0019, hidden=half_space((0, 0, -0.0415), (0, 0, 1)))),
        Part("l_ankle", "panel", _instep(shoe)),
        Part("l_ankle", "joint", _sole()),
    ]


def _shoe() -> Solid:
    """The white shell; the shin stands in it, so that no gap opens when the ankle turns."""
    sections = []
    for x, height, n in DOME:
        right, left = np.interp(x, *_side(FOOTPRINT, -1)), np.interp(x, *_side(FOOTPRINT, 1))
        sections.append((x, 0.972 * right, 0.972 * left, 2 * WAIST - height, height, n))
    return loft(0, sections, edge=0.002).cut(half_space((0, 0, -0.0428), (0, 0, 1)))


def _side(outline: Array, sign: int) -> tuple[Array, Array]:
    """x and y along the left (+1) or right (-1) side of the outline, heel to toe."""
    heel, toe = outline[outline[:, 0].argmin()], outline[outline[:, 0].argmax()]
    dx, dy = toe - heel
    off = dx * (outline[:, 1] - heel[1]) - dy * (outline[:, 0] - heel[0])
    side = np.vstack([outline[sign * off > 0], heel, toe])
    return tuple(side[np.argsort(side[:, 0], kind="stable")].T)


def _sole() -> Mesh:
    """The grey rubber under it."""
    return stacked(FOOTPRINT[::2], [(0.0025, -0.0449), (0.0, -0.0430), (0.0, -0.0390), (0.0030, -0.0380)])


def _instep(shoe: Solid) -> Mesh:
    """The coloured plate over the toes."""
    outline = smooth_outline(
        [
            (0.055, 0.004),
            (0.056, 0.030),
            (0.066, 0.0375),
            (0.081, 0.028),
            (0.0895, 0.012),
            (0.0905, -0.006),
            (0.084, -0.021),
            (0.068, -0.029),
            (0.056, -0.022),
        ]
    )
    return panel(shoe, ABOVE, outline, lift=1e-3)
