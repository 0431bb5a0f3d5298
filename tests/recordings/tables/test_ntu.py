"""NTU RGB+D `.skeleton`: people frame by frame, and what a mistake in one is told as."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.recordings import load
from nao_sim.recordings.skeletons.layouts import builtin
from nao_sim.recordings.source import Source
from nao_sim.recordings.tables import ntu
from tests.people import in_file, people, person
from tests.refusals import refusal

LAYOUT = next(layout for layout in builtin() if layout.name == "Kinect v2")


def text_of(frames):
    """The file's text: for each frame the id, values (25, 3) and states (25,) of each body."""
    lines = [str(len(frames))]
    for bodies in frames:
        lines.append(str(len(bodies)))
        for body, values, states in bodies:
            lines += [f"{body} 0 1 1 1 1 0 -0.4 0.06 2", "25"]
            for (x, y, z), state in zip(values, states, strict=True):
                lines.append(f"{x:.9f} {y:.9f} {z:.9f} 250.1 170.2 1000.3 400.4 -0.2 0.04 0.97 -0.06 {state:g}")
    return "\n".join(lines) + "\n"


def frames_of(someone, body="72057594037931101", states=2.0):
    values = in_file(someone, LAYOUT.joints)
    states = np.broadcast_to(states, values.shape[:2])
    return [[(body, values[frame], states[frame])] for frame in range(len(values))]


@pytest.fixture
def write(tmp_path):
    def write(text, name="S001C001P001R001A001.skeleton"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


def refused(path, **options):
    return str(refusal(path, **options))


@settings(max_examples=10)
@given(someone=people(frames=20), seed=st.integers(0, 99))
def test_what_is_written_is_read(tmp_path_factory, someone, seed):
    states = np.random.default_rng(seed).choice([0.0, 1.0, 2.0], (20, 25), p=[0.05, 0.25, 0.7])
    path = tmp_path_factory.mktemp("ntu") / "x.skeleton"
    path.write_text(text_of(frames_of(someone, states=states)))
    recording = load(path)
    assert recording.format == "NTU RGB+D skeleton" and "Kinect v2" in recording.reason
    np.testing.assert_array_equal(recording.motion.confidence, states / 2.0)
    for place, joint in enumerate(recording.motion.joints):
        known = states[:, place] > 0.0
        np.testing.assert_allclose(recording.motion.track(joint)[known], someone.track(joint)[known], atol=1e-6)


def test_of_several_people_the_longest_tracked_or_the_one_asked_for_is_read(write):
    one, two = frames_of(person(20, 1), "11"), frames_of(person(20, 2, height=1.3), "22")
    frames = [[]] + [a + (b if 4 <= frame < 12 else []) for frame, (a, b) in enumerate(zip(one, two, strict=True))]
    path = write(text_of(frames))
    recording = load(path)
    assert recording.frames == 20
    assert "2 people: 11, tracked longest (20 frames), taken (--person)" in recording.notes
    other = load(path, person="22")
    assert other.frames == 8 and other.notes[0].startswith("no times: 30")
    assert "no person 33; expected one of 11, 22 (--person)" in refused(path, person=33)


def test_a_frame_without_the_person_is_missing(write):
    frames = frames_of(person(20, 1))
    frames[7] = []
    skeleton = load(write(text_of(frames))).motion
    assert np.isnan(skeleton.positions[7]).all() and np.isfinite(skeleton.positions[8]).all()


def test_a_file_that_breaks_off_is_read_as_far_as_it_goes_and_says_so(write):
    lines = text_of(frames_of(person(20, 1))).splitlines()
    for cut in (lines[:-3], [*lines[:-1], lines[-1][:20]], lines[:-28]):
        recording = load(write("\n".join(cut)))
        assert recording.frames == 19 and "breaks off after 19 of 20 frames" in recording.notes
    assert "no whole frame" in refused(write("\n".join(lines[:20])))


@pytest.mark.parametrize(
    ("line", "text", "words"),
    [
        (30, "x", "line 30: 'x'; expected the number of bodies"),
        (31, "7 0 1", "line 31: 3 values; expected the 10 of a body"),
        (32, "24", "line 32: 24 joints; expected 25"),
        (40, "1 2 3", "line 40: 3 values; expected 12"),
        (40, "a 0 0 0 0 0 0 0 0 0 0 2", "line 40, column x: 'a'; expected a number"),
        (40, "0 0 0 0 0 0 0 0 0 0 0 7", "line 40, column tracking state: 7; expected 0, 1, 2"),
    ],
)
def test_a_mistake_is_told_with_its_line(write, line, text, words):
    lines = text_of(frames_of(person(20, 1))).splitlines()
    lines[line - 1] = text
    assert words in refused(write("\n".join(lines)))


def test_more_frames_than_promised_and_none_at_all_are_told(write):
    lines = text_of(frames_of(person(20, 1))).splitlines()
    assert "more than the 19 frames" in refused(write("\n".join(["19", *lines[1:]])))
    twice = frames_of(person(20, 1))
    twice[3] *= 2
    assert "a body twice in one frame" in refused(write(text_of(twice)))


@pytest.mark.parametrize(
    "text", ["3\n4\n5\n", "2\n1\n0.1 0.2\n", "12 20\n40\n", "time,x\n", "1 2 3 4 5 6 7 8 9 10\n25\n"]
)
def test_other_text_is_not_taken(write, text):
    assert ntu.recognise(Source(write(text))) is None
