"""The charts of any surface."""

from __future__ import annotations

from typing import Any

from lamella.network.charts.charts import Charts
from lamella.network.charts.plane_charts import PlaneCharts
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.surface import Surface


def charts_of(surface: Surface[Any]) -> Charts:
    """The surface as lines are traced on it."""
    if isinstance(surface, ClosedForm):
        return PlaneCharts(surface)
    # heavy, and closed forms do without
    from lamella.network.charts.element_charts import ElementCharts
    from lamella.surface.element.surface import ElementSurface

    assert isinstance(surface, ElementSurface)
    return ElementCharts(surface)
