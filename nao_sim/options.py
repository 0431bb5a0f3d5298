"""The options that several commands share."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Literal

import typer

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
