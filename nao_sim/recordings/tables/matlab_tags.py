"""Whether the elements of a `.mat` file are what their place in it asks for.

SciPy takes the type of an element for granted: one that is damaged ends the
program.  So the tags are looked at before it (The MathWorks, "MAT-File Format",
level 5: each element has a type and a size, and those of an array come in the
order of flags, sizes, name, and then its contents).
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from dataclasses import dataclass

HEADER = 128  # bytes
_INT8, _INT32, _UINT32, _MATRIX, _COMPRESSED = 1, 5, 6, 14, 15
_NUMBERS = (1, 2, 3, 4, 5, 6, 7, 9, 12, 13)
_TEXT = (1, 2, 3, 4, 5, 6, 16, 17, 18)
_CELL, _STRUCT, _OBJECT, _CHARACTERS, _SPARSE, _FUNCTION, _OPAQUE = 1, 2, 3, 4, 5, 16, 17
_COMPLEX = 0x800
_DEEPEST = 64
_BEFORE = {_STRUCT: ((_INT32,), (_INT8,)), _OBJECT: ((_INT8,), (_INT32,), (_INT8,)), _SPARSE: ((_INT32,), (_INT32,))}


@dataclass(frozen=True)
class _Element:
    kind: int
    body: memoryview


def check_tags(content: bytes) -> None:
    """Look at all elements of a file.

    Raises:
        ValueError: one is cut off, or of another type than its place asks for.
    """
    little = content[HEADER - 2 : HEADER] != b"MI"
    for element in _elements(memoryview(content)[HEADER:], little):
        inside = [element]
        if element.kind == _COMPRESSED:
            inside = list(_elements(memoryview(_inflated(element.body)), little))
        for each in inside:
            _expect(each, (_MATRIX,))
            _check_matrix(each.body, little, 0)


def _check_matrix(body: memoryview, little: bool, depth: int) -> None:
    parts = list(_elements(body, little))
    if not parts:
        return  # an empty array
    if depth > _DEEPEST:
        raise ValueError("arrays too deep in each other")
    _expect(parts[0], (_UINT32,))
    flags = _number(parts[0].body[:4], little)
    kind = flags & 0xFF
    if kind == _OPAQUE:
        raise ValueError("an object that only MATLAB can read")
    for part, kinds in zip(parts[1:], ((_INT32,), (_INT8,)), strict=False):
        _expect(part, kinds)
    before, rest = _BEFORE.get(kind, ()), parts[3:]
    for part, kinds in zip(rest, before, strict=False):
        _expect(part, kinds)
    _check_contents(kind, bool(flags & _COMPLEX), rest[len(before) :], little, depth)


def _check_contents(kind: int, imaginary: bool, parts: list[_Element], little: bool, depth: int) -> None:
    if kind in (_CELL, _STRUCT, _OBJECT, _FUNCTION):
        for part in parts:
            _expect(part, (_MATRIX,))
            _check_matrix(part.body, little, depth + 1)
        return
    if len(parts) != 1 + imaginary:
        raise ValueError(f"{len(parts)} elements of an array that has {1 + imaginary}")
    for part in parts:
        _expect(part, _TEXT if kind == _CHARACTERS else _NUMBERS)


def _elements(content: memoryview, little: bool) -> Iterator[_Element]:
    """The elements one after the other; each but a compressed one fills a multiple of eight bytes."""
    at = 0
    while at < len(content):
        first, second = (_number(content[start : start + 4], little) for start in (at, at + 4))
        small = first >> 16  # up to four bytes stand in the tag itself
        kind, size, start = (first & 0xFFFF, small, at + 4) if small else (first, second, at + 8)
        if start + size > len(content) or small > 4:  # noqa: PLR2004
            raise ValueError("an element that is cut off")
        yield _Element(kind, content[start : start + size])
        at = at + 8 if small else start + size + (0 if kind == _COMPRESSED else -size % 8)


def _number(content: memoryview, little: bool) -> int:
    if len(content) < 4:  # noqa: PLR2004
        raise ValueError("a tag that is cut off")
    return int.from_bytes(content, "little" if little else "big")


def _inflated(body: memoryview) -> bytes:
    try:
        return zlib.decompress(body)
    except zlib.error as error:
        raise ValueError(str(error)) from None


def _expect(element: _Element, kinds: tuple[int, ...]) -> None:
    if element.kind not in kinds:
        raise ValueError(f"an element of type {element.kind}; expected {' or '.join(map(str, kinds))}")
