"""Made-up data sets: recordings of made-up people in files, and manifests of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from gestures.postures import held, skeleton, slerp

from nao_sim.gestures.manifest import Manifest, Row, save_manifest
from nao_sim.motion import Skeleton

SIGNS = {  # from, to, cycles a second
    "wave": (("down", "piUp"), ("down", "side"), 1.3),
    "clap": (("forward", "forward"), ("side", "side"), 1.0),
    "left_knock": (("forward", "down"), ("piUp", "down"), 1.6),
}
POSES = {"side": ("side", "side"), "up": ("up", "up"), "left_up": ("up", "down"), "piUp": ("piUp", "piUp")}


def moving(name: str, user: int, seconds: float = 1.6) -> Skeleton:
    """A person who repeats a movement; each user differs in speed, phase, extent and noise."""
    start, end, speed = SIGNS[name]
    random = np.random.default_rng(user)
    times = np.arange(0.0, seconds, 1.0 / 30.0)
    phase, speed = random.uniform(0.0, 2.0 * np.pi), speed * random.uniform(0.8, 1.25)
    share = 0.5 - random.uniform(0.35, 0.5) * np.cos(2.0 * np.pi * speed * times + phase)
    return skeleton(np.stack([slerp(held(*start), held(*end), value) for value in share]), noise=0.004, seed=user)


def holding(name: str, user: int, seconds: float = 0.8) -> Skeleton:
    """A person who holds a pose."""
    return skeleton(np.repeat(held(*POSES[name])[None], round(30 * seconds), axis=0), noise=0.006, seed=user)


def shown(name: str, user: int) -> Skeleton:
    """A person who shows a pose or a movement, or hangs the arms where there is none of that name."""
    if name in SIGNS:
        return moving(name, user)
    return holding(name, user) if name in POSES else skeleton(np.repeat(held("down")[None], 30, axis=0), seed=user)


def write_person(person: Skeleton, path: Path) -> Path:
    """A table with a header of joints and axes, in metres, x forward, y left, z up."""
    names = [f"{joint}_{axis}" for joint in person.joints for axis in "xyz"]
    lines = [",".join(["time", *names])]
    for time, frame in zip(person.times, person.positions, strict=True):
        lines.append(",".join(f"{value:.6f}" for value in (time, *frame.ravel())))
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def write_set(folder: Path, names: tuple[str, ...], users: range, name: str = "gestures.csv") -> Manifest:
    """A recording of each gesture by each user, and their manifest."""
    rows = []
    for user in users:
        for gesture in names:
            write_person(shown(gesture, user), folder / f"{gesture}_{user}.csv")
            rows.append(Row(f"{gesture}_{user}.csv", label=gesture, user=f"user{user}"))
    manifest = Manifest(folder / name, tuple(rows))
    save_manifest(manifest)
    return manifest
