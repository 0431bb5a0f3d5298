"""The keys of the window: one table for what they do and for what is told of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from nao_sim.viewing.playback import Layer, Playback

STEP, STRIDE = 0.02, 0.5  # s: a control step, and what a longer key stroke moves


@dataclass(frozen=True)
class Key:
    """A key.

    Attributes:
        codes: of the keyboard, as GLFW numbers them.
        name: printed on it.
        does: in words.
        press: does it.
    """

    codes: tuple[int, ...]
    name: str
    does: str
    press: Callable[[Playback], None]


# MuJoCo's viewer keeps most letters and the digits 0 to 5 for itself, and gives no modifiers: these are what is left.
KEYS = (
    Key((32,), "Space", "pause and go on", Playback.toggle),
    Key((263,), "Left", "half a second back", lambda player: player.jump(-STRIDE)),
    Key((262,), "Right", "half a second forward", lambda player: player.jump(STRIDE)),
    Key((44,), ",", "one step (20 ms) back", lambda player: player.jump(-STEP)),
    Key((46,), ".", "one step (20 ms) forward", lambda player: player.jump(STEP)),
    Key((268,), "Home", "to the start", lambda player: player.seek(0.0)),
    Key((269,), "End", "to the end", lambda player: player.jump(player.duration)),
    Key((45, 333), "-", "slower", Playback.slower),
    Key((61, 334), "=", "faster", Playback.faster),
    Key((54,), "6", "person", lambda player: player.show(Layer.person)),
    Key((55,), "7", "collision shapes", lambda player: player.show(Layer.collision)),
    Key((56,), "8", "contacts", lambda player: player.show(Layer.contacts)),
    Key((57,), "9", "safety colours", lambda player: player.show(Layer.safety)),
)
_BY_CODE = {code: key for key in KEYS for code in key.codes}


def press(code: int, player: Playback) -> None:
    """Do what a key does; keys that are not in the table do nothing."""
    if key := _BY_CODE.get(code):
        key.press(player)


def told() -> str:
    """All keys in a line each."""
    width = max(len(key.name) for key in KEYS)
    return "\n".join(f"{key.name:<{width}}  {key.does}" for key in KEYS)
