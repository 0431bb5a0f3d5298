"""The leg: grey hip joints, thigh, shin, and the grey ankle between shin and foot."""

from __future__ import annotations

from .inlays import Plane, panel
from .lathe import turned
from .meshes import Mesh, skin
from .parts import Part
from .solids import Solid, box, cylinder, loft, smooth_outline

FRONT = Plane(origin=(0, 0, 0), outward=(1, 0, 0), right=(0, 1, 0))

# z, back, front, inside, outside, roundness
THIGH = (
    (-0.0955, -0.0050, 0.0470, -0.0370, 0.0425, 2.9),
    (-0.0800, -0.0110, 0.0510, -0.0405, 0.0460, 2.8),
    (-0.0650, -0.0190, 0.0500, -0.0407, 0.0475, 2.7),
    (-0.0480, -0.0285, 0.0455, -0.0385, 0.0485, 2.6),
    (-0.0300, -0.0375, 0.0380, -0.0300, 0.0487, 2.6),
    (-0.0120, -0.0440, 0.0280, -0.0180, 0.0487, 2.6),
    (0.0020, -0.0420, 0.0180, -0.0060, 0.0475, 2.5),
    (0.0120, -0.0340, 0.0070, 0.0070, 0.0435, 2.4),
    (0.0180, -0.0220, -0.0060, 0.0190, 0.0340, 2.2),
    (0.0190, -0.0160, -0.0120, 0.0250, 0.0290, 2.0),
)
SHIN = (
    (-0.1257, -0.0100, 0.0090, -0.0225, 0.0275, 3.0),
    (-0.1220, -0.0190, 0.0160, -0.0250, 0.0310, 2.8),
    (-0.1120, -0.0285, 0.0245, -0.0272, 0.0338, 2.7),
    (-0.1000, -0.0345, 0.0285, -0.0290, 0.0362, 2.6),
    (-0.0850, -0.0384, 0.0292, -0.0328, 0.0415, 2.5),
    (-0.0700, -0.0394, 0.0305, -0.0365, 0.0465, 2.5),
    (-0.0500, -0.0352, 0.0370, -0.0400, 0.0512, 2.5),
    (-0.0350, -0.0270, 0.0440, -0.0412, 0.0520, 2.6),
    (-0.0180, -0.0185, 0.0490, -0.0410, 0.0515, 2.7),
    (-0.0060, -0.0130, 0.0500, -0.0400, 0.0505, 2.8),
    (0.0040, -0.0100, 0.0470, -0.0380, 0.0480, 2.9),
)
BRIDGE = (
    (-0.0570, -0.0150, 0.0060, 0.0040, 0.0160, 2.8),
    (-0.0400, -0.0300, 0.0050, 0.0060, 0.0280, 2.8),
    (-0.0050, -0.0380, 0.0040, 0.0040, 0.0400, 2.6),
    (0.0160, -0.0330, 0.0000, 0.0080, 0.0360, 2.6),
    (0.0239, -0.0240, -0.0060, 0.0120, 0.0280, 2.6),
)


def parts() -> list[Part]:
    """The parts of links `LPelvis`, `LHip`, `LThigh`, `LTibia` and `LAnklePitch`."""
    thigh, shin = _thigh(), _shin()
    return [
        Part("LPelvis", "joint", skin(_pelvis(), 280)),
        Part("LHip", "joint", _hip()),
        Part("LThigh", "shell", skin(thigh, 480, cell=0.0020)),
        Part("LThigh", "panel", _thigh_plate(thigh)),
        Part("LThigh", "joint", _knee()),
        Part("LTibia", "shell", skin(shin, 560, cell=0.0019) + _cheeks()),
        Part("LTibia", "panel", _shin_plate(shin)),
        Part("LAnklePitch", "joint", _ankle()),
    ]


def _pelvis() -> Solid:
    """The motor along the slanted hip axis and the arm behind it that holds the hip's roll axis."""
    motor = cylinder((-0.004, 0.006, -0.006), (-0.004, -0.0272, 0.0308), 0.0165, edge=0.005)
    arm = box((-0.0589, -0.0140, -0.0142), (-0.0435, 0.0140, 0.0160), 0.005)
    bridge = loft(0, BRIDGE, edge=0.004)
    return motor.join(arm, k=0.004).join(bridge, k=0.008)


def _hip() -> Mesh:
    """The roll axis with its round nose, the ball of the pitch axis, and the motor inside the thigh."""
    roll = [(0, 0.0242), (0.0065, 0.0232), (0.0112, 0.0198), (0.0135, 0.0140), (0.0136, -0.0300), (0, -0.0427)]
    ball = [(0, 0.0146), (0.0110, 0.0135), (0.0169, 0.0070), (0.0169, -0.0070), (0.0110, -0.0127), (0, -0.0136)]
    motor = [(0.0110, -0.0080), (0.0030, -0.0315), (0, -0.0325)]
    return (
        turned(roll, (0, 0, 0), (1, 0, 0), 16, soft=True)
        + turned(ball, (0, 0, 0), (0, 1, 0), 16, soft=True)
        + turned(motor, (-0.012, 0, 0), (0, 0, 1), 8, soft=True)
    )


def _thigh() -> Solid:
    """The white shell; the cheeks of the shin stand out of it at the knee."""
    return loft(2, THIGH, edge=0.007)


def _knee() -> Mesh:
    """The grey drum of the knee, part of the thigh."""
    return turned([(0.0238, 0.0332), (0.0238, -0.0250)], (0, 0, -0.1), (0, 1, 0), 28)


def _shin() -> Solid:
    """The white shell; its lower end turns inside the shoe."""
    return loft(2, SHIN, edge=0.006)


def _cheeks() -> Mesh:
    """The two round cheeks of the shin that hold the knee's drum."""
    profile = [(0, 0.0505), (0.0150, 0.0502), (0.0196, 0.0490), (0.0216, 0.0462), (0.0218, 0.0320), (0.0120, 0.0320)]
    outer = turned(profile, (0, 0, 0), (0, 1, 0), 24, soft=True)
    return outer + turned([(r, y - 0.0093) for r, y in profile], (0, 0, 0), (0, -1, 0), 24, soft=True)


def _thigh_plate(thigh: Solid) -> Mesh:
    """The coloured plate on the front of the thigh."""
    outline = smooth_outline(
        [
            (0.018, 0.004),
            (0.033, -0.002),
            (0.0385, -0.025),
            (0.0365, -0.055),
            (0.0285, -0.082),
            (0.004, -0.0875),
            (-0.0215, -0.082),
            (-0.0280, -0.060),
            (-0.0200, -0.036),
            (-0.0040, -0.014),
        ]
    )
    return panel(thigh, FRONT, outline, lift=1.1e-3, grain=0.0105)


def _shin_plate(shin: Solid) -> Mesh:
    """The coloured plate on the front of the shin."""
    outline = smooth_outline(
        [
            (0.005, -0.008),
            (0.026, -0.010),
            (0.0330, -0.024),
            (0.0295, -0.045),
            (0.0205, -0.063),
            (0.004, -0.0690),
            (-0.0125, -0.063),
            (-0.0195, -0.045),
            (-0.0230, -0.024),
            (-0.0160, -0.010),
        ]
    )
    return panel(shin, FRONT, outline, lift=1.1e-3, grain=0.0105)


def _ankle() -> Mesh:
    """The cross of the ankle's pitch and roll axes, inside shin and shoe."""
    roll = [(0, 0.0395), (0.0025, 0.0385), (0.0138, 0.0120), (0.0138, -0.0120), (0.0020, -0.0375), (0, -0.0399)]
    upright = [(0, 0.0420), (0.0012, 0.0412), (0.0130, 0.0080), (0.0130, -0.0080), (0.0100, -0.0150), (0, -0.0160)]
    return turned(roll, (0, 0, 0), (1, 0, 0), 12, soft=True) + turned(upright, (0, 0, 0), (-0.05, 0, 1), 8, soft=True)
