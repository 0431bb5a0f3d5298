"""A page as a file of HTML that needs nothing else."""

from __future__ import annotations

from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING

from nao_sim.files import make_folder
from nao_sim.plotting.style import svg_text
from nao_sim.sections import write_text
from nao_sim.web.document import Document, Plot
from nao_sim.web.drawing import inline_svg

if TYPE_CHECKING:
    from markupsafe import Markup

_TEMPLATE = "page.html.jinja"


def write_document(document: Document, path: Path) -> None:
    """Write a page, whole or not at all.

    Raises:
        UsageError: it cannot be written there.
    """
    text = html_text(document)
    make_folder(path.parent)
    write_text(path, text)


def html_text(document: Document) -> str:
    """A page as HTML; whatever comes from files is text in it and never markup."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True, keep_trailing_newline=True,
    )  # fmt: skip
    numbers = count(1)
    environment.globals["drawings"] = lambda plot: _drawings(plot, f"plot{next(numbers)}")
    return environment.get_template(_TEMPLATE).render(page=document)


def _drawings(plot: Plot, name: str) -> list[tuple[str, Markup]]:
    """A plot at every width at which it is shown: the class of its element, and the element.

    What comes from files is text in them: an XML writer wrote it.
    """
    from markupsafe import Markup

    sizes = {"large": "page", "small": "column"} if plot.wide else {"any": "column"}
    return [
        (kind, Markup(inline_svg(svg_text(plot.block, size), f"{name}-{kind}", plot.block.title, plot.about)))
        for kind, size in sizes.items()
    ]
