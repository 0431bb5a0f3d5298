"""Animated GIFs."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import cast

import av
from av.filter import Graph
from av.filter.context import FilterContext

from nao_sim.rendering.encode import Picture, Shrinker, Size

_TICKS = 100  # a GIF counts time in hundredths of a second
_SHORTEST = 2  # ticks; viewers slow down frames that are shorter
_PALETTE_SIDE = 16  # ffmpeg lays its 256 colours out in a square


class GifFile:
    """Animated GIF with one palette made from samples of the whole film, ordered dither, endless.

    Args:
        path: the file.
        size: (width, height) in pixels.
        fps: frames a second; where viewers cannot follow (above 50), frames are left out and the speed kept.
        samples: pictures that have the film's colours.
    """

    def __init__(self, path: Path, size: Size, fps: Fraction, samples: Sequence[Picture]) -> None:
        self._shrinker, self._fps, self._count, self._last = Shrinker(size, "rgb24"), fps, 0, -_SHORTEST
        self._file = av.open(str(path), "w", options={"loop": "0"})
        self._stream = self._file.add_stream("gif", rate=_TICKS)
        self._stream.width, self._stream.height, self._stream.pix_fmt = *size, "pal8"
        self._stream.codec_context.time_base = Fraction(1, _TICKS)
        self._held: av.VideoFrame | None = None
        self._dither = Dither(size, palette_of([self._shrinker.frame(sample) for sample in samples], size))

    def add(self, picture: Picture, times: int = 1) -> None:
        """Show `picture` for `times` frames."""
        shown = False
        for _ in range(times):
            tick = self._tick()
            self._count += 1
            if not shown and tick - self._last >= _SHORTEST:
                self._show(self._shrinker.frame(picture), tick)
                shown = True

    def finish(self) -> None:
        """Write what is left and close."""
        if self._held is not None and self._tick() - self._last > 2 * _SHORTEST:
            self._show(self._held, self._tick() - _SHORTEST)  # a GIF's last picture has no end time of its own
        self._file.mux(self._stream.encode())
        self._file.close()

    def close(self) -> None:
        """Let go of the file, finished or not."""
        self._file.close()

    def _tick(self) -> int:
        """When the next frame begins."""
        return round(self._count / self._fps * _TICKS)

    def _show(self, frame: av.VideoFrame, tick: int) -> None:
        self._held, self._last = frame, tick
        frame.pts, frame.time_base = tick, Fraction(1, _TICKS)
        indexed = self._dither.indexed(frame)
        indexed.pts, indexed.time_base = tick, Fraction(1, _TICKS)
        self._file.mux(self._stream.encode(indexed))


def palette_of(frames: Sequence[av.VideoFrame], size: Size) -> av.VideoFrame:
    """The 256 colours that suit all `frames` (rgb24), by median cut."""
    graph = Graph()
    source, generator, sink = _source(graph, size, "rgb24"), graph.add("palettegen"), graph.add("buffersink")
    source.link_to(generator)
    generator.link_to(sink)
    graph.configure()
    for i, frame in enumerate(frames):
        frame.pts, frame.time_base = i, Fraction(1, _TICKS)
        source.push(frame)
    source.push(None)
    return cast(av.VideoFrame, sink.pull())


class Dither:
    """Maps rgb24 frames to the colours of a palette, with an ordered pattern that does not crawl."""

    def __init__(self, size: Size, palette: av.VideoFrame) -> None:
        self._graph = Graph()  # its filters do not keep it alive
        self._source = _source(self._graph, size, "rgb24")
        colours = _source(self._graph, (_PALETTE_SIDE, _PALETTE_SIDE), palette.format.name)
        mapper = self._graph.add("paletteuse", "dither=bayer:bayer_scale=4")
        self._sink = self._graph.add("buffersink")
        self._source.link_to(mapper, 0, 0)
        colours.link_to(mapper, 0, 1)
        mapper.link_to(self._sink)
        self._graph.configure()
        palette.pts = 0
        colours.push(palette)
        colours.push(None)

    def indexed(self, frame: av.VideoFrame) -> av.VideoFrame:
        """The frame as pal8."""
        self._source.push(frame)
        return cast(av.VideoFrame, self._sink.pull())


def _source(graph: Graph, size: Size, pixel_format: str) -> FilterContext:
    return graph.add_buffer(
        width=size[0], height=size[1], format=av.VideoFormat(pixel_format), time_base=Fraction(1, _TICKS)
    )
