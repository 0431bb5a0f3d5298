"""The way of the data, drawn: `python render/gallery/diagram.py` writes how_it_works.svg."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

HERE = Path(__file__).resolve().parent
INK, ROOM, FILE = "#2b2f38", "#fbe3d8", "#dcebf5"
WIDTH, HEIGHT = 1.76, 0.86  # of a box
# what it says, what is below, where its middle is, its colour
BOXES = {
    "recording": ("a recording", "Kinect, mocap, film\nlandmarks, joint angles", 0.0, 1.0, FILE),
    "recordings": ("recordings", "reads; says why\nit took it for what", 2.5, 1.0, ROOM),
    "imitation": ("imitation", "filters; arms, head, legs\nto 26 joint angles", 5.0, 1.75, ROOM),
    "gestures": ("gestures", "recognises; plays\nits own motions", 5.0, 0.25, ROOM),
    "safety": ("safety", "the guard, 50 Hz: every\ncommand can still stop", 7.5, 1.0, ROOM),
    "simulation": ("simulation", "MuJoCo: motors, floor,\nbalance", 10.3, 1.0, ROOM),
    "rendering": ("rendering", "cameras, captions,\ncolours of the guard", 12.8, 1.75, ROOM),
    "report": ("report, plots", "asked, changed and\nwhy; how alike", 12.8, 0.25, FILE),
    "film": ("a film", ".mp4, .webm, .gif, .png", 15.3, 1.75, FILE),
}
ARROWS = (  # from, to, what goes along
    ("recording", "recordings", ""),
    ("recordings", "imitation", "skeleton"),
    ("recordings", "gestures", ""),
    ("imitation", "safety", "requests"),
    ("gestures", "safety", ""),
    ("safety", "simulation", "commands"),
    ("simulation", "rendering", "rollout"),
    ("simulation", "report", ""),
    ("rendering", "film", ""),
)


def main() -> None:
    """Draw boxes and arrows and write the file."""
    with mpl.rc_context({"svg.hashsalt": "nao_sim", "svg.fonttype": "path", "font.size": 8, "text.color": INK}):
        figure = Figure(figsize=(13.0, 2.2), facecolor="white")
        axes = figure.add_axes((0, 0, 1, 1))
        axes.set(xlim=(-1.0, 16.3), ylim=(-0.3, 2.3))
        axes.axis("off")
        for start, end, word in ARROWS:
            arrow(axes, start, end, word)
        for key in BOXES:
            box(axes, key)
        figure.savefig(HERE / "how_it_works.svg", metadata={"Date": None, "Creator": None})


def box(axes: Axes, key: str) -> None:
    """A box with its name and what it does."""
    name, does, x, y, colour = BOXES[key]
    corner = (x - WIDTH / 2, y - HEIGHT / 2)
    style = "round,pad=0.02,rounding_size=0.1"
    axes.add_patch(FancyBboxPatch(corner, WIDTH, HEIGHT, style, fc=colour, ec=INK, lw=0.8))
    axes.text(x, y + 0.2, name, ha="center", va="center", weight="bold", size=10)
    axes.text(x, y - 0.14, does, ha="center", va="center", size=7.6, linespacing=1.25)


def arrow(axes: Axes, start: str, end: str, word: str) -> None:
    """An arrow from the right of one box to the left of another, and what goes along it."""
    (_, _, x, y, _), (_, _, to_x, to_y, _) = BOXES[start], BOXES[end]
    left, right = (x + WIDTH / 2 + 0.03, y), (to_x - WIDTH / 2 - 0.03, to_y)
    axes.add_patch(FancyArrowPatch(left, right, arrowstyle="-|>", mutation_scale=11, lw=1.1, color=INK))
    middle = (left[0] + right[0]) / 2, (y + to_y) / 2 + (0.16 if y == to_y else 0.0)
    if word:
        box = {"fc": "white", "ec": "none", "pad": 0.8}
        axes.text(*middle, word, ha="center", va="center", size=7.6, style="italic", bbox=box)


if __name__ == "__main__":
    main()
