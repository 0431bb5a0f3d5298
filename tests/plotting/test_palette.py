"""Colours of plots: told apart by people who see no difference of red and green."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from nao_sim.plotting import palette

# G. M. Machado, M. M. Oliveira and L. A. F. Fernandes, "A Physiologically-based Model for Simulation of Color Vision
# Deficiency", IEEE Trans. Vis. Comput. Graph. 15(6), 2009: severity 1, on linear RGB.
SEEN = {
    "normal": np.eye(3),
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
}
TOGETHER = {  # what is in one picture, on white paper
    "sides": [palette.LEFT, palette.RIGHT, palette.MIDDLE, palette.WARNING],
    "stages": list(palette.STAGES.values()),
    "reasons": list(palette.REASON_COLOURS.values()),
    "confidence": [*palette.CONFIDENCE, palette.MISSING],
}
APART = 15.0  # CIE 1976 colour difference; neighbours on a print are told apart from about 2.3 on


def _linear(colour: str) -> np.ndarray:
    values = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def _lab(linear: np.ndarray) -> np.ndarray:
    """CIELAB of linear sRGB under D65."""
    to_xyz = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    shares = to_xyz @ linear / to_xyz.sum(axis=1)
    f = np.where(shares > 216 / 24389, np.cbrt(shares), (24389 / 27 * shares + 16) / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


@pytest.mark.parametrize("eyes", list(SEEN))
@pytest.mark.parametrize("what", list(TOGETHER))
def test_colours_of_one_picture_are_told_apart(what: str, eyes: str) -> None:
    seen = {c: _lab(np.clip(np.array(SEEN[eyes]) @ _linear(c), 0.0, 1.0)) for c in {*TOGETHER[what], "#FFFFFF"}}
    apart = {pair: np.linalg.norm(seen[pair[0]] - seen[pair[1]]) for pair in combinations(seen, 2)}
    if what == "confidence":  # its palest is as good as paper
        apart.pop(next(pair for pair in apart if set(pair) == {"#FFFFFF", palette.CONFIDENCE[-1]}))
    assert min(apart.values()) >= APART, min(apart, key=apart.__getitem__)


def test_lightness_alone_orders_the_scale_of_confidence() -> None:
    lightness = [_lab(_linear(colour))[0] for colour in (palette.MISSING, *palette.CONFIDENCE)]
    assert np.diff(lightness).min() > 10.0
