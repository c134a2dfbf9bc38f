"""What the view shows of the largest measures: how near to its limit each lamella is, and where along it."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.stages.network.scene import Thinned
from lamella.strip.lamellas import Lamellas
from lamella.strip.sizing import LEAST_SHARE_TRIED, Sizing
from lamella.view.scene.curves import Fact, Plot, Series
from lamella.view.scene.quantity import Quantity, magnitude

NEAR_LIMIT = ("#2b6f4f", "#7fae5a", "#d9c94a", "#e8963a", "#d7372c")
"""From far below the limit to it: red is the limit and beyond."""
MM = 1e3


def sizing_quantities(sizing: Sizing, lamellas: Lamellas, kept: Thinned) -> tuple[Quantity, ...]:
    """The share of the limit along the strips; of each lamella the share of its largest thickness and height.

    Parameters
    ----------
    sizing : Sizing
    lamellas : Lamellas
    kept : Thinned
        Samples that the view has.
    """
    section = lamellas.section
    lamella = np.repeat(np.arange(len(kept.offsets) - 1), np.diff(kept.offsets))
    thick, high = (
        _share(measure, largest)[lamella]
        for measure, largest in ((section.thickness, sizing.thickness), (section.height, sizing.height))
    )
    at = f"at a safety of {sizing.safety:g}"
    return (
        magnitude(
            "limit", f"Share of the limit {at}", "", limit_share(sizing, lamellas)[kept.samples], 1.0, NEAR_LIMIT
        ),
        magnitude("limit_thickness", f"Thickness over the largest {at}", "", thick, 1.0, NEAR_LIMIT),
        magnitude("limit_height", f"Height over the largest {at}", "", high, 1.0, NEAR_LIMIT),
    )


def limit_share(sizing: Sizing, lamellas: Lamellas) -> Floats:
    """Safety times utilisation along the lamellas, (k,): 1 is the limit."""
    return np.asarray(sizing.safety * lamellas.utilisation)


def sizing_facts(sizing: Sizing) -> tuple[Fact, ...]:
    """The largest measures of each lamella."""
    return tuple(
        Fact(f"Largest {name}", "mm", tuple(f"{MM * value:.4g}" if np.isfinite(value) else "-" for value in values))
        for name, values in sizing.measures().items()
    )


def sizing_plot(sizing: Sizing, lamellas: Lamellas, kept: Thinned) -> Plot:
    """The share of the limit along a lamella, beside the limit."""
    share = limit_share(sizing, lamellas)[kept.samples]
    series = Series("limit", "share of the limit", share), Series("limit_line", "limit", np.ones(len(share)))
    return Plot(f"Share of the limit at a safety of {sizing.safety:g}", "", series)


def _share(measure: float, largest: Floats) -> Floats:
    """Of the largest measure; 0 where none is too large, and of the smallest one that was tried where it is."""
    return np.where(largest > 0, measure / np.where(largest > 0, largest, 1.0), 1 / LEAST_SHARE_TRIED)
