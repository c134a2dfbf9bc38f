"""The charts of any surface."""

from __future__ import annotations

from typing import Any

from lamella.network.charts.charts import Ground
from lamella.network.charts.element_charts import ElementGround
from lamella.network.charts.plane_charts import PlaneGround
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.element.surface import ElementSurface
from lamella.surface.surface import Surface


def ground_of(surface: Surface[Any]) -> Ground:
    """The surface as lines are traced on it."""
    if isinstance(surface, ClosedForm):
        return PlaneGround(surface)
    assert isinstance(surface, ElementSurface)
    return ElementGround(surface)
