"""The foot: a big rounded shoe over a grey sole, hollow around the ankle."""

from __future__ import annotations

from .inlays import Plane, panel
from .lathe import stacked
from .meshes import Mesh, skin
from .parts import Part
from .solids import Solid, below, cylinder, prism, smooth_outline

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
# the height z of the shoe's back over x
INSTEP = (
    (-0.060, -0.028),
    (-0.050, -0.013),
    (-0.034, 0.006),
    (-0.016, 0.0195),
    (0.000, 0.0225),
    (0.014, 0.0195),
    (0.030, 0.0105),
    (0.044, 0.0025),
    (0.060, -0.0080),
    (0.080, -0.0185),
    (0.097, -0.0285),
    (0.104, -0.0330),
)


def parts() -> list[Part]:
    """The parts of link `l_ankle`."""
    shoe = _shoe()
    return [
        Part("l_ankle", "shell", skin(shoe, 1150, cell=0.0019)),
        Part("l_ankle", "panel", _instep(shoe)),
        Part("l_ankle", "joint", _sole()),
    ]


def _shoe() -> Solid:
    """The white shell."""
    body = prism(FOOTPRINT * 0.985, -0.0432, 0.05, edge=0.004).meet(below(INSTEP), k=0.014)
    well = cylinder((0, -0.0298, 0.007), (0, 0.0380, 0.007), 0.0420, edge=0.010)
    return body.cut(well, k=0.006)


def _sole() -> Mesh:
    """The grey rubber under it."""
    return stacked(
        FOOTPRINT[::3], [(0.0035, -0.0449), (0.0010, -0.0437), (0.0, -0.0420), (0.0, -0.0385), (0.0040, -0.0375)]
    )


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
    return panel(shoe, ABOVE, outline, lift=7e-4)
