"""The hand: a wrist cuff, a rounded white back, and fingers of two kinds of phalanx."""

from __future__ import annotations

from .lathe import turned
from .meshes import Mesh, skin
from .parts import Part
from .solids import Solid, box, cylinder, half_space, loft

PHALANGES = (
    "LFinger11_link",
    "LFinger12_link",
    "LFinger13_link",
    "LFinger21_link",
    "LFinger22_link",
    "LFinger23_link",
    "LThumb1_link",
    "LThumb2_link",
)

# x, y lo, y hi, z lo, z hi, roundness
HAND = (
    (0.0004, -0.0195, 0.0200, -0.0205, 0.0215, 2.2),
    (0.0100, -0.0212, 0.0215, -0.0225, 0.0232, 2.2),
    (0.0230, -0.0240, 0.0240, -0.0255, 0.0260, 2.3),
    (0.0380, -0.0292, 0.0292, -0.0265, 0.0298, 2.4),
    (0.0520, -0.0330, 0.0330, -0.0250, 0.0313, 2.5),
    (0.0640, -0.0341, 0.0341, -0.0220, 0.0300, 2.5),
    (0.0750, -0.0325, 0.0325, -0.0160, 0.0255, 2.4),
    (0.0820, -0.0280, 0.0280, -0.0080, 0.0190, 2.3),
    (0.0849, -0.0200, 0.0200, -0.0010, 0.0120, 2.2),
)


def parts() -> list[Part]:
    """The parts of link `l_wrist` and of the eight phalanges."""
    hand, phalanx = _back(), _phalanx()
    return [
        Part("l_wrist", "shell", skin(hand, 400, cell=0.0014, hidden=half_space((0.0012, 0, 0), (1, 0, 0)))),
        Part("l_wrist", "joint", skin(_palm(), 150, cell=0.0014)),
    ] + [Part(link, "joint", phalanx) for link in PHALANGES]


def _back() -> Solid:
    """The cuff and the cover over the fingers' roots, cut aslant on the palm's side."""
    return loft(0, HAND, edge=0.003).cut(half_space((0.0400, 0, -0.0262), (-0.78, 0, 1)), k=0.003)


def _palm() -> Solid:
    """The grey inside of the hand and the root of the thumb."""
    body = box((0.034, -0.0225, -0.0205), (0.0670, 0.0225, 0.0085), 0.009)
    thumb = cylinder((0.0480, -0.0075, -0.0255), (0.0480, 0.0075, -0.0255), 0.0062, edge=0.002)
    return body.join(thumb, k=0.006)


def _phalanx() -> Mesh:
    """One finger bone, 14.36 mm from axis to axis, with its rounded knuckles."""
    profile = [(0, 0.0180), (0.0062, 0.0155), (0.0081, 0.0090), (0.0068, 0.0008), (0, -0.0019)]
    return turned(profile, (0, 0, 0), (1, 0, 0), 8, soft=True).stretched((1, 1, 0.75)).moved((0, -0.0002, 0))
