"""Live imitation: parse, call, print."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from nao_sim import options
from nao_sim.errors import UsageError

if TYPE_CHECKING:
    from nao_sim.live.protocol import Hello
    from nao_sim.motion import JointTrajectory, Skeleton

Port = Annotated[
    int, typer.Option(min=0, max=65535, help="Port for browsers and WebSocket programs; 0 for any free one.")
]


def live(
    host: Annotated[
        str, typer.Option(help="Address to listen at; any but this machine's own asks clients for a token.")
    ] = "127.0.0.1",
    port: Port = 8765,
    token: Annotated[
        str | None,
        typer.Option(
            envvar="NAO_SIM_TOKEN",
            help="What clients must know, 12 characters or more.",
            show_default="none; one of chance, printed, for other addresses",
        ),
    ] = None,
    allow_origin: Annotated[
        list[str] | None,
        typer.Option(metavar="ORIGIN", help="Let in pages of another site, such as https://lab.org; repeatable."),
    ] = None,
    layout: Annotated[
        str,
        typer.Option(metavar="NAME", help="What the points of the sources below are; nao-sim formats lists layouts."),
    ] = "mediapipe_pose",
    mode: Annotated[
        Literal["one-to-one", "gestures"],
        typer.Option(help="Imitate every frame, or play the gestures recognised in them."),
    ] = "one-to-one",
    mirror: Annotated[bool, typer.Option("--mirror", help="Move as the person's mirror image.")] = False,
    replay: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Play a recording, of any format, as if somebody moved now.")
    ] = None,
    loop: Annotated[bool, typer.Option("--loop", help="Begin the recording again at its end.")] = False,
    stdin: Annotated[
        bool, typer.Option("--stdin", help="Take frames from standard input, a JSON text a line.")
    ] = False,
    udp: Annotated[
        int | None, typer.Option(min=0, max=65535, help="Take frames by UDP at this port, a JSON text a datagram.")
    ] = None,
    tcp: Annotated[
        int | None,
        typer.Option(min=0, max=65535, help="Speak the protocol by TCP at this port, a JSON text a line."),
    ] = None,
    commands: Annotated[
        int | None,
        typer.Option(min=0, max=65535, help="Send the robot's 26 joint commands by TCP at this port, a line each."),
    ] = None,
    record: Annotated[
        Path | None,
        typer.Option(metavar="CSV", help="Write what is received, at once; nao-sim play reads it. Never overwrites."),
    ] = None,
    vocabulary: Annotated[
        Path | None,
        typer.Option(
            metavar="VOCAB", help="Gestures to recognise, of nao-sim teach or train.", show_default="the built-in poses"
        ),
    ] = None,
    robot: options.Version = "v5",
    max_speed: options.MaxSpeed = None,
    workers: Annotated[
        int | None,
        typer.Option(
            min=0, max=64, help="Processes for robots; 0 keeps them in the server's own.", show_default="a core fewer"
        ),
    ] = None,
    max_robots: Annotated[
        int | None, typer.Option(min=1, help="Robots at once.", show_default="four for each process")
    ] = None,
    max_clients: Annotated[int, typer.Option(min=1, help="Connections at once.")] = 64,
    quiet: options.Quiet = False,
) -> int:
    """Let the robot do, now, what somebody does in front of a camera or a sensor.

    Frames come from browsers (WebSocket), programs (TCP, UDP, standard input)
    or a recording; every command passes the guard at 50 Hz.  docs/live.md has
    the protocol.  Ends with Ctrl-C.

    Exit status: 0 ended, 2 bad usage, or a port is taken.
    """
    _check(record, replay, loop)
    from nao_sim.live.hub import Limits
    from nao_sim.live.protocol import Hello
    from nao_sim.live.run import Settings, run
    from nao_sim.live.worker import Orders
    from nao_sim.processors import processors

    count = max(1, processors() - 1) if workers is None else workers
    settings = Settings(
        host=host,
        port=port,
        token=token,
        origins=tuple(allow_origin or ()),
        hello=_hello(Hello(layout=layout, mode=mode, mirror=mirror)),
        replay=_motion(replay) if replay else None,
        loop=loop,
        stdin=stdin,
        udp=udp,
        tcp=tcp,
        commands=commands,
        record=record,
        workers=count,
        limits=Limits(max_clients, max_robots or 4 * max(1, count)),
        orders=Orders(robot, _vocabulary(vocabulary), options.rules(max_speed, None, False)),
    )
    run(settings, (lambda line: None) if quiet else print)
    return 0


def _check(record: Path | None, replay: Path | None, loop: bool) -> None:
    """Refuse what cannot work, before anything starts.

    Raises:
        UsageError: options contradict each other.
    """
    if loop and replay is None:
        raise UsageError("--loop: there is nothing to begin again; expected --replay FILE with it")
    if record and (record.is_dir() or not record.parent.is_dir()):
        raise UsageError(f"--record {record}: expected the name of a file in a folder that is there")
    if record and record.suffix.lower() != ".csv":
        raise UsageError(f"--record {record}: expected a name that ends in .csv")


def _hello(hello: Hello) -> Hello:
    from dataclasses import replace

    from nao_sim.live.person import layout_called
    from nao_sim.live.problem import LiveError

    try:
        return replace(hello, layout=layout_called(hello.layout)[0])
    except LiveError as problem:
        raise UsageError(f"--{problem}") from None


def _motion(file: Path) -> Skeleton | JointTrajectory:
    from nao_sim.recordings import load

    return load(file).motion


def _vocabulary(file: Path | None) -> Path | None:
    """The file, if gestures can be read from it."""
    from nao_sim.gestures.storage import vocabulary_of

    vocabulary_of(file)
    return file


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["live", *sys.argv[1:]]))
