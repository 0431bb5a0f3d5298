"""People as sensors see them, and whoever sends them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import suppress

import numpy as np

from nao_sim.live.host import Host, Inward, Outward
from nao_sim.live.moment import Moment
from nao_sim.live.person import layouts
from nao_sim.live.problem import LiveError
from nao_sim.live.protocol import Frame, Hello
from nao_sim.live.session import Session
from nao_sim.motion import Skeleton
from nao_sim.recordings.skeletons.layouts import axis
from tests.people import person

STEP = 0.02
RATE = 30.0


def points_of(skeleton: Skeleton, layout: str = "mediapipe_pose", unit: float = 1.0) -> np.ndarray:
    """The person (T, P, 3) in a layout's order and axes; nan for points that are no joints."""
    known = layouts()[layout]
    forward, left, up = (axis(signed) for signed in known.axes or ("+x", "+y", "+z"))
    points = np.full((len(skeleton), len(known), 3), np.nan)
    for place, joint in enumerate(known.joints):
        if joint in skeleton.joints:
            x, y, z = np.moveaxis(skeleton.track(joint), -1, 0)
            points[:, place] = x[:, None] * forward + y[:, None] * left + z[:, None] * up
    return points / unit


def frames(count: int = 60, seed: int = 0, layout: str = "mediapipe_pose", **how: float) -> list[Frame]:
    """Frames of a made-up person, the first at 100 s of the sender's clock."""
    points = points_of(person(count, seed, **how), layout)  # type: ignore[arg-type]
    return [Frame(100.0 + i / RATE, each, np.ones(len(each))) for i, each in enumerate(points)]


def as_text(frame: Frame, **more: object) -> str:
    """A frame as a JSON text, null where there is no number."""
    points = [None if np.isnan(point).any() else [*point.tolist(), 1.0] for point in frame.points]
    return json.dumps({"type": "frame", "time": frame.time, "points": points, **more})


def run(session: Session, coming: list[tuple[float, Frame]], seconds: float, start: float = 0.0) -> Iterator[Moment]:
    """Feed frames at the times (s) at which they come, and step at 50 Hz."""
    waiting = sorted(coming, key=lambda each: each[0])
    for step in range(round(seconds / STEP)):
        now = start + step * STEP
        while waiting and waiting[0][0] <= now:
            came, frame = waiting.pop(0)
            with suppress(LiveError):  # as a host tells it to the sender
                session.receive(frame, came)
        yield session.step(now)


def at_their_times(sent: list[Frame]) -> list[tuple[float, Frame]]:
    """Frames that come at once, the first at 0 s."""
    return [(frame.time - sent[0].time, frame) for frame in sent]


def opened(host: Host, name: str = "a", now: float = 0.0, **hello: object) -> list[Outward]:
    """Open a robot."""
    return host.take([Inward(name, "open", came=now, hello=Hello(**hello))], now)  # type: ignore[arg-type]


def told(host: Host, data: str | bytes, name: str = "a", now: float = 0.0) -> list[dict]:
    """What a robot answers to a message."""
    return [json.loads(out.text) for out in host.take([Inward(name, "message", data, now)], now)]
