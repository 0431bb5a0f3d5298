"""A person as a stick figure, seen from the front and from the side."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nao_sim.body import SIDES
from nao_sim.motion import Skeleton
from nao_sim.plotting.palette import MIDDLE, SIDE_COLOURS
from nao_sim.robot import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FRONT, SIDE = 1, 0  # the coordinate that goes across: to the person's left, and forwards
_HEAD = 0.1  # m, radius
_ROOM = 0.25  # m between figures
_LIMBS = (("shoulder", "elbow", "wrist", "hand", "hand_tip"), ("hip", "knee", "ankle", "foot"), ("ankle", "heel"))
_FINGERS = tuple(
    ("wrist", *(f"{finger}_{knuckle}" for knuckle in knuckles))
    for finger, knuckles in {
        "thumb": ("cmc", "mcp", "ip", "tip"),
        **dict.fromkeys(("index", "middle", "ring", "pinky"), ("mcp", "pip", "dip", "tip")),
    }.items()
)
_HEAD_AT = (("head",), ("left_ear", "right_ear"), ("left_eye", "right_eye"), ("nose",))
_NECK_AT = (("neck",), ("chest",), ("left_shoulder", "right_shoulder"))
_SPINE = ("pelvis", "spine", "chest", "neck", "head")
_GIRDLES = (("left_shoulder", ("chest", "neck"), "right_shoulder"), ("left_hip", ("pelvis",), "right_hip"))


def key_frames(skeleton: Skeleton, count: int = 6) -> NDArray[np.intp]:
    """Frames evenly over the recording's time, of those near each instant the one with most joints."""
    seen = np.isfinite(skeleton.positions).all(axis=2).sum(axis=1)
    instants = np.linspace(skeleton.times[0], skeleton.times[-1], min(count, len(skeleton)))
    near = (skeleton.times[-1] - skeleton.times[0]) / (4 * count)
    chosen = []
    for instant in instants:
        away = np.abs(skeleton.times - instant)
        candidates = np.flatnonzero(away <= max(near, away.min()))
        best = candidates[seen[candidates] == seen[candidates].max()]
        chosen.append(best[np.argmin(away[best])])
    return np.unique(chosen)


def spacing(skeleton: Skeleton, frames: NDArray[np.intp]) -> float:
    """Metres from one figure to the next, so that none touches another in either view."""
    places = skeleton.positions[frames] - _middles(skeleton, frames)[:, None]
    reach = np.nanmax(np.abs(places[:, :, :2]), initial=0.3)
    return 2.0 * float(reach) + _ROOM


def heights(skeleton: Skeleton, frames: NDArray[np.intp]) -> tuple[float, float]:
    """The lowest and the highest point of the figures, with some room, m; anything where nobody is seen."""
    up = skeleton.positions[frames, :, 2]
    up = up[np.isfinite(up)]
    low, high = (float(up.min()), float(up.max())) if len(up) else (0.0, 1.0)
    return low - 0.05, high + _HEAD + 0.08


def draw_strip(axes: Axes, skeleton: Skeleton, frames: NDArray[np.intp], across: int) -> None:
    """The person at some frames, side by side.

    Args:
        axes: where to draw.
        skeleton: the person.
        frames: (N,) which frames.
        across: `FRONT`, the person's left to the right, or `SIDE`, the person looking to the right.
    """
    step = spacing(skeleton, frames)
    middles = _middles(skeleton, frames)[:, across]
    for place, (frame, middle) in enumerate(zip(frames, middles, strict=True)):
        points = skeleton.positions[frame][:, [across, 2]] + [place * step - middle, 0.0]
        _draw_person(axes, skeleton, points)
    axes.set(aspect="equal", xlim=(-step / 2, (len(frames) - 0.5) * step), ylim=heights(skeleton, frames))
    axes.set_xticks(np.arange(len(frames)) * step, [f"{skeleton.times[frame]:.2f} s" for frame in frames])
    axes.grid(visible=False, axis="x")
    axes.tick_params(axis="x", length=0)
    axes.set_ylabel("z, up (m)")


def _draw_person(axes: Axes, skeleton: Skeleton, points: Array) -> None:
    """One figure: points (J, 2), nan where missing; the nearer, right side last."""
    index = {joint: place for place, joint in enumerate(skeleton.joints)}
    for side in ("", *SIDES):
        colour = SIDE_COLOURS[side]
        for chain, width in _chains(side, skeleton.joints):
            line = [points[index[joint]] for joint in chain if joint in index]
            if line:
                axes.plot(*np.transpose(line), color=colour, linewidth=width, marker="o", markersize=1.4 * width)
    head, neck = (_between(skeleton.joints, points, places) for places in (_HEAD_AT, _NECK_AT))
    if np.isfinite(head).all():
        from matplotlib.patches import Circle

        axes.plot(*np.transpose([neck, head]), color=MIDDLE, linewidth=1.6, zorder=1)
        axes.add_patch(Circle(tuple(head), _HEAD, facecolor="white", edgecolor=MIDDLE, linewidth=1.6, zorder=3))


def _chains(side: str, joints: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], float]]:
    """Joints to connect and the width of the line; of the middle, too, where `side` is empty."""
    if not side:
        yield _SPINE, 1.6
        if len(set(_SPINE[:4]) & set(joints)) < 2:  # noqa: PLR2004  without a spine the flanks hold the figure together
            yield from (((f"{flank}_shoulder", f"{flank}_hip"), 1.6) for flank in SIDES)
        for left, middles, right in _GIRDLES:
            middle = [joint for joint in middles if joint in joints][:1]
            yield (left, *middle, right), 1.6
        return
    for limb in _LIMBS:
        yield tuple(f"{side}_{part}" for part in limb), 2.2
    for finger in _FINGERS:
        yield tuple(f"{side}_{part}" for part in finger), 0.8


def _between(joints: tuple[str, ...], points: Array, places: tuple[tuple[str, ...], ...]) -> Array:
    """The middle of the first group of joints that are all seen; nan where there is none."""
    for names in places:
        if all(name in joints for name in names):
            middle = np.mean([points[joints.index(name)] for name in names], axis=0)
            if np.isfinite(middle).all():
                return np.asarray(middle)
    return np.full(2, np.nan)


def _middles(skeleton: Skeleton, frames: NDArray[np.intp]) -> Array:
    """(N, 3) where the person is: the pelvis, or the middle of what is seen."""
    pelvis = skeleton.track("pelvis")[frames]
    low, high = (limit(skeleton.positions[frames], axis=1) for limit in (np.fmin.reduce, np.fmax.reduce))
    return np.nan_to_num(np.where(np.isfinite(pelvis), pelvis, (low + high) / 2.0))
