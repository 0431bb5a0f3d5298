"""Make the sample motions of this folder: `python trajectories/make_trajectories.py [--check]`.

Every motion is a table of postures at times, joined by minimum jerk; `stress.csv`
is in `stress.py`, the person of `person_wave.csv` in `waving_person.py`.  With
`--check` nothing is written: the exit status says whether the files are what this
program makes.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from itertools import pairwise
from pathlib import Path

import numpy as np
from stress import COMMENTS as STRESS_COMMENTS
from stress import stress, stress_text
from waving_person import kinect_text, minimum_jerk, waving_person

from nao_sim.motion import JointTrajectory
from nao_sim.recordings import joint_csv_text
from nao_sim.robot import Array, load_robot

FOLDER = Path(__file__).resolve().parent
RATE = 50.0  # Hz
DECIMALS = 3
ORIGIN = "Made by trajectories/make_trajectories.py of nao_sim; no recorded data in it."
PERSON = "A made-up person in front of a Kinect v2: waves, points and opens both arms."
ROBOT = load_robot()

# Arms, as the left one's angles in degrees and its hand's opening.
ARM = ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw", "Hand")
REST = (80.2, 17.2, -79.6, -57.9, 0.0, 0.25)  # the arms of StandInit
SIDE = (0.0, 72.0, -80.0, -6.0, 0.0, 0.6)
FORWARD = (0.0, 5.0, -80.0, -6.0, 0.0, 0.6)
PI_UP = (0.0, 70.0, -90.0, -85.0, 0.0, 0.6)
UP = (-85.0, 10.0, -80.0, -6.0, 0.0, 0.6)
DOWN = (88.0, 14.0, -80.0, -6.0, 0.0, 0.3)
WAVING = (-75.0, 55.0, 0.0, -55.0, 0.0, 0.9)
RELAXED = (78.0, 22.0, -72.0, -64.0, -15.0, 0.45)
WELCOME = (45.0, 34.0, -72.0, -55.0, -80.0, 0.9)
APART = (35.0, 28.0, -75.0, -62.0, -60.0, 0.7)
TOGETHER = (35.0, -6.0, -75.0, -62.0, -60.0, 0.7)
HELD_OUT = (15.0, 12.0, -85.0, -20.0, -70.0, 0.9)
DRAWN_IN = (25.0, 14.0, -85.0, -78.0, -70.0, 0.3)
HELLO = (-20.0, 42.0, -58.0, -80.0, -10.0, 0.9)

Posture = Mapping[str, float]
Keyframes = list[tuple[float, Posture]]


def left(arm: tuple[float, ...]) -> Posture:
    """Joint angles (deg) of the left arm."""
    return {"L" + name: value for name, value in zip(ARM, arm, strict=True)}


def right(arm: tuple[float, ...]) -> Posture:
    """Joint angles (deg) of the right arm, in the mirror of the left."""
    signs = dict(zip(ROBOT.joint_names, ROBOT.mirror_sign.tolist(), strict=True))
    return {"R" + name: value * signs["R" + name] for name, value in zip(ARM, arm, strict=True)}


def both(arm: tuple[float, ...]) -> Posture:
    """Joint angles (deg) of both arms."""
    return {**left(arm), **right(arm)}


def head(yaw: float, pitch: float) -> Posture:
    """Joint angles (deg) of the head."""
    return {"HeadYaw": yaw, "HeadPitch": pitch}


def through(keyframes: Keyframes) -> dict[str, Array]:
    """Angles over time: each keyframe is reached at its time (s); one that does not name a joint holds it."""
    times = clock(keyframes)
    angles = {name: np.full(len(times), value) for name, value in keyframes[0][1].items()}
    for (start, _), (end, posture) in pairwise(keyframes):
        progress = minimum_jerk((times - start) / (end - start))
        for name, value in posture.items():
            angles[name] = angles[name] + progress * (value - angles[name][-1])
    return angles


def clock(keyframes: Keyframes) -> Array:
    """Sample times (s) from 0 to the last keyframe."""
    return np.arange(round(keyframes[-1][0] * RATE) + 1) / RATE


def trajectory(times: Array, angles: Mapping[str, Array]) -> JointTrajectory:
    """The joint trajectory of angles in degrees (hands 0..1)."""
    positions = np.full((len(times), len(ROBOT.joint_names)), np.nan)
    for name, values in angles.items():
        joint = ROBOT.index[name]
        positions[:, joint] = values / ROBOT.report_unit(joint)
    return JointTrajectory(times, positions, np.isfinite(positions).any(axis=0))


def gesture(posture: Posture) -> JointTrajectory:
    """From rest to a posture of the arms, a hold of two seconds, and back."""
    start = both(REST)
    keyframes: Keyframes = [(0.0, start), (0.4, {}), (2.2, posture), (4.2, {}), (6.0, start), (6.4, {})]
    return trajectory(clock(keyframes), through(keyframes))


def gestures() -> dict[str, str]:
    """Name and text of the robot's motion for every gesture of both arms, and of one of them."""
    arms = {"side": SIDE, "forward": FORWARD, "piUp": PI_UP, "up": UP, "down": DOWN}
    postures = {name: both(arm) for name, arm in arms.items()}
    for side, of_side in (("left", left), ("right", right)):
        postures |= {f"{side}_{name}": of_side(arm) for name, arm in arms.items() if name != "down"}
    held = {
        name: plain(lambda posture=posture: gesture(posture), f"Gesture '{name}': there, a hold of 2 s, and back.")
        for name, posture in postures.items()
    }
    moved = {name: plain(make, f"Gesture '{name}': {what}.") for name, (what, make) in MOVEMENTS.items()}
    return {f"gestures/{name}.csv": text for name, text in (held | moved).items()}


def waving(arm: Callable[[tuple[float, ...]], Posture], prefix: str, outward: float) -> JointTrajectory:
    """One hand is raised and waves three times."""
    start = both(REST)
    keyframes: Keyframes = [(0.0, start), (0.2, {}), (2.0, arm(WAVING)), (4.8, {}), (6.6, start), (6.8, {})]
    times, angles = clock(keyframes), through(keyframes)
    swing = minimum_jerk((times - 1.7) / 0.7) * minimum_jerk((5.0 - times) / 0.7)
    phase = 2.0 * np.pi * 1.0 * (times - 1.7)
    angles[prefix + "ElbowRoll"] -= outward * 22.0 * swing * np.sin(phase)
    angles[prefix + "ShoulderRoll"] -= outward * 4.0 * swing * np.sin(phase)
    return trajectory(times, angles)


def clapping() -> JointTrajectory:
    """Both hands before the chest go apart and together three times, and do not touch."""
    keyframes: Keyframes = [(0.0, both(REST)), (0.2, {}), (1.4, both(APART))]
    for beat in range(3):
        keyframes += [(1.9 + 1.0 * beat, both(TOGETHER)), (2.4 + 1.0 * beat, both(APART))]
    keyframes += [(5.6, both(REST)), (5.8, {})]
    return trajectory(clock(keyframes), through(keyframes))


def nodding() -> JointTrajectory:
    """The head nods twice, the arms a little open."""
    start = {**both(REST), **head(0.0, 0.0)}
    keyframes: Keyframes = [(0.0, start), (0.2, {}), (0.8, {**both(RELAXED), **head(0.0, -8.0)})]
    keyframes += [(1.4, head(0.0, 16.0)), (2.0, head(0.0, -6.0)), (2.6, head(0.0, 14.0)), (3.4, start), (3.6, {})]
    return trajectory(clock(keyframes), through(keyframes))


def beckoning(arm: Callable[[tuple[float, ...]], Posture]) -> JointTrajectory:
    """One hand, held out, comes back to the shoulder three times."""
    keyframes: Keyframes = [(0.0, both(REST)), (0.2, {}), (1.4, arm(HELD_OUT))]
    for beat in range(3):
        keyframes += [(2.1 + 1.3 * beat, arm(DRAWN_IN)), (2.75 + 1.3 * beat, arm(HELD_OUT))]
    keyframes += [(6.8, both(REST)), (7.0, {})]
    return trajectory(clock(keyframes), through(keyframes))


def wave() -> JointTrajectory:
    """The right hand waves four times; head, hand and the other arm take part."""
    keyframes: Keyframes = [
        (0.0, {**both(REST), **head(0.0, 0.0)}),
        (0.3, {}),
        (1.8, {**right(WAVING), **left(RELAXED), **head(-16.0, -9.0)}),
        (5.6, {}),
        (7.2, {**both(REST), **head(0.0, 0.0)}),
        (7.5, {}),
    ]
    times, angles = clock(keyframes), through(keyframes)
    swing = minimum_jerk((times - 1.5) / 0.7) * minimum_jerk((5.8 - times) / 0.7)
    phase = 2.0 * np.pi * 1.1 * (times - 1.5)
    angles["RElbowRoll"] += 22.0 * swing * np.sin(phase)
    angles["RShoulderRoll"] += 4.0 * swing * np.sin(phase)
    angles["RWristYaw"] += 8.0 * swing * np.sin(phase - 0.6)
    angles["HeadYaw"] += 4.0 * swing * np.sin(phase / 2.0)
    angles["LElbowRoll"] += 4.0 * swing * np.sin(phase / 2.0)
    return trajectory(times, angles)


def arm_circles() -> JointTrajectory:
    """Both arms draw two circles beside the body, then two the other way."""
    start = (0.0, 18.0, -80.0, -8.0, 0.0, 0.6)
    keyframes: Keyframes = [
        (0.0, both(REST)),
        (0.4, {}),
        (2.0, both(start)),
        (12.4, {}),
        (14.0, both(REST)),
        (14.4, {}),
    ]
    times, angles = clock(keyframes), through(keyframes)
    turns = 2.0 * (minimum_jerk((times - 2.1) / 5.0) - minimum_jerk((times - 7.3) / 5.0))
    phase = 2.0 * np.pi * turns
    for side, outward in (("L", 1.0), ("R", -1.0)):
        angles[side + "ShoulderPitch"] -= 33.0 * np.sin(phase)
        angles[side + "ShoulderRoll"] += outward * 27.0 * (1.0 - np.cos(phase))
    return trajectory(times, angles)


def greeting() -> JointTrajectory:
    """Open arms and a nod, then a raised right hand with a second, smaller nod."""
    keyframes: Keyframes = [
        (0.0, {**both(REST), **head(0.0, 0.0)}),
        (0.3, {}),
        (1.7, {**both(WELCOME), **head(0.0, -8.0)}),
        (2.0, {}),
        (2.6, head(0.0, 16.0)),
        (3.2, head(0.0, -6.0)),
        (4.5, {**right(HELLO), **left(REST), **head(-12.0, -8.0)}),
        (5.0, head(-12.0, 6.0)),
        (5.5, head(-8.0, -6.0)),
        (5.9, {}),
        (7.2, {**both(REST), **head(0.0, 0.0)}),
        (7.5, {}),
    ]
    return trajectory(clock(keyframes), through(keyframes))


MOVEMENTS: Mapping[str, tuple[str, Callable[[], JointTrajectory]]] = {
    "left_wave": ("the hand is raised and waves", lambda: waving(left, "L", 1.0)),
    "right_wave": ("the hand is raised and waves", lambda: waving(right, "R", -1.0)),
    "left_come": ("the hand beckons", lambda: beckoning(left)),
    "right_come": ("the hand beckons", lambda: beckoning(right)),
    "clap": ("the hands go together and apart, and do not touch", clapping),
    "nod": ("the head nods", nodding),
}


def plain(make: Callable[[], JointTrajectory], title: str) -> str:
    """A motion as a file's text."""
    return joint_csv_text(make(), (title, ORIGIN), DECIMALS)


def files() -> dict[str, str]:
    """Name and text of every file that this program makes."""
    made = gestures()
    made["wave.csv"] = plain(wave, "A friendly wave of the right hand.")
    made["arm_circles.csv"] = plain(arm_circles, "Both arms draw circles beside the body, two each way.")
    made["greeting.csv"] = plain(greeting, "A greeting: open arms and a nod, then a raised hand.")
    made["person_wave.csv"] = kinect_text(*waving_person(), (PERSON, ORIGIN))
    made["stress.csv"] = stress_text(stress(), (*STRESS_COMMENTS, ORIGIN), DECIMALS)
    return made


def main(arguments: list[str]) -> int:
    """Write the files, or with `--check` compare them."""
    different = []
    for name, text in files().items():
        path = FOLDER / name
        if not path.exists() or path.read_bytes() != text.encode():
            different.append(name)
            if arguments != ["--check"]:
                path.write_text(text, encoding="utf-8", newline="\n")
    print(f"{'differ' if arguments == ['--check'] else 'written'}: {', '.join(different) or 'none'}")
    return 1 if different and arguments == ["--check"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
