"""Pictures into files: one class a kind of file."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any, Protocol, cast

import av
import numpy as np
from av.video.reformatter import ColorRange, Colorspace, Interpolation, VideoReformatter
from numpy.typing import NDArray

Picture = NDArray[np.uint8]
Size = tuple[int, int]
_BT709 = 1  # the colour matrix every player assumes for video that says so
_THREADS = 2  # a constant: the encoders' output depends on it
_PNG_COMPRESSION = 1


class Encoder(Protocol):
    """Takes pictures (height, width, 3) uint8 of any size, and shrinks them to its own."""

    def add(self, picture: Picture, times: int = 1) -> None:
        """Show `picture` for `times` frames."""

    def finish(self) -> None:
        """Write what is left and close."""

    def close(self) -> None:
        """Let go of the file, finished or not."""


class Shrinker:
    """Reduces supersampled pictures to the size of the file, averaging the pixels."""

    def __init__(self, size: Size, pixel_format: str) -> None:
        self._size, self._format, self._swscale = size, pixel_format, VideoReformatter()

    def frame(self, picture: Picture) -> av.VideoFrame:
        """(height, width, 3) RGB as a video frame of the wanted size and pixel format."""
        colours: dict[str, Any] = {}
        if self._format == "yuv420p":
            colours = {"dst_colorspace": Colorspace.ITU709, "dst_color_range": ColorRange.MPEG}
        return self._swscale.reformat(
            av.VideoFrame.from_ndarray(picture, format="rgb24"),
            *self._size,
            format=self._format,
            interpolation=Interpolation.AREA,
            **colours,
        )


def shrink(picture: Picture, size: Size) -> Picture:
    """(h, w, 3) reduced to `size` (width, height)."""
    if picture.shape[1::-1] == size:
        return picture.copy()
    return Shrinker(size, "rgb24").frame(picture).to_ndarray().astype(np.uint8, copy=False)


class VideoFile:
    """MP4 (H.264) or WebM (VP9), 4:2:0, BT.709."""

    def __init__(self, path: Path, codec: str, options: Mapping[str, str], size: Size, fps: Fraction) -> None:
        muxer = {"movflags": "faststart"} if path.suffix == ".mp4" else {}
        self._file = av.open(str(path), "w", options=muxer)
        self._stream = cast(av.VideoStream, self._file.add_stream(codec, rate=fps, options=dict(options)))
        self._stream.width, self._stream.height, self._stream.pix_fmt = *size, "yuv420p"
        context = self._stream.codec_context
        context.colorspace = context.color_primaries = context.color_trc = _BT709
        context.color_range = int(ColorRange.MPEG)
        context.time_base, context.thread_count = 1 / fps, _THREADS
        self._shrinker, self._count = Shrinker(size, "yuv420p"), 0

    def add(self, picture: Picture, times: int = 1) -> None:
        """Show `picture` for `times` frames."""
        frame = self._shrinker.frame(picture)
        for _ in range(times):
            frame.pts, self._count = self._count, self._count + 1
            self._file.mux(self._stream.encode(frame))

    def finish(self) -> None:
        """Write what is left and close."""
        self._file.mux(self._stream.encode())
        self._file.close()

    def close(self) -> None:
        """Let go of the file, finished or not."""
        self._file.close()


class PngFolder:
    """A folder of numbered pictures, `frame_00001.png` on, the way frame-based tools expect them."""

    def __init__(self, path: Path, size: Size) -> None:
        path.mkdir(exist_ok=True)
        self._folder, self._shrinker, self._count = path, Shrinker(size, "rgb24"), 0

    def add(self, picture: Picture, times: int = 1) -> None:
        """Show `picture` for `times` frames."""
        image = self._shrinker.frame(picture).to_image()
        for _ in range(times):
            self._count += 1
            image.save(self._folder / f"frame_{self._count:05d}.png", compress_level=_PNG_COMPRESSION)

    def finish(self) -> None:
        """Nothing is left to write."""

    def close(self) -> None:
        """Nothing is held."""
