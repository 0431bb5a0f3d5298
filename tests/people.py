"""Made-up people that move like people: constant bones, arms and legs that bend the right way, a face and toes."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from nao_sim import body
from nao_sim.motion import Skeleton

RATE = 30.0
_MIRROR = np.array([1.0, -1.0, 1.0])
# Where points of a part are in its own frame (x forward, y left, z up), in heights of the body; hands hang down.
_HEAD = {"head": (0.0, 0.0, 0.09), "nose": (0.06, 0.0, 0.085), "left_eye": (0.05, 0.018, 0.105),
         "left_ear": (0.0, 0.043, 0.095), "neck": (0.0, 0.0, 0.0)}  # fmt: skip
_FINGERS = {"thumb": (0.022, 0.02), "index": (0.012, 0.052), "middle": (0.004, 0.054), "ring": (-0.005, 0.052),
            "pinky": (-0.014, 0.048)}  # fmt: skip
_KNUCKLES = {"thumb": ("cmc", "mcp", "ip", "tip")}


def person(  # noqa: PLR0913 (each may vary)
    frames: int = 60,
    seed: int = 0,
    *,
    height: float = 1.7,
    turning: float = 0.0,
    facing: float = 0.0,
    sitting: bool = False,
    arms: float = 1.0,
    rate: float = RATE,
    joints: tuple[str, ...] | None = None,
) -> Skeleton:
    """A person who moves arms, head and trunk smoothly, and the legs a little.

    Args:
        frames: T.
        seed: of the motion.
        height: m.
        turning: rad, how far the person turns to the left until the end.
        facing: rad, where the person faces at first, 0 for x.
        sitting: whether on a chair.
        arms: how much of their range the arms use, 0 to 1.
        rate: Hz.
        joints: which joints; all that `nao_sim.body` knows where None.

    Returns:
        The skeleton, feet at z = 0 or above, the pelvis near x = y = 0.
    """
    random = np.random.default_rng(seed)
    times = np.arange(frames) / rate
    swing = _Swing(times, random)
    yaw = facing + turning * np.linspace(0.0, 1.0, frames)
    lean = swing(-0.05, 0.25)
    torso = Rotation.from_euler("ZYX", np.column_stack([yaw, lean, swing(-0.1, 0.1)]))
    root = Rotation.from_euler("z", yaw[:, None])
    found = _trunk(torso, swing)
    for side in body.SIDES:
        found |= _leg(root, side, sitting, swing)
        found |= _arm(torso, found, side, arms, swing)
    lowest = min(float(found[f"{side}_{part}"][:, 2].min()) for side in body.SIDES for part in ("heel", "foot"))
    drift = np.column_stack([swing(-0.05, 0.05), swing(-0.05, 0.05), np.full(frames, -lowest)])
    chosen = body.joints() if joints is None else joints
    return Skeleton(times, np.stack([(found[name] + drift) * height for name in chosen], axis=1), tuple(chosen))


@st.composite
def people(draw: st.DrawFn, frames: int = 40, **fixed: object) -> Skeleton:
    """People of any height who stand or sit, turn a little or not, and move in any way."""
    told = {
        "seed": draw(st.integers(0, 2**16)),
        "height": draw(st.floats(1.15, 1.98)),
        "turning": draw(st.sampled_from([0.0, 0.0, 0.6, -0.6])),
        "sitting": draw(st.booleans()),
    }
    return person(frames, **(told | fixed))  # type: ignore[arg-type]


class _Swing:
    """Smooth random angles."""

    def __init__(self, times: np.ndarray, random: np.random.Generator) -> None:
        self._times, self._random = times, random

    def __call__(self, low: float, high: float) -> np.ndarray:
        """(T,) between `low` and `high`, around a middle of its own."""
        frequency, phase = self._random.uniform(0.1, 0.9, 3), self._random.uniform(0.0, 2 * np.pi, 3)
        waves = np.sin(2 * np.pi * frequency * self._times[:, None] + phase) @ [0.5, 0.3, 0.2]
        span = self._random.uniform(0.3, 1.0) * (high - low)
        middle = self._random.uniform(low + span / 2, high - span / 2)
        return middle + waves * span / 2


def _length(start: str, end: str) -> float:
    return next(bone.length for bone in body.bones() if (bone.start, bone.end) == (start, end))


def _trunk(torso: Rotation, swing: _Swing) -> dict[str, np.ndarray]:
    neck_height = _length("pelvis", "neck")
    half = {part: _length(f"left_{part}", f"right_{part}") / 2 for part in ("shoulder", "hip")}
    places = {"pelvis": (0.0, 0.0, 0.0), "spine": (0.0, 0.0, _length("pelvis", "spine")),
              "chest": (0.0, 0.0, _length("pelvis", "chest")), "neck": (0.0, 0.0, neck_height)}  # fmt: skip
    for side, sign in zip(body.SIDES, (1.0, -1.0), strict=True):
        places[f"{side}_shoulder"] = (0.0, sign * half["shoulder"], _length("pelvis", "chest") - 0.01)
    found = {name: torso.apply(place) for name, place in places.items()}
    for side, sign in zip(body.SIDES, (1.0, -1.0), strict=True):
        found[f"{side}_hip"] = _flat(torso).apply((0.0, sign * half["hip"], -0.02))
    head = torso * Rotation.from_euler("ZY", np.column_stack([swing(-0.5, 0.5), swing(-0.2, 0.3)]))
    for name, place in _HEAD.items():
        found[name] = found["neck"] + head.apply(place)
        if name.startswith("left_"):
            found[body.twin(name)] = found["neck"] + head.apply(np.array(place) * _MIRROR)
    return found


def _flat(torso: Rotation) -> Rotation:
    """Where the pelvis faces: the torso without its lean."""
    return Rotation.from_euler("z", torso.as_euler("ZYX")[:, :1])


def _bend(pitch: np.ndarray) -> Rotation:
    """Turn what hangs down forwards."""
    return Rotation.from_euler("y", -pitch[:, None])


def _leg(root: Rotation, side: str, sitting: bool, swing: _Swing) -> dict[str, np.ndarray]:
    flip = np.ones(3) if side == "left" else _MIRROR
    hip = np.array([0.0, _length("left_hip", "right_hip") / 2, -0.02])
    thigh = _bend(swing(1.3, 1.6) if sitting else swing(0.0, 0.35))
    thigh = Rotation.from_euler("x", swing(0.0, 0.12)[:, None]) * thigh
    shank = thigh * _bend(-(swing(1.2, 1.5) if sitting else swing(0.05, 0.4)))
    foot = shank * _bend(swing(-0.2, 0.1))
    knee = hip + thigh.apply([0.0, 0.0, -_length("left_hip", "left_knee")])
    ankle = knee + shank.apply([0.0, 0.0, -_length("left_knee", "left_ankle")])
    toes = ankle + foot.apply(
        [_length("left_ankle", "left_foot") * 0.92, 0.0, -_length("left_ankle", "left_foot") * 0.39]
    )
    heel = ankle + foot.apply([-0.025, 0.0, -0.03])
    return {f"{side}_{name}": root.apply(place * flip)
            for name, place in (("knee", knee), ("ankle", ankle), ("foot", toes), ("heel", heel))}  # fmt: skip


def _arm(torso: Rotation, found: dict[str, np.ndarray], side: str, arms: float, swing: _Swing) -> dict[str, np.ndarray]:
    flip = np.ones(3) if side == "left" else _MIRROR
    raised = Rotation.from_euler("x", arms * swing(0.05, 1.5)[:, None]) * _bend(arms * swing(-0.1, 1.7))
    upper = raised * Rotation.from_euler("z", arms * swing(-0.9, 0.3)[:, None])
    fore = upper * _bend(0.15 + arms * swing(0.0, 1.9))
    elbow = upper.apply([0.0, 0.0, -_length("left_shoulder", "left_elbow")])
    wrist = elbow + fore.apply([0.0, 0.0, -_length("left_elbow", "left_wrist")])
    places = {"elbow": elbow, "wrist": wrist} | {name: wrist + fore.apply(place) for name, place in _hand().items()}
    return {f"{side}_{name}": found[f"{side}_shoulder"] + torso.apply(place * flip) for name, place in places.items()}


def _hand() -> dict[str, tuple[float, float, float]]:
    """Points of the left hand from its wrist: palm inwards, thumb ahead, fingers down."""
    places = {"hand": (0.0, 0.0, -_length("left_wrist", "left_hand")), "hand_tip": (0.004, 0.0, -0.105)}
    for finger, (ahead, down) in _FINGERS.items():
        for number, knuckle in enumerate(_KNUCKLES.get(finger, ("mcp", "pip", "dip", "tip"))):
            places[f"{finger}_{knuckle}"] = (ahead * (1.0 + 0.1 * number), 0.0, -down - 0.017 * number)
    return places


def in_file(
    skeleton: Skeleton, joints: tuple[str, ...], unit: float = 1.0, axes: tuple[str, str, str] = ("-z", "-x", "+y")
) -> np.ndarray:
    """The numbers (T, J, 3) of a file with these joints, unit (m) and axes (forward, left, up); `-` is the chest."""
    from nao_sim.recordings.skeletons.layouts import axis

    known = [skeleton.track("chest" if joint == "-" else joint) for joint in joints]
    return np.stack(known, axis=1) @ np.array([axis(signed) for signed in axes]) / unit
