"""Lines that wind around on a surface without reaching its rim: each turn would cross the other family anew.

Principal lines do so around holes, closed where the surface is symmetric and in spirals elsewhere. A few lines tell of
it before all are traced, and of other normal curvatures whose lines do reach the rim.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lamella.drawing_origin import coordinates
from lamella.errors import InputError
from lamella.network.flow import Flow, trace
from lamella.network.ground import Ground, Look
from lamella.network.line_field import LineField
from lamella.network.pattern import Pattern
from lamella.surface.element.places import Places
from lamella.surface.points import Floats

# lines of each family that are tried, spread over the surface
PROBES = 12
# of the spacing: a line that comes back as near to its seed winds around
BESIDE = 0.25
# steps a spacing, and longest half over the surface's size
STEPS, LONGEST = 3, 12.0
# normal curvatures looked at: these quantiles of H over the area, and 0; offered are those that at least this share of
# the area has, and of two with shares as alike as this the one nearer to the middle of H
QUANTILES, LEAST_AREA, ALIKE = np.linspace(0.1, 0.9, 9), 0.5, 0.02
# of them are tried, those that most of the area has first
MOST_TRIED = 6


def wound(
    ground: Ground, field: LineField, seeds: Places, is_a: NDArray[np.bool_], *, spacing: float, size: float
) -> Flow:
    """Lines from seeds, see `lamella.network.flow.trace`; those that come back to their seed are given up there."""
    return trace(ground, field, seeds, is_a, step=spacing / STEPS, longest=LONGEST * size, beside=BESIDE * spacing)


def refuse_winding(ground: Ground, field: LineField, flow: Flow, pattern: Pattern, spacing: float, size: float) -> None:
    """Refuse lines that do not end.

    Raises
    ------
    InputError
        With a normal curvature whose lines do, if there is one.
    """
    winding = flow.endless
    if not winding.any():
        return
    where, area = ground.samples()
    look = ground.look(where)
    better = _reaching(ground, field, where, area, look, spacing, size)
    principal = pattern.kind == "principal"
    offered = f"normal_curvature = {better:g}, whose lines reach the rim" if better is not None else ""
    cut_open = "cut the surface open where they go around"
    through = flow.position[flow.half == 2 * int(winding.argmax())][0]
    raise InputError(
        f"{winding.sum()} of {flow.count} lines wind around without reaching the rim, one of them through "
        f"({coordinates(through)}) m: closed lines are offered on surfaces of constant mean curvature only",
        (f'write kind = "lamellas" and {offered}; or ' if principal else f"write {offered}; or ") * bool(offered)
        + cut_open,
        "network.kind" if principal else "network.normal_curvature",
    )


def probes(ground: Ground, field: LineField, where: Places, look: Look, spacing: float, size: float) -> Flow:
    """Some lines of both families, through places spread over those (n,) that have directions."""
    usable = np.flatnonzero(field.margin(look.mean, look.deviator) > 0)
    some = usable[np.linspace(0, len(usable) - 1, min(PROBES, len(usable))).astype(np.int64)]
    is_a = np.repeat([True, False], len(some))
    return wound(ground, field, where[np.tile(some, 2)], is_a, spacing=spacing, size=size)


def _reaching(
    ground: Ground, field: LineField, where: Places, area: Floats, look: Look, spacing: float, size: float
) -> float | None:
    """A normal curvature, 1/m, that most of the surface has and whose lines end; None: none was found."""
    order = np.argsort(look.mean)
    share = np.cumsum(area[order]) / area.sum()
    middle = float(look.mean[order[np.searchsorted(share, 0.5)]])
    values = [0.0, *(float(f"{look.mean[order[np.searchsorted(share, q)]]:.2g}") for q in QUANTILES)]
    choices = []
    for value in sorted(set(values)):
        other = LineField(value, field.scale)
        there = float(area[other.margin(look.mean, look.deviator) > 0].sum() / area.sum())
        if there >= LEAST_AREA:
            choices.append((-round(there / ALIKE), abs(value - middle), value))
    for _, _, value in sorted(choices)[:MOST_TRIED]:
        if not probes(ground, LineField(value, field.scale), where, look, spacing, size).endless.any():
            return value
    return None
