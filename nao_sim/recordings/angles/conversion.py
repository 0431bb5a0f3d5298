"""From one joint-angle format to another, and what that costs: measured, not assumed."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.files import beside, check_results
from nao_sim.motion import JointTrajectory
from nao_sim.recordings.angles.writing import check_extension, write_draft
from nao_sim.recordings.recording import Recording
from nao_sim.recordings.registry import load, read
from nao_sim.recordings.source import Source
from nao_sim.robot import load_robot

ROUNDING = 1e-9  # s, rad or opening: less is no loss worth a word


@dataclass(frozen=True)
class Loss:
    """How a motion that was read back differs from the one that was written.

    Attributes:
        joints: names of those that are no longer there.
        frames: how many there were, and how many there are.
        time: s, by which a frame moved at most.
        angle: rad, by which a joint is off at most, at the old frames.
        opening: of a hand, likewise.
        filled: values that asked nothing and now ask something.
        emptied: values that asked something and now ask nothing.
        labels: names of stretches or poses that are no longer there.
    """

    joints: tuple[str, ...]
    frames: tuple[int, int]
    time: float
    angle: float
    opening: float
    filled: int
    emptied: int
    labels: int

    @property
    def told(self) -> tuple[str, ...]:
        """Each difference in a few words; none where the motion is the same but for rounding."""
        before, after = self.frames
        words = {
            f"joints that ask nothing are not kept: {', '.join(self.joints)}": self.joints,
            f"{before} frames became {after}": before != after,
            f"times moved by up to {1000.0 * self.time:.3g} ms": self.time > ROUNDING,
            f"angles changed by up to {np.degrees(self.angle):.2g} deg": self.angle > ROUNDING,
            f"hand openings changed by up to {self.opening:.2g}": self.opening > ROUNDING,
            f"{self.filled} gaps bridged: the values beside them join": self.filled,
            f"{self.emptied} values gone": self.emptied,
            f"names of poses or gestures are not kept ({self.labels})": self.labels,
        }
        return tuple(text for text, holds in words.items() if holds)


def measure(before: Recording, after: Recording) -> Loss:
    """Compare a motion with what was read back of it."""
    old, new = before.motion, after.motion
    assert isinstance(old, JointTrajectory) and isinstance(new, JointTrajectory), "convert() takes no others"
    robot, shift = load_robot(), max(0.0, -float(old.times[0]))  # writers that know no time before 0 begin there
    same = len(old) == len(new)
    times = np.abs(new.times - old.times) if same else np.array([shift])
    positions = new.positions if same else new.sample(old.times + shift)
    kept = old.given & new.given
    was, now = np.isfinite(old.positions[:, kept]), np.isfinite(positions[:, kept])
    with np.errstate(invalid="ignore"):
        off = np.where(was & now, np.abs(positions - old.positions)[:, kept], 0.0)
    return Loss(
        joints=tuple(np.array(robot.joint_names)[old.given & ~new.given].tolist()),
        frames=(len(old), len(new)),
        time=float(times.max()),
        angle=float(off[:, ~robot.is_hand[kept]].max(initial=0.0)),
        opening=float(off[:, robot.is_hand[kept]].max(initial=0.0)),
        filled=int((now & ~was).sum()),
        emptied=int((was & ~now).sum()),
        labels=len({label.name for label in before.labels} - {label.name for label in after.labels}),
    )


def convert(source: Source, target: Path) -> tuple[Recording, Recording, Loss]:
    """Read joint angles and write them in the format of the target's extension.

    Args:
        source: the file to read, which stays as it is.
        target: the file to write, replaced if it is there.

    Returns:
        What was read, what the written file holds, and how that differs.

    Raises:
        RecordingError: the source cannot be read.
        UsageError: it is a person's recording; or the target is the source, or
            of no format that is written, or cannot be written.
    """
    check_extension(target)
    check_results([target], source.path)
    before = read(source)
    if not isinstance(before.motion, JointTrajectory):
        raise UsageError(
            f"{source.path}: a person's recording ({before.format}); expected joint angles of a NAO "
            f"(nao-sim retarget {source.path} -o angles.csv makes them)"
        )
    with beside(target) as draft:
        write_draft(draft, before.motion)
        after = load(draft)
    return before, after, measure(before, after)
