"""A performance as one HTML page that needs neither a server nor a network."""

from __future__ import annotations

import base64
import hashlib
import html
from collections.abc import Collection
from importlib.resources import files
from string import Template
from typing import TYPE_CHECKING, Any

from nao_sim.check_tables import verdict_words
from nao_sim.console import summary
from nao_sim.viewing.curves import pack_curves
from nao_sim.viewing.packing import Parcel
from nao_sim.viewing.playback import SPEEDS, Layer
from nao_sim.viewing.scenery import pack_scenery
from nao_sim.viewing.stage import Stage, stage_of

if TYPE_CHECKING:
    from nao_sim.performed import Performed

SCRIPTS = ("algebra.js", "parcel.js", "motion.js", "player.js", "shaders.js", "painter.js", "camera.js", "plots.js",
           "page.js")  # fmt: skip


def page(performed: Performed, look: str, theme: str, shown: Collection[Layer]) -> bytes:
    """The page.

    Args:
        performed: what it shows.
        look: name of the surroundings.
        theme: name of the robot's colours.
        shown: the layers that are shown at first.

    Raises:
        UsageError: no look or theme of that name.
    """
    stage = stage_of(performed, look, theme)
    title = f"{performed.task.recording.path.name} on a NAO"
    script = '"use strict";\n' + "\n".join(_text(name) for name in SCRIPTS)
    style = _text("page.css")
    return (
        Template(_text("page.html"))
        .substitute(
            title=html.escape(title),
            policy=f"default-src 'none'; script-src '{_hash(script)}'; style-src '{_hash(style)}'; img-src data:; "
            "base-uri 'none'; form-action 'none'",
            style=style,
            script=script,
            data=_packed(stage, title, shown),
        )
        .encode()
    )


def _packed(stage: Stage, title: str, shown: Collection[Layer]) -> str:
    parcel, report = Parcel(), stage.performed.report
    layers = [layer for layer in Layer if layer is not Layer.person or stage.figure is not None]
    told: dict[str, Any] = {
        "title": title,
        "verdict": verdict_words(report),
        "verdict_kind": report["verdict"],
        "summary": list(summary(report).items()),
        "notes": list(report["notes"]),
        "rules_off": list(report["rules_off"]),
        "speeds": SPEEDS,
        "layers": [{"name": layer.name, "words": layer.value, "shown": layer in shown} for layer in layers],
        "scene": pack_scenery(parcel, stage),
        "curves": pack_curves(parcel, stage),
    }
    return parcel.pack(told)


def _text(name: str) -> str:
    return files("nao_sim.viewing").joinpath("web", name).read_text(encoding="utf-8")


def _hash(text: str) -> str:
    return f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}"
