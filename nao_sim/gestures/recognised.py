"""The gestures recognised in a recording, and what the robot does for them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from nao_sim.errors import UsageError
from nao_sim.gestures.directions import readings_of_skeleton
from nao_sim.gestures.gesture_stream import stream_gestures
from nao_sim.gestures.performing import perform_gestures
from nao_sim.gestures.streaming import Decision, Segment, segments_of
from nao_sim.gestures.vocabulary import Vocabulary
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.robot import Array, Robot


@dataclass(frozen=True, eq=False)
class Recognised:
    """A recording in which gestures were recognised, frame after frame as in a stream.

    Attributes:
        person: who shows them.
        vocabulary: what could be recognised.
        decisions: (T,) of the person's frames.
    """

    person: Skeleton
    vocabulary: Vocabulary
    decisions: tuple[Decision, ...]

    @cached_property
    def segments(self) -> tuple[Segment, ...]:
        """The gestures, from when they were announced to when that ended."""
        return segments_of(self.decisions)

    def performed(self, robot: Robot, rest: Array) -> JointTrajectory:
        """What the robot is asked to do, with `rest` (26,) between gestures."""
        return perform_gestures(self.vocabulary, self.decisions, robot, rest)

    def has_motion(self, label: str) -> bool:
        """Whether the robot has a motion for a gesture."""
        return self.vocabulary.motion_of(label) is not None

    @property
    def notes(self) -> tuple[str, ...]:
        """What a user should know."""
        if not self.segments:
            return ("no gesture of the vocabulary was recognised: the robot rests",)
        lacking = sorted({each.label for each in self.segments if not self.has_motion(each.label)})
        return (f"no motion for {', '.join(lacking)}: the robot rests instead",) if lacking else ()

    def as_report(self) -> dict[str, Any]:
        """As the JSON has it; times are those of the recording, from its first frame on."""
        first = self.decisions[0].time
        rows = [
            {
                "label": each.label,
                "start_s": round(each.start - first, 3),
                "end_s": round(each.end - first, 3),
                "confidence": round(each.confidence, 3),
                "has_motion": self.has_motion(each.label),
            }
            for each in self.segments
        ]
        return {"vocabulary": list(self.vocabulary.names), "segments": rows}


def recognise(person: Skeleton, vocabulary: Vocabulary) -> Recognised:
    """Recognise the gestures of a recording.

    Raises:
        UsageError: no arm of the person is tracked.
    """
    if not (readings_of_skeleton(person).trust > 0.0).any():
        raise UsageError(f"no arm to recognise gestures of: only {', '.join(person.joints)}")
    return Recognised(person, vocabulary, stream_gestures(vocabulary, person))
