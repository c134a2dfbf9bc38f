"""Arrays in one piece of bytes, each in as few as it needs, and what a reader has to know of them."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
import orjson
from numpy.typing import NDArray

from lamella.base.arrays import Floats, Integers

Spec = dict[str, Any]

MAGIC = b"LMSC"
MISSING = 65535
"""Level of a number that is not known, in two bytes."""
ALIGNMENT = 4


class Pack:
    """Arrays one after the other, little-endian; what is there already is not put there again.

    An array is described by its type ("f4", "i2", "u1", "u2", "u4"), the place of its first byte, how many numbers it
    has, and for quantised ones the number of level 0 and the step of a level.
    """

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._size = 0
        self._known: dict[bytes, int] = {}

    def float32(self, values: Floats) -> Spec:
        """Numbers to 24 bits."""
        return self._put("f4", values.astype("<f4"))

    def integers(self, values: Integers) -> Spec:
        """Non-negative integers in as few bytes as the largest needs."""
        largest = int(values.max(initial=0))
        kind = "u1" if largest < 2**8 else "u2" if largest < 2**16 else "u4"
        return self._put(kind, values.astype(f"<{kind}"))

    def direction16(self, vectors: Floats) -> Spec:
        """Unit vectors to 2e-5, as shares of 32767."""
        return self._put("i2", np.rint(vectors * 32767).astype("<i2"))

    def quantised(self, values: Floats) -> Spec:
        """Numbers to 1/65534 of their range; anything not finite is missing."""
        finite = np.isfinite(values)
        if not finite.any():
            return {"type": "constant", "value": None, "count": values.size}
        low, high = float(values[finite].min()), float(values[finite].max())
        if low == high and finite.all():
            return {"type": "constant", "value": low, "count": values.size}
        step = (high - low) / (MISSING - 1) or 1.0
        levels = np.where(finite, np.rint((np.where(finite, values, low) - low) / step), MISSING)
        return {**self._put("u2", levels.astype("<u2")), "low": low, "step": step}

    def _put(self, kind: str, values: NDArray[Any]) -> Spec:
        data = np.ascontiguousarray(values).tobytes()
        place = self._known.get(data)
        if place is None:
            place = self._known[data] = self._size
            padding = bytes(-len(data) % ALIGNMENT)
            self._parts += [data, padding]
            self._size += len(data) + len(padding)
        return {"type": kind, "at": place, "count": values.size}

    def whole(self, header: Spec) -> bytes:
        """`MAGIC`, the header's length in four bytes, the header as JSON, the arrays."""
        text = orjson.dumps(header)
        text += b" " * (-len(text) % ALIGNMENT)
        return b"".join([MAGIC, struct.pack("<I", len(text)), text, *self._parts])


def unpacked(data: bytes) -> tuple[Spec, bytes]:
    """The header and the arrays' bytes of what `Pack.whole` has made."""
    if data[:4] != MAGIC:
        raise ValueError("these are no packed arrays")
    (length,) = struct.unpack("<I", data[4:8])
    return orjson.loads(data[8 : 8 + length]), data[8 + length :]


def array_of(spec: Spec, body: bytes) -> NDArray[Any]:
    """An array as it was put in, to what its type keeps of it."""
    if spec["type"] == "constant":
        return np.full(spec["count"], np.nan if spec["value"] is None else spec["value"])
    values = np.frombuffer(body, f"<{spec['type']}", spec["count"], spec["at"])
    if "step" in spec:
        return np.where(values == MISSING, np.nan, spec["low"] + values * spec["step"])
    return values / 32767 if spec["type"] == "i2" else values
