"""Surroundings and colours change what is seen, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim.errors import UsageError
from nao_sim.rendering.looks import dress
from nao_sim.rendering.presets import load_figure, load_look, load_theme, look_names, theme_names
from nao_sim.simulation.scene import PINNED_FLOOR, compiled, compose

PLAIN = load_look("studio"), load_theme("orange")


def _compiled(look="studio", theme="orange", base="free"):
    return compiled(dress(compose(base=base), load_look(look), load_theme(theme)))


def test_the_promised_names_are_there_and_the_first_ones_change_nothing():
    assert look_names() == ("studio", "classroom", "lab")
    assert theme_names()[0] == "orange" and len(theme_names()) > 2
    assert compose().to_xml_string() == dress(compose(), *PLAIN).to_xml_string()


@pytest.mark.parametrize("look", look_names()[1:])
@pytest.mark.parametrize("base", ["free", "pinned"])
def test_what_stands_around_is_never_touched_and_poses_mean_the_same(look, base):
    plain, dressed = _compiled(base=base), _compiled(look, base=base)
    added = np.arange(dressed.ngeom) >= 0
    added[[dressed.geom(plain.geom(i).name).id for i in range(plain.ngeom) if plain.geom(i).name]] = False
    added &= dressed.geom_bodyid == 0
    assert (dressed.geom_contype[added] == 0).all() and (dressed.geom_conaffinity[added] == 0).all()
    assert added.sum() == dressed.ngeom - plain.ngeom > 0
    assert dressed.nq == plain.nq and dressed.nbody == plain.nbody
    floor = PINNED_FLOOR if base == "pinned" else 0.0
    lowest = dressed.geom_pos[added, 2] - dressed.geom_size[added, 2]
    assert lowest.min() >= floor - 1e-9


@pytest.mark.parametrize("look", look_names())
@pytest.mark.parametrize("where", [(0.0, 0.0), load_figure().place])
def test_nothing_higher_than_tape_stands_where_arms_reach(look, where):
    for thing in load_look(look).things:
        beside = np.abs(np.subtract(thing.at[:2], where)) - thing.size[:2]
        tape = thing.at[2] + thing.size[2] < 0.01
        assert tape or np.hypot(*np.maximum(beside, 0.0)) > 0.5, thing


@pytest.mark.parametrize("theme", theme_names())
def test_a_theme_colours_materials_of_the_robot(theme):
    model, colours = _compiled(theme=theme), load_theme(theme).colours
    for material, colour in colours.items():
        np.testing.assert_allclose(model.material(material).rgba[:3], colour, atol=1e-6)


@pytest.mark.parametrize(("load", "kind"), [(load_look, "look"), (load_theme, "theme")])
def test_an_unknown_name_is_refused_with_the_known_ones(load, kind):
    with pytest.raises(UsageError, match=f"{kind} 'best' is not known; expected one of .*, "):
        load("best")
