"""A stream asks the robot the same as the file path does with the same filter."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim.imitation.filters import Kalman
from nao_sim.imitation.head import median, nod
from nao_sim.imitation.person import torso_frames
from nao_sim.imitation.retarget import one_to_one
from nao_sim.imitation.stream import ImitationStream, stream_imitation
from nao_sim.motion import Skeleton
from tests.people import person

SAME = 1e-9  # rad
FACELESS = ("head", "neck", "chest", "pelvis", *(
    f"{side}_{name}" for side in ("left", "right") for name in ("shoulder", "elbow", "wrist", "hip", "index_mcp",
                                                                "pinky_mcp", "index_tip", "index_pip", "index_dip")
))  # fmt: skip


def _with_gaps(skeleton: Skeleton, seed: int) -> Skeleton:
    random = np.random.default_rng(seed)
    positions = skeleton.positions + random.normal(0.0, 0.01, skeleton.positions.shape)
    positions[random.random(positions.shape[:2]) < 0.05] = np.nan
    positions[20:40, 3] = np.nan
    confidence = random.uniform(0.2, 1.0, positions.shape[:2])
    return Skeleton(skeleton.times, positions, skeleton.joints, confidence)


@pytest.mark.parametrize("seed", range(3))
def test_a_recording_streamed_frame_by_frame_asks_what_the_whole_one_asks_after_the_causal_filter(robot, seed):
    recorded = _with_gaps(person(90, seed), seed)
    whole = one_to_one(Kalman().filter(recorded), robot)
    np.testing.assert_allclose(stream_imitation(recorded, robot), whole, rtol=0.0, atol=SAME)
    raw = stream_imitation(recorded, robot, raw=True)
    np.testing.assert_allclose(raw, one_to_one(recorded, robot), rtol=0.0, atol=SAME)


def test_without_a_face_only_the_nod_differs_for_a_stream_knows_no_median_of_the_future(robot):
    recorded = _with_gaps(person(90, 1, joints=FACELESS), 1)
    streamed, filtered = stream_imitation(recorded, robot), Kalman().filter(recorded)
    whole = one_to_one(filtered, robot)
    pitch = robot.index["HeadPitch"]
    others = np.arange(26) != pitch
    np.testing.assert_allclose(streamed[:, others], whole[:, others], rtol=0.0, atol=SAME)
    lean = nod(filtered, torso_frames(filtered))
    so_far = [median(lean[: frame + 1]) for frame in range(len(lean))]
    expected = np.clip(lean - so_far, robot.lower[pitch], robot.upper[pitch])
    np.testing.assert_allclose(streamed[:, pitch], expected, rtol=0.0, atol=SAME)


def test_after_a_reset_the_same_person_is_imitated_the_same(robot):
    recorded = person(20, 2)
    stream = ImitationStream(recorded.joints, robot)
    rounds = []
    for _ in range(2):
        frames = zip(recorded.positions, recorded.times.tolist(), strict=True)
        rounds.append([stream.update(*frame) for frame in frames])
        stream.reset()
    np.testing.assert_array_equal(*rounds)
