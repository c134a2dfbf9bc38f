"""Strips bent towards developable ones where the net's own curves have none (paper, Figures 7 and 10).

The borders move, one on the surface and one on its parallel surface at the strips' height, until quads are planar.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report
from lamella.files.write.drawn_layer import DrawnLayer
from lamella.strip.developable_strips import DevelopableStrips
from lamella.strip.lamellas import Lamellas
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.surface import Surface

if TYPE_CHECKING:
    from lamella.projection.problems.planar_strips import PlanarStrips

QUADS = 8
"""Pieces of a cell edge before they are halved once: what is told of a quad is that of sixteen a cell."""
BATCH = 3_000
"""Points that are solved for at once: every strip is alone, and progress is reported between them."""
COLOUR = (150, 60, 150)
"""Of their borders in the model."""


@dataclass(frozen=True, eq=False)
class Optimised:
    """Strips of the lamellas along which no developable strip exists everywhere.

    Attributes
    ----------
    lamellas : (m,) int
        Of the network.
    parts : tuple of PlanarStrips
        Of these one after the other.
    fault : str
        Why there are none.
    """

    lamellas: Integers
    parts: tuple[PlanarStrips, ...] = ()
    fault: str = ""

    def figures(self) -> dict[str, Any]:
        """What the summary tells, rounded to what does not hang on the solver's last bits."""
        if not self.parts:
            return {"lamellas": len(self.lamellas), "fault": self.fault}
        before, after = (
            np.concatenate([x for one in self.parts for x in getattr(one, k)]) for k in ("before", "after")
        )
        shift, tilt, turn = (
            float(np.concatenate([x for one in self.parts for x in getattr(one, key)]).max())
            for key in ("shift", "tilt", "turn")
        )
        return {
            "lamellas": len(self.lamellas),
            "fault": None,
            "planarity_before_max": round(float(before.max()), 6),
            "planarity_max": round(float(after.max()), 6),
            "shift_max": round(shift, 5),
            "tilt_max_deg": round(tilt, 2),
            "turn_max_deg": round(turn, 2),
        }


def optimised_strips(
    lamellas: Lamellas, strips: DevelopableStrips, surface: Surface[Any], progress: Progress
) -> Optimised | None:
    """Strips of the lamellas that have a place without a developable one; None where there are none."""
    # heavy, and most projects do without
    from lamella.projection.foot_points import foot_surface
    from lamella.projection.problems.planar_strips import planar_strips
    from lamella.surface.element.surface import ElementSurface

    network = lamellas.network
    some = np.unique(np.array([lamella for lamella, _, _ in strips.gaps(network)], np.int64))
    curves = [_curve(lamellas, lamella) for lamella in some.tolist()]
    long = np.array([len(curve) >= 4 for curve in curves], bool)
    some, curves = some[long], [curve for curve, kept in zip(curves, long.tolist(), strict=True) if kept]
    if not len(some):
        return None
    if not isinstance(surface, ClosedForm | ElementSurface):
        return None
    feet = foot_surface(surface)
    starts = np.cumsum([0] + [len(curve) for curve in curves])
    parts, begin = [], 0
    while begin < len(curves):
        end = max(int(np.searchsorted(starts, starts[begin] + BATCH, "right")) - 1, begin + 1)
        progress(Report.step("strips made planar", begin / len(curves)))
        try:
            parts.append(planar_strips(curves[begin:end], feet, lamellas.section.height, rounds=1))
        except InputError as error:
            return Optimised(some, fault=error.message)
        begin = end
    return Optimised(some, tuple(parts))


def _curve(lamellas: Lamellas, lamella: int) -> Floats:
    """Points of a lamella's centre line, about `QUADS` a cell edge."""
    network = lamellas.network
    begin, end = int(network.sample_offsets[lamella]), int(network.sample_offsets[lamella + 1])
    cells = max(int(network.stop_offsets[lamella + 1] - network.stop_offsets[lamella]) - 1, 1)
    pieces = min(QUADS * cells, end - begin - 1)
    at = np.unique(np.round(np.linspace(begin, end - 1, pieces + 1)).astype(np.int64))
    return network.sample_points[at]


def optimised_layers(optimised: Optimised) -> Iterator[DrawnLayer]:
    """Both borders of every strip in the model."""
    curves = [curve for one in optimised.parts for pair in zip(one.lower, one.upper, strict=True) for curve in pair]
    if curves:
        yield DrawnLayer("strips made planar", curves=tuple(curves), colour=COLOUR)
