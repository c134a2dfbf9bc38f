"""How many NURBS patches a surface of curved triangles takes in surface.3dm, and how many are written.

Known without Rhino's library, so that a check can say it.
"""

from __future__ import annotations

from lamella.surface.element.surface import ElementSurface

SMALL_PATCHES = 10_000
"""A run writes surfaces of so many patches without being asked to (`FilesTable.surface_3dm`)."""

MOST_PATCHES = 20_000
"""Surfaces of more patches (about 1 kB each, and slow in Rhino) are written as one mesh."""

MESH_TOLERANCE = 1e-4
"""Sag of that mesh aimed at, over the diagonal of the bounding box; what it came to is in the file."""


def patch_count(surface: ElementSurface) -> int:
    """Patches of four sides: three an element."""
    return 3 * len(surface.connectivity.elements)


def is_written(surface: ElementSurface, requested: bool | None) -> bool:
    """Whether a run writes surface.3dm: as it was requested, and else where the surface is small."""
    return patch_count(surface) <= SMALL_PATCHES if requested is None else requested
