"""The colours of all plots, by what they stand for.

Most are M. Okabe and K. Ito's, Color Universal Design (2008), and greys.  Those that are to be told apart in one
picture can be told apart by people with deuteranopia and protanopia, too; a test computes it.
"""

from __future__ import annotations

BLUE, SKY, GREEN, YELLOW = "#0072B2", "#56B4E9", "#009E73", "#F0E442"
ORANGE, VERMILION, PURPLE, BLACK = "#E69F00", "#D55E00", "#CC79A7", "#000000"
DARK_GREY, GREY, PALE_GREY, SHADE = "#4D4D4D", "#7F7F7F", "#BFBFBF", "#F2F2F2"

LEFT, RIGHT, MIDDLE, WARNING = BLUE, VERMILION, DARK_GREY, PURPLE
SIDE_COLOURS = {"left": LEFT, "right": RIGHT, "": MIDDLE}
SIDE_WIDTHS = {"left": 2.4, "right": 1.0, "": 1.2}  # of lines over time: the left one shows under the right one

NEAREST = "nearest"
STAGES = {"requested": GREY, "commanded": BLACK, "simulated": BLUE, NEAREST: ORANGE}
STAGE_LINES = {"requested": "--", "commanded": "-", "simulated": "-", NEAREST: ":"}
STAGE_WIDTHS = {"requested": 1.1, "commanded": 1.0, "simulated": 2.2, NEAREST: 1.8}  # commands lie on what was done

REASON_COLOURS = {
    "limit": PURPLE, "margin": YELLOW, "one_motor": PALE_GREY, "coupling": SKY, "speed": ORANGE,
    "self_collision": VERMILION, "detour": GREEN, "balance": BLUE, "ramp": DARK_GREY, "stale": BLACK,
}  # fmt: skip
OTHER_REASON = GREY  # one that has no words
LEVEL = "#CC0000"  # what must not be passed, and what went wrong
CONFIDENCE, MISSING = ("#8C4A00", ORANGE, "#DCEAF4"), "#262626"  # from 0 to 1, ever lighter; darkest
SHARES = "Blues"  # a scale of lightness
SCALE = "viridis"  # of many lines in an order
