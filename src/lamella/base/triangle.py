"""The triangle that elements are images of."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats

CORNERS: Floats = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
"""Local coordinates of its corners, (3, 2), counter-clockwise."""

CORNERS.setflags(write=False)
