"""How a picture is laid out and what is written into it, read from `render/presets.toml` and typed nowhere else."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any, Literal

from nao_sim.errors import UsageError
from nao_sim.rendering.preset_kinds import Camera
from nao_sim.rendering.presets import load_camera, rows_of_table, table_row

Size = tuple[int, int]
Box = tuple[int, int, int, int]
WHOLE = (0.0, 0.0, 1.0, 1.0)


@dataclass(frozen=True)
class Pane:
    """A part of the picture with a view of its own.

    Attributes:
        at: left, top, width and height, as shares of the picture's.
        shows: the robot as it was simulated, or in the posture that was asked for.
        camera: name of a camera preset; the one that the user chose where None.
        label: what is written at its top, if anything.
        label_unguarded: what is written there where rules of the guard were switched off.
        border: its width, as a share of the picture's height.
        lower: m, by how much lower than usual the camera looks: what it shows is higher up, over the captions.
    """

    at: tuple[float, float, float, float] = WHOLE
    shows: Literal["simulated", "requested"] = "simulated"
    camera: str | None = None
    label: str = ""
    label_unguarded: str = ""
    border: float = 0.0
    lower: float = 0.0

    def title(self, guarded: bool) -> str:
        """What is written at its top, all rules of the guard being on or not."""
        return self.label if guarded else self.label_unguarded or self.label


@dataclass(frozen=True)
class Arrangement:
    """How a picture is laid out.

    Attributes:
        name: the preset's name.
        panes: its parts; later ones cover earlier ones.
        person: where the recorded person is shown (a table of `[figure]`), if at all.
        needs_person: whether it is for recordings of people alone.
        two: whether a second robot may be there.
    """

    name: str
    panes: tuple[Pane, ...]
    person: str | None = None
    needs_person: bool = False
    two: bool = False


@dataclass(frozen=True)
class Overlay:
    """What is shown over the picture.

    Attributes:
        name: the preset's name.
        gestures: captions of recognised gestures.
        limits: captions of joints at their limits.
        time: the time of the recording.
        safety: coloured limbs and captions where the guard intervenes.
    """

    name: str
    gestures: bool = False
    limits: bool = False
    time: bool = False
    safety: bool = False


@dataclass(frozen=True)
class View:
    """A part of the picture as it is painted.

    Attributes:
        camera: where it is taken from.
        at: as `Pane` has it.
        border: as `Pane` has it.
    """

    camera: Camera
    at: tuple[float, float, float, float] = WHOLE
    border: float = 0.0

    def box(self, size: Size) -> Box:
        """Left, top, width and height in pixels of a picture of `size`; neighbours share no pixel and leave none."""
        left, right = (round(edge * size[0]) for edge in (self.at[0], self.at[0] + self.at[2]))
        top, bottom = (round(edge * size[1]) for edge in (self.at[1], self.at[1] + self.at[3]))
        return left, top, max(1, right - left), max(1, bottom - top)

    def to_json(self) -> dict[str, Any]:
        """As JSON knows it."""
        return asdict(self)

    @staticmethod
    def from_json(table: Mapping[str, Any]) -> View:
        """The view that `to_json` told."""
        return View(Camera(**table["camera"]), tuple(table["at"]), table["border"])


@dataclass(frozen=True)
class LimitLooks:
    """How a film shows that a joint is at its limit.

    Attributes:
        within_deg: degrees; nearer than this to where commands end is at the limit.
        hold: s for which a caption stays at least.
        most: captions at a time.
        dot: red, green and blue of its dot, 0 to 1.
    """

    within_deg: float
    hold: float
    most: int
    dot: tuple[float, float, float]


def arrangement_names() -> tuple[str, ...]:
    """The ways to lay out a picture, in the table's order."""
    return tuple(rows_of_table("arrangement"))


def overlay_names() -> tuple[str, ...]:
    """What can be shown over a picture, in the table's order."""
    return tuple(rows_of_table("overlay"))


def load_arrangement(name: str) -> Arrangement:
    """The arrangement `name`.

    Raises:
        UsageError: no such preset.
    """
    row = dict(table_row("arrangement", name))
    panes = tuple(Pane(**pane | ({"at": tuple(pane["at"])} if "at" in pane else {})) for pane in row.pop("panes"))
    return Arrangement(name=name, panes=panes, **row)


def load_overlay(name: str) -> Overlay:
    """The overlay `name`.

    Raises:
        UsageError: no such preset.
    """
    return Overlay(name=name, **table_row("overlay", name))


def with_safety(overlay: str) -> str:
    """The name of the overlay that shows what `overlay` shows, and safety.

    Raises:
        UsageError: there is none, as of one that shows nothing.
    """
    wanted = asdict(load_overlay(overlay)) | {"safety": True, "name": ""}
    found = [name for name in overlay_names() if asdict(load_overlay(name)) | {"name": ""} == wanted]
    if not found:
        raise UsageError(f"--show-safety and --overlay {overlay} contradict each other; give one of them")
    return found[0]


def load_limits() -> LimitLooks:
    """How joints at their limits are shown."""
    row = dict(rows_of_table("limits"))
    return LimitLooks(**row | {"dot": tuple(row["dot"])})


def views_of(arrangement: Arrangement, camera: str, suffix: str = "") -> tuple[View, ...]:
    """The parts of a picture, seen by `camera` where a pane has none of its own.

    Args:
        arrangement: the layout.
        camera: name of a camera preset.
        suffix: of the preset's name for whoever is beside the robot; panes with a camera of their own have none.

    Raises:
        UsageError: no such camera.
    """
    return tuple(
        View(_lowered(load_camera(pane.camera or f"{camera}{suffix}"), pane.lower), pane.at, pane.border)
        for pane in arrangement.panes
    )


def _lowered(camera: Camera, by: float) -> Camera:
    """A camera that looks at a point `by` (m) lower; one of the model stays as it is."""
    x, y, z = camera.lookat
    return replace(camera, lookat=(x, y, z - by))
