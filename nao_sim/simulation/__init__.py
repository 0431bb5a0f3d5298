"""The robot in MuJoCo physics: scene, stepper, rollout and what is measured on it."""

from nao_sim.no_gl import import_mjcf

import_mjcf()
