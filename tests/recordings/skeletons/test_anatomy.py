"""What is measured of a body does not depend on where it stands, and tells a body from other points."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from nao_sim import body
from nao_sim.recordings.skeletons import plausibility
from nao_sim.recordings.skeletons.anatomy import Body, median, middle, unit
from nao_sim.recordings.skeletons.facing import Told, front_told
from nao_sim.recordings.skeletons.fitting import WORST, fit
from nao_sim.recordings.skeletons.layouts import builtin
from nao_sim.recordings.skeletons.plausibility import (
    crookedness,
    disproportion,
    is_flat,
    lopsidedness,
    misfits,
    upside_down,
    wobble,
)
from tests.people import in_file, people, person

UP = np.array([0.0, 0.0, 1.0])


def _body(someone, joints=None) -> Body:
    names = joints or someone.joints
    return Body(tuple(names), np.stack([someone.track(name) for name in names], axis=1))


@settings(max_examples=20)
@given(someone=people(), seed=st.integers(0, 99), scale=st.sampled_from([0.001, 0.3, 40.0]))
def test_measures_do_not_depend_on_place_turn_and_scale(someone, seed, scale):
    here = _body(someone)
    turn, shift = Rotation.random(random_state=seed), np.random.default_rng(seed).normal(size=3)
    there = Body(here.joints, scale * (turn.apply(here.values.reshape(-1, 3)).reshape(here.values.shape) + shift))
    assert there.height == pytest.approx(scale * here.height)
    for measure in (disproportion, wobble, lopsidedness, crookedness):
        assert measure(there) == pytest.approx(measure(here), abs=1e-9)
    assert upside_down(there, turn.apply(UP)) == upside_down(here, UP)


@settings(max_examples=20)
@given(someone=people())
def test_a_person_has_constant_like_and_upright_bones(someone):
    found = _body(someone)
    tall = someone.positions[0, :, 2].max() - someone.positions[0, :, 2].min()
    assert 0.4 * tall < found.height < 2.0 * tall
    assert disproportion(found) < 0.01 and lopsidedness(found) < 0.01 and upside_down(found, UP) < 0.1
    assert wobble(found) < 0.05 and misfits(found) == {} and not is_flat(found)


@settings(max_examples=20)
@given(someone=people())
def test_the_front_is_where_toes_and_nose_are_and_the_mirror_tells_the_opposite(someone):
    found = _body(someone)
    front = unit(np.cross(found.leftward, UP))
    told, against = front_told(found, front), front_told(found, -front)
    assert told["toes"] > 0.7 and told["nose"] > 0.7 and sum(told.values()) > 1.5
    assert against == pytest.approx({part: -amount for part, amount in told.items()})


@settings(max_examples=20)
@given(someone=people(), layout=st.sampled_from(builtin()), order=st.randoms(use_true_random=False))
def test_any_other_order_is_less_of_a_body(someone, layout, order):
    values = in_file(someone, layout.joints)
    points = [columns[0] for columns in layout.columns.values()]
    mixed = list(points)
    order.shuffle(mixed)
    names = tuple(layout.columns)
    true, other = fit(names, values[:, points], Told()), fit(names, values[:, mixed], Told())
    assert true.problems == () and true.cost < 1.0
    assert mixed == points or other.cost > true.cost


@pytest.mark.parametrize(
    ("change", "measure"),
    [
        (lambda v, at: v[:, at["left_knee"]].__isub__([0.0, 0.3, 0.3]), "lopsidedness"),
        (lambda v, at: v[::2, at["right_elbow"]].__iadd__([0.3, 0.0, 0.3]), "wobble"),
        (lambda v, at: v[:, [at["left_hip"], at["right_hip"]]].__imul__(1.0), None),
    ],
)
def test_what_is_wrong_is_what_is_measured(change, measure):
    someone = person(40, 5)
    values = someone.positions.copy()
    change(values, {joint: place for place, joint in enumerate(someone.joints)})
    found = Body(someone.joints, values)
    high = {name for name in ("lopsidedness", "wobble") if getattr(plausibility, name)(found) > 0.2 * WORST[name]}
    assert high == ({measure} if measure else set())


def test_sides_that_cross_and_a_head_below_are_told():
    someone = person(40, 5)
    swapped = [body.twin(name) if name.partition("_")[2] in ("knee", "ankle", "heel", "foot") else name
               for name in someone.joints]  # fmt: skip
    crossed = Body(tuple(swapped), someone.positions)
    assert crookedness(crossed) > WORST["crookedness"] > crookedness(_body(someone))
    headless = {"head": "left_knee", "left_knee": "head"}
    wrong = Body(tuple(headless.get(name, name) for name in someone.joints), someone.positions)
    assert upside_down(wrong, UP) > upside_down(_body(someone), UP) and misfits(wrong)


def test_a_hand_stands_in_for_a_wrist_that_is_not_there():
    someone = person(20, 1)
    names = tuple(name for name in someone.joints if not name.endswith(("wrist", "ankle")))
    found = _body(someone, names)
    ends = {bone.end for bone in found.medians}
    assert {"left_hand", "right_hand", "left_foot", "right_foot"} <= ends
    assert found.height == pytest.approx(_body(someone).height, rel=0.02)


def test_missing_joints_are_not_measured():
    someone = person(20, 1)
    few = _body(someone, ("left_shoulder", "right_shoulder", "head"))
    assert lopsidedness(few) == 0.0 and front_told(few, unit(np.cross(few.leftward, UP)))["toes"] == 0.0
    assert np.isnan(few.track("left_hip")).all()
    none = Body(("head",), np.full((3, 1, 3), np.nan))
    assert np.isnan(none.height) and fit(none.joints, none.values, Told()).problems


def test_medians_leave_out_what_is_missing():
    assert median(np.array([np.nan, 3.0, 1.0])) == 2.0 and np.isnan(median(np.array([np.nan])))
    assert middle(np.array([[1.0, np.nan, np.nan], [3.0, 5.0, np.nan]])).tolist()[:2] == [2.0, 5.0]
