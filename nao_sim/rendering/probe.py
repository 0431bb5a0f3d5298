"""Run as a script in a child process: can this machine render with the back end in MUJOCO_GL?

Prints the driver's name (GL_RENDERER) and leaves with 0 where a white ball on black comes out as a picture.
Import errors, driver crashes and blank pictures all leave with another status.
"""

from __future__ import annotations

import os
import sys

_SIDE = 16  # pixels
_BALL = f"""<mujoco>
  <visual><quality shadowsize="0" offsamples="0"/><global offwidth="{_SIDE}" offheight="{_SIDE}"/></visual>
  <worldbody><light pos="0 0 3"/><geom size="0.5" rgba="1 1 1 1"/></worldbody>
</mujoco>"""


def render_ball() -> tuple[int, int]:
    """Render a white ball before a black background: (darkest, brightest) pixel value."""
    import mujoco
    import numpy as np

    model = mujoco.MjModel.from_xml_string(_BALL)
    gl = mujoco.GLContext(_SIDE, _SIDE)
    gl.make_current()
    context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_50.value)
    mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, context)
    data, scene, camera = mujoco.MjData(model), mujoco.MjvScene(model, 10), mujoco.MjvCamera()
    mujoco.mj_forward(model, data)
    camera.distance = 3.0
    mujoco.mjv_updateScene(model, data, mujoco.MjvOption(), None, camera, mujoco.mjtCatBit.mjCAT_ALL.value, scene)
    pixels, whole = np.zeros((_SIDE, _SIDE, 3), np.uint8), mujoco.MjrRect(0, 0, _SIDE, _SIDE)
    mujoco.mjr_render(whole, scene, context)
    mujoco.mjr_readPixels(pixels, None, whole, context)
    print(renderer_name(), flush=True)
    return int(pixels.min()), int(pixels.max())


def renderer_name() -> str:
    """GL_RENDERER of the current context."""
    import ctypes

    from OpenGL.raw.GL.VERSION.GL_1_0 import glGetString  # OpenGL.GL loads slowly

    name = glGetString(0x1F01)
    return ctypes.string_at(name).decode() if name else "unknown"


if __name__ == "__main__":
    darkest, brightest = render_ball()
    if darkest == brightest:
        print(f"a blank picture (every pixel is {darkest})", file=sys.stderr, flush=True)
    os._exit(0 if darkest < brightest else 1)  # some drivers crash in their exit handlers
