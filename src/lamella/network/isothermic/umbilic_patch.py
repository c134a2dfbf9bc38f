"""Elements around an umbilic on which the isothermic coordinates are polynomials.

At a zero of order m of D, w goes like z^(1 + m/2), z the tangent plane as the complex plane: no polynomial where m is
odd. In zeta = sqrt(z) both are, w like zeta^(m + 2) and z = zeta^2. So the elements are straight in zeta there: next to
the umbilic their nodes come nearer to it like those of the quarter-point elements of fracture mechanics (Barsoum, Int.
J. Numer. Methods Eng. 10 (1976), 25-37, doi:10.1002/nme.1620100103). Where m is even they are straight in z.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Complexes, Integers
from lamella.surface.element.lagrange import lagrange, subdivision

# triangles along a ray from the umbilic to the rosette's rim
PATCH_RINGS = 3


@dataclass(frozen=True)
class UmbilicPatch:
    """Triangles around z = 0; vertex 0 is there, and the last ones run around the rim counter-clockwise.

    Attributes
    ----------
    vertices : (v,) complex
    faces : (m, 3) int
    nodes : (m, k) complex
        Nodes of the elements of an order.
    rim : (r,) int
        Vertices around.
    """

    vertices: Complexes
    faces: Integers
    nodes: Complexes
    rim: Integers


def umbilic_patch(zero_order: int, argument: float, radius: float, order: int) -> UmbilicPatch:
    """Wedges between the principal lines that leave a zero: one lamella leaves in the middle of each.

    Parameters
    ----------
    zero_order : int
        Order m of the zero: 2 (m + 2) wedges.
    argument : float
        That of c in D = c z^m + ..., rad.
    radius : float
        Of the rim's vertices.
    order : int
        Of the elements.
    """
    wedges = 2 * (zero_order + 2)
    power = 2 if zero_order % 2 else 1
    corner = (np.pi * np.arange(wedges + 1) - argument) / (zero_order + 2)
    start = radius ** (1 / power) * np.exp(1j * corner / power)
    local, triangles = subdivision(PATCH_RINGS)
    grid = np.rint(local * PATCH_RINGS).astype(np.int64)
    ring, step = grid.sum(1), grid[:, 1]
    # one row of numbers a ring: wedge after wedge; the last point of a wedge is the first of the next one
    first = 1 + wedges * ring * (ring - 1) // 2
    faces, nodes = [], []
    vertices = np.zeros(1 + wedges * PATCH_RINGS * (PATCH_RINGS + 1) // 2, complex)
    lattice = lagrange(order).nodes
    barycentric = np.column_stack([1 - lattice.sum(1), lattice])
    for wedge in range(wedges):
        zeta = local @ start[wedge : wedge + 2]
        number = np.where(ring == 0, 0, first + (wedge * ring + step) % np.maximum(wedges * ring, 1))
        # where the way around ends the branch of the root is the other one, and z the same
        vertices[number] = zeta**power
        faces.append(number[triangles])
        nodes.append((barycentric @ zeta[triangles].T).T ** power)
    rim = np.arange(1 + wedges * PATCH_RINGS * (PATCH_RINGS - 1) // 2, len(vertices))
    return UmbilicPatch(vertices, np.concatenate(faces), np.concatenate(nodes), rim)
