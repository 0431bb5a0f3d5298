"""What is around the robot and what colours it wears, put into a scene before it is compiled."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nao_sim.rendering.preset_kinds import Look, Theme, Thing

if TYPE_CHECKING:
    from dm_control import mjcf

VISIBLE = 1  # geom group of what is seen and never touched


def dress(scene: mjcf.RootElement, look: Look, theme: Theme) -> mjcf.RootElement:
    """The scene, changed: other surroundings, other colours of the robot.  Poses of it mean the same as before.

    Args:
        scene: as `nao_sim.simulation.scene.compose` makes it.
        look: the surroundings.
        theme: colours by material.
    """
    for material, colour in theme.colours.items():
        scene.find("material", material).rgba = (*colour, 1.0)
    for name, changes in (("floor", look.floor), ("sky", look.sky)):
        for key, value in changes.items():
            setattr(scene.find("texture", name), key, value)
    for key, value in look.surface.items():
        setattr(scene.find("material", "floor"), key, value)
    for key, value in look.headlight.items():
        setattr(scene.visual.headlight, key, value)
    floor = scene.find("geom", "floor")
    height = floor.pos[2] if floor.pos is not None else 0.0
    for thing in look.things:
        _add(scene, thing, height)
    return scene


def _add(scene: mjcf.RootElement, thing: Thing, floor: float) -> None:
    x, y, z = thing.at
    scene.worldbody.add(
        "geom",
        type=thing.shape,
        pos=(x, y, z + floor),
        size=thing.size,
        euler=(0.0, 0.0, thing.turned_deg),
        rgba=(*thing.colour, 1.0),
        contype=0,
        conaffinity=0,
        group=VISIBLE,
    )
