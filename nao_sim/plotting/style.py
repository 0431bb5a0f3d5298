"""The look that all plots share: `nao_sim.mplstyle`, the colours of the sides, a canvas without a display."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nao_sim.files import beside

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WIDTH = 12.0  # in, of a page
# M. Okabe and K. Ito, Color Universal Design (2008): told apart by colour-blind people, too.
LEFT, RIGHT, MIDDLE, WARNING = "#0072B2", "#D55E00", "#4D4D4D", "#CC79A7"
SIDE_COLOURS = {"left": LEFT, "right": RIGHT, "": MIDDLE}
SIDE_WIDTHS = {"left": 2.4, "right": 1.0, "": 1.2}  # of lines over time: the left one shows under the right one


def side_of(joint: str) -> str:
    """`left`, `right`, or nothing for a joint in the middle."""
    side = joint.partition("_")[0]
    return side if side in SIDE_COLOURS else ""


@contextmanager
def styled() -> Iterator[None]:
    """Inside, figures have the project's look, whatever the user's own settings are."""
    import matplotlib

    with matplotlib.rc_context(), warnings.catch_warnings():
        matplotlib.rcdefaults()
        matplotlib.rc_file(Path(__file__).with_name("nao_sim.mplstyle"), use_default_template=False)
        warnings.filterwarnings("ignore", "Glyph .* missing", UserWarning)  # a file's name may be in any script
        yield


def page(height: float) -> Figure:
    """An empty page, `height` inches high, that needs no display."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH, height))
    FigureCanvasAgg(figure)
    return figure


def save(figure: Figure, path: Path) -> None:
    """Write a figure as its name's extension says, whole or not at all.

    Raises:
        UsageError: it cannot be written there.
    """
    kind = path.suffix.removeprefix(".").lower()
    undated: dict[str, Any] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(kind, {})
    with beside(path) as draft:
        figure.savefig(draft, format=kind, metadata=undated)
