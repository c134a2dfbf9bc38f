"""Equality of results up to rounding."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from functools import cached_property
from typing import Any

import numpy as np


def close(one: Any, other: Any, tolerance: float) -> bool:
    """Whether two values, or all that two objects are made of, are equal up to rounding.

    Parameters
    ----------
    one, other
        Arrays, numbers, containers, dataclasses, or objects of the same class with attributes. Fields of dataclasses
        with ``compare=False`` and cached properties do not count.
    tolerance : float
        See `lamella.base.result.Result.allclose`.
    """
    if one is other:
        return True
    if isinstance(one, np.ndarray | float | complex) and not isinstance(other, str):
        return _near(np.asarray(one), np.asarray(other), tolerance)
    if isinstance(other, float | complex) and isinstance(one, int):
        return _near(np.asarray(one), np.asarray(other), tolerance)
    if type(one) is not type(other):
        return False
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(close(a, b, tolerance) for a, b in zip(one, other, strict=True))
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(close(one[key], other[key], tolerance) for key in one)
    parts = _parts(one)
    return bool(one == other) if parts is None else close(parts, _parts(other), tolerance)


def _near(one: np.ndarray[Any, Any], other: np.ndarray[Any, Any], tolerance: float) -> bool:
    if one.shape != other.shape:
        return False
    kinds = one.dtype.kind + other.dtype.kind
    if not any(kind in "fc" for kind in kinds) or not all(kind in "fciub" for kind in kinds):
        return bool(np.array_equal(one, other))
    scale = max(1.0, *(float(np.abs(a[np.isfinite(a)]).max(initial=0.0)) for a in (one, other)))
    return bool(np.allclose(one, other, rtol=0.0, atol=tolerance * scale, equal_nan=True))


def _parts(one: Any) -> dict[str, Any] | None:
    """What an object is made of, by name; None where it is a value."""
    if is_dataclass(one):
        return {field.name: getattr(one, field.name) for field in fields(one) if field.compare}
    own: Any = type(one)
    if own.__eq__ is not object.__eq__ or not hasattr(one, "__dict__"):
        return None
    return {k: v for k, v in vars(one).items() if not isinstance(getattr(own, k, None), cached_property)}
