"""Which OpenGL back end can render off-screen here: probed in child processes, which a broken driver may crash.

`MUJOCO_GL` is honoured when set.  Otherwise EGL is tried first (GPU or Mesa's software, the faster of the two),
then OSMesa, then GLFW where a display is there.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from threading import Thread

from nao_sim.errors import RenderingError

BACKENDS = ("egl", "osmesa", "glfw")
INSTALL = {"egl": "apt-get install libegl1 libegl-mesa0 libgl1", "osmesa": "apt-get install libosmesa6"}
_INSTALL = f"install one: {', or '.join(INSTALL.values())}"
_SOFTWARE = ("llvmpipe", "softpipe", "swrast", "swr ", "software")
_TIMEOUT_S = 30.0
_MEANT = {  # what PyOpenGL and MuJoCo say, and what it means
    re.compile(r"'NoneType' object has no attribute '(gl|egl|OSMesa)"): "its library is not installed",
    re.compile(r"Cannot initialize a EGL device display"): "its library is there, but no driver for it",
    re.compile(r"OpenGL platform library has not been loaded"): "the display does not answer, or has no OpenGL",
}


@dataclass(frozen=True)
class Backend:
    """An OpenGL back end that rendered a picture on this machine.

    Attributes:
        name: `egl`, `osmesa` or `glfw`, the value for MUJOCO_GL.
        renderer: the driver's name (GL_RENDERER).
        tried: the back ends that were probed, in order, the chosen one last.
    """

    name: str
    renderer: str
    tried: tuple[str, ...]

    @property
    def is_software(self) -> bool:
        """True where the processor, not a GPU, draws."""
        return any(word in self.renderer.lower() for word in _SOFTWARE)


@dataclass(frozen=True)
class Trial:
    """What came of a back end that was probed.

    Attributes:
        name: of the back end.
        renderer: the driver's name where it renders, otherwise empty.
        failure: why it does not, in a line; otherwise empty.
    """

    name: str
    renderer: str
    failure: str


def try_backends() -> tuple[Trial, ...]:
    """Probe every back end that this machine may have, whatever `MUJOCO_GL` says."""
    return tuple(map(probe, _candidates(bool(os.environ.get("DISPLAY")))))


def probe(name: str) -> Trial:
    """Try one back end, whatever `MUJOCO_GL` says."""
    return Trial(name, *_probe(name))


def choose_backend() -> Backend:
    """The first back end that renders; found once a process, then remembered.

    Raises:
        RenderingError: the one that MUJOCO_GL names does not render, or none does.
    """
    return _choose(os.environ.get("MUJOCO_GL", "").strip().lower(), bool(os.environ.get("DISPLAY")))


def start_probe() -> Future[Backend]:
    """Begin `choose_backend` beside other work; `.result()` waits for it, and raises what it raises."""
    future: Future[Backend] = Future()

    def probe() -> None:
        try:
            future.set_result(choose_backend())
        except BaseException as error:
            future.set_exception(error)

    Thread(target=probe, name="gl-probe", daemon=True).start()
    return future


def gl_environment(name: str, **extra: str) -> Mapping[str, str]:
    """The environment of a child process that renders with back end `name`."""
    platform = {"egl": "egl", "osmesa": "osmesa"}.get(name)
    inherited = {key: value for key, value in os.environ.items() if key != "PYOPENGL_PLATFORM"}
    return inherited | {"MUJOCO_GL": name} | ({"PYOPENGL_PLATFORM": platform} if platform else {}) | extra


@cache
def _choose(wanted: str, has_display: bool) -> Backend:
    if wanted and wanted not in BACKENDS:
        raise RenderingError(f"MUJOCO_GL={wanted} cannot render off-screen; expected one of {', '.join(BACKENDS)}")
    candidates = (wanted,) if wanted else _candidates(has_display)
    failures: list[str] = []
    for i, name in enumerate(candidates):
        renderer, failure = _probe(name)
        if renderer:
            return Backend(name, renderer, candidates[: i + 1])
        failures.append(f"{name} ({failure})")
    if wanted:
        raise RenderingError(f"MUJOCO_GL={wanted} cannot render here: {failures[0]}; unset MUJOCO_GL, or {_INSTALL}")
    raise RenderingError(f"no OpenGL back end can render here; tried {', '.join(failures)}; {_INSTALL}")


def _candidates(has_display: bool) -> tuple[str, ...]:
    return BACKENDS if has_display else tuple(name for name in BACKENDS if name != "glfw")


def _probe(name: str) -> tuple[str, str]:
    """(GL_RENDERER, "") where `name` renders, otherwise ("", the reason in a line)."""
    script = Path(__file__).with_name("probe.py")
    try:
        done = subprocess.run(
            [sys.executable, "-P", str(script)],
            env=gl_environment(name),
            capture_output=True,
            text=True,
            errors="replace",
            timeout=_TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return "", f"no answer in {_TIMEOUT_S:.0f} s"
    lines = done.stdout.strip().splitlines()
    if done.returncode == 0 and lines:
        return lines[-1], ""
    if meant := next((words for said, words in _MEANT.items() if said.search(done.stderr)), ""):
        return "", meant
    return "", last_line(done.stderr) or exit_reason(done.returncode)


def last_line(text: str, limit: int = 100) -> str:
    """The last line that says something, as a traceback's does."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1][:limit] if lines else ""


def exit_reason(status: int | None) -> str:
    """An exit status in words."""
    return f"killed by signal {-status}" if status is not None and status < 0 else f"exit status {status}"
