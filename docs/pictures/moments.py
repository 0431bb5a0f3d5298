"""Moments of a film side by side, for the README.

    ./run play trajectories/stress.csv --show-safety --quality fine --size 484x364 --fps 10 --video render/stress.png
    .venv/bin/python docs/pictures/moments.py render/stress 12 13 -o docs/pictures/safety.png

The film is a folder of frames (`--video NAME.png`); the moments are seconds from its start.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from PIL import Image

COLOURS = 255  # few colours make a small file


def main() -> None:
    """Read the command line and write the picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("film", type=Path, help="folder of frames")
    parser.add_argument("moments", type=float, nargs="+", help="s from the film's start")
    parser.add_argument("--fps", type=float, default=10.0, help="frames a second of the film")
    parser.add_argument("-o", "--output", type=Path, required=True)
    order = parser.parse_args()
    frames = [Image.open(order.film / f"frame_{round(moment * order.fps) + 1:05d}.png") for moment in order.moments]
    side_by_side(frames).quantize(COLOURS, dither=Image.Dither.NONE).save(order.output, optimize=True)


def side_by_side(frames: list[Image.Image]) -> Image.Image:
    """One picture of several of one size."""
    width, height = frames[0].size
    row = Image.new("RGB", (width * len(frames), height))
    for i, frame in enumerate(frames):
        row.paste(frame, (i * width, 0))
    return row


if __name__ == "__main__":
    main()
