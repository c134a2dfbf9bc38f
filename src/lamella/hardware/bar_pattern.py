"""What a flat bar is cut as that stands along a curve: unrolled like a lamella.

The bar's middle fibre keeps its length, and in the plane it has the curvature that the axis has towards the surface
normal, kn: a bar that was cut straight would have to be bent about its strong axis by that. What is left is bending
about the weak axis, kg, and twist, tg, which a flat bar takes.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.fabrication.axis import Axis, outline
from lamella.hardware.shape import Prism

ARCS = 64
"""Arcs that the middle fibre is unrolled to."""


def bar_pattern(
    points: Floats, up: Floats, curvature: Floats, width: float, thickness: float, cuts: Floats | None = None
) -> Prism:
    """The flat pattern of a bar, x along it and y along the normal, cut obliquely where it is mitred.

    Parameters
    ----------
    points, up : (k, 3)
        Of the axis, m, at equal steps about, and the direction of the bar's width there.
    curvature : (k - 2,)
        kn of the axis at its inner points, 1/m.
    width, thickness : float
        m.
    cuts : (2, 3), optional
        Normals of the planes in which it begins and ends.
    """
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    stations = np.append(0.0, np.cumsum(steps))
    # what the axis turns up to each point, and so on each arc
    half = (steps[1:] + steps[:-1]) / 2
    turned = np.append(0.0, np.cumsum(curvature * half))
    middles = np.append(steps[0] / 2, stations[1:-1] + steps[1:] / 2)
    knots = np.linspace(0.0, stations[-1], min(ARCS, len(points) - 1) + 1)
    bends = np.diff(np.interp(knots, middles, turned)) / np.diff(knots)
    # there is no turn told before the first and after the last of them
    bends[[0, -1]] = [_end(curvature), _end(curvature[::-1])]
    ends = np.repeat(knots[[0, -1], None], 2, axis=1)
    if cuts is not None:
        ahead = np.stack([points[1] - points[0], points[-1] - points[-2]])
        ahead /= np.linalg.norm(ahead, axis=1)[:, None]
        slope = np.einsum("ij,ij->i", up[[0, -1]], cuts) / np.einsum("ij,ij->i", ahead, cuts)
        ends = ends - slope[:, None] * np.array([-width / 2, width / 2])
    made = outline(Axis.of(knots, bends), width, np.empty(0), 0.0, True, ends=ends)
    return Prism(made, -thickness / 2, thickness / 2)


def _end(curvature: Floats) -> float:
    """At the first quarter of an arc: of a smooth curve that the first values tell."""
    count = max(len(curvature) // ARCS, 1)
    return float(curvature[:count].mean())
