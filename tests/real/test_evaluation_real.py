"""Evaluations of real data sets: the figures of the benchmarks, through manifests."""

from __future__ import annotations

from pathlib import Path

import pytest

from nao_sim.errors import RecordingError
from nao_sim.gestures.evaluation.data_set import read_examples
from nao_sim.gestures.evaluation.evaluate import Wanted, evaluate
from nao_sim.gestures.manifest import load_manifest
from nao_sim.paths import TRAJECTORIES

SHARED = Path(__file__).resolve().parents[3] / "shared" / "recordings"
POSES = SHARED / "openpose_body25_poses"
SIGNS = SHARED / "isl_kinect_signs" / "signs12_10people_3reps.tar.xz"


def thesis():
    return read_examples(load_manifest(TRAJECTORIES / "thesis_users.csv"))


def test_the_thesis_users_left_out_are_recognised_as_in_the_benchmark():
    part = evaluate(thesis()).parts["poses"]
    assert part.shown.accuracy.right == 25 and part.shown.forced.right == 26 and part.shown.accuracy.count == 28
    assert next(iter(part.shown.by_users)) == "user4"  # whose rows contradict themselves


@pytest.mark.skipif(not POSES.is_dir(), reason=f"no {POSES}")
def test_strangers_in_pictures_are_recognised_after_the_thesis_table(tmp_path):
    names = {"T": "side", "Yoga_UpwardSalute": "up", "Stand": "down", "Traffic_AllStop": "piUp"}
    rows = [f"{POSES / name}_body.json.gz,{label}," for name, label in names.items()]
    (tmp_path / "m.csv").write_text("\n".join(["path,label,user", *rows]) + "\n", encoding="utf-8")
    test = read_examples(load_manifest(tmp_path / "m.csv"))
    outcome = evaluate(thesis(), test, Wanted(single_arms=True)).parts["poses"].shown
    assert outcome.accuracy.count == 2121 and outcome.accuracy.value > 0.985
    assert set(outcome.classes) >= set(names.values()) and outcome.told_none.right < 30


@pytest.mark.skipif(not SIGNS.is_file(), reason=f"no {SIGNS}")
def test_signs_in_an_archive_are_movements_of_strangers_and_a_broken_one_is_named(tmp_path):
    rows = [f"{SIGNS}/{word}_s{signer:02d}_1.txt,{word},s{signer:02d}"
            for word in ("go", "rain", "sorry") for signer in (1, 4, 7)]  # fmt: skip
    (tmp_path / "m.csv").write_text("\n".join(["path,label,user", *rows]) + "\n", encoding="utf-8")
    manifest = load_manifest(tmp_path / "m.csv")
    with pytest.raises(RecordingError, match=r"line 3, column path: .*go_s04_1\.txt"):
        read_examples(manifest)
    data = read_examples(manifest, skip_unreadable=True)
    found = evaluate(data)
    assert len(data.skipped) == 1 and set(found.kinds.of.values()) == {"movements"}
    assert found.parts["movements"].shown.forced.right == 8
