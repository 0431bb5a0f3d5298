"""What a page says, before it is written as HTML."""

from __future__ import annotations

import platform
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib import metadata
from typing import TYPE_CHECKING, Literal

from nao_sim import __version__
from nao_sim.sections import Section

if TYPE_CHECKING:
    from nao_sim.plotting.style import Block
    from nao_sim.web.film import Film

Tone = Literal["good", "fair", "bad"]
_PACKAGES = ("mujoco", "numpy", "matplotlib")
_FOLDERS = re.compile(r"(?<![\w.:/])~?/(?:[^\s/:'\"]+/)+")


@dataclass(frozen=True)
class Verdict:
    """What came of it, in a few words.

    Attributes:
        words: the verdict.
        tone: whether that is good; shown by a sign and a colour.
    """

    words: str
    tone: Tone


@dataclass(frozen=True, eq=False)
class Plot:
    """A plot and what is to be seen in it.

    Attributes:
        block: what to draw.
        about: for those who cannot see it.
        wide: whether it takes the width of the page, where that is wider than a phone's.
    """

    block: Block
    about: str
    wide: bool = False


@dataclass(frozen=True, eq=False)
class Document:
    """A page.

    Attributes:
        title: what it is about.
        lead: a sentence or two on what was done.
        verdict: what came of it, where there is one.
        warnings: what must not be overlooked.
        summary: lines below a word each.
        film: of the robot, where there is one.
        no_film: why there is none although one was ordered.
        key: what the colours of all plots mean, where that is not in the plots.
        plots: plots, in their order.
        sections: tables with words.
        remarks: what a user should know.
        made: how it was made: a word and what it was, each.
    """

    title: str
    lead: str
    verdict: Verdict | None = None
    warnings: Sequence[str] = ()
    summary: Mapping[str, Sequence[str]] = field(default_factory=dict)
    film: Film | None = None
    no_film: str = ""
    key: Plot | None = None
    plots: Sequence[Plot] = ()
    sections: Sequence[Section] = ()
    remarks: Sequence[str] = ()
    made: Mapping[str, str] = field(default_factory=dict)


def made_by(command: str, files: Mapping[str, str], more: Mapping[str, str] | None = None) -> dict[str, str]:
    """How a page was made: its command line, files by their names, and versions."""
    versions = ", ".join(f"{name} {metadata.version(name)}" for name in _PACKAGES)
    system = f"Python {platform.python_version()}, {versions}"
    return {"command": command, **files, **(more or {}), "nao_sim": __version__, "with": system}


def without_folders(text: str) -> str:
    """A text in which files are called by their names alone: where they lie is nobody's business."""
    return _FOLDERS.sub("", text)
