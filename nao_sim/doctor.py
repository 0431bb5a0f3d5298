"""What works on this machine, and what to install."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nao_sim.errors import RenderingError

if TYPE_CHECKING:
    from rich.text import Text

    from nao_sim.checkup import Checkup, Package

UNFIT_STATUS = 1


def doctor(
    *,
    picture: Annotated[Path, typer.Option("--output", "-o", metavar="PNG", help="Where the test picture goes.")] = Path(
        "render/doctor.png"
    ),
    json: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Also write everything as JSON, for a bug report.")
    ] = None,
) -> int:
    """Say what works on this machine: versions, every way to render without a screen, a test picture; what to install.

    Exit status: 0 all is well, 1 a package is missing or of a version that does not do, 3 nothing can render here.
    """
    from nao_sim.checkup import checkup
    from nao_sim.errors import UsageError
    from nao_sim.files import check_results, make_folder

    if picture.suffix.lower() != ".png":
        raise UsageError(f"--output {picture}: expected a name that ends in .png")
    outputs = [path for path in (picture, json) if path]
    check_results(outputs)
    for path in outputs:
        make_folder(path.parent)
    found = checkup(picture)
    _print(found)
    if json:
        from nao_sim.report import save_report

        save_report(found.to_json(), json)
    return UNFIT_STATUS if found.wrong else 0 if found.picture.path else RenderingError.exit_status


def _print(found: Checkup) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from nao_sim.checkup import headline

    table = Table(show_header=False, box=None, pad_edge=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    blocks: dict[str, list[Text]] = {
        **{label: [Text(value)] for label, value in headline().items()},
        "packages": _packages(found),
        "OpenGL": _backends(found),
        "picture": [_picture(found)],
        "advice": [Text(remedy, style="bold") for remedy in found.remedies] or [Text("all is well")],
    }
    for label, lines in blocks.items():
        for number, line in enumerate(lines):
            table.add_row("" if number else label, line)
    Console().print(table)


def _packages(found: Checkup) -> list[Text]:
    from rich.text import Text

    needed = [package for package in found.packages if not package.extra]
    fitting = ", ".join(f"{package.name} {package.version}" for package in needed if package.fits)
    extras: dict[str, list[Package]] = {}
    for package in found.packages:
        extras.setdefault(package.extra, []).append(package)
    wrong = [
        Text(
            f"{package.name} {package.version or 'missing'}; expected {package.expected or 'any version'}", style="red"
        )
        for package in found.wrong
    ]
    lines = [Text(fitting)] if fitting else [Text("not known: this folder is used without being installed", "yellow")]
    return lines + wrong + [_extra(name, of) for name, of in extras.items() if name]


def _extra(name: str, packages: list[Package]) -> Text:
    from rich.text import Text

    missing = [package for package in packages if not package.fits]
    if not missing:
        return Text(f"extra {name}: {', '.join(f'{package.name} {package.version}' for package in packages)}")
    names = ", ".join(package.name for package in missing)
    return Text(f"extra {name}: without {names}; where it is wanted: {missing[0].remedy}", style="dim")


def _backends(found: Checkup) -> list[Text]:
    from rich.text import Text

    lines = [
        Text(f"{trial.name}: works, {trial.renderer}", "green")
        if trial.renderer
        else Text(f"{trial.name}: no, {trial.failure}", "yellow")
        for trial in found.backends
    ]
    if all(trial.name != "glfw" for trial in found.backends):
        lines.append(Text("glfw: not tried, no display", style="dim"))
    if wanted := os.environ.get("MUJOCO_GL"):
        lines.append(Text(f"MUJOCO_GL={wanted} asks for this one alone"))
    return lines


def _picture(found: Checkup) -> Text:
    from rich.text import Text

    made = found.picture
    if made.path is None:
        return Text(f"none: {made.failure}", "red")
    return Text(f"{made.path} ({made.seconds:.1f} s)")


if __name__ == "__main__":
    from nao_sim.cli import main

    sys.exit(main(["doctor", *sys.argv[1:]]))
