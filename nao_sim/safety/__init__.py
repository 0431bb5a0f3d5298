"""What keeps the robot safe: limits, speeds, distances, and the guard that composes them."""

from nao_sim.no_gl import import_mujoco

import_mujoco()
