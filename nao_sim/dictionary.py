"""A page of all gestures that the robot knows, to be printed."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer

from nao_sim import options
from nao_sim.errors import UsageError
from nao_sim.files import check_results, make_folder
from nao_sim.robot import START_POSTURE, Array, Robot

if TYPE_CHECKING:
    from nao_sim.gestures.vocabulary import Vocabulary
    from nao_sim.motion import JointTrajectory


def dictionary(  # noqa: PLR0913  # a command line's options are its function's arguments
    *,
    vocabulary: Annotated[
        Path | None,
        typer.Option(metavar="VOCAB", help="Of nao-sim teach or train.", show_default="what comes with nao_sim"),
    ] = None,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="PICTURE", help=".png, .jpg or .pdf.")] = Path(
        "render/dictionary.pdf"
    ),
    columns: Annotated[int | None, typer.Option(min=1, help="Side by side.", show_default="as many as rows")] = None,
    size: Annotated[str, typer.Option(metavar="WIDTHxHEIGHT", help="Pixels of a picture.")] = "360x400",
    camera: options.Camera = "front",
    quality: options.Quality = "fine",
    look: options.Look = "studio",
    theme: options.Theme = "orange",
    robot: options.Version = "v5",
    quiet: options.Quiet = False,
) -> None:
    """Draw every gesture for which the robot has a motion on one page, at the pose that is farthest from rest."""
    from nao_sim.filming import Film, dressed
    from nao_sim.gestures.storage import vocabulary_of
    from nao_sim.moments import Moments
    from nao_sim.rendering import render_stills
    from nao_sim.rendering.sheet import save_sheet, sheet
    from nao_sim.robot import load_robot
    from nao_sim.simulation.scene import compiled
    from nao_sim.simulation.simulator import Simulator

    film = Film(output, 30.0, options.parse_size(size), camera, quality, look=look, theme=theme, moments=Moments())
    film.check()
    check_results([output], *([vocabulary] if vocabulary else []))
    known = vocabulary_of(vocabulary)
    make_folder(output.parent)
    simulator = Simulator(load_robot(robot))
    poses = key_poses(known, simulator.robot)
    qpos = simulator.map.to_qpos(np.stack(list(poses.values())), simulator.base_pose())
    pictures = render_stills(compiled(dressed(film, simulator)), qpos, film.size, camera, quality)
    save_sheet(sheet(pictures, list(poses), columns), output)
    if not quiet:
        print(f"picture  {output} ({len(pictures)} gestures)")


def key_poses(vocabulary: Vocabulary, robot: Robot) -> dict[str, Array]:
    """Of each gesture with a motion the pose (26,) farthest from rest, by name: what is recognised first.

    Raises:
        UsageError: there is none.
    """
    names = dict.fromkeys((*vocabulary.names, *vocabulary.motions))
    motions = {name: motion for name in names if (motion := vocabulary.motion_of(name))}
    if not motions:
        raise UsageError("no gesture has a motion of the robot; expected a vocabulary of nao-sim teach or train")
    return {name: _farthest(motion, robot.postures[START_POSTURE]) for name, motion in motions.items()}


def _farthest(motion: JointTrajectory, rest: Array) -> Array:
    poses = np.where(np.isfinite(motion.positions), motion.positions, rest)
    farthest: Array = poses[np.linalg.norm(poses - rest, axis=1).argmax()]
    return farthest


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["dictionary", *sys.argv[1:]]))
