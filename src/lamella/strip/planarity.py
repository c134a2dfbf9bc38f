"""Planarity score of strip quads (paper section 2.3)."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats


def planarity_score(v1: Floats, v2: Floats, v3: Floats, v4: Floats) -> Floats:
    """Distance of a quad's diagonals over their mean length: 2 d(v1v3, v2v4) / (|v1v3| + |v2v4|).

    Parameters
    ----------
    v1, v2, v3, v4 : (q, 3)
        Corners in order, m.

    Returns
    -------
    (q,)
        0 for planar quads; the paper colours 0.005 and above in full red.
    """
    first, second = v3 - v1, v4 - v2
    across = np.cross(first, second)
    size = np.linalg.norm(across, axis=1)
    distance = np.abs(np.einsum("ij,ij->i", v2 - v1, across)) / np.where(size > 0, size, 1)
    return np.asarray(2 * distance / (np.linalg.norm(first, axis=1) + np.linalg.norm(second, axis=1)))
