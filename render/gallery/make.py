"""The gallery: runs the commands of shots.py, makes their pictures small, and writes README.md beside them.

    .venv/bin/python render/gallery/make.py                  # all of it, about two minutes
    .venv/bin/python render/gallery/make.py safety.png       # some of it

Pictures come from the sample recordings alone.  On one machine the same pictures come out again, byte for byte; another
OpenGL draws edges a little differently.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from PIL import Image

from nao_sim.cli import main as nao_sim
from nao_sim.paths import TRAJECTORIES
from nao_sim.rendering.sheet import sheet

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from shots import FPS, SHOTS, Shot  # noqa: E402  # beside this file

COLOURS = 255  # few colours make a small plot
PICTURE = {"quality": 90, "method": 6}  # of WebP
FILM = {"quality": 70, "method": 6}
TITLE = """# Gallery

Pictures of what nao_sim draws. Each is made by the commands below it (here with `./run`; installed, the command is
`nao-sim`) from the [samples](../../trajectories/README.md); `render/gallery/make.py` runs them all and writes
this page.
"""
DONE, MADE_SAFE = 0, 1  # exit statuses


def main() -> None:
    """Read the command line, make the pictures and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", choices=[[], *(shot.name for shot in SHOTS)], metavar="NAME")
    wanted = parser.parse_args().names
    for shot in SHOTS:
        if shot.name in wanted or not wanted:
            make(shot)
            print(f"{shot.name}  {(HERE / shot.name).stat().st_size / 1000:.0f} kB")
    (HERE / "README.md").write_text(page(), encoding="utf-8")


def make(shot: Shot) -> None:
    """Run the commands of a picture and put its parts together."""
    with elsewhere():
        for command in shot.commands:
            with contextlib.redirect_stdout(io.StringIO()):
                status = nao_sim(command.split())
            if status not in (DONE, MADE_SAFE):
                raise SystemExit(f"{shot.name}: nao-sim {command} ended with {status}")
        pictures = [Image.open(path).convert("RGB") for path in parts(shot)]
    path = HERE / shot.name
    if shot.loop:
        pictures[0].save(path, save_all=True, append_images=pictures[1:], duration=1000 // FPS, loop=0, **FILM)
        return
    together = joined([narrowed(picture, shot.width) for picture in pictures], shot.words, shot.columns)
    if path.suffix == ".png":
        together.quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)
    else:
        together.save(path, **PICTURE)


def parts(shot: Shot) -> list[Path]:
    """The files of a picture's parts: what is named, or the frames of a film at its moments or between them."""
    moments = list(shot.moments)
    if shot.loop:
        moments = (np.arange(round(shot.loop[0] * FPS), round(shot.loop[1] * FPS) + 1) / FPS).tolist()
    if not moments:
        return [Path(part) for part in shot.parts]
    numbers = [round(moment * FPS) + 1 for moment in moments]
    return [Path(shot.parts[0], f"frame_{number:05d}.png") for number in numbers]


def narrowed(picture: Image.Image, width: int | None) -> Image.Image:
    """The picture, at most that many pixels wide."""
    if width is None or picture.width <= width:
        return picture
    return picture.resize((width, round(picture.height * width / picture.width)), Image.Resampling.LANCZOS)


def joined(pictures: Sequence[Image.Image], words: Sequence[str], columns: int | None) -> Image.Image:
    """One picture of several of one size."""
    told = words or [""] * len(pictures)
    return Image.fromarray(sheet([np.asarray(picture) for picture in pictures], told, columns or len(pictures)))


def page() -> str:
    """The gallery as Markdown."""
    return "\n".join([TITLE, *map(paragraph, SHOTS)])


def paragraph(shot: Shot) -> str:
    """A picture, what it shows and how it is made."""
    commands = "\n".join(f"./run {command}" for command in shot.commands)
    return f"## {shot.title}\n\n{shot.caption}\n\n![{shot.caption}]({shot.name})\n\n```sh\n{commands}\n```\n"


@contextlib.contextmanager
def elsewhere() -> Iterator[None]:
    """A folder of its own to work in, with the samples in it."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        Path("trajectories").symlink_to(TRAJECTORIES)
        try:
            yield
        finally:
            os.chdir(before)


if __name__ == "__main__":
    main()
