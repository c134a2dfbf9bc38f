"""A few lines of a field, traced to see where such lines lead before all are traced."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans
from lamella.network.charts.charts import Charts, ChartSample
from lamella.network.streamlines.direction_field import LineField
from lamella.network.streamlines.streamlines import Streamlines, trace
from lamella.surface.element.places import Places

# lines of each family that are tried, spread over the surface
PROBES = 12
# of the spacing: a line that comes back as near to its seed winds around
SAME_LINE = 0.25
# steps a spacing, and longest half over the surface's size
SPACING_STEPS, HALF_LENGTH_MAX = 3, 12.0


def wound(
    charts: Charts, field: LineField, seeds: Places, is_a: Booleans, *, spacing: float, size: float
) -> Streamlines:
    """Streamlines from seeds; those that come back to their seed are given up there."""
    return trace(
        charts,
        field,
        seeds,
        is_a,
        step=spacing / SPACING_STEPS,
        longest=HALF_LENGTH_MAX * size,
        beside=SAME_LINE * spacing,
    )


def probes(
    charts: Charts, field: LineField, where: Places, sample: ChartSample, spacing: float, size: float
) -> Streamlines:
    """Some lines of both families, through places spread over those (n,) that have directions."""
    usable = np.flatnonzero(field.margin(sample.mean, sample.deviator) > 0)
    some = usable[np.linspace(0, len(usable) - 1, min(PROBES, len(usable))).astype(np.int64)]
    is_a = np.repeat([True, False], len(some))
    return wound(charts, field, where[np.tile(some, 2)], is_a, spacing=spacing, size=size)
