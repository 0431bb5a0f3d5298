"""Choregraphe timelines: behaviours (.xar), projects that name them (.pml), and animations (.qianim).

A key stands at (frame - start_frame) / fps, angles are in degrees, hands run
from 0 to 1, and the curves between keys are NAOqi's Bezier curves (libqicore,
libqicore-compat/src/timeline.cpp).  Of several timelines the longest is read:
which one runs when is decided on the robot, by the boxes' programs.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import PurePosixPath

import numpy as np

from nao_sim.errors import RecordingError
from nao_sim.recordings.angles.fixed_options import refuse_options
from nao_sim.recordings.angles.keyframes import AFTER, BEFORE, RATE, Curve, trajectory
from nao_sim.recordings.angles.timeline_xml import ActuatorCurve, Behaviour, Document, Key, Timeline, parse
from nao_sim.recordings.recording import Label, Recording
from nao_sim.recordings.source import Source
from nao_sim.robot import Array, load_robot

NAME = "Choregraphe timeline"
LOOKS = "an XML element <ChoregrapheProject>, <Timeline>, <Animation> or <Package>"
ROOTS = ("ChoregrapheProject", "ChoregrapheBox", "Timeline", "Animation", "Package")
DEGREES, OPENING, RADIANS = ("0", "degree"), ("1", "dimensionless"), ("radian",)  # as .xar and .qianim have them
PERCENT = 2.0  # an opening above this can only be percent
SIDES = {"left": BEFORE, "right": AFTER}
LISTED = 5  # timelines named in a note
_ROOT = re.compile(
    rb"""\s* (?: <\?[^>]*>\s* | <!--(?:[^-]|-(?!->))*-->\s* | <!DOCTYPE[^>\[]*(?:\[[^\]]*\])?\s*>\s* )* <(\w+)[\s/>]""",
    re.VERBOSE,
)


@dataclass(frozen=True, eq=False)
class _Motion:
    """A timeline that moves something.

    Attributes:
        source: the file that it stands in.
        timeline: as it stands there.
        name: for the user.
        curves: of its joints, in seconds and the joints' units.
        end: s, when it stops.
        notes: what a user should know of it.
    """

    source: Source
    timeline: Timeline
    name: str
    curves: list[Curve]
    end: float
    notes: tuple[str, ...]

    @property
    def seconds(self) -> float:
        """From time 0 to the last key, or the end."""
        return min(self.end, max(float(curve.times[-1]) for curve in self.curves))


def recognise(source: Source) -> str | None:
    """Why the file is one of Choregraphe's, or None."""
    match = _ROOT.match(source.start.removeprefix(b"\xef\xbb\xbf"))
    root = match[1].decode() if match else ""
    return f"the XML element <{root}> is Choregraphe's" if root in ROOTS else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file.
        reason: why it is taken for this format.

    Returns:
        The recording: the longest timeline, sampled at `RATE` and at its keys.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    refuse_options(source, "a Choregraphe timeline", "deg")
    document = parse(source)
    motions = _motions(source, document.timelines)
    missing: list[Behaviour] = []
    for behaviour in document.behaviours:
        beside = _beside(source, behaviour)
        if beside is None:
            missing.append(behaviour)
        else:
            motions += _motions(beside, parse(beside).timelines, behaviour.path)
    if not motions:
        raise _without_motion(source, document, missing)
    longest = max(motions, key=lambda motion: motion.seconds)
    motion = trajectory(longest.source, longest.curves, longest.end)
    keys = np.unique(np.concatenate([curve.times for curve in longest.curves]))
    label = Label(longest.timeline.box or longest.source.path.stem, float(motion.times[0]), float(motion.times[-1]))
    notes = (*_choice(longest, motions, missing), *longest.notes)
    return Recording(source.path, NAME, reason, motion, len(keys), notes, (label,))


def _beside(source: Source, behaviour: Behaviour) -> Source | None:
    """The behaviour's file, None where there is none; refuse one out of the project's folder."""
    path = PurePosixPath(behaviour.path.replace("\\", "/"))
    if not path.parts or path.is_absolute() or ".." in path.parts or ":" in behaviour.path:
        raise source.error(f"behaviour '{behaviour.path}'", "a path inside the project's folder", behaviour.line)
    beside = replace(source, path=source.path.parent / path)
    try:
        return beside if beside.path.is_file() else None
    except OSError:  # no name that a file can have
        return None


def _without_motion(source: Source, document: Document, missing: Sequence[Behaviour]) -> RecordingError:
    if missing:
        found = f"behaviour '{missing[0].path}', which is not beside it"
        return source.error(found, "the behaviours (.xar) that the project names", missing[0].line)
    found = "a project without motion" if document.behaviours else "no motion"
    line = document.timelines[0].line if document.timelines else None
    return source.error(found, "a Timeline with an ActuatorCurve that has keys and is not muted", line)


def _motions(source: Source, timelines: Sequence[Timeline], behaviour: str = "") -> list[_Motion]:
    """The timelines that move something."""
    motions = []
    for timeline in sorted(timelines, key=lambda timeline: timeline.line):
        played = [curve for curve in timeline.curves if curve.keys and not curve.muted]
        if played:
            motions.append(_motion(source, timeline, played, behaviour))
    return motions


def _motion(source: Source, timeline: Timeline, played: Sequence[ActuatorCurve], behaviour: str) -> _Motion:
    _check_actuators(source, played)
    curves = [curve for row in played if (curve := _curve(source, timeline, row)) is not None]
    if not curves:
        raise source.error("keys before the start frame only", "a key to play", timeline.line)
    end = np.inf
    if timeline.end >= 1.0:
        end = (timeline.end - timeline.start) / _fps(source, timeline, timeline.curves[0])
        if end < min(curve.times[0] for curve in curves):
            raise source.error(f"an end at frame {timeline.end:g}, before any key", "a key to play", timeline.line)
    name = " ".join(part for part in (behaviour, f"'{timeline.box}'" if timeline.box else "") if part)
    return _Motion(source, timeline, name or source.path.name, curves, end, _notes(timeline, played, curves, end))


def _check_actuators(source: Source, played: Sequence[ActuatorCurve]) -> None:
    seen: dict[str, int] = {}
    for row in played:
        if row.actuator not in load_robot().index:
            raise source.error("unknown actuator", "a NAOqi joint of NAO", row.line, row.actuator or "actuator")
        if row.actuator in seen:
            found = f"another curve (the first is in line {seen[row.actuator]})"
            raise source.error(found, "each joint once", row.line, row.actuator)
        seen[row.actuator] = row.line


def _fps(source: Source, timeline: Timeline, row: ActuatorCurve) -> float:
    fps = row.fps or timeline.fps
    if fps is None or fps <= 0.0:
        found = "no fps" if fps is None else f"{fps:g} frames a second"
        raise source.error(found, "a positive fps", timeline.line)
    return fps


def _curve(source: Source, timeline: Timeline, row: ActuatorCurve) -> Curve | None:
    """A curve in seconds and in its joint's unit; None where all keys are before the start frame, as NAOqi has it."""
    keys = [key for key in row.keys if key.frame >= timeline.start]
    if not keys:
        return None
    frames, values = np.array([key.frame for key in keys]), np.array([key.value for key in keys])
    if (wrong := np.diff(frames) <= 0.0).any():
        key, before = keys[int(wrong.argmax()) + 1], keys[int(wrong.argmax())]
        raise source.error(f"frame {key.frame:g}", f"a frame after {before.frame:g}", key.line, row.actuator)
    fps, factor = _fps(source, timeline, row), _factor(source, row, float(values.max()))
    handles = np.array([_handles(source, row, key) for key in keys]) * [1.0 / fps, factor]
    held = np.array([key.tangents["right"].kind == "constant" if "right" in key.tangents else False for key in keys])
    joint = load_robot().index[row.actuator]
    return Curve(joint, (frames - timeline.start) / fps, values * factor, handles, held)


def _factor(source: Source, row: ActuatorCurve, largest: float) -> float:
    """From the curve's unit to the joint's; without a unit angles are degrees, as NAOqi takes them."""
    is_hand = load_robot().is_hand[load_robot().index[row.actuator]]
    if row.unit not in ("", *(OPENING if is_hand else (*DEGREES, *RADIANS))):
        expected = "1 or 'dimensionless' for a hand" if is_hand else "0, 'degree' or 'radian' for an angle"
        raise source.error(f"unit '{row.unit}'", expected, row.line, row.actuator)
    if is_hand:
        return 0.01 if largest > PERCENT else 1.0
    return 1.0 if row.unit in RADIANS else float(np.radians(1.0))


def _handles(source: Source, row: ActuatorCurve, key: Key) -> Array:
    """Offsets (2, 2) of the handles before and after a key, in frames and the curve's unit; nan: automatic."""
    handles = np.full((2, 2), np.nan)
    for side, tangent in key.tangents.items():
        way = -tangent.frames if side == "left" else tangent.frames
        if tangent.kind not in ("bezier", "linear", "constant"):
            raise source.error(f"interpType '{tangent.kind}'", "bezier, linear or constant", key.line, row.actuator)
        if tangent.kind == "bezier" and way < 0.0:
            found = f"a {side} tangent of {tangent.frames:g} frames"
            raise source.error(found, "one that points away from its key", key.line, row.actuator)
        handles[SIDES[side]] = (tangent.frames, tangent.value) if tangent.kind == "bezier" else (0.0, 0.0)
    return handles


def _choice(longest: _Motion, motions: Sequence[_Motion], missing: Sequence[Behaviour]) -> tuple[str, ...]:
    """What was read, and what was not."""
    notes = [f"timeline {longest.name}, its curves sampled at {RATE:g} Hz"]
    others = [f"{motion.name} ({motion.seconds:.1f} s)" for motion in motions if motion is not longest]
    if others:
        more = f" and {len(others) - LISTED} more" if len(others) > LISTED else ""
        notes.append(f"the longest of {len(motions)} timelines; not read: {', '.join(others[:LISTED])}{more}")
    if missing:
        notes.append(f"not beside the project: {', '.join(behaviour.path for behaviour in missing[:LISTED])}")
    return tuple(notes)


def _notes(timeline: Timeline, played: Sequence[ActuatorCurve], curves: Sequence[Curve], end: float) -> tuple[str, ...]:
    early = sum(key.frame < timeline.start for row in played for key in row.keys)
    late = sum(int((curve.times > end).sum()) for curve in curves)
    hands = load_robot().is_hand
    percent = [row.actuator for row in played if hands[load_robot().index[row.actuator]]
               and max(key.value for key in row.keys) > PERCENT]  # fmt: skip
    muted = [curve.actuator for curve in timeline.curves if curve.muted]
    starts = {float(curve.times[0]) for curve in curves}
    notes = {
        "Choregraphe would not play it: it is disabled": not timeline.enabled,
        f"muted, so not read: {', '.join(muted)}": muted,
        f"{early} keys before the start frame are not played": early,
        f"{late} keys after the end frame are not reached": late,
        f"openings above {PERCENT:g}, taken as percent: {', '.join(percent)}": percent,
        "joints hold their first key until its time": len(starts) > 1,
    }
    return tuple(note for note, holds in notes.items() if holds)
