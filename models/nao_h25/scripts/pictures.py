"""Pictures of the model for its README: four views of the robot, and its collision shapes.

MUJOCO_GL=egl python models/nao_h25/scripts/pictures.py
"""

from __future__ import annotations

import mujoco
import numpy as np
from PIL import Image
from tables import MODEL

PICTURES = MODEL / "pictures"
AZIMUTHS_DEG = (180, 217, 270, 0)  # from the front, three quarters, its left side, the back
SIZE = (640, 400)  # height and width of one view; rendered twice as large, then halved
COLOURS = 255
FLOOR_GROUP, VISUAL_GROUP, COLLISION_GROUP = 0, 2, 3


def main() -> None:
    """Write `robot.png` and `collision.png`."""
    PICTURES.mkdir(exist_ok=True)
    model = mujoco.MjModel.from_xml_path(str(MODEL / "scene.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("StandInit").id)
    mujoco.mj_forward(model, data)
    save("robot.png", views(model, data, VISUAL_GROUP))
    solid(model)
    save("collision.png", views(model, data, COLLISION_GROUP))


def solid(model: mujoco.MjModel) -> None:
    """Opaque shapes, each kind of contact rule in its own colour: bodies, fingers, soles."""
    for geom in np.flatnonzero(model.geom_group == COLLISION_GROUP):
        name = model.geom(geom).name
        model.geom_rgba[geom] = (
            (0.35, 0.55, 0.85, 1) if "sole" in name else
            (0.45, 0.70, 0.45, 1) if "Finger" in name or "Thumb" in name else
            (0.93, 0.60, 0.25, 1)
        )  # fmt: skip


def views(model: mujoco.MjModel, data: mujoco.MjData, group: int) -> Image.Image:
    """All views side by side, with only the given group of the robot's geoms."""
    option = mujoco.MjvOption()
    option.geomgroup[:] = 0
    option.geomgroup[[FLOOR_GROUP, group]] = 1
    option.flags[mujoco.mjtVisFlag.mjVIS_RANGEFINDER] = False  # no sonar beams
    height, width = SIZE
    renderer = mujoco.Renderer(model, 2 * height, 2 * width)
    pictures = []
    for azimuth in AZIMUTHS_DEG:
        renderer.update_scene(data, camera_at(azimuth), option)
        pictures.append(renderer.render())
    renderer.close()
    row = Image.fromarray(np.concatenate(pictures, axis=1))
    return row.resize((width * len(AZIMUTHS_DEG), height), Image.Resampling.LANCZOS)


def camera_at(azimuth: float) -> mujoco.MjvCamera:
    """A camera that sees the whole robot, looking along `azimuth` (degrees, 0 is the robot's forward)."""
    camera = mujoco.MjvCamera()
    camera.lookat[:] = 0.0, 0.0, 0.28
    camera.distance, camera.azimuth, camera.elevation = 1.38, azimuth, -6.0
    return camera


def save(name: str, picture: Image.Image) -> None:
    """Few colours make a small file."""
    picture.quantize(COLOURS, dither=Image.Dither.NONE).save(PICTURES / name, optimize=True)


if __name__ == "__main__":
    main()
