"""A film inside a page: as data, with a picture of it for print."""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

LARGEST_MB = 10.0  # as text it takes a third more, and mail is often refused from 20 MB on
_KINDS = {".mp4": "video/mp4", ".webm": "video/webm", ".gif": "image/gif"}
_POSTER = 640  # pixels, greatest width


@dataclass(frozen=True)
class Film:
    """A film as a page holds it.

    Attributes:
        kind: `video/mp4`, `video/webm` or `image/gif`; empty where the film is not in the page.
        data: base64 of it.
        poster: base64 of a JPEG of its middle.
        size: (width, height) of the poster in pixels.
        words: what a reader should know of it.
    """

    kind: str
    data: str
    poster: str
    size: tuple[int, int]
    words: str

    @property
    def moving(self) -> bool:
        """Whether it is a video with controls."""
        return self.kind.startswith("video/")


def film_in_page(path: Path, largest_mb: float = LARGEST_MB) -> Film:
    """A film that was written, or a picture of it and where it is if it is too large to be mailed.

    Args:
        path: .mp4, .webm, .gif, or a folder of frames.
        largest_mb: of the file.
    """
    poster = _middle(path)
    poster.thumbnail((_POSTER, _POSTER))
    text = io.BytesIO()
    poster.convert("RGB").save(text, "JPEG", quality=80)
    still = base64.b64encode(text.getvalue()).decode()
    if path.is_dir():
        return Film("", "", still, poster.size, f"A picture of the film, whose frames are in the folder {path.name}.")
    megabytes = path.stat().st_size / 1e6
    if megabytes > largest_mb:
        why = f"The film, {path.name}, is a file of its own: with {megabytes:.0f} MB it is too large for this page."
        return Film("", "", still, poster.size, f"{why} Here is its middle.")
    data = base64.b64encode(path.read_bytes()).decode()
    return Film(_KINDS[path.suffix.lower()], data, still, poster.size, f"{path.name}, {megabytes:.1f} MB.")


def _middle(path: Path) -> Any:
    """The picture in the middle of a film."""
    from PIL import Image

    if path.is_dir():
        frames = sorted(path.glob("*.png"))
        return Image.open(frames[len(frames) // 2])
    if path.suffix.lower() == ".gif":
        picture = Image.open(path)
        picture.seek(getattr(picture, "n_frames", 1) // 2)
        return picture
    import av

    with av.open(str(path)) as film:
        stream = film.streams.video[0]
        if stream.duration:
            film.seek((stream.start_time or 0) + stream.duration // 2, stream=stream)
        return next(film.decode(stream)).to_image()
