"""Colours of nets: by the planarity score as in the paper, by how spherical stars are, by radius and by angle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.projection.mesh_figures import MeshFigures
from lamella.projection.problems.planar_strips import RED
from lamella.projection.quad_mesh import QuadMesh

NetColour = Literal["planarity", "sphericity", "radius", "angle"]
"""What a net is coloured by.

planarity
    Of faces; full red at a score of 0.005 and above (paper, section 2.3).
sphericity
    Of stars: distance from their best sphere over the mean edge; full red at 0.005 and above.
radius
    Of the best sphere of each star, m.
angle
    Between both polylines, degrees; white at 90.
"""

# from good to full red; from small to large; from one side to the other
GOOD_BAD = ("#2f7fb8", "#a9cfe0", "#f2e9c9", "#ee8a4d", "#d60000")
SMALL_LARGE = ("#26456e", "#3f7fa0", "#7fb5a5", "#d5d49a", "#f3efd0")
EITHER_SIDE = ("#7b3f8c", "#b99ac4", "#f1f1f2", "#9cc3a5", "#2f7d4a")
UNKNOWN = "#c9cccf"
# what does not vary by this share is constant, degrees for angles
LEAST_RANGE, LEAST_ANGLE = 1e-3, 0.1


@dataclass(frozen=True)
class NetColours:
    """Values with their colours.

    Attributes
    ----------
    key : str
    label : str
        For a legend, with the unit.
    on : "vertices" or "faces"
    values : (n,)
        NaN where not known.
    low, high : float
        Values of the first and the last colour.
    stops : tuple of str
        Colours at equal steps between them, as #rrggbb.
    """

    key: NetColour
    label: str
    on: Literal["vertices", "faces"]
    values: Floats
    low: float
    high: float
    stops: tuple[str, ...]

    @property
    def rgb(self) -> NDArray[np.uint8]:
        """sRGB of each value, (n, 3)."""
        table = np.array([_rgb(stop) for stop in self.stops], np.float64)
        share = np.clip((self.values - self.low) / (self.high - self.low), 0, 1)
        known = np.isfinite(share)
        at = np.where(known, share, 0) * (len(table) - 1)
        columns = [np.interp(at, np.arange(len(table)), column) for column in table.T]
        return np.where(known[:, None], np.stack(columns, 1).round(), _rgb(UNKNOWN)).astype(np.uint8)


def net_colours(mesh: QuadMesh, figures: MeshFigures, key: NetColour) -> NetColours:
    """Colours of a net by one of its figures.

    Raises
    ------
    InputError
        An unknown key.
    """
    if key == "planarity":
        return NetColours(key, "planarity score of faces", "faces", figures.faces["planarity"], 0.0, RED, GOOD_BAD)
    if key == "sphericity":
        values = figures.vertices["star_sphericity"] / mesh.mean_edge
        return NetColours(key, "stars off their spheres / edge", "vertices", values, 0.0, RED, GOOD_BAD)
    if key == "radius":
        values = figures.vertices["star_radius"]
        known = values[np.isfinite(values)]
        low, high = (float(x) for x in np.percentile(known, (2, 98))) if len(known) else (0.0, 1.0)
        middle, half = (low + high) / 2, max((high - low) / 2, LEAST_RANGE * (low + high) / 2)
        return NetColours(key, "radius of stars (m)", "vertices", values, middle - half, middle + half, SMALL_LARGE)
    if key == "angle":
        values = figures.vertices["angle"]
        known = values[np.isfinite(values)]
        off = max(float(np.percentile(np.abs(known - 90), 98)) if len(known) else 0.0, LEAST_ANGLE)
        return NetColours(key, "node angle (degrees)", "vertices", values, 90 - off, 90 + off, EITHER_SIDE)
    raise InputError(f"unknown colour {key!r}", f"choose one of {', '.join(get_args(NetColour))}")


def _rgb(colour: str) -> tuple[int, int, int]:
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)
