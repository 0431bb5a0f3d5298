"""JSON text as values: one document, or one after the other (JSON lines).

The whole file is held at once.  Every way in which it can fail is one error
with a line and a column.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any

from nao_sim.recordings.source import TEXT, Source

Json = Any  # None, bool, int, float, str, list or dict
LARGEST = 1 << 30  # bytes; as Python values it takes some ten times that
_START = re.compile(rb"\s*(?:\{\s*[\"}]|\[\s*[\[\]{\"\-0-9nN])")
_BETWEEN = re.compile(r"[\s,\x1e]*")  # RFC 7464 puts a record separator before each document
_MARK = b"\xef\xbb\xbf"


def looks_like_json(source: Source) -> bool:
    """Whether the file starts as JSON does."""
    return bool(_START.match(source.start.removeprefix(_MARK)))


def documents(source: Source) -> list[tuple[int, Json]]:
    """Every document of the file with the line (from 1) that it starts on.

    Args:
        source: the file.

    Returns:
        One pair for plain JSON, one a document for JSON lines.

    Raises:
        RecordingError: it is no UTF-8 text, or no JSON; the message names line and column.
    """
    try:
        return list(_each(source, _text(source)))
    except RecursionError:
        raise source.error("JSON nested too deeply", "frames of landmarks") from None
    except MemoryError:
        raise source.error("JSON that does not fit in memory", "a smaller file: cut it into parts") from None


def _text(source: Source) -> str:
    with source.open() as stream:
        content = stream.read(LARGEST + 1)
    if len(content) > LARGEST:
        raise source.error(f"more than {LARGEST >> 20} MB of JSON", "a smaller file: cut it into parts")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise source.error("bytes that are not UTF-8 text", TEXT, line) from None


def _each(source: Source, text: str) -> Iterator[tuple[int, Json]]:
    decoder, place, line, counted = json.JSONDecoder(), 0, 1, 0
    while (place := _past(text, place)) < len(text):
        line, counted = line + text.count("\n", counted, place), place
        try:
            value, place = decoder.raw_decode(text, place)
        except json.JSONDecodeError as error:
            raise source.error(f"broken JSON ({_reason(text, error)})", "JSON", error.lineno, error.colno) from None
        except ValueError as error:  # an integer of more than 4300 digits
            raise source.error(f"broken JSON ({str(error).split(';')[0].lower()})", "JSON", line) from None
        yield line, value


def _past(text: str, place: int) -> int:
    match = _BETWEEN.match(text, place)
    return match.end() if match else place


def _reason(text: str, error: json.JSONDecodeError) -> str:
    if not text[error.pos :].strip():
        return "it ends in the middle"
    return f"{error.msg[:1].lower()}{error.msg[1:]}".strip()
