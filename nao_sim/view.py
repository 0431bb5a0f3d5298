"""Looking at a recording by hand: in a window, in a browser, or as a page to keep."""

from __future__ import annotations

import sys
from inspect import cleandoc
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nao_sim import options
from nao_sim.console import ProgressBar, print_summary
from nao_sim.errors import UsageError
from nao_sim.verdict import UNSAFE_STATUS, Verdict
from nao_sim.viewing.keys import told
from nao_sim.viewing.playback import Layer, Playback

if TYPE_CHECKING:
    from nao_sim.performed import Performed
    from nao_sim.replay import Orders

HOST, PORT = "127.0.0.1", 8080


def view(  # noqa: PLR0913  # a command line's options are its function's arguments
    recording: Annotated[
        Path, typer.Argument(help="A person's skeleton or a NAO's joint angles, of any format in README.md.")
    ],
    *,
    web: Annotated[bool, typer.Option("--web", help="Show it in a browser instead; Ctrl-C ends.")] = False,
    host: Annotated[
        str | None, typer.Option(help="Address that --web listens at.", show_default="127.0.0.1: this machine alone")
    ] = None,
    port: Annotated[
        int | None, typer.Option(help="Port that --web listens at; 0 takes a free one.", show_default=str(PORT))
    ] = None,
    export: Annotated[
        Path | None, typer.Option(metavar="PAGE.html", help="Write a page to keep, mail or publish instead.")
    ] = None,
    look: options.Look = "studio",
    theme: options.Theme = "orange",
    show_person: options.ShowPerson = True,
    show_safety: options.ShowSafety = False,
    match: options.Match = options.MatchOption.directions,
    body: options.Body = options.BodyOption.arms,
    raw: options.Raw = False,
    unit: options.Unit = None,
    rate: options.Rate = None,
    layout: options.Layout = None,
    person: options.Person = None,
    rig: options.Rig = None,
    base: options.Base = "free",
    robot: options.Version = "v5",
    speed: options.Speed = 1.0,
    max_speed: options.MaxSpeed = None,
    without: options.Without = None,
    accept_risk: options.AcceptRisk = False,
    quiet: options.Quiet = False,
) -> int:
    """Look at a recording by hand: pause, go back and forth, slow it down, turn round.

    Opens MuJoCo's viewer, which needs a display.  Without one, --web shows the
    same and more in a browser, and --export writes it as one HTML file that
    needs neither a server nor a network.

    Exit status: 0 done, 2 bad input or usage, 3 no window can be opened here;
    with --export 4 where the simulated robot fell or broke a rule.
    """
    options.check_speed(speed)
    _check_ways(web, export, {"--host": host, "--port": port})
    from nao_sim.recordings import Source
    from nao_sim.rendering.presets import load_look, load_theme
    from nao_sim.replay import Orders

    load_look(look)
    load_theme(theme)
    orders = Orders(
        recording=Source(recording, unit, rate, layout, person, rig),
        robot=robot,
        base=base,
        speed=speed,
        match=match.value,
        body=body.value,
        raw=raw,
        rules=options.rules(max_speed, without, accept_risk),
    )
    shown = [layer for layer, wanted in ((Layer.person, show_person), (Layer.safety, show_safety)) if wanted]
    if export:
        return _export(orders, export, look, theme, shown, quiet)
    if web:
        return _serve(orders, HOST if host is None else host, PORT if port is None else port, look, theme, shown, quiet)
    return _open(orders, look, theme, shown, quiet)


# docs and help have the keys from the table that the window obeys
view.__doc__ = f"""{cleandoc(view.__doc__ or "")}

\b
Keys of the window:
{told()}
0 to 5, the letters and the mouse are MuJoCo's own; F1 lists them.
"""


def _open(orders: Orders, look: str, theme: str, shown: list[Layer], quiet: bool) -> int:
    from nao_sim.viewing.window import check_display, open_window

    check_display()
    performed = _perform(orders, quiet)
    from nao_sim.viewing.stage import stage_of

    stage = stage_of(performed, look, theme)
    if not quiet:
        print_summary(performed.report, {})
        print(told(), flush=True)
    open_window(stage, Playback(stage.duration, shown))
    return 0


def _serve(orders: Orders, host: str, port: int, look: str, theme: str, shown: list[Layer], quiet: bool) -> int:
    from nao_sim.viewing.server import PageServer

    with PageServer(host, port) as server:  # first, for a port that is taken is known at once
        performed = _perform(orders, quiet)
        from nao_sim.viewing.page import page

        server.page = page(performed, look, theme, shown)
        if not quiet:
            print_summary(performed.report, {})
        print(f"open {server.url} in a browser; Ctrl-C ends", flush=True)
        server.serve_until_interrupted()
    return 0


def _export(orders: Orders, path: Path, look: str, theme: str, shown: list[Layer], quiet: bool) -> int:
    from nao_sim.files import beside, check_results, make_folder

    check_results([path], orders.recording.path)
    make_folder(path.parent)
    performed = _perform(orders, quiet)
    from nao_sim.viewing.page import page

    with beside(path) as draft:
        draft.write_bytes(page(performed, look, theme, shown))
    if not quiet:
        print_summary(performed.report, {"page": path})
    return UNSAFE_STATUS if performed.report["verdict"] == Verdict.unsafe else 0


def _perform(orders: Orders, quiet: bool) -> Performed:
    from nao_sim.performed import perform_recording

    with ProgressBar(quiet) as progress:
        return perform_recording(orders, progress)


def _check_ways(web: bool, export: Path | None, for_web: dict[str, object]) -> None:
    """Refuse options that do not go together.

    Raises:
        UsageError: some do not.
    """
    if web and export:
        raise UsageError("--web and --export contradict each other; give one of them")
    if export and export.suffix.lower() not in (".html", ".htm"):
        raise UsageError(f"--export {export}: expected a name that ends in .html")
    if not web and (given := [option for option, value in for_web.items() if value is not None]):
        raise UsageError(f"{given[0]}: says where a browser finds the page; expected --web with it")
    port = for_web["--port"]
    if isinstance(port, int) and not 0 <= port < 1 << 16:
        raise UsageError(f"--port {port}: expected 0 to 65535")


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["view", *sys.argv[1:]]))
