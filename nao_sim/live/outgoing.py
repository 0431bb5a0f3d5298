"""What a server says: every message as a JSON text. docs/live.md shows each."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from nao_sim.console import REASONS
from nao_sim.live.moment import Command, Moment
from nao_sim.live.person import layouts
from nao_sim.live.problem import LiveError
from nao_sim.live.protocol import LARGEST, MODES, VERSION, Hello
from nao_sim.robot import Array, Robot
from nao_sim.simulation.simulator import CONTROL_STEP

DIGITS = 4  # of rad and m: a hundredth of a degree, a tenth of a millimetre
PART = 32 * 1024  # characters of a recording in a message


def text(kind: str, **fields: Any) -> str:
    """A message."""
    return json.dumps({"type": kind, **fields}, separators=(",", ":"), allow_nan=False)


def welcome(session: str | None, hello: Hello, robot: Robot) -> str:
    """Says what a client got, and all that it needs to read what follows."""
    return text(
        "welcome",
        protocol=VERSION,
        role=hello.role,
        session=session,
        layout=hello.layout,
        mode=hello.mode,
        mirror=hello.mirror,
        robot=robot.version,
        joints=robot.joint_names,
        lower=rounded(robot.lower),
        upper=rounded(robot.upper),
        step_s=CONTROL_STEP,
        rate=hello.rate,
        layouts=list(layouts()),
        modes=MODES,
        largest_message=LARGEST,
    )


def error(problem: LiveError, fatal: bool = False) -> str:
    """Says what was wrong, and whether the connection ends."""
    return text("error", code=problem.code, message=str(problem), fatal=fatal)


def state(moment: Moment, noticed: Iterable[tuple[str, Sequence[str], Sequence[int]]], robot: Robot) -> str:
    """The robot after a control step."""
    decision, known = moment.decision, moment.errors[np.isfinite(moment.errors)]
    return text(
        "state",
        step=moment.step,
        time=round(moment.time, 3),
        frame_time=finite(moment.frame_time, 6),
        age=finite(moment.age),
        requested=rounded(moment.requested),
        commanded=rounded(moment.commanded),
        simulated=rounded(moment.simulated),
        base=rounded(moment.base_pose),
        light=vars(moment.light),
        interventions=[_intervention(*each, moment, robot) for each in noticed],
        gesture=None if decision is None else {"label": decision.label, "confidence": finite(decision.confidence, 3)},
        similarity={
            "cosine": finite(np.cos(known).mean()) if len(known) else None,
            "error_deg": finite(np.degrees(known.mean()), 2) if len(known) else None,
        },
        flags=moment.flags,
        frames=vars(moment.counts),
    )


def _intervention(
    reason: str, links: Sequence[str], joints: Sequence[int], moment: Moment, robot: Robot
) -> Mapping[str, Any]:
    sizes = {
        robot.joint_names[joint]: finite(moment.change(reason, links)[joint] * robot.report_unit(joint), 1)
        for joint in joints
    }
    return {"reason": reason, "words": REASONS.get(reason, reason), "links": list(links), "changed_deg": sizes}


def command(told: Command) -> str:
    """What a robot is told at a control step."""
    return text(
        "command",
        step=told.step,
        time=round(told.time, 3),
        frame_time=finite(told.frame_time, 6),
        positions=rounded(told.positions, 6),
    )


def recording(csv: bytes, frames: int) -> list[str]:
    """A recording in as many messages as it takes."""
    whole = csv.decode()
    parts = [whole[start : start + PART] for start in range(0, len(whole), PART)]
    return [
        text("recording", part=number, parts=len(parts), frames=frames, csv=part) for number, part in enumerate(parts)
    ]


def rounded(values: Array, digits: int = DIGITS) -> list[float | None]:
    """Numbers as JSON has them, null where not finite."""
    found: list[float | None] = np.round(values, digits).tolist()
    return found if np.isfinite(values).all() else [finite(value, digits) for value in found]


def finite(value: float | np.floating | None, digits: int = DIGITS) -> float | None:
    """A number as JSON has it."""
    return None if value is None or not math.isfinite(value) else round(float(value), digits)
