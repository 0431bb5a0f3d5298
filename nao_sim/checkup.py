"""What works on this machine: packages, OpenGL, a test picture."""

from __future__ import annotations

import os
import platform
import sys
import time
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from nao_sim import __version__
from nao_sim.errors import NaoSimError
from nao_sim.processors import processors
from nao_sim.rendering.backend import INSTALL, Trial, try_backends

DISTRIBUTION = "nao-sim"


@dataclass(frozen=True)
class Package:
    """A package that is asked for.

    Attributes:
        name: of the distribution.
        version: what is installed, or None.
        expected: the versions that do, as pip writes them; empty for any.
        extra: which extra asks for it; empty where everybody needs it.
    """

    name: str
    version: str | None
    expected: str
    extra: str = ""

    @property
    def fits(self) -> bool:
        """Whether it is there in a version that does."""
        return self.version is not None and Requirement(f"x{self.expected}").specifier.contains(
            self.version, prereleases=True
        )

    @property
    def remedy(self) -> str:
        """What to type where it does not fit."""
        wanted = f"{DISTRIBUTION}[{self.extra}]" if self.extra else f"{self.name}{self.expected}"
        return f"pip install '{wanted}'"


@dataclass(frozen=True)
class Picture:
    """The test picture.

    Attributes:
        path: where it is, or None where it could not be made.
        seconds: that it took, the start of a rendering process included.
        failure: why it is not there; otherwise empty.
    """

    path: Path | None
    seconds: float
    failure: str = ""


@dataclass(frozen=True)
class Checkup:
    """Everything that was found.

    Attributes:
        packages: what is asked for, by everybody and by extras.
        backends: every OpenGL back end that was probed.
        picture: of the robot in its start posture.
    """

    packages: tuple[Package, ...]
    backends: tuple[Trial, ...]
    picture: Picture

    @property
    def wrong(self) -> tuple[Package, ...]:
        """The packages that everybody needs and that are missing or do not fit."""
        return tuple(package for package in self.packages if not (package.extra or package.fits))

    @property
    def remedies(self) -> tuple[str, ...]:
        """What to do, the most urgent first; extras are not urgent and left out."""
        found = [f"type: {package.remedy}" for package in self.wrong]
        works = [trial.name for trial in self.backends if trial.renderer]
        wanted = os.environ.get("MUJOCO_GL", "").strip().lower()
        if not works:
            found.append(f"type: {INSTALL['egl']}")
        elif wanted and wanted not in works:
            found.append(f"type: unset MUJOCO_GL, or export MUJOCO_GL={works[0]}")
        elif not self.picture.path and not found:
            found.append("what failed above is a fault of nao_sim or of a driver: please report it with --json FILE")
        return tuple(found)

    def to_json(self) -> dict[str, Any]:
        """All of it, for a bug report; the picture's folder is left out."""
        path = self.picture.path
        return {
            "nao_sim": __version__,
            "python": platform.python_version(),
            "system": f"{platform.system()} {platform.machine()}",
            "processors": processors(),
            "packages": [asdict(package) | {"fits": package.fits} for package in self.packages],
            "backends": [asdict(trial) for trial in self.backends],
            "MUJOCO_GL": os.environ.get("MUJOCO_GL"),
            "picture": asdict(self.picture) | {"path": path.name if path else None},
        }


def checkup(picture: Path) -> Checkup:
    """Look at everything; `picture` is where the test picture goes."""
    return Checkup(tuple(packages()), try_backends(), _picture(picture))


def packages(requires: list[str] | None = None) -> Iterator[Package]:
    """What this project's own metadata ask for, and what of it is there.

    Args:
        requires: the requirements as the metadata have them; those of the installed distribution where None.
    """
    for line in _requires() if requires is None else requires:
        requirement = Requirement(line)
        marker = requirement.marker
        for extra in ("", *_extras(line)):
            if marker is None or marker.evaluate({"extra": extra}):
                yield Package(requirement.name, _version(requirement.name), str(requirement.specifier), extra)
                break


def _requires() -> list[str]:
    try:
        return metadata.requires(DISTRIBUTION) or []
    except metadata.PackageNotFoundError:  # used from a folder, without being installed
        return []


def _extras(line: str) -> list[str]:
    """The extras that a requirement's marker names: `...; extra == "bench"`."""
    _, _, marker = line.partition(";")
    parts = marker.replace("'", '"').split("extra ==")[1:]
    return [part.split('"')[1] for part in parts]


def _version(name: str) -> str | None:
    try:
        return metadata.version(canonicalize_name(name))
    except metadata.PackageNotFoundError:
        return None


def _picture(path: Path) -> Picture:
    began = time.perf_counter()
    try:
        from nao_sim.no_gl import import_mujoco

        import_mujoco()
        from nao_sim.rendering.still import render_still, save_png
        from nao_sim.simulation.simulator import Simulator

        simulator = Simulator()
        save_png(render_still(simulator.model, simulator.data.qpos, quality="standard"), path)
    except NaoSimError as error:
        return Picture(None, time.perf_counter() - began, str(error))
    except Exception as error:  # whatever a broken package does: finding it out is what this is for
        said = str(error).splitlines()
        return Picture(
            None, time.perf_counter() - began, f"{type(error).__name__}: {said[0]}" if said else type(error).__name__
        )
    return Picture(path, time.perf_counter() - began)


def headline() -> Mapping[str, str]:
    """What the machine is, in a few words."""
    return {
        "nao_sim": __version__,
        "Python": f"{platform.python_version()} ({sys.executable})",
        "system": f"{platform.system()} {platform.release()} {platform.machine()}, {processors()} processors",
    }
