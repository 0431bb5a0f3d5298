"""The `nao-sim` command: parse, call, print.

A command's module, and with it MuJoCo, is imported only when that command
runs: `nao-sim --help` answers at once.  `main` is also the one place where
errors turn into messages and exit statuses.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from nao_sim import __version__
from nao_sim.errors import NaoSimError

INTERRUPTED = 130  # what a shell reports for a program ended by Ctrl-C

# name: (module, function, the line that `nao-sim --help` shows)
COMMANDS = {
    "play": ("nao_sim.play", "play", "Let the robot imitate a recording; write a video and a report."),
    "live": ("nao_sim.live_command", "live", "Let the robot do, now, what somebody does before a camera or sensor."),
    "still": ("nao_sim.still", "still", "Take pictures of a robot that imitates a recording."),
    "view": ("nao_sim.view", "view", "Look at a recording by hand: in a window, a browser, or a page to keep."),
    "check": ("nao_sim.check", "check", "Say what the robot can safely do of a recording, and what not."),
    "retarget": ("nao_sim.retarget", "retarget", "Write a person's recording as a NAO's joint angles."),
    "convert": ("nao_sim.convert", "convert", "Convert joint angles from one format to another."),
    "inspect": ("nao_sim.inspect_recording", "inspect", "Say what is in a recording, and how good it is."),
    "formats": ("nao_sim.formats", "formats", "List what can be read, and how it is told."),
    "compare": ("nao_sim.compare", "compare", "Say how well the robot imitates the recording."),
    "teach": ("nao_sim.teach", "teach", "Teach a gesture by a few examples; add it to a vocabulary."),
    "recognise": ("nao_sim.recognise", "recognise", "Say which gestures a recording shows, and when."),
    "train": ("nao_sim.train", "train", "Learn gestures from labelled recordings."),
    "evaluate": ("nao_sim.evaluate", "evaluate", "Say how well gestures of strangers are recognised."),
    "dictionary": ("nao_sim.dictionary", "dictionary", "Draw all gestures that the robot knows on one page."),
    "doctor": ("nao_sim.doctor", "doctor", "Say what works on this machine, and what to install."),
    "reproduce": ("nao_sim.reproduce", "reproduce", "Put the thesis's published figures beside ours."),
}


class _LazyCommands(TyperGroup):
    """The commands of the table above, imported when run and not when listed."""

    def list_commands(self, ctx: Any) -> list[str]:
        return [*COMMANDS, *super().list_commands(ctx)]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        if cmd_name not in COMMANDS:
            return super().get_command(ctx, cmd_name)
        return TyperCommand(cmd_name, help=COMMANDS[cmd_name][2])

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        name, command, rest = super().resolve_command(ctx, args)
        return name, _load(name) if name in COMMANDS else command, rest


def _load(name: str) -> Any:
    module, function, _ = COMMANDS[name]
    single = typer.Typer(add_completion=False)
    single.command(name)(getattr(import_module(module), function))
    return typer.main.get_command(single)


app = typer.Typer(
    cls=_LazyCommands,
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"nao-sim {__version__}")
        raise typer.Exit


@app.callback()
def _root(
    _version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and leave.")
    ] = False,
) -> None:
    """A NAO H25 humanoid in MuJoCo that imitates recorded people, safely."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    A command's own module offers itself with `sys.exit(main(["play", *sys.argv[1:]]))`.

    Args:
        arguments: the words after the program's name; those of this process
            when None.  No words at all ask for the help.

    Returns:
        The exit status: 0, the `exit_status` of the `NaoSimError` that was
        raised, 2 for words that cannot be understood, 130 after Ctrl-C.
    """
    signal.signal(signal.SIGTERM, _end)
    words = list(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    try:
        status = typer.main.get_command(app).main(words, prog_name="nao-sim", standalone_mode=False)
    except NaoSimError as error:
        return _complain("nao-sim", str(error), error.exit_status)
    except typer.TyperException as error:
        context = getattr(error, "ctx", None)
        command = context.command_path if context else "nao-sim"
        said = error.format_message().removesuffix(".").replace("Value error, ", "")  # the checker's word, not ours
        return _complain(command, f"{said}; see {command} --help", error.exit_code)
    except (KeyboardInterrupt, typer.Abort):
        return INTERRUPTED
    return status if isinstance(status, int) else 0


def _end(number: int, _frame: object) -> None:
    """Leave as after Ctrl-C, so that nothing half-written stays behind."""
    raise SystemExit(128 + number)


def _complain(program: str, message: str, status: int) -> int:
    print(f"{program}: {' '.join(message.splitlines())}", file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main())
