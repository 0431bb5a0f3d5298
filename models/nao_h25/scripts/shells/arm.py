"""The arm: shoulder disc, upper arm with its coloured cap, elbow ball and forearm."""

from __future__ import annotations

import numpy as np

from .inlays import Drum, Plane, panel
from .lathe import turned
from .meshes import Mesh, skin
from .parts import Part
from .solids import Solid, half_space, loft, smooth_outline

ELBOW = np.array([0.105, 0.015, 0.0])
OUTSIDE = Plane(origin=(0, 0, 0), outward=(0, 1, 0), right=(1, 0, 0))

# x, y in, y out, z lo, z hi, roundness
UPPER = (
    (-0.0472, 0.0150, 0.0220, -0.004, 0.004, 2.0),
    (-0.0440, 0.0085, 0.0300, -0.0165, 0.0165, 2.1),
    (-0.0360, 0.0030, 0.0345, -0.0280, 0.0280, 2.2),
    (-0.0200, 0.0010, 0.0361, -0.0375, 0.0375, 2.3),
    (0.0000, 0.0010, 0.0361, -0.0408, 0.0408, 2.4),
    (0.0150, 0.0000, 0.0361, -0.0400, 0.0400, 2.4),
    (0.0300, -0.0060, 0.0360, -0.0365, 0.0365, 2.4),
    (0.0450, -0.0105, 0.0355, -0.0325, 0.0325, 2.4),
    (0.0600, -0.0125, 0.0350, -0.0290, 0.0290, 2.4),
    (0.0750, -0.0115, 0.0345, -0.0265, 0.0265, 2.4),
    (0.0860, -0.0085, 0.0335, -0.0240, 0.0240, 2.4),
)
LOWER = (
    (-0.0137, 0.0060, 0.0215, -0.0130, 0.0150, 2.4),
    (-0.0080, -0.0040, 0.0262, -0.0190, 0.0220, 2.4),
    (0.0020, -0.0140, 0.0269, -0.0226, 0.0268, 2.4),
    (0.0130, -0.0200, 0.0267, -0.0231, 0.0283, 2.4),
    (0.0250, -0.0218, 0.0255, -0.0230, 0.0278, 2.4),
    (0.0400, -0.0212, 0.0235, -0.0222, 0.0250, 2.3),
    (0.0564, -0.0196, 0.0205, -0.0208, 0.0218, 2.2),
)


def parts() -> list[Part]:
    """The parts of links `LShoulder`, `LBicep` and `LForeArm`."""
    upper, lower = _upper(), _lower()
    return [
        Part("LShoulder", "joint", _disc()),
        Part("LBicep", "shell", skin(upper, 480) + _barrel()),
        Part("LBicep", "panel", _cap(upper)),
        Part("LBicep", "joint", _elbow()),
        Part("LForeArm", "shell", skin(lower, 340, cell=0.0014, hidden=half_space((0.0557, 0, 0), (-1, 0, 0)))),
        Part("LForeArm", "panel", _cuff(lower)),
    ]


def _disc() -> Mesh:
    """The disc between torso and arm that turns with the shoulder's pitch."""
    profile = [(0.0150, -0.0020), (0.0315, -0.0020), (0.0330, -0.0035), (0.0330, -0.0225), (0.0295, -0.0258)]
    return turned(profile, (0, 0, 0), (0, 1, 0), 26)


def _upper() -> Solid:
    """The upper arm: a dome and a sleeve."""
    return loft(0, UPPER, edge=0.006)


def _barrel() -> Mesh:
    """The round barrel about the shoulder's roll axis; its ends are the two cheeks."""
    end = [(0, 0.0410), (0.0150, 0.0403), (0.0205, 0.0384), (0.0240, 0.0345), (0.0251, 0.0280)]
    profile = end + [(radius, -height) for radius, height in reversed(end)]
    return turned(profile, (0, 0, 0), (0, 0, 1), 24, soft=True)


def _cap(upper: Solid) -> Mesh:
    """The coloured plate over the shoulder and down the outside of the arm."""
    outline = smooth_outline(
        [
            (-0.0395, 0.0),
            (-0.0330, 0.0180),
            (-0.0150, 0.0290),
            (0.0080, 0.0310),
            (0.0300, 0.0265),
            (0.0550, 0.0185),
            (0.0720, 0.0100),
            (0.0755, 0.0),
            (0.0720, -0.0100),
            (0.0550, -0.0185),
            (0.0300, -0.0265),
            (0.0080, -0.0310),
            (-0.0150, -0.0290),
            (-0.0330, -0.0180),
        ]
    )
    return panel(upper, OUTSIDE, outline, lift=1.1e-3, grain=0.0105)


def _elbow() -> Mesh:
    """The grey ball of the elbow and the rod that holds it."""
    angle = np.linspace(0, 2.0, 6)
    ball = [(0.0172 * np.sin(a), 0.0172 * np.cos(a)) for a in angle]
    return turned([*ball, (0.0150, -0.0250)], ELBOW, (1, 0, 0), 18, soft=True)


def _lower() -> Solid:
    """The forearm, cut aslant where the elbow's ball enters."""
    opening = half_space((-0.006, 0, 0), (1, 1, 0))
    return loft(0, LOWER, edge=0.003).cut(opening, k=0.003)


def _cuff(lower: Solid) -> Mesh:
    """The coloured plate on the outside of the forearm."""
    drum = Drum(origin=(0, 0.003, 0.002), axis=(1, 0, 0), front=(0, 1, 0), radius=0.024)
    outline = smooth_outline(
        [
            (-0.020, 0.014),
            (-0.010, 0.006),
            (0.0, 0.004),
            (0.010, 0.006),
            (0.020, 0.014),
            (0.0205, 0.033),
            (0.014, 0.0495),
            (0.0, 0.0515),
            (-0.014, 0.0495),
            (-0.0205, 0.033),
        ]
    )
    return panel(lower, drum, outline, lift=1.1e-3)
