"""The look that all plots share: `nao_sim.mplstyle`, sizes for screens and papers, a canvas without a display."""

from __future__ import annotations

import io
import textwrap
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from nao_sim.files import beside
from nao_sim.plotting.palette import SIDE_COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

    Canvas: TypeAlias = Figure | SubFigure

_FONT = 9.0  # pt, of the style: heights and widths of plots are inches at this size
_SCALED = ("font.size", "axes.titlesize", "axes.labelsize", "xtick.labelsize", "ytick.labelsize", "legend.fontsize",
           "figure.titlesize")  # fmt: skip
_LETTER = 0.6  # mean width of a letter, as a share of its size
_NARROW = 7.0  # in at 9 pt; a picture that is narrower has one panel beside the other no more


@dataclass(frozen=True)
class Size:
    """How large a picture is.

    Attributes:
        width: in.
        font: pt, of most text.
        dpi: pixels an inch, of a .png and of what is pixels in the other kinds.
    """

    width: float
    font: float
    dpi: int


# A page and a column of a journal with two columns (IEEE: 7.16 in and 3.5 in, text of 8 to 10 pt).
SIZES = {"screen": Size(12.0, _FONT, 120), "page": Size(7.16, 8.0, 300), "column": Size(3.5, 8.0, 300)}
USUAL = {".png": "screen", ".svg": "page", ".pdf": "page"}


@dataclass(frozen=True, eq=False)
class Block:
    """A part of a picture, or all of it.

    Attributes:
        title: what it shows, in a few words.
        draw: draws it on an empty canvas.
        height: in at the style's own font, for a width in the same inches.
    """

    title: str
    draw: Callable[[Canvas], None]
    height: Callable[[float], float]


def side_of(joint: str) -> str:
    """`left`, `right`, or nothing for a joint in the middle."""
    side = joint.partition("_")[0]
    return side if side in SIDE_COLOURS else ""


@contextmanager
def styled(size: str = "screen") -> Iterator[None]:
    """Inside, figures have the project's look and a size of `SIZES`, whatever the user's own settings are."""
    import matplotlib

    wanted = SIZES[size]
    with matplotlib.rc_context(), warnings.catch_warnings():
        matplotlib.rcdefaults()
        matplotlib.rc_file(Path(__file__).with_name("nao_sim.mplstyle"), use_default_template=False)
        scale = wanted.font / _FONT
        matplotlib.rcParams.update({key: size * scale for key, size in matplotlib.rcParams.items() if key in _SCALED})
        matplotlib.rcParams["figure.figsize"] = (wanted.width, wanted.width)
        matplotlib.rcParams["savefig.dpi"] = wanted.dpi
        warnings.filterwarnings("ignore", "Glyph .* missing", UserWarning)  # a file's name may be in any script
        yield


def across() -> float:
    """How wide pictures are, in inches at the style's own font: how much fits side by side."""
    import matplotlib

    return float(matplotlib.rcParams["figure.figsize"][0] / _scale())


def narrow(width: float | None = None) -> bool:
    """Whether a picture, those drawn now where `width` is None, is as narrow as a column."""
    return (across() if width is None else width) < _NARROW


def beside_each_other(width: float, least: float, most: int) -> int:
    """How many panels of a least width (in) fit into a width, one at least and `most` at most."""
    return int(min(max(width // least, 1), most))


def page(height: float) -> Figure:
    """An empty page, `height` inches high at the style's own font, that needs no display."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(matplotlib.rcParams["figure.figsize"][0], height * _scale()))
    FigureCanvasAgg(figure)
    return figure


def stacked(blocks: Sequence[Block], title: str = "", colour: str = "black") -> Figure:
    """Blocks below each other, on a page as high as they are, with a title where there is one."""
    heights, lines = [block.height(across()) for block in blocks], _wrapped(title)
    figure = page(sum(heights) + 0.22 * lines.count("\n"))
    parts = figure.subfigures(len(blocks), 1, height_ratios=heights) if len(blocks) > 1 else figure
    for block, part in zip(blocks, [figure] if len(blocks) == 1 else list(parts), strict=True):  # type: ignore[arg-type]
        block.draw(part)
    if title:
        figure.suptitle(lines, x=0.01, ha="left", color=colour)
    return figure


def save_page(
    blocks: Sequence[Block], path: Path, title: str = "", *, colour: str = "black", size: str | None = None
) -> None:
    """Draw blocks below each other into a file.

    Args:
        blocks: what to draw.
        path: a `.png`, `.svg` or `.pdf`.
        title: above all.
        colour: of the title.
        size: a name of `SIZES`; a screen's for a `.png` and a paper's page for the others where None.

    Raises:
        UsageError: it cannot be written there.
    """
    with styled(size or USUAL[path.suffix.lower()]):
        save(stacked(blocks, title, colour), path)


def svg_text(block: Block, size: str = "column") -> str:
    """A block as the text of an SVG."""
    text = io.StringIO()
    with styled(size):
        stacked([block]).savefig(text, format="svg", metadata=_undated("svg"))
    return text.getvalue()


def save(figure: Figure, path: Path) -> None:
    """Write a figure as its name's extension says, whole or not at all; the same figure gives the same bytes.

    Raises:
        UsageError: it cannot be written there.
    """
    kind = path.suffix.removeprefix(".").lower()
    with beside(path) as draft:
        figure.savefig(draft, format=kind, metadata=_undated(kind))


def legend_above(axes: Axes, handles: Sequence[Any], columns: int | None = None) -> None:
    """A legend at the right end of a panel's title."""
    axes.legend(
        handles=list(handles), ncols=columns or len(handles), loc="lower right", bbox_to_anchor=(1.0, 1.0),
        borderaxespad=0.1,
    )  # fmt: skip


def shortened(name: str, most: int) -> str:
    """A name of at most so many characters."""
    return name if len(name) <= most else f"{name[: most - 1]}…"


def _wrapped(title: str) -> str:
    """Lines as long as the page is wide."""
    import matplotlib

    letter = _LETTER * matplotlib.rcParams["figure.titlesize"] / _scale() / 72.0
    return "\n".join(textwrap.wrap(title, int(across() / letter), max_lines=4, placeholder=" …"))


def _scale() -> float:
    import matplotlib

    return float(matplotlib.rcParams["font.size"] / _FONT)


def _undated(kind: str) -> dict[str, Any]:
    return {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(kind, {})
