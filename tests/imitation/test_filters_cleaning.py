"""The filters one after the other."""

from __future__ import annotations

from dataclasses import asdict, replace

import numpy as np
import pytest

from nao_sim.imitation.filters import Cleaning, Fill, Reject, Smooth, clean
from nao_sim.motion import Skeleton
from tests.people import person
from tests.tracking import JOINTS, one_track, same, spoiled


def troubled() -> Skeleton:
    """Three seconds with a jump, a point of no confidence, a short gap and a long one."""
    skeleton = person(90, joints=JOINTS)
    positions, confidence = np.array(skeleton.positions), np.ones((90, len(JOINTS)))
    wrist, head, elbow = (JOINTS.index(name) for name in ("left_wrist", "head", "right_elbow"))
    positions[40, wrist] += 2.0
    positions[50:54, wrist] = positions[20:60, head] = np.nan
    confidence[30, elbow] = 0.1
    return replace(skeleton, positions=positions, confidence=confidence)


def test_it_is_the_filters_one_after_the_other() -> None:
    skeleton = troubled()
    assert same(clean(skeleton)[0], Smooth().filter(Fill().filter(Reject().filter(skeleton))))


def test_what_was_done_is_counted() -> None:
    cleaning = clean(troubled())[1]
    assert cleaning == Cleaning(
        points=900,
        rejected={"confidence": {"right_elbow": 1}, "bone length": {"left_wrist": 1}, "jump": {}},
        filled={"left_wrist": 5, "right_elbow": 1},
        missing={"head": 40},
    )
    assert asdict(cleaning)["filled"] == {"left_wrist": 5, "right_elbow": 1}


def test_what_was_done_is_told() -> None:
    assert clean(troubled())[1].notes() == (
        "1 of 900 points rejected by confidence (right_elbow)",
        "1 of 900 points rejected by bone length (left_wrist)",
        "6 of 900 points filled in (left_wrist, right_elbow)",
        "40 of 900 points missing (head)",
    )
    assert Cleaning(9, {}, {}, {"a": 1, "b": 3, "c": 1, "d": 1}).notes() == (
        "6 of 9 points missing (b, a, c and 1 more)",
    )


def test_of_a_good_recording_there_is_nothing_to_tell() -> None:
    assert clean(person(60))[1].notes() == ()


def test_each_filter_can_be_left_out() -> None:
    skeleton = troubled()
    assert same(clean(skeleton, None, None, None)[0], skeleton)
    assert same(clean(skeleton, fill=None, smooth=None)[0], Reject().filter(skeleton))
    assert clean(skeleton, reject=None)[1].rejected == {}


@pytest.mark.parametrize("frequency", [1.0, 2.0, 3.0])
def test_fast_motion_of_good_mocap_is_kept(frequency: float) -> None:
    times = np.arange(0.0, 5.0, 1.0 / 120.0)
    wave = 0.4 * np.sin(2.0 * np.pi * frequency * times)
    result, cleaning = clean(one_track(times, wave))
    assert cleaning.notes() == ()
    left = result.positions[120:-120, 0, 1] @ wave[120:-120] / (wave[120:-120] @ wave[120:-120])
    assert 0.95 < left < 1.001


def test_a_bad_recording_becomes_much_better() -> None:
    truth = person(600, seed=5, joints=JOINTS)
    bad = spoiled(truth, np.random.default_rng(5))
    result, _ = clean(bad)

    def error(skeleton: Skeleton) -> float:
        return float(np.sqrt(np.nanmean((skeleton.positions - truth.positions) ** 2)))

    assert error(result) < 0.35 * error(bad)
    assert np.isfinite(result.positions[2:-2]).all()
