"""Choregraphe's timelines: frames, units, tangents, which of several, and projects that name behaviours."""

import numpy as np
import pytest

from nao_sim.errors import RecordingError
from nao_sim.motion import JointTrajectory
from nao_sim.recordings import load
from nao_sim.robot import load_robot
from tests.recordings.samples import (
    BEHAVIOUR,
    HAND_CURVE,
    LINEAR,
    YAW_CURVE,
    actuator,
    box,
    key,
    project,
    timeline,
)

ROBOT = load_robot()
YAW, HAND = ROBOT.index["HeadYaw"], ROBOT.index["LHand"]


def motion_of(path) -> JointTrajectory:
    motion = load(path).motion
    assert isinstance(motion, JointTrajectory)
    return motion


@pytest.mark.parametrize(
    "content", [BEHAVIOUR, BEHAVIOUR.replace("\n", "\r\n"), "\ufeff" + BEHAVIOUR, "<!-- mine -->" + BEHAVIOUR[39:]]
)
def test_a_behaviour_loads_with_its_times_units_and_joints(write, content):
    recording = load(write(content))
    motion = recording.motion
    assert recording.format == "Choregraphe timeline" and recording.frames == 3
    assert recording.reason == "the XML element <ChoregrapheProject> is Choregraphe's"
    np.testing.assert_allclose(motion.times, [0.0, 1.0, 2.0])
    np.testing.assert_allclose(motion.positions[:, YAW], np.radians([0.0, 30.0, -15.0]))
    np.testing.assert_allclose(motion.positions[:, HAND], 0.25)
    assert motion.given.sum() == 2
    assert [(label.name, label.start, label.end) for label in recording.labels] == [("Wave", 0.0, 2.0)]
    assert "'Wave'" in recording.notes[0] and "hold their first key" in recording.notes[1]


def test_keys_without_tangents_are_joined_by_naoqis_automatic_curve(write):
    motion = motion_of(write(project(timeline(actuator("HeadYaw", key(1, 0), key(26, 30), key(51, 60))))))
    at = motion.sample(np.array([0.5, 1.0, 1.5]))[:, YAW]
    slope = np.radians(30.0)  # per second in the middle, 0 at the ends: a quarter less and more than the straight line
    np.testing.assert_allclose(at, [slope / 2 - slope / 8, slope, 1.5 * slope + slope / 8], atol=1e-9)


def test_tangents_are_in_frames_and_in_the_curves_unit(write):
    right = '<Tangent side="right" interpType="bezier" abscissaParam="12.5" ordinateParam="20" />'
    left = '<Tangent side="left" interpType="bezier" abscissaParam="-12.5" ordinateParam="0" />'
    motion = motion_of(write(project(timeline(actuator("HeadYaw", key(1, 0, right), key(26, 10, left))))))
    u = 0.5  # where the abscissa 3u/2 (1-u)^2 + 3u^2/2 (1-u) + u^3 is 0.5
    assert 1.5 * u * (1 - u) ** 2 + 1.5 * u**2 * (1 - u) + u**3 == 0.5
    degrees = 3 * u * (1 - u) ** 2 * 20 + 3 * u**2 * (1 - u) * 10 + u**3 * 10
    assert np.degrees(motion.sample(np.array([0.5]))[0, YAW]) == pytest.approx(degrees, abs=1e-9)


def test_a_constant_tangent_holds_the_value(write):
    held = '<Tangent side="right" interpType="constant" abscissaParam="0" ordinateParam="0" />'
    motion = motion_of(write(project(timeline(actuator("HeadYaw", key(1, 5, held), key(26, 10, LINEAR))))))
    assert np.degrees(motion.sample(np.array([0.9]))[0, YAW]) == pytest.approx(5.0)
    assert np.degrees(motion.positions[-1, YAW]) == pytest.approx(10.0)


def test_of_several_timelines_the_longest_is_read_and_the_others_are_named(write):
    short = timeline(actuator("HeadPitch", key(1, 0), key(11, 5)))
    recording = load(write(project(box("Nod", short), box("Look", timeline(YAW_CURVE)), box("Bow", short))))
    assert recording.labels[0].name == "Look" and recording.motion.given[YAW]
    assert recording.notes[1] == "the longest of 3 timelines; not read: 'Nod' (0.4 s), 'Bow' (0.4 s)"
    twins = load(write(project(box("Nod", short), box("Bow", short))))
    assert twins.labels[0].name == "Nod"


def test_a_timeline_inside_a_timeline_has_its_own_curves(write):
    inner = (
        f"<BehaviorLayer><Diagram>{box('Inner', timeline(actuator('HeadPitch', key(1, 5))))}</Diagram></BehaviorLayer>"
    )
    outer = timeline(YAW_CURVE).replace("<ActuatorList>", inner + "<ActuatorList>")
    recording = load(write(project(box("Outer", outer))))
    assert recording.labels[0].name == "Outer" and np.flatnonzero(recording.motion.given).tolist() == [YAW]


def test_start_and_end_frames_bound_the_motion(write):
    attributes = 'enable="1" fps="25" start_frame="26" end_frame="38.5"'
    recording = load(write(project(timeline(YAW_CURVE, attributes=attributes))))
    np.testing.assert_allclose(recording.motion.times, [0.0, 0.5])
    np.testing.assert_allclose(np.degrees(recording.motion.positions[:, YAW]), [30.0, 7.5])
    assert "1 keys before the start frame are not played" in recording.notes
    assert "1 keys after the end frame are not reached" in recording.notes


def test_muted_curves_and_disabled_timelines_are_told(write):
    muted = actuator("HeadPitch", key(1, 5), more='mute="1"')
    recording = load(write(project(timeline(YAW_CURVE, muted, attributes='enable="0" fps="25"'))))
    assert "muted, so not read: HeadPitch" in recording.notes and not recording.motion.given[1]
    assert "Choregraphe would not play it: it is disabled" in recording.notes


def test_hands_in_percent_are_told(write):
    recording = load(write(project(timeline(actuator("LHand", key(1, 0), key(26, 80), unit="")))))
    np.testing.assert_allclose(recording.motion.positions[[0, -1], HAND], [0.0, 0.8])
    assert "openings above 2, taken as percent: LHand" in recording.notes


def test_curves_without_a_unit_are_degrees_as_naoqi_takes_them(write):
    bare = YAW_CURVE.replace(' unit="0"', "")
    np.testing.assert_array_equal(
        motion_of(write(project(timeline(bare)))).positions,
        motion_of(write(project(timeline(YAW_CURVE)), "b")).positions,
    )


def test_animations_say_rate_and_unit_by_curve_and_version_2_counts_from_0(write):
    curve = actuator("HeadYaw", key(0, 0.1), key(25, 0.5), unit="radian", more='fps="25"')
    motion = motion_of(write(f'<Animation typeVersion="2.0">{curve}</Animation>'))
    assert (motion.times[0], motion.times[-1]) == (0.0, 1.0)
    np.testing.assert_allclose(motion.positions[[0, -1], YAW], [0.1, 0.5])
    first = actuator("HeadYaw", key(1, 0), key(26, 30), unit="degree", more='fps="25"')
    motion = motion_of(write(f'<Animation typeVersion="1.0"><ActuatorList>{first}</ActuatorList></Animation>'))
    assert (motion.times[0], motion.times[-1]) == (0.0, 1.0)


def test_angles_that_no_robot_has_are_read_without_a_warning(write):
    motion = motion_of(write(project(timeline(actuator("HeadYaw", key(1, 1e308), key(26, -1e308), key(27, 1e308))))))
    assert motion.given[YAW] and motion.positions[0, YAW] == pytest.approx(np.radians(1e308))


def test_a_box_of_the_library_is_read(write):
    content = BEHAVIOUR.replace("ChoregrapheProject", "ChoregrapheBox")
    assert load(write(content)).reason == "the XML element <ChoregrapheBox> is Choregraphe's"


def package(*behaviours):
    rows = "".join(f'<BehaviorDescription name="b" src="{src}" xar="behavior.xar" />\n' for src in behaviours)
    return f'<?xml version="1.0"?>\n<Package name="p" format_version="4">\n{rows}</Package>\n'


def test_a_project_leads_to_its_behaviours(write):
    write(project(box("Nod", timeline(actuator("HeadPitch", key(1, 0), key(11, 5))))), "nod/behavior.xar")
    write(BEHAVIOUR, "wave/behavior.xar")
    recording = load(write(package("nod", "wave", "gone"), "p.pml"))
    assert recording.labels[0].name == "Wave" and recording.path.name == "p.pml"
    assert recording.notes[0].startswith("timeline wave/behavior.xar 'Wave'")
    assert recording.notes[1] == "the longest of 2 timelines; not read: nod/behavior.xar 'Nod' (0.4 s)"
    assert recording.notes[2] == "not beside the project: gone/behavior.xar"


def test_a_mistake_in_a_behaviour_names_the_behaviours_file(write):
    broken = write(BEHAVIOUR.replace('value="30"', 'value="up"'), "wave/behavior.xar")
    with pytest.raises(RecordingError, match="'up'") as caught:
        load(write(package("wave"), "p.pml"))
    assert caught.value.path == broken


PACKAGES = {
    "behaviours elsewhere": (package("wave"), 3, ["wave/behavior.xar", "not beside"]),
    "no behaviours": (package(), None, ["no motion"]),
    "a path out of the folder": (package("../wave"), 3, ["'../wave/behavior.xar'", "inside"]),
    "an absolute path": (package("/etc"), 3, ["'/etc/behavior.xar'", "inside"]),
    "a drive": (package("C:"), 3, ["inside"]),
    "a path with backslashes": (package("..\\wave"), 3, ["inside"]),
    "no path": (package("").replace(' src="" xar="behavior.xar"', ""), 3, ["''", "inside"]),
    "a name that no file can have": (package("x" * 300), 3, ["not beside"]),
}


@pytest.mark.parametrize("kind", PACKAGES)
def test_a_project_without_readable_behaviours_is_told_so(write, told, kind):
    content, line, words = PACKAGES[kind]
    told(write(content, "p.pml"), line, None, *words)


def test_a_project_of_behaviours_without_motion(write, told):
    write(project(box("Say", "")), "say/behavior.xar")
    told(write(package("say"), "p.pml"), None, None, "a project without motion")


BOMB = (
    '<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">]>\n'
    "<ChoregrapheProject>&b;</ChoregrapheProject>"
)
BARE = project(timeline(YAW_CURVE))
MISTAKES = {
    "truncated": (BARE[:-60], 9, 1, ["unclosed token", "well-formed XML"]),
    "cut within a tag": (BARE[: BARE.index('value="30"')], 7, None, ["well-formed XML"]),
    "entities": ("<?xml version='1.0'?>\n<ChoregrapheProject>&b;</ChoregrapheProject>", 2, 21, ["entity"]),
    "no curves": (project(timeline()), 3, None, ["no motion", "ActuatorCurve"]),
    "no timeline": (project(), None, None, ["no motion"]),
    "only muted": (BARE.replace('mute="0"', 'mute="1"'), 3, None, ["no motion", "muted"]),
    "another robot's joint": (BARE.replace("HeadYaw", "KneePitch"), 5, "KneePitch", ["unknown actuator", "NAO"]),
    "no actuator": (BARE.replace(' actuator="HeadYaw"', ""), 5, "actuator", ["unknown actuator"]),
    "a joint twice": (project(timeline(YAW_CURVE, YAW_CURVE)), 10, "HeadYaw", ["line 5", "once"]),
    "no fps": (BARE.replace(' fps="25"', ""), 3, None, ["no fps", "positive"]),
    "fps 0": (BARE.replace('fps="25"', 'fps="0"'), 3, None, ["0 frames a second"]),
    "fps text": (BARE.replace('fps="25"', 'fps="fast"'), 3, "fps", ["'fast'", "a number"]),
    "a key without a frame": (BARE.replace('frame="26" ', ""), 7, "HeadYaw frame", ["no frame", "finite number"]),
    "a key without a value": (BARE.replace(' value="30"', ""), 7, "HeadYaw value", ["no value"]),
    "a value that is text": (BARE.replace('"30"', '"up"'), 7, "HeadYaw value", ["'up'", "a number"]),
    "a value that is nan": (BARE.replace('"30"', '"nan"'), 7, "HeadYaw value", ["'nan'", "finite"]),
    "a value that is inf": (BARE.replace('"30"', '"1e999"'), 7, "HeadYaw value", ["'1e999'", "finite"]),
    "frames that go back": (BARE.replace('"51"', '"20"'), 8, "HeadYaw", ["frame 20", "after 26"]),
    "a frame twice": (BARE.replace('"51"', '"26"'), 8, "HeadYaw", ["frame 26", "after 26"]),
    "only early keys": (BARE.replace('start_frame="1"', 'start_frame="60"'), 3, None, ["before the start frame"]),
    "an early end": (
        project(timeline(HAND_CURVE)).replace('end_frame="-1"', 'end_frame="3"'), 3, None, ["end at frame 3"],
    ),
    "a hand in degrees": (project(timeline(HAND_CURVE)).replace('unit="1"', 'unit="0"'), 5, "LHand", ["unit '0'"]),
    "an angle in percent": (BARE.replace('unit="0"', 'unit="1"'), 5, "HeadYaw", ["unit '1'", "degree"]),
    "an unknown unit": (BARE.replace('unit="0"', 'unit="grad"'), 5, "HeadYaw", ["unit 'grad'"]),
    "an unknown tangent": (BARE.replace('"linear"', '"spline"', 1), 6, "HeadYaw", ["'spline'", "bezier, linear"]),
    "a tangent of no side": (BARE.replace('side="left"', 'side="up"', 1), 6, "HeadYaw", ["'up'", "left or right"]),
    "a tangent backwards": (
        BARE.replace('"linear" abscissaParam="0"', '"bezier" abscissaParam="2"', 1), 6, "HeadYaw", ["left", "away"],
    ),
    "a curve outside": (project(YAW_CURVE), 3, None, ["outside", "Timeline"]),
    "a key outside": (project(timeline(key(1, 2))), 5, None, ["outside", "ActuatorCurve"]),
    "a tangent outside": (project(timeline(actuator("HeadYaw", LINEAR))), 6, None, ["outside", "Key"]),
    "no encoding there is": (BARE.replace("UTF-8", "klingon"), 1, None, ["klingon", "UTF-8"]),
    "hours of curves": (
        project(timeline(actuator("HeadYaw", key(1, 0), key(9e9, 5)))), None, None, ["at most 6 hours"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_with_its_place_and_what_was_expected(write, mistake):
    content, line, column, words = MISTAKES[mistake]
    path = write(content)
    with pytest.raises(RecordingError) as caught:
        load(path)
    message = str(caught.value)
    assert caught.value.line == line and (column is None or caught.value.column == column), message
    assert message.startswith(str(path)) and "\n" not in message and all(word in message for word in words), message


def test_entities_are_never_expanded(write, told):
    told(write(BOMB), 1, None, "document type declaration", "XML without one")


@pytest.mark.parametrize(("options", "word"), [({"unit": "rad"}, "degrees"), ({"rate": 30.0}, "no rate")])
def test_options_that_contradict_the_format_are_refused(write, told, options, word):
    path = write(BEHAVIOUR)
    told(path, None, None, word, **options)
    assert load(path, unit="deg").frames == 3


def test_markup_of_another_kind_is_not_taken_for_a_timeline(write, told):
    told(write("<html><Timeline/></html>"), 1, None, "which no reader knows")
