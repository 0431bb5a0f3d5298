"""Where pictures go: which kinds of file there are, and how one appears whole or not at all."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from types import MappingProxyType

from nao_sim.errors import UsageError
from nao_sim.files import beside
from nao_sim.rendering.encode import Encoder, Picture, PngFolder, Size, VideoFile
from nao_sim.rendering.gif import GifFile
from nao_sim.rendering.preset_kinds import Quality

Opener = Callable[[Path, Size, Fraction, Quality, Sequence[Picture]], Encoder]

KINDS: Mapping[str, Opener] = MappingProxyType(
    {
        ".mp4": lambda path, size, fps, quality, _: VideoFile(path, "libx264", quality.mp4, size, fps),
        ".webm": lambda path, size, fps, quality, _: VideoFile(path, "libvpx-vp9", quality.webm, size, fps),
        ".gif": lambda path, size, fps, _, samples: GifFile(path, size, fps, samples),
        ".png": lambda path, size, *_: PngFolder(path, size),
    }
)
NEEDS_SAMPLES = frozenset({".gif"})
NEEDS_EVEN = frozenset({".mp4", ".webm"})


def kind_of(path: Path) -> str:
    """The extension of `path`, in small letters.

    Raises:
        UsageError: no such kind of file is written here.
    """
    kind = path.suffix.lower()
    if kind not in KINDS:
        raise UsageError(f"{path}: cannot write '{kind or path.name}' files; expected one of {', '.join(KINDS)}")
    return kind


def target_of(path: Path) -> Path:
    """What is written for `path`: itself, but for `.png` the folder of its stem, which holds the frames."""
    return path.with_suffix("") if kind_of(path) == ".png" else path


def check_even(kind: str, size: Size) -> None:
    """Videos in 4:2:0 need even sides.

    Raises:
        UsageError: such a `kind` of file cannot have pictures of this size.
    """
    if kind in NEEDS_EVEN and any(side % 2 for side in size):
        even = "x".join(str(side + side % 2) for side in size)
        raise UsageError(f"{kind} videos need an even width and height, not {size[0]}x{size[1]}; try {even}")


@contextmanager
def draft_of(path: Path) -> Iterator[Path]:
    """A temporary name that becomes the film `path` at the end, and is removed after any error.

    Raises:
        UsageError: the folder is missing or cannot be written, or `path` is taken by something else.
    """
    target = target_of(path)
    _check_free(target, is_folder=target != path)
    with beside(target) as draft:
        yield draft


def _check_free(target: Path, is_folder: bool) -> None:
    """Only a film is overwritten by a film, and only numbered frames by numbered frames."""
    if target.is_dir() and not is_folder:
        raise UsageError(f"{target}: is a folder; expected the name of a file")
    if is_folder and target.exists() and not (target.is_dir() and all(map(_is_frame, target.iterdir()))):
        raise UsageError(f"{target}: has other things than frames in it; expected a new name")


def _is_frame(path: Path) -> bool:
    return path.match("frame_*.png")
