"""What should be known of panels before they are ordered."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.drawing_origin import coordinates
from lamella.base.message import Message
from lamella.base.wording import counted
from lamella.panels.flatness import Planes
from lamella.panels.panels import LAID, UMBILIC
from lamella.panels.polygons import Polygons
from lamella.panels.rules import PanelRules

MM = 1000.0
NAMED = 6
"""Panels that a message names by their places."""

HOW = {
    "triangles": "they are made of triangles",
    "single-curved": "plates there are bent to one curve, others are made of triangles",
    "cold-bent": "plates there are to be bent cold by their warp, others are made of triangles",
}
WHERE = {"inside": "inside", "rim": "at the rim", "umbilic": "beside an umbilic"}


def panel_warnings(
    rules: PanelRules,
    points: Floats,
    planned: Polygons,
    planes: Planes,
    laid: Integers,
    over: Booleans,
    left_out: Floats,
    conflicts: Integers,
) -> tuple[Message, ...]:
    """The warnings of `lamella.panels.make_panels.make_panels`, which has these measures."""
    found = []
    if len(conflicts):
        found.append(
            Message(
                "panels_seam",
                "every second node does not meet every second node around the net: at "
                f"{counted(len(conflicts), 'edge')}, first at ({_place(points[conflicts[0]].mean(axis=0))}), panels "
                "are cut as at a rim; another number of cells, or a net that closes, has no such seam",
            )
        )
    if over.any():
        found.append(_over(rules, planned, planes, laid, over))
    if len(left_out):
        places = "; ".join(f"({_place(point)})" for point in left_out[:NAMED])
        found.append(
            Message(
                "panels_left_out",
                f"a gap of {MM * rules.gap:g} mm leaves nothing of {counted(len(left_out), 'small panel')} at "
                f"{places}{', ...' if len(left_out) > NAMED else ''}",
            )
        )
    return tuple(found)


def _over(rules: PanelRules, planned: Polygons, planes: Planes, laid: Integers, over: Booleans) -> Message:
    """The warning of panels that are no plates."""
    which = np.flatnonzero(over)
    # those beside umbilics first, then by how far they are out of plane, to a thousandth of a millimetre
    order = np.lexsort((which, -np.round(planes.out_of_plane[which], 6), laid[which] != UMBILIC))
    named = "; ".join(_told(k, planes, laid) for k in which[order[:NAMED]].tolist())
    at_rim, beside = (int((laid[which] == k).sum()) for k in (LAID.index("rim"), UMBILIC))
    return Message(
        "panels_over_limit",
        f"{counted(len(which), 'panel')} of {len(planned):,} ({beside} beside umbilics, {at_rim} at rims) are more "
        f"than {MM * rules.limit:g} mm out of plane, {HOW[rules.above_limit]}: {named}"
        f"{'; ...' if len(which) > NAMED else ''}",
    )


def _place(point: Floats) -> str:
    """Coordinates to the micrometre, m: what is rounding is 0."""
    return coordinates(np.round(point, 6) + 0.0)


def _told(k: int, planes: Planes, laid: Integers) -> str:
    """A panel by its number and place, with what a plate there would have to be bent by."""
    warp = planes.warps[k]
    bent = f", warp {MM * warp:.3g} mm" if np.isfinite(warp) and warp > 0 else ""
    return (
        f"P{k + 1} {WHERE[LAID[laid[k]]]} at ({_place(planes.origins[k])}) by "
        f"{MM * planes.out_of_plane[k]:.3g} mm{bent}"
    )
