"""The table of cameras and qualities."""

import pytest

from nao_sim.errors import UsageError
from nao_sim.rendering import camera_names, quality_names
from nao_sim.rendering.presets import WITH_TWO, load_camera, load_figure, load_quality, load_shadow


def test_the_promised_names_are_there():
    assert camera_names() == ("front", "three-quarter", "side", "top", "orbit", "follow", "head")
    assert quality_names() == ("draft", "standard", "fine")


@pytest.mark.parametrize("name", quality_names())
def test_every_quality_is_whole(name):
    quality = load_quality(name)
    assert quality.supersample >= 1
    assert {"preset", "crf"} <= set(quality.mp4) and "crf" in quality.webm
    assert (quality.shadow_map > 0) == (quality.shadow_lights > 0)
    assert load_shadow().reach > load_shadow().step


def test_qualities_go_from_fast_to_beautiful():
    qualities = [load_quality(name) for name in quality_names()]
    assert [q.shadow_map for q in qualities] == sorted(q.shadow_map for q in qualities)
    assert qualities[0].shadow_map == 0 and qualities[-1].reflection


@pytest.mark.parametrize("name", camera_names())
def test_every_camera_is_a_preset_or_a_model_camera(name):
    camera = load_camera(name)
    if name == "head":
        assert camera.model_camera == "CameraTop"
    else:
        ends = (load_figure("beside").camera, load_figure("behind").camera, WITH_TWO)
        beside, behind, with_two = (load_camera(f"{name}{end}").distance for end in ends)
        assert 0.75 < camera.distance < min(beside, behind) and max(beside, behind) < with_two


@pytest.mark.parametrize(("load", "kind"), [(load_camera, "camera"), (load_quality, "quality")])
def test_an_unknown_name_is_refused_with_the_known_ones(load, kind):
    with pytest.raises(UsageError, match=f"{kind} 'best' is not known; expected one of .*, "):
        load("best")
