"""Choosing a back end."""

import subprocess
import sys

import pytest

from nao_sim.errors import RenderingError
from nao_sim.rendering import backend as module
from nao_sim.rendering import choose_backend, start_probe


@pytest.fixture(autouse=True)
def forget(monkeypatch):
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.delenv("DISPLAY", raising=False)
    module._choose.cache_clear()
    yield
    module._choose.cache_clear()


def probes(monkeypatch, outcome):
    """Replace the probe; returns the names it was asked for."""
    asked = []

    def probe(name):
        asked.append(name)
        return outcome.get(name, ("", "no driver"))

    monkeypatch.setattr(module, "_probe", probe)
    return asked


def test_when_egl_renders_expect_nothing_else_is_tried_and_the_answer_is_remembered(monkeypatch):
    asked = probes(monkeypatch, {"egl": ("llvmpipe (LLVM 15)", "")})
    first, second = choose_backend(), choose_backend()
    assert first is second and asked == ["egl"]
    assert (first.name, first.renderer, first.tried, first.is_software) == (
        "egl",
        "llvmpipe (LLVM 15)",
        ("egl",),
        True,
    )


def test_when_egl_is_broken_expect_osmesa(monkeypatch):
    probes(monkeypatch, {"osmesa": ("softpipe", "")})
    assert choose_backend().tried == ("egl", "osmesa")


@pytest.mark.parametrize(("display", "tried"), [(None, ["egl", "osmesa"]), (":0", ["egl", "osmesa", "glfw"])])
def test_when_none_renders_expect_one_line_that_says_what_to_install(monkeypatch, display, tried):
    asked = probes(monkeypatch, {})
    if display:
        monkeypatch.setenv("DISPLAY", display)
    with pytest.raises(RenderingError, match=r"no OpenGL back end.*egl.*osmesa.*apt-get install libegl1") as caught:
        choose_backend()
    assert asked == tried and "\n" not in str(caught.value) and caught.value.exit_status == 3


def test_when_mujoco_gl_is_set_expect_only_that_one(monkeypatch):
    asked = probes(monkeypatch, {"egl": ("GPU", "")})
    monkeypatch.setenv("MUJOCO_GL", "osmesa")
    with pytest.raises(RenderingError, match=r"MUJOCO_GL=osmesa cannot render here.*no driver"):
        choose_backend()
    assert asked == ["osmesa"]


def test_when_mujoco_gl_is_no_back_end_expect_the_known_ones(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "off")
    with pytest.raises(RenderingError, match=r"MUJOCO_GL=off.*egl, osmesa, glfw"):
        choose_backend()


def test_when_probed_beside_other_work_expect_the_same_answer_or_error(monkeypatch):
    probes(monkeypatch, {})
    with pytest.raises(RenderingError):
        start_probe().result(10)


@pytest.mark.parametrize(
    ("script", "reason"),
    [
        ("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)", "killed by signal 11"),
        ("raise ImportError('no libEGL')", "no libEGL"),
        ("import sys; sys.exit(1)", "exit status 1"),
    ],
)
def test_when_the_driver_breaks_the_child_expect_a_reason(monkeypatch, tmp_path, script, reason):
    (tmp_path / "probe.py").write_text(script)
    monkeypatch.setattr(module, "__file__", str(tmp_path / "backend.py"))
    with pytest.raises(RenderingError, match=reason):
        choose_backend()


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("AttributeError: 'NoneType' object has no attribute 'eglQueryString'", "its library is not installed"),
        ("AttributeError: 'NoneType' object has no attribute 'glGetError'", "its library is not installed"),
        ("ImportError: Cannot initialize a EGL device display. This likely means", "no driver for it"),
        ("mujoco.FatalError: an OpenGL platform library has not been loaded into", "the display does not answer"),
    ],
)
def test_what_libraries_say_of_a_driver_that_is_missing_is_told_in_words(monkeypatch, tmp_path, said, meant):
    (tmp_path / "probe.py").write_text(f"raise SystemExit({said!r})")
    monkeypatch.setattr(module, "__file__", str(tmp_path / "backend.py"))
    assert meant in module._probe("egl")[1]


def test_when_the_driver_hangs_expect_a_reason(monkeypatch, tmp_path):
    (tmp_path / "probe.py").write_text("import threading; threading.Event().wait()")
    monkeypatch.setattr(module, "__file__", str(tmp_path / "backend.py"))
    monkeypatch.setattr(module, "_TIMEOUT_S", 0.2)
    with pytest.raises(RenderingError, match=r"no answer"):
        choose_backend()


def test_importing_the_package_loads_no_renderer():
    code = "import sys, nao_sim.rendering; sys.exit(bool({'mujoco', 'OpenGL', 'av', 'dm_control'} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
