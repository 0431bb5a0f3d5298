"""What the guard changed, as colours on limbs."""

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.filming import Crew, Film
from nao_sim.rendering import choose_backend
from nao_sim.rendering.figure import Figure, add_figure
from nao_sim.rendering.presets import load_safety
from nao_sim.robot import load_robot
from nao_sim.safety.change import Change
from nao_sim.safety_colours import SafetyColours
from nao_sim.simulation.rollout import Rollout
from nao_sim.simulation.scene import compiled, compose
from nao_sim.simulation.simulator import CONTROL_STEP, Simulator

STEPS = 100
ROBOT = load_robot()
LOOKS = load_safety()
TIMES = CONTROL_STEP * np.arange(1.0, STEPS + 1.0)
PARTS = (*ROBOT.limbs, "torso")
joint = st.integers(0, 25)
# how dichromats see linear red, green and blue (Machado, Oliveira and Fernandes 2009, severity 1)
SIGHT = {
    "all": np.eye(3),
    "no red": [(0.152286, 1.052583, -0.204868), (0.114503, 0.786281, 0.099216), (-0.003882, -0.048116, 1.051998)],
    "no green": [(0.367322, 0.860646, -0.227968), (0.280085, 0.672501, 0.047413), (-0.011820, 0.042940, 0.968881)],
    "no blue": [(1.255528, -0.076749, -0.178779), (-0.078411, 0.930809, 0.147602), (0.004733, 0.691367, 0.303900)],
}


@pytest.fixture(scope="module")
def simulator():
    return Simulator(ROBOT)


@pytest.fixture(scope="module")
def colours(simulator):
    return SafetyColours(simulator.model, ROBOT)


def change(reason, size=1.0, joints=("RElbowYaw",), links=()):
    sizes = np.zeros(26)
    sizes[[ROBOT.index[name] for name in joints]] = size
    return Change(reason, sizes, links)


def spell(*changes, first=20, last=40):
    """Interventions of a run, with the same changes from step `first` to step `last`."""
    return [tuple(changes) if first <= step <= last else () for step in range(STEPS)]


def covers(colours, interventions, times=TIMES):
    """(N, parts, 4) of a film's frames."""
    rows = colours.at(times, interventions, TIMES).rows
    return rows[:, : 4 * len(PARTS)].reshape(len(times), len(PARTS), 4)


def coloured(colours, interventions, step=30):
    """The parts that are coloured at a step, and by which colour."""
    here = covers(colours, interventions)[step]
    return {part: tuple(cover[:3]) for part, cover in zip(PARTS, here, strict=True) if cover[3] > 0.0}


def test_where_nothing_is_changed_nothing_is_shown(colours):
    assert not colours.at(TIMES, [()] * STEPS, TIMES).rows.any()


@given(st.integers(0, STEPS - 1), st.integers(0, STEPS - 1), joint)
@settings(deadline=None)
def test_a_spell_colours_its_limb_at_its_time_for_long_enough(colours, first, length, joint):
    last = min(first + length, STEPS - 1)
    shown = covers(colours, spell(change("limit", joints=[ROBOT.joint_names[joint]]), first=first, last=last))
    limb = next(i for i, part in enumerate(PARTS) if part != "torso" and joint in ROBOT.limbs[part])
    opacity = shown[:, limb, 3]
    assert not np.delete(shown, limb, axis=1).any()
    assert not opacity[:first].any() and opacity[first] > 0.0
    visible = TIMES[opacity > 0.0]
    assert visible[-1] - visible[0] >= min(LOOKS.hold, TIMES[-1] - TIMES[first]) - 1e-9
    assert visible[-1] <= TIMES[last] + LOOKS.hold + LOOKS.fade
    assert np.abs(np.diff(opacity)).max() <= CONTROL_STEP / LOOKS.fade + 1e-9


def test_a_reason_that_flickers_shows_a_steady_colour(colours):
    flicker = [(change("limit"),) if step % 8 == 0 else () for step in range(STEPS)]
    opacity = covers(colours, flicker)[:, PARTS.index("RArm"), 3]
    assert (opacity[10:] == 1.0).all()


@pytest.mark.parametrize(
    ("links", "parts"),
    [
        (("l_wrist", "torso"), {"LArm", "torso"}),
        (("l_wrist", "LThigh"), {"LArm", "LLeg"}),
        (("RForeArm", "Head"), {"RArm", "Head"}),
        (("LFinger12_link", "r_wrist"), {"LArm", "RArm"}),
    ],
)
def test_a_self_collision_colours_the_limbs_of_both_links_and_no_other(colours, links, parts):
    assert set(coloured(colours, spell(change("self_collision", joints=["LElbowRoll"], links=links)))) == parts


def test_balance_colours_legs_and_torso(colours):
    assert set(coloured(colours, spell(change("balance", joints=["LHipPitch"])))) == {"LLeg", "RLeg", "torso"}


@pytest.mark.parametrize(
    ("reason", "joint", "size", "is_shown"),
    [
        ("limit", "RElbowYaw", np.radians(0.49), False),
        ("limit", "RElbowYaw", np.radians(0.51), True),
        ("speed", "RElbowYaw", np.radians(2.9), False),
        ("speed", "RElbowYaw", np.radians(3.1), True),
        ("speed", "RHand", 0.06, False),
        ("speed", "RHand", 0.3, True),
        ("unheard_of", "RElbowYaw", 1.0, False),
    ],
)
def test_small_changes_are_not_shown(colours, reason, joint, size, is_shown):
    assert bool(coloured(colours, spell(change(reason, size, [joint])))) == is_shown


def test_the_later_colour_of_the_table_covers_the_earlier_and_both_are_said(colours):
    both = spell(change("self_collision", links=("RForeArm", "torso")), change("speed"))
    assert coloured(colours, both)["RArm"] == LOOKS.colours["collision"]
    row = colours.at(TIMES, both, TIMES).rows[30]
    words = {
        label.word for label, opacity in zip(colours.tint.script.labels, row[4 * len(PARTS) :], strict=True) if opacity
    }
    assert words == {LOOKS.reasons[reason].word for reason in ("self_collision", "speed")}


def test_interventions_of_another_run_are_refused(colours):
    with pytest.raises(ValueError, match="3 interventions; expected one for each of 100 steps"):
        colours.at(TIMES, [()] * 3, TIMES)


def test_every_shell_and_panel_of_the_robot_is_of_one_limb_and_none_of_the_person():
    poses = np.zeros((1, 7))
    scene = compose()
    add_figure(scene, Figure({"head": 0.1}, poses, np.zeros(1)))
    model = compiled(scene)
    tint = SafetyColours(model, ROBOT).tint
    geoms = [geom for part in tint.parts for geom in part]
    materials = {model.material(name).id for name in LOOKS.takes}
    assert len(geoms) == len(set(geoms)) and all(tint.parts)
    assert set(geoms) == {i for i in range(model.ngeom) if model.geom_matid[i] in materials}
    assert not any(model.body(model.geom_bodyid[geom]).name.startswith("person") for geom in geoms)


@pytest.mark.parametrize("sight", SIGHT)
def test_colour_blind_people_tell_the_colours_and_the_bare_shells_apart(simulator, sight):
    shell = simulator.model.material("shell").rgba[:3]
    take = LOOKS.takes["shell"]
    seen = [shell, *((1.0 - take) * shell + take * np.array(colour) for colour in LOOKS.colours.values())]
    labs = [_lab(np.clip(np.array(SIGHT[sight]) @ _linear(rgb), 0.0, 1.0)) for rgb in seen]
    assert min(np.linalg.norm(a - b) for a, b in combinations(labs, 2)) > 25.0


def test_a_film_colours_exactly_the_limbs_that_would_have_met(simulator, tmp_path):
    pictures = {
        name: _film(simulator, tmp_path / name, interventions)
        for name, interventions in {
            "nothing": spell(),
            "collision": spell(change("self_collision", links=("LForeArm", "Head")), last=STEPS),
        }.items()
    }
    assert np.array_equal(pictures["nothing"], _film(simulator, tmp_path / "off", spell(), overlay="none"))
    changed = (pictures["collision"] != pictures["nothing"]).any(axis=-1)[:80]  # the captions are below
    limbs = _pixels_of(simulator, ("LShoulder", "LBicep", "LElbow", "LForeArm", "l_", "LF", "LThumb", "Head", "Neck"))
    assert not (changed & ~limbs[:80]).any()
    assert changed.sum() > 0.85 * limbs[:80].sum()  # eyes and buttons keep their colour


def _film(simulator, path, interventions, overlay="safety"):
    """The last frame (120, 160, 3) of a film of a robot that stands still."""
    from PIL import Image

    positions = np.tile(ROBOT.postures["StandInit"], (STEPS, 1))
    base = np.tile(simulator.base_pose(), (STEPS, 1))
    rollout = Rollout(TIMES, positions, positions, positions, 0.0 * positions, base)
    film = Film(path.with_suffix(".png"), 2.0, (160, 120), "front", "draft", overlay=overlay)
    with Crew(film, simulator, None, 1.0, _backend()) as crew:
        crew.shoot(rollout, lambda done, total: None, interventions)
    return np.asarray(Image.open(sorted(path.iterdir())[-1]))


def _pixels_of(simulator, prefixes):
    """(120, 160) where bodies of these names are seen: where a film in which they are black differs."""
    before = simulator.model.geom_rgba.copy()
    shown = []
    for rgba in ((1.0, 1.0, 1.0, 1.0), (0.0, 0.0, 0.0, 1.0)):
        for geom in range(simulator.model.ngeom):
            if simulator.model.body(simulator.model.geom_bodyid[geom]).name.startswith(prefixes):
                simulator.model.geom_rgba[geom] = rgba
        shown.append(_still(simulator))
    simulator.model.geom_rgba[:] = before
    return (shown[0] != shown[1]).any(axis=-1)


def _still(simulator):
    from nao_sim.rendering import render_still

    return render_still(simulator.model, simulator.data.qpos, (160, 120), "front", "draft", _backend())


def _backend():
    from nao_sim.errors import RenderingError

    try:
        return choose_backend()
    except RenderingError as error:
        pytest.skip(str(error))


def _linear(rgb):
    """Linear light of sRGB (IEC 61966-2-1)."""
    rgb = np.asarray(rgb, float)
    return np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)


def _lab(linear):
    """CIELAB (CIE 1976) under D65."""
    to_xyz = [(0.4124, 0.3576, 0.1805), (0.2126, 0.7152, 0.0722), (0.0193, 0.1192, 0.9505)]
    x, y, z = np.array(to_xyz) @ linear / (0.9505, 1.0, 1.0890)
    x, y, z = (np.cbrt(v) if v > 0.008856 else 7.787 * v + 16.0 / 116.0 for v in (x, y, z))
    return np.array([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)])
