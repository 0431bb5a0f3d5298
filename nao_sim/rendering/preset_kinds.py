"""What a row of `render/presets.toml` says: cameras, qualities, surroundings, colours, and how people are drawn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Camera:
    """Where a picture is taken from; either `model_camera` or the rest.

    Attributes:
        name: the preset's name.
        model_camera: name of a camera in the model, or None.
        lookat: (3,) m, the point in the middle of the picture; the robot stands at the origin and faces +x.
        distance: m, from `lookat` to the camera.
        azimuth_deg: direction of view about z, 0 looks along +x and 90 along +y.
        elevation_deg: direction of view above the horizon, negative looks down.
        fovy_deg: vertical field of view.
        turn_s: s in which it goes once round `lookat`; 0 stands still.
        follows: whether it goes along with the robot's torso over the floor.
    """

    name: str
    model_camera: str | None = None
    lookat: tuple[float, float, float] = (0.0, 0.0, 0.0)
    distance: float = 1.0
    azimuth_deg: float = 180.0
    elevation_deg: float = 0.0
    fovy_deg: float = 45.0
    turn_s: float = 0.0
    follows: bool = False

    @property
    def stands(self) -> bool:
        """Whether it never moves."""
        return self.model_camera is None and not self.turn_s and not self.follows

    @property
    def width(self) -> int:
        """Numbers of each frame that say where it is: how far (deg) it has turned, if it does."""
        return 1 if self.turn_s else 0

    def rows(self, times: NDArray[np.float64]) -> NDArray[np.float64]:
        """Those numbers (N, width) at times (N,) s."""
        if not self.turn_s:
            return np.zeros((len(times), 0))
        return np.mod(np.round(times[:, None] * 360.0 / self.turn_s, 6), 360.0)  # a whole turn is none


@dataclass(frozen=True)
class Shadow:
    """The square that has shadows.

    Attributes:
        reach: m, half its side.
        step: m, it follows the robot in steps of this length.
    """

    reach: float
    step: float


@dataclass(frozen=True)
class FigureLooks:
    """How the recorded person is drawn.

    Attributes:
        place: (2,) m, where on the floor; the robot stands at the origin and faces +x.
        height: m, how tall.
        camera: end of the name of the cameras' presets that have the person in the picture, too.
        radius: m, of a bone.
        head_radius: m, of the head.
        opacity: 0 to 1.
        left: red, green, blue of the person's left side.
        right: of the right side.
        middle: of the rest.
    """

    place: tuple[float, float]
    height: float
    camera: str
    radius: float
    head_radius: float
    opacity: float
    left: tuple[float, float, float]
    right: tuple[float, float, float]
    middle: tuple[float, float, float]

    def colour(self, bone: str) -> tuple[float, float, float]:
        """The colour of a bone, by its name's side."""
        across = "left" in bone and "right" in bone
        return (
            self.middle if across else self.left if "left" in bone else self.right if "right" in bone else self.middle
        )


@dataclass(frozen=True)
class ReasonLooks:
    """How a film shows one of the guard's reasons to change a joint.

    Attributes:
        colour: name of a colour of `SafetyLooks`.
        word: what the caption says.
        least_deg: degrees; smaller changes of a joint are not shown.
        where: `joints` colours the limbs whose joints it changed, `links` those of the two links that would have
            met, anything else is a list of the parts to colour.
    """

    colour: str
    word: str
    least_deg: float
    where: str | tuple[str, ...] = "joints"


@dataclass(frozen=True)
class SafetyLooks:
    """How a film shows what the guard changed.

    Attributes:
        fade: s, in which a colour comes and goes.
        hold: s for which it stays at least.
        letter: height of a line of the captions, as a share of the picture's.
        least_hand: of a hand's opening; smaller changes are not shown.
        takes: how far each material takes the colour, 0 to 1.
        colours: red, green and blue by name; the later ones cover the earlier ones.
        reasons: by the guard's names; what is not here is not shown.
    """

    fade: float
    hold: float
    letter: float
    least_hand: float
    takes: Mapping[str, float] = field(hash=False)
    colours: Mapping[str, tuple[float, float, float]] = field(hash=False)
    reasons: Mapping[str, ReasonLooks] = field(hash=False)


@dataclass(frozen=True)
class SecondLooks:
    """Where a second robot is.

    Attributes:
        place: (2,) m on the floor, from the first one.
    """

    place: tuple[float, float]


@dataclass(frozen=True)
class GestureLooks:
    """How a film shows what is recognised.

    Attributes:
        steady: s for which the number in a caption stays at least.
        pose: red, green and blue of a pose's dot, 0 to 1.
        movement: of a movement's.
    """

    steady: float
    pose: tuple[float, float, float]
    movement: tuple[float, float, float]


@dataclass(frozen=True)
class Quality:
    """What is drawn, and how it is encoded.

    Attributes:
        name: the preset's name.
        supersample: pixels rendered along each side of a picture pixel, at least 1.
        msaa: multisampling, samples a pixel (0 is off).
        shadow_map: side of the shadow map in texels (0 is no shadow).
        shadow_lights: how many lights may cast shadows.
        reflection: whether reflective floors mirror the robot.
        mp4: options of the H.264 encoder.
        webm: options of the VP9 encoder.
    """

    name: str
    supersample: float
    msaa: int
    shadow_map: int
    shadow_lights: int
    reflection: bool
    mp4: Mapping[str, str] = field(hash=False)
    webm: Mapping[str, str] = field(hash=False)


@dataclass(frozen=True)
class Thing:
    """Something that stands around.

    Attributes:
        shape: `box`, `sphere`, `cylinder`, `capsule` or `ellipsoid`.
        at: (3,) m, its middle; the robot stands at the origin and faces +x.
        size: m, as MuJoCo has it: half sides, or radius and half length.
        colour: red, green, blue.
        turned_deg: about z.
    """

    shape: str
    at: tuple[float, float, float]
    size: tuple[float, ...]
    colour: tuple[float, float, float]
    turned_deg: float = 0.0


@dataclass(frozen=True)
class Look:
    """What is around the robot; what is left out is as the model's scene has it.

    Attributes:
        name: the preset's name.
        floor: changes of the floor's texture.
        surface: changes of the floor's material.
        sky: changes of the sky's texture.
        headlight: changes of the light at the camera.
        things: what stands around.
    """

    name: str
    floor: Mapping[str, Any] = field(default_factory=dict, hash=False)
    surface: Mapping[str, Any] = field(default_factory=dict, hash=False)
    sky: Mapping[str, Any] = field(default_factory=dict, hash=False)
    headlight: Mapping[str, Any] = field(default_factory=dict, hash=False)
    things: tuple[Thing, ...] = ()


@dataclass(frozen=True)
class Theme:
    """What colours the robot wears.

    Attributes:
        name: the preset's name.
        colours: red, green and blue by material of the model; those left out stay.
    """

    name: str
    colours: Mapping[str, tuple[float, float, float]] = field(default_factory=dict, hash=False)
