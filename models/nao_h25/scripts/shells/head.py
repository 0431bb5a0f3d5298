"""The head: a wide helmet with a flat face, round eyes and ears, and the tactile strip on top."""

from __future__ import annotations

import numpy as np

from .inlays import Drum, Plane, panel, seam
from .lathe import turned
from .meshes import Mesh, skin
from .parts import Part
from .solids import Array, Solid, both_sides, ellipsoid, loft, smooth_outline, unit

EYE = np.array([0.0468, 0.0272, 0.0470])
EYE_OUTWARD = unit([np.cos(0.36), np.sin(0.36), 0.03])
EAR = np.array([-0.004, 0.0, 0.0500])
FOREHEAD = np.array([0.0575, 0.0, 0.06364])
ABOVE = Plane(origin=(0, 0, 0.06), outward=(0, 0, 1), right=(1, 0, 0))
FRONT = Plane(origin=(0, 0, 0), outward=(1, 0, 0), right=(0, 1, 0))

BEHIND = Plane(origin=(0, 0, 0), outward=(-1, 0, 0), right=(0, -1, 0))
HATCH = smooth_outline(
    [
        (0.023, 0.062),
        (0.016, 0.081),
        (0.0, 0.085),
        (-0.016, 0.081),
        (-0.023, 0.062),
        (-0.018, 0.043),
        (0.0, 0.039),
        (0.018, 0.043),
    ],
    40,
)

# z, back, front, right, left, roundness
SKULL = (
    (0.0002, -0.012, 0.018, -0.014, 0.014, 2.0),
    (0.0040, -0.029, 0.036, -0.0285, 0.0285, 2.1),
    (0.0110, -0.040, 0.0445, -0.0390, 0.0390, 2.2),
    (0.0200, -0.0485, 0.0500, -0.0480, 0.0480, 2.3),
    (0.0320, -0.0555, 0.0545, -0.0560, 0.0560, 2.35),
    (0.0470, -0.0596, 0.0578, -0.0613, 0.0613, 2.4),
    (0.0636, -0.0606, 0.0587, -0.0625, 0.0625, 2.4),
    (0.0780, -0.0585, 0.0560, -0.0605, 0.0605, 2.35),
    (0.0910, -0.0525, 0.0490, -0.0550, 0.0550, 2.3),
    (0.1010, -0.0435, 0.0400, -0.0460, 0.0460, 2.2),
    (0.1085, -0.0320, 0.0290, -0.0340, 0.0340, 2.1),
    (0.1130, -0.0180, 0.0160, -0.0195, 0.0195, 2.0),
    (0.1145, -0.0010, 0.0010, -0.0010, 0.0010, 2.0),
)


def parts() -> list[Part]:
    """The parts of link `Head` and the hidden joint of link `Neck`."""
    skull = _skull()
    return [
        Part("Head", "shell", skin(skull, 1500) + _ear_cup().both_sides()),
        Part("Head", "panel", _crescent(skull).both_sides()),
        Part("Head", "joint", _seams(skull) + _grille().both_sides()),
        Part("Head", "dark", _strip(skull) + _cameras(skull) + _vents(skull) + (_pupil() + _grille_gap()).both_sides()),
        Part("Head", "led", (_eye_ring() + _ear_ring()).both_sides()),
        Part(
            "Neck",
            "joint",
            turned([(0.0126, 0.0127), (0.0126, -0.0125)], (0, 0, 0), (0, 0, 1), 20),
        ),
    ]


def _skull() -> Solid:
    """The white shell with the dishes of the eyes."""
    dish = ellipsoid(EYE + 0.0164 * EYE_OUTWARD, 0.024)
    return loft(2, SKULL, edge=0.0).cut(both_sides(dish), k=0.015)


def _crescent(skull: Solid) -> Mesh:
    """The coloured plate beside the tactile strip, seen from above."""
    outline = smooth_outline(
        [
            (0.037, 0.020),
            (0.020, 0.0165),
            (0.0, 0.0155),
            (-0.022, 0.0165),
            (-0.042, 0.020),
            (-0.043, 0.026),
            (-0.024, 0.037),
            (-0.002, 0.0425),
            (0.018, 0.0385),
            (0.034, 0.028),
        ]
    )
    return panel(skull, ABOVE, outline, lift=4e-4, grain=0.008)


def _strip(skull: Solid) -> Mesh:
    """The three tactile buttons along the crown."""
    ends = ((0.0145, 0.0400), (-0.0125, 0.0130), (-0.0390, -0.0140))
    plates = [panel(skull, ABOVE, _pad(a, b, 0.0095), lift=7e-4, grain=0.0045) for a, b in ends]
    return plates[0] + plates[1] + plates[2]


def _pad(lo: float, hi: float, half: float) -> Array:
    """A rounded rectangle from x = lo to hi, y = -half to half."""
    turn = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    corner = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    corner = np.sign(corner) * np.abs(corner) ** 0.45
    return corner * [(hi - lo) / 2, half] + [(hi + lo) / 2, 0]


def _cameras(skull: Solid) -> Mesh:
    """The windows of the two cameras, forehead and mouth."""
    mouth = smooth_outline([(0.0085, 0.0178), (0.0, 0.0213), (-0.0085, 0.0178), (0.0, 0.0143)], 40)
    forehead = turned([(0, 0.0014), (0.0036, 0.0012), (0.0046, 0.0)], FOREHEAD, (1, 0, 0.02), 20)
    return forehead + panel(skull, FRONT, mouth, lift=3e-4, grain=0.004)


def _vents(skull: Solid) -> Mesh:
    """The two air slots under the hatch at the back of the head."""
    slots = [
        panel(skull, BEHIND, _pad(-w, w, 0.0014)[:, :2] + [0, z], lift=3e-4, rim=0.0)
        for w, z in ((0.0115, 0.0300), (0.0095, 0.0245))
    ]
    return slots[0] + slots[1]


def _pupil() -> Mesh:
    """The dark lens in the middle of the eye and the dark rim of its socket."""
    rim = turned([(0.0148, 0.0006), (0.0165, 0.0010), (0.0175, -0.0010)], EYE, EYE_OUTWARD, 24)
    lens = turned([(0, 0.0028), (0.0060, 0.0024), (0.0106, 0.0010)], EYE, EYE_OUTWARD, 20, soft=True)
    return rim + lens


def _eye_ring() -> Mesh:
    """The ring of eight lights around the pupil."""
    return turned([(0.0104, 0.0009), (0.0125, 0.0016), (0.0148, 0.0004)], EYE, EYE_OUTWARD, 24, soft=True)


def _grille() -> Mesh:
    """The loudspeaker in the ear: a grey cover."""
    return turned([(0, 0.0664), (0.0105, 0.0661)], EAR, (0, 1, 0), 20, soft=True)


def _grille_gap() -> Mesh:
    """The dark ring between the cover and the lights."""
    return turned([(0.0100, 0.0658), (0.0146, 0.0656)], EAR, (0, 1, 0), 24)


def _ear_ring() -> Mesh:
    """The ring of ten lights around the loudspeaker."""
    return turned([(0.0145, 0.0660), (0.0176, 0.0662)], EAR, (0, 1, 0), 26)


def _ear_cup() -> Mesh:
    """The white cup that holds the loudspeaker."""
    profile = [
        (0.0172, 0.0652),
        (0.0180, 0.0663),
        (0.0212, 0.0652),
        (0.0226, 0.0620),
        (0.0228, 0.0540),
    ]
    return turned(profile, EAR, (0, 1, 0), 26, soft=True)


def _seams(skull: Solid) -> Mesh:
    """Where the face mask meets the back of the head: from ear to ear, over the crown."""
    around = Drum(origin=(-0.004, 0, 0.05), axis=(1, 0, 0), front=(0, 0, 1), radius=0.06)
    lower = Drum(origin=(-0.004, 0, 0.05), axis=(1, 0, 0), front=(0, 0, -1), radius=0.06)
    upper = np.linspace(0.043, 0.0715, 10)
    under = np.linspace(0.027, 0.0715, 12)
    arc = seam(skull, around, np.stack([upper, 0 * upper], axis=1))
    jaw = seam(skull, lower, np.stack([-under, 0 * under], axis=1))
    hatch = seam(skull, BEHIND, np.vstack([HATCH, HATCH[:1]]))
    return arc.both_sides() + jaw.both_sides() + hatch
