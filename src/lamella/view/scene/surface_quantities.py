"""What a surface can be coloured by, one definition for the report and for still pictures."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.vectors import diagonal
from lamella.surface.mesh import SurfaceMesh
from lamella.view.scene.quantity import Quantity

# dark where the surface is curved most
SEQUENTIAL = ("#26456e", "#3f7fa0", "#7fb5a5", "#d5d49a", "#f3efd0")
DIVERGING = ("#7b3f8c", "#b99ac4", "#e4e3e6", "#9cc3a5", "#2f7d4a")

QUANTITY_ROUNDING = 1e-9
"""H - H0 up to this share of the curvature scale is rounding, not a property of the surface."""
CONSTANT = 1e-6
"""Other quantities that vary by less than this share of the scale are constant."""
CONSTANT_SHARE = 1e-3
"""Least curvature scale, over 1 / the diagonal of the bounding box: a plane's is rounding."""
FLAT = 1e-6
"""Where both principal curvatures are below this share of the scale, their ratio says nothing."""
USUAL = 0.98
"""Share of the area whose values the colours always tell apart: curvature has poles at corners of the boundary."""
OUTLYING = 1.5
"""How far beyond those values the largest has to be for the colours to leave it out."""
ONE_SIGN = 0.02
"""A quantity whose values of one sign are all below this share of the largest of the other has one sign."""


def surface_quantities(mesh: SurfaceMesh, mean_curvature: float) -> dict[str, Quantity]:
    """The quantities of a surface, by key.

    Parameters
    ----------
    mesh : SurfaceMesh
    mean_curvature : float
        H0, which the surface should have everywhere, 1/m.

    Returns
    -------
    dict
        "deviation" (H - H0), "K", "ratio" (of the principal curvature of smaller magnitude to the other: -1 on a
        minimal surface, 0 on a cylinder, 1 on a sphere), "k1", "k2".
    """
    larger = np.maximum(np.abs(mesh.k1), np.abs(mesh.k2))
    area = _vertex_areas(mesh)
    flattest = CONSTANT_SHARE / diagonal(mesh.points)
    scale = max(flattest, _usual(larger, area))
    found = (
        _deviation(mesh.mean_curvature - mean_curvature, area, mean_curvature, scale),
        _of_either_sign("K", "Gaussian curvature K", "1/m²", mesh.gaussian_curvature, area, scale**2),
        _ratio(mesh.gaussian_curvature, larger, scale),
        _of_either_sign("k1", "Principal curvature k1", "1/m", mesh.k1, area, scale),
        _of_either_sign("k2", "Principal curvature k2", "1/m", mesh.k2, area, scale),
    )
    return {quantity.key: quantity for quantity in found}


def _deviation(values: Floats, area: Floats, mean_curvature: float, scale: float) -> Quantity:
    named = ("deviation", "Deviation H − H0", "1/m")
    least, most = _extent(values)
    h0 = f"H0 = {mean_curvature:.4g} 1/m".replace("-", "−")
    if not max(-least, most) > QUANTITY_ROUNDING * scale:
        # colours would show the last digits of the arithmetic
        return Quantity(*named, f"to rounding, {h0}", values, 0.0, 0.0, least, most, (DIVERGING[2],))
    limit = _limit(np.abs(values), area)
    return Quantity(*named, h0, values, -limit, limit, least, most, DIVERGING)


def _ratio(gaussian: Floats, larger: Floats, scale: float) -> Quantity:
    # K over the square of the larger one: the ratio with its sign, and never a division by the smaller one
    values = np.divide(gaussian, larger**2, out=np.full(len(larger), np.nan), where=larger > FLAT * scale)
    named = ("ratio", "Ratio k1/k2, smaller to larger", "")
    remark = "−1 minimal, 0 cylinder, 1 sphere"
    return Quantity(*named, remark, values, -1.0, 1.0, *_extent(values), DIVERGING)


def _of_either_sign(key: str, label: str, unit: str, values: Floats, area: Floats, size: float) -> Quantity:
    named = (key, label, unit)
    least, most = _extent(values)
    if not most - least > CONSTANT * size:
        middle = (least + most) / 2
        # a zero that is rounding reads as zero
        middle = 0.0 if abs(middle) <= CONSTANT * size else middle
        return Quantity(*named, "everywhere", values, middle, middle, least, most, (SEQUENTIAL[1],))
    limit = _limit(np.abs(values), area)
    if most < -ONE_SIGN * least:
        return Quantity(*named, "", values, -limit, min(most, 0.0), least, most, SEQUENTIAL)
    if least > -ONE_SIGN * most:
        return Quantity(*named, "", values, max(least, 0.0), limit, least, most, SEQUENTIAL[::-1])
    return Quantity(*named, "", values, -limit, limit, least, most, DIVERGING)


def _extent(values: Floats) -> tuple[float, float]:
    known = values[np.isfinite(values)]
    return (float(known.min()), float(known.max())) if len(known) else (np.nan, np.nan)


def _limit(sizes: Floats, area: Floats) -> float:
    """Size of the last colour: the largest, or where a small part has far larger ones, the largest of the rest."""
    known = sizes[np.isfinite(sizes)]
    usual, largest = _usual(sizes, area), float(known.max())
    return usual if largest > OUTLYING * usual > OUTLYING * known.min() else largest


def _usual(sizes: Floats, area: Floats) -> float:
    """Size that is not exceeded on the share `USUAL` of the area; 0 where none is known."""
    known = np.isfinite(sizes)
    if not known.any():
        return 0.0
    order = np.argsort(sizes[known])
    covered = np.cumsum(area[known][order])
    place = np.searchsorted(covered, USUAL * covered[-1])
    return float(sizes[known][order[min(int(place), len(order) - 1)]])


def _vertex_areas(mesh: SurfaceMesh) -> Floats:
    """Area about each vertex, up to a factor; meshes are finer where more is going on, which is no larger a part."""
    corners = mesh.points[mesh.faces]
    faces = np.linalg.norm(np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]), axis=1)
    # the repeated corner of a triangle counts twice, which is near enough
    return np.asarray(np.bincount(mesh.faces.ravel(), np.repeat(faces, 4), len(mesh.points)), np.float64)
