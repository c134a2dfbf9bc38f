"""The lamellas of a network: curvatures, stresses and developed node marks of every strip."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Lamellas:
    """Flat strips that stand normal to the surface along the centre lines of a network.

    Arrays of shape (k,) run over the network's samples, (q,) over its stops, (m,) over its lamellas.

    Attributes
    ----------
    height, thickness : float
        Strip section, m; the height stands along the surface normal, half of it on either side.
    layers : int
        Parallel strips of each lamella.
    offset : float
        Distance of neighbouring layers, m.
    marks : str
        "arc-length" or "relaxed", see `stop_stations`.
    normal_curvature, geodesic_curvature, geodesic_torsion : (k,)
        kn, kg, tg of the centre line, 1/m.
    bending, torsion : (k,)
        Weak-axis bending stress E t |kg| / 2 and St-Venant shear G t |tg|, Pa.
    helix_edge, helix_centre : (k,)
        Helix normal stress at the strip's edge (tension) and centre line (compression), Pa.
    restraint : (k,)
        Tension from node marks at the unshortened length, Pa; zero where marks are relaxed.
    von_mises : (k,)
        Largest equivalent stress of the section, Pa.
    utilisation : (k,)
        Share of the material's strength.
    planarity : (k,)
        Planarity score of the strip quad between a sample and the next; zero at each lamella's end.
    stop_stations : (q,)
        Place of the node on the developed centre line, m from the lamella's start.
    developed_lengths : (m,)
        Length of the developed centre line from first to last node, m.
    """

    height: float
    thickness: float
    layers: int
    offset: float
    marks: str
    normal_curvature: Floats
    geodesic_curvature: Floats
    geodesic_torsion: Floats
    bending: Floats
    torsion: Floats
    helix_edge: Floats
    helix_centre: Floats
    restraint: Floats
    von_mises: Floats
    utilisation: Floats
    planarity: Floats
    stop_stations: Floats
    developed_lengths: Floats
