"""Measures of parts where a project does not say them, computed here alone: for its file and for the parts."""

from __future__ import annotations

from lamella.fabrication.rules import edge_scale

# m of strip beyond the last slot, and from a singular node to the strips: lengths a workshop can clamp and drill,
# whatever the size of the structure
END_DISTANCE_MIN, HUB_RADIUS_MIN = 0.05, 0.02
# slot widths of strip beyond the last slot, along the shorter edge
END_SLOTS = 2.0
# thicknesses of the strip that goes through a slot
SLOT_THICKNESSES = 2.0


def default_slot_width(thickness: float) -> float:
    """Of strips of a thickness, m."""
    return SLOT_THICKNESSES * thickness


def default_end_distance(slot_width: float, curvature: float, height: float) -> float:
    """From the last slot to the end of a strip of a curvature (1/m) and height, m."""
    return max(END_DISTANCE_MIN, END_SLOTS * slot_width / edge_scale(curvature, height))


def default_hub_radius(clear: float) -> float:
    """From a singular node to the strips' ends, m, where they are clear of each other at `clear`, m."""
    return max(HUB_RADIUS_MIN, clear)
