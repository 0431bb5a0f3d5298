"""Arrays as bytes that a page can carry: laid out, squeezed, and written as text."""

from __future__ import annotations

import base64
import gzip
import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

_MOST = 32766  # of 16 bits
UNKNOWN = -32768  # what stands for no number
_TYPES = {"uint8": "u1", "int8": "i1", "uint16": "u2", "int16": "i2", "uint32": "u4", "float32": "f4"}


@dataclass(frozen=True, eq=False)
class Rounded:
    """Numbers in 16 bits.

    Attributes:
        values: (...) any numbers, not finite ones included.
        step: what they are rounded to; where None the finest that has room for them all.
    """

    values: NDArray[np.float64]
    step: float | None = None

    @property
    def scale(self) -> float:
        """What one stands for."""
        largest = float(np.abs(self.values[np.isfinite(self.values)]).max(initial=0.0))
        return max(self.step or 0.0, largest / _MOST) or 1.0

    @property
    def coded(self) -> NDArray[np.int16]:
        """(...) whole numbers."""
        known = np.isfinite(self.values)
        return np.where(known, np.rint(np.where(known, self.values, 0.0) / self.scale), UNKNOWN).astype(np.int16)


class Parcel:
    """Collects named arrays; `pack` ties them up with what else is told."""

    def __init__(self) -> None:
        self._table: dict[str, dict[str, Any]] = {}
        self._bytes = bytearray()

    def add(self, name: str, values: ArrayLike | Rounded, dtype: type | None = None) -> None:
        """Put an array in.

        Args:
            name: under which the page finds it.
            values: of any shape; `Rounded` ones come out as numbers with a fraction.
            dtype: of the bytes, where they are not rounded.
        """
        rounded = isinstance(values, Rounded)
        array = np.ascontiguousarray(values.coded if isinstance(values, Rounded) else np.asarray(values, dtype))
        self._bytes.extend(bytes(-len(self._bytes) % 4))
        row = {"type": _TYPES[array.dtype.name], "shape": list(array.shape), "at": len(self._bytes)}
        self._table[name] = row | ({"scale": values.scale} if rounded else {})
        self._bytes.extend(array.astype(array.dtype.newbyteorder("<")).tobytes())

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
