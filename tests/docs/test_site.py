"""The documentation as a site: it builds without a warning, and what is read of it fetches nothing."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

from tests.docs.shown import ROOT

pytest.importorskip("mkdocs")
FETCHED = re.compile(r"<(?:link|script|img|iframe)[^>]*?(?:href|src)=\"?(https?:[^\"> ]+)")


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    words = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(folder)]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


def test_every_page_is_built_and_fetches_nothing(site):
    pages = {path.relative_to(site).as_posix(): path.read_text(encoding="utf-8") for path in site.rglob("*.html")}
    assert {"index.html", "five_minutes.html", "commands.html", "models/nao_h25/index.html"} <= set(pages)
    assert {name: FETCHED.findall(text) for name, text in pages.items() if FETCHED.search(text)} == {}


def test_functions_and_the_model_are_on_the_site(site):
    assert "nao_sim.imitation.retarget.Retargeted" in (site / "python.html").read_text(encoding="utf-8")
    assert (site / "models/nao_h25/pictures/robot.png").is_file()
    assert "inertia about the centre of mass" in (site / "models/nao_h25/index.html").read_text(encoding="utf-8")
