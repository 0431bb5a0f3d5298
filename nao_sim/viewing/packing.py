"""Arrays as bytes that a page can carry: laid out, squeezed, and written as text."""

from __future__ import annotations

import base64
import gzip
import json
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nao_sim.robot import Array

_MOST = 32766  # of 16 bits
UNKNOWN = -32768  # what stands for no number
_TYPES = {"uint8": "u1", "int8": "i1", "uint16": "u2", "int16": "i2", "uint32": "u4", "float32": "f4"}


class Parcel:
    """Collects named arrays; `pack` ties them up with what else is told."""

    def __init__(self) -> None:
        self._table: dict[str, dict[str, Any]] = {}
        self._bytes = bytearray()

    def add(self, name: str, values: ArrayLike, dtype: type) -> None:
        """Put an array of any shape in, under a name, as numbers of a type."""
        array: NDArray[Any] = np.asarray(values, dtype)
        self._bytes.extend(bytes(-len(self._bytes) % 4))
        self._table[name] = {"type": _TYPES[array.dtype.name], "shape": list(array.shape), "at": len(self._bytes)}
        self._bytes.extend(array.astype(array.dtype.newbyteorder("<")).tobytes())

    def add_rounded(self, name: str, values: Array, step: float) -> None:
        """Put numbers in, of any shape and not finite ones included, rounded so that each takes 16 bits.

        Args:
            name: under which the page finds them.
            values: where they are too large, they are rounded to more than `step`.
            step: what they are rounded to.
        """
        known = np.isfinite(values)
        finite = np.where(known, values, 0.0)
        scale = max(step, float(np.abs(finite).max(initial=0.0)) / _MOST)
        self.add(name, np.where(known, np.rint(finite / scale), UNKNOWN), np.int16)
        self._table[name]["scale"] = scale

    def pack(self, told: dict[str, Any]) -> str:
        """Everything as one word of letters: base64 of gzip of a length (4 bytes), JSON, padding, and the arrays."""
        head = json.dumps(told | {"arrays": self._table}, ensure_ascii=False, allow_nan=False).encode()
        head += b" " * (-len(head) % 4)
        whole = len(head).to_bytes(4, "little") + head + bytes(self._bytes)
        return base64.b64encode(gzip.compress(whole, 9, mtime=0)).decode("ascii")


def unpack(text: str) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """What `pack` packed: what was told, and the arrays, those rounded multiplied out."""
    whole = gzip.decompress(base64.b64decode(text))
    size = int.from_bytes(whole[:4], "little")
    told = json.loads(whole[4 : 4 + size])
    return told, {name: _array(row, whole[4 + size :]) for name, row in told["arrays"].items()}


def _array(row: dict[str, Any], data: bytes) -> NDArray[Any]:
    count = int(np.prod(row["shape"]))
    values = np.frombuffer(data, f"<{row['type']}", count, row["at"]).reshape(row["shape"])
    return np.where(values == UNKNOWN, np.nan, values * row["scale"]) if "scale" in row else values
