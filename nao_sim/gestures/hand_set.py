"""The thesis's Decision Based Rule as its description has it: 16 thresholds, set by hand for one person.

The thesis names its thresholds T1 to T16; their values are not among the
figures that this project has.  These are set by hand, from the body's own
proportions, for an adult of `HEIGHT`: an elbow that points along an axis is one
upper arm away from the shoulder, and on the other axes half of that or less.
"""

from __future__ import annotations

from nao_sim.body import bones
from nao_sim.gestures.arm_places import ELBOWS
from nao_sim.gestures.thresholds import AT_LEAST, AT_MOST, Threshold

HEIGHT = 1.70  # m
UPPER_ARM = HEIGHT * next(bone.length for bone in bones() if bone.end == "left_elbow")  # m
FAR, NEAR = 0.7 * UPPER_ARM, 0.6 * UPPER_ARM  # m: points that way; is not away that way

# In the thesis's order.  It has no rule for piUp, whose elbows are where those of side are.
_RULES = (
    ("up", "up", AT_LEAST, FAR), ("up", "outward", AT_MOST, NEAR),
    ("side", "outward", AT_LEAST, FAR), ("side", "up", AT_LEAST, -NEAR),
    ("forward", "forward", AT_LEAST, FAR), ("forward", "outward", AT_MOST, NEAR),
    ("down", "up", AT_MOST, -FAR), ("down", "forward", AT_MOST, NEAR),
)  # fmt: skip
HAND_SET = tuple(
    Threshold(label, column, relation, value)
    for label, axis, relation, value in _RULES
    for column, name in enumerate(ELBOWS)
    if name.endswith(axis)
)
"""16 rows for columns as `nao_sim.gestures.arm_places.elbow_offsets` has them, metres."""
