"""The options that several commands share, and what is expected of them."""

from __future__ import annotations

import shlex
from enum import StrEnum
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from nao_sim.errors import UsageError
from nao_sim.rendering.arrangements import (
    arrangement_names,
    load_overlay,
    overlay_names,
    with_safety,
)
from nao_sim.rendering.presets import camera_names, look_names, quality_names, theme_names

if TYPE_CHECKING:
    from nao_sim.safety.rules import Rules


def _or(names: tuple[str, ...]) -> str:
    return f"{', '.join(names[:-1])} or {names[-1]}"


Unit = Annotated[Literal["deg", "rad"] | None, typer.Option(help="Unit of the angles, where the file does not say.")]
Rate = Annotated[float | None, typer.Option(help="Frames a second (Hz), where the file has no times.")]
Layout = Annotated[
    Path | None,
    typer.Option(metavar="TOML", help="Table of yours that says which number in the file is what (docs/layouts.md)."),
]
Person = Annotated[
    str | None,
    typer.Option(metavar="ID", help="Which of several people in the file.", show_default="the one seen longest"),
]
Rig = Annotated[
    Path | None, typer.Option(metavar="ASF", help="Skeleton of an AMC file.", show_default="the subject's, near it")
]
Base = Annotated[Literal["free", "pinned"], typer.Option(help="Stand on its feet, or be held by the torso.")]
Speed = Annotated[float, typer.Option(help="Times as fast as recorded.")]
Camera = Annotated[str, typer.Option(metavar="NAME", help=f"Where to look from: {_or(camera_names())} (its own eyes).")]
Quality = Annotated[
    str,
    typer.Option(
        metavar="NAME",
        help=f"How good pictures look: {_or(quality_names())}; draft is fast and has no shadows, fine takes long.",
    ),
]
Look = Annotated[str, typer.Option(metavar="NAME", help=f"What is around the robot: {_or(look_names())}.")]
Theme = Annotated[str, typer.Option(metavar="NAME", help=f"Colours of the robot: {_or(theme_names())}.")]
Arrange = Annotated[
    str,
    typer.Option(
        metavar="NAME",
        help=f"How the picture is laid out: {_or(arrangement_names())}. The person stands beside the robot or behind "
        "it, or is left out; compare has what was requested on the left and what is safe on the right; eyes has in a "
        "corner what the robot sees.",
    ),
]
Overlay = Annotated[
    str,
    typer.Option(
        metavar="NAME",
        help=f"What is written over it: {_or(overlay_names())}. Labels are gestures, joints at their limits and the "
        "time of the recording; safety colours the limbs in which the guard intervenes, and says why.",
    ),
]
ShowPerson = Annotated[bool, typer.Option("--show-person/--hide-person", help="Show the recorded person.")]
ShowSafety = Annotated[bool, typer.Option("--show-safety/--no-show-safety", help="The same as --overlay safety.")]
Version = Annotated[Literal["v4", "v5", "v6"], typer.Option("--robot", help="NAO H25 version.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")]


class MatchOption(StrEnum):
    """What of a person's arms the robot's arms take over."""

    directions = "directions"
    hands = "hands"


class BodyOption(StrEnum):
    """How much of a person the robot takes over."""

    arms = "arms"
    whole = "whole"


Match = Annotated[MatchOption, typer.Option(help="Point the arms as the person's, or bring the hands to their places.")]
Body = Annotated[BodyOption, typer.Option(help="Follow with arms and head, or with legs and torso, too.")]
Raw = Annotated[bool, typer.Option("--raw", help="Leave out the filters: follow a person's every frame as recorded.")]
MaxSpeed = Annotated[
    float | None,
    typer.Option(
        "--max-speed",
        metavar="SHARE",
        help="Greatest speed of a joint: share of its motor's no-load speed, 0.05 to 1.",
        show_default="0.8",
    ),
]
Without = Annotated[
    list[str] | None,
    typer.Option(
        "--without", metavar="RULE", help="Switch off coupling, speed, self_collision, balance or stream; repeatable."
    ),
]
AcceptRisk = Annotated[bool, typer.Option("--accept-risk", help="Needed beside --without: you know what it may do.")]


class KindOption(StrEnum):
    """What the gestures of a data set are taken for."""

    auto = "auto"
    poses = "poses"
    movements = "movements"

    @property
    def wanted(self) -> Literal["poses", "movements"] | None:
        """Nothing where the data decide."""
        return None if self is KindOption.auto else self.value  # type: ignore[return-value]


Kind = Annotated[KindOption, typer.Option(help="What all gestures are; auto decides for each, and says why.")]
Manifest = Annotated[
    Path, typer.Argument(help="A CSV with path,label,user[,start,end][,layout][,split] (docs/data_sets.md).")
]
SingleArms = Annotated[
    bool, typer.Option("--single-arms", help="Learn each symmetric pose with one arm alone, too, the other hanging.")
]
SkipUnreadable = Annotated[
    bool, typer.Option("--skip-unreadable", help="Leave out recordings that cannot be read, and say which.")
]
SLOWEST, FASTEST = 0.01, 1000.0  # times the recorded speed


class PlotSizeOption(StrEnum):
    """How large pictures are."""

    screen = "screen"
    page = "page"
    column = "column"


Plot = Annotated[
    Path | None, typer.Option("--plot", metavar="PICTURE", help="Also draw it: a .png, or for papers a .svg or .pdf.")
]
PlotSize = Annotated[
    PlotSizeOption | None,
    typer.Option(
        "--plot-size",
        help="For a screen (12 in wide), a paper's page (7.16 in) or its column (3.5 in).",
        show_default="screen for a .png, else page",
    ),
]
Html = Annotated[
    Path | None,
    typer.Option("--html", metavar="PAGE", help="Also write a page to mail or print, all in one file: an .html."),
]

STDOUT = Path("-")
PICTURES = (".png", ".svg", ".pdf")
PAGES = (".html", ".htm")


def check_picture(plot: Path | None, option: str = "--plot") -> None:
    """Refuse the name of a picture of no kind that can be drawn.

    Raises:
        UsageError: it ends otherwise.
    """
    if plot and plot.suffix.lower() not in PICTURES:
        raise UsageError(f"{option} {plot}: expected a name that ends in {', '.join(PICTURES[:-1])} or {PICTURES[-1]}")


def check_page(html: Path | None) -> None:
    """Refuse the name of a page that no browser would open, and all pages where they cannot be written.

    Raises:
        UsageError: it ends otherwise than in .html or .htm, or jinja2 is missing.
    """
    if html and html.suffix.lower() not in PAGES:
        raise UsageError(f"--html {html}: expected a name that ends in {' or '.join(PAGES)}")
    if html and find_spec("jinja2") is None:
        raise UsageError(f"--html {html}: the package jinja2 is missing; type: pip install jinja2")


def command_line(context: typer.Context) -> str:
    """The command line of a command, with names of files and no folders."""
    words = ["nao-sim", context.info_name or ""]
    for parameter in context.command.params:
        source, value = context.get_parameter_source(parameter.name or ""), context.params.get(parameter.name or "")
        if source is None or source.name != "COMMANDLINE":
            continue
        named = parameter.param_type_name == "option"
        for each in value if isinstance(value, list | tuple) else [value]:
            if isinstance(each, bool):
                words.append((parameter.opts if each else parameter.secondary_opts)[0])
            else:
                words += [parameter.opts[0]] * named + [_word(each)]
    return shlex.join(words)


def _word(value: object) -> str:
    text = str(value.value if isinstance(value, StrEnum) else value)
    return Path(text).name if "/" in text else text


def check_speed(speed: float) -> None:
    """Refuse a speed that is none.

    Raises:
        UsageError: it is out of all proportion, or no number.
    """
    if not SLOWEST <= speed <= FASTEST:
        raise UsageError(f"--speed {speed:g}: expected a factor from {SLOWEST:g} to {FASTEST:g}")


def rules(max_speed: float | None, without: list[str] | None, accept_risk: bool) -> Rules:
    """The rules that the guard keeps, as the command line has them; `self-collision` is `self_collision`, too.

    Raises:
        UsageError: no such share or rule, or a rule off without `--accept-risk`.
    """
    from nao_sim.safety.rules import SPEED_FRACTION, Rules

    share = SPEED_FRACTION if max_speed is None else max_speed
    return Rules(share, frozenset(rule.replace("-", "_") for rule in without or ()), accept_risk)


def overlaid(overlay: str, show_safety: bool) -> str:
    """The overlay as `--overlay` and `--show-safety` have it.

    Raises:
        UsageError: there is none of that name, or they contradict each other.
    """
    load_overlay(overlay)
    return with_safety(overlay) if show_safety else overlay


def for_one(overlay: str, show_safety: bool) -> dict[str, bool]:
    """The options that show the guard's work on one robot, and whether they are given."""
    return {"--show-safety": show_safety, f"--overlay {overlay}": load_overlay(overlay).safety}


COMPRESSED = (".gz", ".bz2", ".xz")


def film_of(recording: Path) -> Path:
    """Where a recording's video goes if nobody says; a compressed file's name is that of what is in it."""
    inner = Path(recording.stem) if recording.suffix.lower() in COMPRESSED else recording
    return Path("render") / f"{inner.stem}.mp4"


def parse_size(text: str) -> tuple[int, int]:
    """Width and height of `640x480`.

    Raises:
        UsageError: not two whole numbers with an x between them.
    """
    width, _, height = text.lower().partition("x")
    if not (width.isdecimal() and height.isdecimal()):
        raise UsageError(f"--size {text}: expected WIDTHxHEIGHT in pixels, such as 640x480")
    return int(width), int(height)
