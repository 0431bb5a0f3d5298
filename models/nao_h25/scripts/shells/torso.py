"""The torso: broad shoulders, a tapering waist, the chest button and its sonars."""

from __future__ import annotations

import numpy as np

from .inlays import Drum, Plane, panel, seam, spot
from .lathe import turned
from .meshes import Mesh, skin
from .parts import Part
from .solids import Solid, both_sides, cylinder, ellipsoid, loft, smooth_outline

BUTTON = (0.0, 0.0552)
SONARS = ((0.0341, 0.0698), (0.0416, 0.0509))
FRONT = Plane(origin=(0, 0, 0), outward=(1, 0, 0), right=(0, 1, 0))
BACK = Plane(origin=(0, 0, 0), outward=(-1, 0, 0), right=(0, -1, 0))

# the outline of the battery's cover
HATCH = smooth_outline(
    [
        (0.034, 0.055),
        (0.030, 0.078),
        (0.0, 0.083),
        (-0.030, 0.078),
        (-0.034, 0.055),
        (-0.028, 0.018),
        (-0.020, 0.006),
        (0.0, 0.003),
        (0.020, 0.006),
        (0.028, 0.018),
    ],
    48,
)

# z, back, front, right, left, roundness
TRUNK = (
    (-0.0960, 0.002, 0.012, -0.004, 0.004, 2.0),
    (-0.0920, -0.021, 0.033, -0.0130, 0.0130, 2.0),
    (-0.0830, -0.030, 0.041, -0.0185, 0.0185, 2.0),
    (-0.0680, -0.037, 0.0465, -0.0218, 0.0218, 2.0),
    (-0.0520, -0.042, 0.0477, -0.0250, 0.0250, 2.1),
    (-0.0350, -0.0462, 0.0490, -0.0350, 0.0350, 2.2),
    (-0.0125, -0.0482, 0.0502, -0.0440, 0.0440, 2.4),
    (0.0100, -0.0495, 0.0515, -0.0525, 0.0525, 2.5),
    (0.0300, -0.0510, 0.0545, -0.0625, 0.0625, 2.6),
    (0.0450, -0.0520, 0.0570, -0.0695, 0.0695, 2.6),
    (0.0600, -0.0526, 0.0585, -0.0755, 0.0755, 2.6),
    (0.0750, -0.0526, 0.0589, -0.0790, 0.0790, 2.6),
    (0.0900, -0.0520, 0.0570, -0.0800, 0.0800, 2.6),
    (0.1050, -0.0490, 0.0505, -0.0790, 0.0790, 2.6),
    (0.1180, -0.0430, 0.0410, -0.0770, 0.0770, 2.5),
    (0.1280, -0.0310, 0.0290, -0.0730, 0.0730, 2.4),
    (0.1333, -0.0100, 0.0090, -0.0600, 0.0600, 2.2),
)


def parts() -> list[Part]:
    """The parts of link `torso`."""
    trunk = _trunk()
    return [
        Part("torso", "shell", skin(trunk, 1600, cell=0.0022, hidden=_covered())),
        Part("torso", "panel", (_flank(trunk)).both_sides()),
        Part("torso", "joint", _neck() + _hub().both_sides() + _seams(trunk) + _sonar_rims(trunk).both_sides()),
        Part("torso", "dark", _button_rim(trunk) + _socket(trunk) + _sonars(trunk).both_sides()),
        Part("torso", "led", _button(trunk)),
    ]


def _trunk() -> Solid:
    """The white shell with its neckline and the wells of the shoulder discs."""
    neckline = ellipsoid((0.002, 0, 0.140), (0.054, 0.048, 0.0340))
    well = cylinder((0, 0.0712, 0.1), (0, 0.15, 0.1), 0.0350)
    return loft(2, TRUNK, edge=0.0).cut(neckline, k=0.014).cut(both_sides(well), k=0.002)


def _covered() -> Solid:
    """What shoulder discs and neck hide of the shell."""
    floor = cylinder((0, 0.0690, 0.1), (0, 0.0735, 0.1), 0.0270)
    return both_sides(floor).join(cylinder((0, 0, 0.08), (0, 0, 0.12), 0.0150))


def _flank(trunk: Solid) -> Mesh:
    """The coloured plate down the side of the chest; u runs around the trunk from the front."""
    outline = smooth_outline(
        [
            (0.0500, 0.1145),
            (0.0560, 0.1070),
            (0.0578, 0.0920),
            (0.0595, 0.0720),
            (0.0640, 0.0450),
            (0.0595, 0.0180),
            (0.0505, -0.0080),
            (0.0390, -0.0280),
            (0.0300, -0.0290),
            (0.0340, -0.0080),
            (0.0410, 0.0180),
            (0.0475, 0.0420),
            (0.0470, 0.0620),
            (0.0395, 0.0835),
            (0.0325, 0.0905),
            (0.0300, 0.0970),
            (0.0325, 0.1025),
            (0.0405, 0.1085),
        ]
    )
    drum = Drum(origin=(0, 0, 0), axis=(0, 0, 1), front=(1, 0, 0), radius=0.060)
    return panel(trunk, drum, outline, lift=1.2e-3)


def _neck() -> Mesh:
    """The grey neck that carries the head."""
    return turned(
        [(0.0, 0.1262), (0.0125, 0.1262), (0.0150, 0.1150), (0.0230, 0.1010)], (0, 0, 0), (0, 0, 1), 22, soft=True
    )


def _hub() -> Mesh:
    """The motor hub inside the shoulder disc."""
    return turned([(0, 0.087), (0.012, 0.087), (0.012, 0.070)], (0, 0, 0.1), (0, 1, 0), 8)


def _button(trunk: Solid) -> Mesh:
    """The chest button, lit from inside."""
    profile = [(0, 0.0026), (0.0050, 0.0023), (0.0080, 0.0015), (0.0090, 0.0)]
    return turned(profile, *spot(trunk, FRONT, BUTTON), 20, soft=True)


def _button_rim(trunk: Solid) -> Mesh:
    return turned([(0.0088, 0.0011), (0.0116, 0.0011), (0.0124, -0.001)], *spot(trunk, FRONT, BUTTON), 24)


def _sonars(trunk: Solid) -> Mesh:
    """The membranes of the two sonar discs of the left side."""
    return _both([turned([(0, 0.0008), (0.0060, 0.0010)], *spot(trunk, FRONT, at), 16) for at in SONARS])


def _sonar_rims(trunk: Solid) -> Mesh:
    profile = [(0.0058, 0.0015), (0.0076, 0.0015), (0.0084, -0.0010)]
    return _both([turned(profile, *spot(trunk, FRONT, at), 16) for at in SONARS])


def _socket(trunk: Solid) -> Mesh:
    """The charger's socket at the small of the back."""
    return turned([(0, 0.0004), (0.0050, 0.0006), (0.0065, -0.001)], *spot(trunk, BACK, (0.0, -0.0150)), 20)


def _both(meshes: list[Mesh]) -> Mesh:
    return meshes[0] + meshes[1]


def _seams(trunk: Solid) -> Mesh:
    """The belt line between chest and belly, front and back, and the battery's cover."""
    y = np.linspace(-0.0385, 0.0385, 18)
    belt = np.stack([y, -0.030 + 4.0 * y**2], axis=1)
    hatch = seam(trunk, BACK, np.vstack([HATCH, HATCH[:1]]))
    return seam(trunk, FRONT, belt) + seam(trunk, BACK, belt) + hatch
