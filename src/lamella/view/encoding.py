"""Arrays in the report's JSON: base64 of little-endian numbers, in as few bytes as they need."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lamella.base.arrays import Floats, Integers

Spec = dict[str, Any]

MISSING = 65535


def _encoded(kind: str, values: NDArray[Any]) -> Spec:
    return {"type": kind, "data": base64.b64encode(np.ascontiguousarray(values).tobytes()).decode()}


def float32(values: Floats) -> Spec:
    return _encoded("f4", values.astype("<f4"))


def integers(values: Integers) -> Spec:
    """Encode non-negative integers in as few bytes as the largest needs."""
    largest = int(values.max(initial=0))
    kind = "u1" if largest < 2**8 else "u2" if largest < 2**16 else "u4"
    return _encoded(kind, values.astype(f"<{kind}"))


def direction16(vectors: Floats) -> Spec:
    """Encode unit vectors to 2e-5."""
    return _encoded("i2", np.rint(vectors * 32767).astype("<i2"))


def quantised(values: Floats) -> Spec:
    """Encode numbers to colour and plot with to 1/65534 of their range; anything not finite is missing."""
    finite = np.isfinite(values)
    if not finite.any():
        return {"type": "constant", "value": None, "count": len(values)}
    low, high = float(values[finite].min()), float(values[finite].max())
    if low == high and finite.all():
        return {"type": "constant", "value": low, "count": len(values)}
    step = (high - low) / (MISSING - 1) or 1.0
    levels = np.where(finite, np.rint((np.where(finite, values, low) - low) / step), MISSING)
    return {**_encoded("u2", levels.astype("<u2")), "low": low, "step": step}
