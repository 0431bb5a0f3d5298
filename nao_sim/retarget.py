"""A person's recording as a NAO's joint angles."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from nao_sim import options
from nao_sim.console import ProgressBar
from nao_sim.errors import UsageError
from nao_sim.files import check_results


def retarget(
    recording: Annotated[Path, typer.Argument(help="A person's skeleton, of any format in README.md.")],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="File to write: .csv, .motion (Webots), .npz or .py (Choregraphe).")
    ],
    match: options.Match = options.MatchOption.directions,
    body: options.Body = options.BodyOption.arms,
    raw: options.Raw = False,
    rate: options.Rate = None,
    layout: options.Layout = None,
    person: options.Person = None,
    rig: options.Rig = None,
    robot: options.Version = "v5",
    plot: options.Plot = None,
    plot_size: options.PlotSize = None,
    quiet: options.Quiet = False,
) -> None:
    """Write a person's recording as a NAO's joint angles, inside its limits; nothing is simulated.

    Speeds, balance and collisions are up to whoever plays the angles: play does
    that, and makes them safe.
    """
    from nao_sim.imitation.retarget import retarget as retarget_skeleton
    from nao_sim.motion import Skeleton
    from nao_sim.recordings import Source, read
    from nao_sim.recordings.angles.writing import check_extension, write_motion
    from nao_sim.robot import START_POSTURE, load_robot

    check_extension(output)
    options.check_picture(plot)
    check_results([output, plot], recording)
    source = read(Source(recording, rate=rate, layout=layout, person=person, rig=rig))
    if not isinstance(source.motion, Skeleton):
        raise UsageError(f"{recording}: holds joint angles ({source.format}) already; use nao-sim convert")
    model = load_robot(robot)
    with ProgressBar(quiet) as progress:
        retargeted = retarget_skeleton(
            source.motion,
            model,
            match=match.value,
            body=body.value,
            start=model.postures[START_POSTURE],
            raw=raw,
            progress=lambda done, total: progress("retargeting", done, total),
        )
    write_motion(output, retargeted.motion)
    if plot:
        from nao_sim.plotting.picture import save_angles

        title = f"{output.name}: joint angles after {recording.name}"
        save_angles(retargeted.motion, plot, title, model, plot_size and plot_size.value)
    if quiet:
        return
    for note in (*source.notes, *retargeted.notes):
        typer.echo(f"note: {note}")
    joints = [name for name, given in zip(model.joint_names, retargeted.motion.given, strict=True) if given]
    typer.echo(f"read     {recording}: {source.format} ({source.reason}), {source.frames} frames")
    typer.echo(f"written  {output}: {len(retargeted.motion)} frames of {', '.join(joints)}")
    if plot:
        typer.echo(f"written  {plot}")


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["retarget", *sys.argv[1:]]))
