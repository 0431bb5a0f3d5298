"""A player's buttons: whatever is pressed, in whatever order."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.viewing.keys import KEYS, STEP, STRIDE, press, told
from nao_sim.viewing.playback import SPEEDS, Layer, Playback

SECONDS = st.floats(0.0, 20.0)
CODES = st.sampled_from([code for key in KEYS for code in key.codes])
MUJOCOS_OWN = {*range(ord("0"), ord("6")), *range(ord("A"), ord("Z") + 1), *range(290, 302)}


@given(st.floats(0.0, 10.0), st.lists(st.one_of(CODES, st.floats(0.0, 3.0))))
def test_whatever_is_pressed_the_moment_lies_in_the_recording_and_the_speed_is_one_of_the_list(duration, events):
    player = Playback(duration)
    for event in events:
        if isinstance(event, float):
            player.advance(event)
        else:
            press(event, player)
        assert 0.0 <= player.time <= duration and player.speed in SPEEDS


@given(st.lists(SECONDS), st.sampled_from(SPEEDS))
def test_time_passes_at_the_speed_and_stops_at_the_end(passed, speed):
    player = Playback(10.0)
    player.speed = speed
    for seconds in passed:
        player.advance(seconds)
    assert player.time == pytest.approx(min(speed * sum(passed), 10.0))
    assert player.playing == (player.time < 10.0)


@given(SECONDS, SECONDS)
def test_a_pause_stands_still_and_the_end_begins_again(at, passed):
    player = Playback(20.0, playing=False)
    player.seek(at)
    player.advance(passed)
    assert player.time == at
    player.toggle()
    assert player.playing and player.time == (0.0 if at == 20.0 else at)


@pytest.mark.parametrize(("code", "moved"), [(262, STRIDE), (263, -STRIDE), (46, STEP), (44, -STEP)])
def test_a_jump_goes_its_way_and_stays_there(code, moved):
    player = Playback(20.0)
    player.seek(5.0)
    press(code, player)
    player.advance(1.0)
    assert player.time == pytest.approx(5.0 + moved) and not player.playing


def test_a_key_shows_its_layer_and_the_next_stroke_hides_it():
    player = Playback(1.0, [Layer.person])
    for code, layer in ((54, Layer.person), (55, Layer.collision), (56, Layer.contacts), (57, Layer.safety)):
        before = player.shown
        press(code, player)
        assert player.shown ^ before == {layer}
        press(code, player)
        assert player.shown == before


def test_no_key_is_taken_twice_nor_one_of_mujocos_own_and_all_are_told():
    codes = [code for key in KEYS for code in key.codes]
    assert len(set(codes)) == len(codes) and MUJOCOS_OWN.isdisjoint(codes)
    assert len(told().splitlines()) == len(KEYS)
