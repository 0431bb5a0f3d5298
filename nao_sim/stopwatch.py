"""How long the parts of the main job take."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from nao_sim.rendering import RenderReport
    from nao_sim.simulation.performance import Performance


class Stopwatch:
    """How long each part of a replay takes, as the report tells it."""

    def __init__(self) -> None:
        self._began = self._last = perf_counter()
        self._parts: dict[str, float | str] = {}

    def lap(self, part: str) -> None:
        """The time since the last lap went into `part`."""
        now = perf_counter()
        self._parts[part], self._last = now - self._last, now

    def film(self, made: RenderReport) -> None:
        """Note what rendering took."""
        self._parts |= {"render_s": made.seconds, "render_fps": made.frames / made.seconds}
        self._parts |= {"gl_backend": made.backend.name, "gl_renderer": made.backend.renderer}

    def timing(self, performance: Performance) -> dict[str, float | str]:
        """The report's `timing`, rounded."""
        total = perf_counter() - self._began
        parts = self._parts | {
            "safety_s": performance.safety_s,
            "simulate_s": performance.simulate_s,
            "total_s": total,
            "realtime_factor": float(performance.rollout.time[-1]) / total,
        }
        return {key: round(value, 4) if isinstance(value, float) else value for key, value in parts.items()}
