"""Lines that wind around on a surface without reaching its rim: each turn would cross the other family anew.

Principal lines do so around holes and around pairs of umbilics, closed where the surface is symmetric and in spirals
elsewhere. A few lines show it before all are traced.
"""

from __future__ import annotations

import numpy as np

from lamella.base.drawing_origin import coordinates
from lamella.base.errors import InputError
from lamella.network.charts.charts import Charts
from lamella.network.pattern import Pattern
from lamella.network.streamlines.direction_field import LineField
from lamella.network.streamlines.streamlines import Streamlines
from lamella.network.streamlines.ways_to_rim import cut_across, reaching_curvature


def refuse_winding(
    charts: Charts, field: LineField, lines: Streamlines, pattern: Pattern, spacing: float, size: float
) -> None:
    """Refuse lines that do not end.

    Raises
    ------
    InputError
        With what lets them end: a normal curvature whose lines reach the rim, a cut.
    """
    winding = lines.endless
    if not winding.any():
        return
    principal = pattern.kind == "principal"
    ways = (
        _of_angle(principal)
        if pattern.angle != 90
        else _of_mesh(charts, field, lines.take(np.flatnonzero(winding)), spacing, size, principal)
    )
    through = lines.position[lines.half == 2 * int(winding.argmax())][0]
    raise InputError(
        f"{winding.sum()} of {lines.count} lines wind around without reaching the rim, one of them through "
        f"({coordinates(through)}) m: closed lines are offered on surfaces of constant mean curvature only",
        "; or ".join(ways) or "cut the surface open where they go around",
        "kind" if principal else "angle" if pattern.angle != 90 else "normal_curvature",
    )


def _of_angle(principal: bool) -> list[str]:
    """Where the surface was found for a node angle: its normal curvature is given, and there is no mesh."""
    return ['write kind = "lamellas": the surface is found for them'] if principal else ["write another angle"]


def _of_mesh(
    charts: Charts, field: LineField, winding: Streamlines, spacing: float, size: float, principal: bool
) -> list[str]:
    """Another normal curvature, and a cut, where they are found."""
    ways = []
    better = reaching_curvature(charts, field, spacing, size)
    if better is not None:
        kind = 'kind = "lamellas" and ' if principal else ""
        ways.append(f"write {kind}normal_curvature = {better:g}, whose lines reach the rim")
    cut = cut_across(charts, field, winding, spacing, size)
    if cut is not None:
        # nanometres are rounding
        places = ", ".join(f"({coordinates(np.round(point, 9) + 0.0)})" for point in cut.points)
        ways.append(
            f"divide the mesh in two along the line through {places} m and make a project of each part"
            if cut.divides
            else f"cut the mesh open: take out the faces along the line through {places} m"
        )
    return ways
