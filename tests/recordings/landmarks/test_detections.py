"""Lists of people, each with the picture it was seen in."""

import json

import numpy as np
import pytest

from nao_sim.recordings import load
from nao_sim.recordings.landmarks.detections import by_picture
from tests.people import in_file, person

COCO = ("nose", *(f"{side}_{part}" for part in ("eye", "ear", "shoulder", "elbow", "wrist", "hip", "knee", "ankle")
                  for side in ("left", "right")))  # fmt: skip


def flat(seed, aside=0.0, frames=20):
    """Numbers (T, 51) x y score of somebody in a picture."""
    values = in_file(person(frames, seed), COCO, axes=("-z", "+x", "-y")) * 190.0 + [320.0 + aside, 240.0, 0.0]
    values[:, :, 2] = 0.9
    return values.reshape(frames, -1).tolist()


@pytest.fixture
def write(tmp_path):
    def write(content, name="results.json"):
        path = tmp_path / name
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    return write


def alone(write, keypoints, **options):
    return load(write([{"keypoints": points} for points in keypoints], "alone.json"), **options).motion.positions


def alphapose(first, second, tracked=True, since=5):
    return [
        {"image_id": f"{i}.jpg", "category_id": 1, "keypoints": points, "score": 2.5}
        | ({"idx": who} if tracked else {})
        for i, both in enumerate(zip(second, first, strict=True))
        for who, points in ((2, both[0]), (1, both[1]))
        if who == 1 or i >= since
    ]


def coco(first, second, since=5):
    listed = alphapose(first, second, tracked=False, since=since)
    listed = [{"id": 900 + i} | person | {"image_id": int(person["image_id"][:-4])} for i, person in enumerate(listed)]
    return {"images": [{"id": i} for i in range(len(first))], "annotations": listed}


def numbered(first, second):
    return [{"frame": i, "person": name, "keypoints": points} for i, both in enumerate(zip(first, second, strict=True))
            for name, points in zip("ab", both, strict=True) if name == "a" or i]  # fmt: skip


def timed(first, second):
    return [{"time": frame["frame"] / 30} | frame for frame in numbered(first, second)]


@pytest.mark.parametrize("shape", [alphapose, lambda a, b: alphapose(a, b, False), coco, numbered, timed])
def test_of_several_people_in_a_picture_the_one_seen_longest_is_read(write, shape):
    first = flat(1)
    recording = load(write(shape(first, flat(2, 250.0))))
    np.testing.assert_allclose(recording.motion.positions, alone(write, first), atol=1e-9)
    assert any("several people" in note for note in recording.notes)


def test_the_person_asked_for_is_read(write):
    first, second = flat(1), flat(2, 250.0)
    found = load(write(alphapose(first, second)), person="2").motion.positions
    np.testing.assert_allclose(found, alone(write, second[5:]), atol=1e-9)


def test_lines_of_people_are_frames_too(write):
    first = flat(1)
    text = "".join(json.dumps(line) + "\n" for line in numbered(first, flat(2, 250.0)))
    np.testing.assert_allclose(load(write(text)).motion.positions, alone(write, first), atol=1e-9)


def test_pictures_without_anybody_are_gaps(write):
    listed = [
        person for person in alphapose(flat(1), flat(2), since=99) if person["image_id"] not in ("3.jpg", "4.jpg")
    ]
    times = load(write(listed), rate=10.0).motion.times
    np.testing.assert_allclose(times, [0.0, 0.1, 0.2, *np.arange(5, 20) / 10])


def test_other_lists_stay_as_they_are():
    for frames in ([[1, 2]], [], [{"image_id": i, "id": 7} for i in range(3)], [{"time": 1.0}, {"time": 1.0}], [None]):
        assert by_picture(frames) == (frames, list(range(len(frames))))
