"""What a run warns about surfaces: sizes that are no building, elements that will not do, files that are meshes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from lamella.base.message import Message
from lamella.base.vectors import diagonal
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.mesh import SurfaceMesh
from lamella.surface.surface import Surface

# m; the largest timber gridshells span well under 200 m
LARGE = 250.0
# surfaces this many strip heights across are a unit mistake more often than a building
SLENDER = 2500.0


def size_warnings(mesh: SurfaceMesh, height: float) -> Iterator[Message]:
    """Sizes that look like millimetres taken for metres."""
    size = diagonal(mesh.points)
    if size > LARGE or size > SLENDER * height:
        yield Message(
            "unit_large",
            f"the surface is {size:,.0f} m across and the lamella {height:g} m high: all lengths in a project file are "
            "metres, were millimetres meant?",
        )
    elif size < 5 * height:
        yield Message(
            "unit_small",
            f"the surface is only {size:.3g} m across for a lamella {height:g} m high: all lengths in a project file "
            "are metres",
        )


def order_warning(order: int, tolerance: float, most_nodes: int) -> Message | None:
    """That elements of order 2 will need too many nodes, before they are made; None: they will not.

    Their curvature is off by the first power of their size: 0.6 to 2.4 / sqrt(nodes) of the curvature scale on films
    between rings, caps and saddles.
    """
    nodes = 2 / tolerance**2
    if order > 2 or nodes <= most_nodes:
        return None
    return Message(
        "order_low",
        f"order = 2 takes about {nodes:,.0f} nodes for tolerance = {tolerance:g} (most_nodes = {most_nodes:,}): order "
        "= 3 or 4 keeps it with a few thousand",
    )


def surface_file_warnings(surface: Surface[Any], requested: bool | None) -> Iterator[Message]:
    """A surface.3dm that is no NURBS, or is left out since it would be large; `requested` as in the project."""
    if isinstance(surface, ClosedForm):
        return
    # heavy, and closed forms do without
    from lamella.surface.element.surface import SMOOTHED_ORDER, ElementSurface

    if not isinstance(surface, ElementSurface):
        return
    from lamella.files.write.surface_patches import (
        MESH_TOLERANCE,
        MOST_PATCHES,
        SMALL_PATCHES,
        is_written,
        patch_count,
    )

    count = patch_count(surface)
    if requested is None and count > SMALL_PATCHES:
        yield Message(
            "surface_3dm_left_out",
            f"surface.3dm is left out: NURBS would be {count:,} patches (more than {SMALL_PATCHES:,}); write "
            "files.surface_3dm = true for it, or false for none without this warning",
        )
    if is_written(surface, requested) and count > MOST_PATCHES:
        yield Message(
            "surface_3dm_mesh",
            f"surface.3dm holds one mesh, within about {MESH_TOLERANCE:g} of the surface's size, and exact boundary "
            f"curves: NURBS would be {count:,} patches (limit {MOST_PATCHES:,}); a larger surface.tolerance"
            + (" or a higher surface.order" if surface.connectivity.basis.order < max(SMOOTHED_ORDER) else "")
            + " takes fewer",
        )
