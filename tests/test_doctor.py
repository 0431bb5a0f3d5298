"""The doctor finds what is wrong with a machine, and says what to do."""

from __future__ import annotations

import json
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim import cli, doctor
from nao_sim.checkup import Checkup, Package, Picture, checkup, packages
from nao_sim.rendering import backend
from nao_sim.rendering.backend import Trial

VERSIONS = st.tuples(*(st.integers(0, 30),) * 3)
WORKING = (Trial("egl", "llvmpipe", ""), Trial("osmesa", "", "its library is not installed"))


@pytest.fixture(autouse=True)
def anywhere(monkeypatch):
    monkeypatch.delenv("MUJOCO_GL", raising=False)


def _healthy(tmp_path, **other):
    return Checkup(**({"packages": (), "backends": WORKING, "picture": Picture(tmp_path / "doctor.png", 1.0)} | other))


@given(VERSIONS, VERSIONS)
def test_a_package_fits_when_its_version_is_not_older_than_what_is_asked_for(found, wanted):
    package = Package("x", ".".join(map(str, found)), f">={'.'.join(map(str, wanted))}")
    assert package.fits == (found >= wanted)


def test_what_is_not_installed_does_not_fit_and_is_asked_for_by_its_extra():
    (needed, extra) = packages(["no-such-package<2,>=1", 'nor-this-one>=3; extra == "learn"'])
    assert (needed.fits, needed.extra, extra.fits, extra.extra) == (False, "", False, "learn")
    assert needed.remedy == f"pip install 'no-such-package{needed.expected}'"
    assert extra.remedy == "pip install 'nao-sim[learn]'"


def test_a_requirement_for_other_systems_is_left_out():
    assert not list(packages(["no-such-package; sys_platform == 'a made-up one'"]))


def test_a_missing_package_is_advised_and_status_1(tmp_path, monkeypatch, capsys):
    missing = Package("mujoco", "4.0.0", "<3.18,>=3.17")
    monkeypatch.setattr("nao_sim.checkup.checkup", lambda path: _healthy(tmp_path, packages=(missing,)))
    assert cli.main(["doctor", "-o", str(tmp_path / "doctor.png")]) == doctor.UNFIT_STATUS
    said = capsys.readouterr().out
    assert "mujoco 4.0.0; expected <3.18,>=3.17" in said and "pip install 'mujoco<3.18,>=3.17'" in said


def test_where_nothing_renders_expect_what_to_install_and_status_3(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(backend, "_probe", lambda name: ("", "no driver"))
    backend._choose.cache_clear()
    assert cli.main(["doctor", "-o", str(tmp_path / "doctor.png")]) == 3
    said = " ".join(capsys.readouterr().out.split())
    assert "egl: no, no driver" in said and "type: apt-get install libegl1 libegl-mesa0 libgl1" in said
    assert not list(tmp_path.iterdir())
    backend._choose.cache_clear()


def test_a_back_end_that_was_asked_for_and_does_not_work_is_what_to_change(tmp_path, monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "osmesa")
    (advice,) = _healthy(tmp_path, picture=Picture(None, 1.0, "cannot render")).remedies
    assert "unset MUJOCO_GL" in advice and "MUJOCO_GL=egl" in advice
    monkeypatch.setenv("MUJOCO_GL", "egl")
    assert not _healthy(tmp_path).remedies


def test_whatever_a_broken_package_raises_is_a_finding(tmp_path, monkeypatch):
    def broken():
        raise AttributeError("module 'mujoco' has no attribute 'MjModel'\nand more")

    monkeypatch.setattr("nao_sim.no_gl.import_mujoco", broken)
    monkeypatch.setattr(backend, "_probe", lambda name: ("llvmpipe", ""))
    found = checkup(tmp_path / "doctor.png")
    assert found.picture.failure == "AttributeError: module 'mujoco' has no attribute 'MjModel'"
    assert any("report it" in advice for advice in found.remedies)


def test_this_machine_is_told_in_words_and_as_json_and_its_picture_shows_something(tmp_path, capsys):
    picture, told = tmp_path / "doctor.png", tmp_path / "doctor.json"
    status = cli.main(["doctor", "-o", str(picture), "--json", str(told)])
    found, said = json.loads(told.read_text()), capsys.readouterr().out
    assert status == (0 if picture.exists() else 3)
    assert {trial["name"] for trial in found["backends"]} >= {"egl", "osmesa"}
    mujoco = next(package for package in found["packages"] if package["name"] == "mujoco")
    assert mujoco["fits"] and re.search(rf"mujoco\s+{re.escape(mujoco['version'])}", said)
    if picture.exists():
        from PIL import Image

        with Image.open(picture) as image:
            assert len(image.convert("RGB").getcolors(2**20)) > 1000
