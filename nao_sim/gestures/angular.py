"""How likely a direction is, where a limb should point somewhere and does so with some spread.

The limb is taken for a vector that is normally distributed around where it
should point, N(mu, sigma^2 I), of which only the direction is told.  In space
that is the angular Gaussian density (K. V. Mardia and P. E. Jupp, Directional
Statistics, 2000, section 9.3.2, also "projected normal"):

    f(u) = exp(-(|m|^2 - t^2) / 2) (t phi(t) + (1 + t^2) Phi(t)) / 2 pi,   m = mu / sigma, t = m . u

and in a picture, where depth is lost and m is projected into its plane,

    f(u) = exp(-|m|^2 / 2) (1 + t Phi(t) / phi(t)) / 2 pi.

So a limb that points at the camera has no likely direction in the picture, by
itself: m is short there and f uniform.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.special import ndtr

from nao_sim.robot import Array

_ROOT_2PI = math.sqrt(2.0 * math.pi)


def density_ratio(along: Array, square: Array, planar: bool) -> Array:
    """How much likelier a direction is than if nothing were known of it.

    Args:
        along: (...) t = m . u of directions u.
        square: (...) |m|^2, of m in the picture where depth is lost; shapes broadcast.
        planar: whether x is lost.

    Returns:
        (...) 4 pi f(u), or 2 pi f(u) in a picture; never negative, and exact to about 1e-15 of the largest value.
    """
    below = along * ndtr(along)  # t Phi(t)
    beside = np.exp(0.5 * (along * along - square))
    if planar:
        ratio = np.exp(-0.5 * square) + _ROOT_2PI * below * beside
    else:
        ratio = 2.0 * beside * (along * np.exp(-0.5 * along * along) / _ROOT_2PI + below * along + ndtr(along))
    return np.maximum(ratio, 0.0)
