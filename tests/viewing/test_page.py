"""The page: what it carries, and that a browser makes of it what MuJoCo does."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import re
import shutil
import subprocess

import mujoco
import numpy as np
import pytest

from nao_sim.viewing.packing import unpack
from nao_sim.viewing.page import page
from nao_sim.viewing.playback import Layer

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
FLAGS = [
    "--headless",
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--window-size=900,600",
    "--virtual-time-budget=60000",
    "--dump-dom",
]
ASK = """
const asking = setInterval(() => {
  if (!window.page && document.getElementById("complaint").hidden) return;
  clearInterval(asking);
  try {
    const { player, motion, painter } = page, told = { shown: getComputedStyle(document.body).display };
    player.playing = false;
    const { gl, canvas } = painter, slider = document.getElementById("slider");
    const look = (time) => {
      slider.value = time;
      slider.dispatchEvent(new Event("input"));
      page.show();
      const pixels = new Uint8Array(4 * canvas.width * canvas.height);
      gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      return pixels;
    };
    const differ = (a, b) => a.filter((value, i) => Math.abs(value - b[i]) > 24).length;
    const first = look(0.5), later = look(TIME);
    told.time = player.time;
    told.poses = motion.poses(player.time);
    told.moved = differ(first, later);
    told.hues = new Set(later.filter((value, i) => i % 4 < 3)).size;
    told.layers = {};
    for (const box of document.querySelectorAll("#layers input")) {
      box.click();
      told.layers[box.id] = differ(later, look(TIME));
      box.click();
    }
    told.gl = gl.getError();
    told.plots = page.plots.length;
    told.cursor = parseFloat(page.plots[0].cursor.style.left);
    document.body.dataset.told = JSON.stringify(told);
  } catch (error) { document.body.dataset.told = JSON.stringify({ error: String(error.stack) }); }
  document.getElementById("data").remove();
}, 20);
"""


@pytest.fixture(scope="module")
def made(performed) -> str:
    return page(performed, "studio", "orange", [Layer.person]).decode()


@pytest.fixture(scope="module")
def carried(made):
    return unpack(re.search(r'id="data">([^<]*)<', made)[1])


def test_the_page_loads_nothing_and_runs_only_its_own_script(made):
    rest = re.sub(r'id="data">[^<]*<', "", made)
    assert not re.search(r"https?://|<link[^>]*href=\"(?!data:,)|<img|@import|\bfetch\(|XMLHttpRequest|\burl\(", rest)
    policy = re.search(r'Security-Policy" content="([^"]*)"', made)[1]
    assert policy.startswith("default-src 'none'; ")
    for tag in ("script", "style"):
        (text,) = re.findall(rf"<{tag}>(.*?)</{tag}>", made, re.DOTALL)
        assert f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}" in policy
    assert html.escape("raises <b> & waves.csv") in made and len(re.findall("</script>", made)) == 2
    assert len(made) < 2e6


def test_it_carries_the_performance_as_it_was(carried, performed):
    told, arrays = carried
    rollout = performed.performance.rollout
    assert told["verdict_kind"] == performed.report["verdict"] and told["curves"]["times"][2] == len(rollout)
    for name in ("command", "joint_positions", "base_pose"):
        assert np.abs(arrays[name] - getattr(rollout, name)).max() <= 1e-4
    assert (np.isnan(arrays["requested"]) == np.isnan(rollout.requested)).all()
    assert arrays["contact_counts"].sum() == len(arrays["contact_points"]) > 0
    assert np.abs(arrays["contact_points"][:, 2]).max() < 0.005  # it stands, and touches nothing but the floor


def _truth(stage, time: float) -> np.ndarray:
    """Positions and turns (bodies, 7) as MuJoCo has them."""
    data = mujoco.MjData(stage.model)
    data.qpos[:] = stage.qpos(np.array([time]))[0]
    mujoco.mj_kinematics(stage.model, data)
    return np.hstack([data.xpos, data.xquat])


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium is installed")
def test_a_browser_shows_the_robot_where_mujoco_has_it_and_the_slider_moves_it(made, stage, tmp_path):
    time = float(stage.rollout.time[stage.tinted.rows.sum(axis=1).argmax()])  # the guard slows an arm
    without_policy = re.sub(r"<meta http-equiv=\"Content-Security[^>]*>", "", made)  # our question is a script, too
    question = f"<script>{ASK.replace('TIME', str(time))}</script></body>"
    file = tmp_path / "page.html"
    file.write_text(without_policy.replace("</body>", question), encoding="utf-8")
    done = subprocess.run(
        [CHROMIUM, *FLAGS, f"--user-data-dir={tmp_path / 'profile'}", file.as_uri()],
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    found = re.search(r'data-told="([^"]*)"', done.stdout)
    assert found, done.stderr[-2000:]
    told = json.loads(html.unescape(found[1]))
    assert "error" not in told, told["error"]
    poses, truth = np.array(told["poses"]), _truth(stage, told["time"])
    assert told["time"] == pytest.approx(time, abs=0.011)
    assert np.abs(poses[:, :3] - truth[:, :3]).max() < 5e-4
    assert np.abs((poses[:, 3:] * truth[:, 3:]).sum(axis=1)).min() > 1.0 - 1e-5
    assert told["moved"] > 2000 and told["hues"] > 100 and told["gl"] == 0
    assert set(told["layers"]) == {f"layer-{layer.name}" for layer in Layer}
    assert min(told["layers"].values()) > 50, told["layers"]
    assert told["plots"] >= 3 and told["cursor"] > 46
