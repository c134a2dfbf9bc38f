"""Types of arrays, defined once: what the annotations of every module name."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
"""Real numbers, of any shape; annotations give the shape in the docstring."""

Complexes = NDArray[np.complex128]

Integers = NDArray[np.int64]
"""Whole numbers: indices and counts."""

Booleans = NDArray[np.bool_]
"""Masks."""
