"""How near points lie to a plane or to a sphere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError


@dataclass(frozen=True)
class Plane:
    """The plane of least squares through points.

    Attributes
    ----------
    origin : (3,)
        Centre of the points, m.
    axes : (3, 3)
        Rows: two directions in the plane, the first along its larger extent, and the normal; right-handed.
    height : float
        Extent of the points along the normal, m.
    """

    origin: Floats
    axes: Floats
    height: float

    def project(self, points: Floats) -> Floats:
        """Coordinates in the plane of points (..., 3), m, (..., 2)."""
        return np.asarray((points - self.origin) @ self.axes[:2].T)


def fitted_plane(points: Floats, normals: Floats | None = None) -> Plane:
    """The plane of least squares.

    Parameters
    ----------
    points : (n, 3)
        m.
    normals : (n, 3), optional
        The plane's normal looks to the same side as most of them.

    Raises
    ------
    InputError
        Fewer than three points.
    """
    if len(points) < 3:
        raise InputError(f"{len(points)} points", "a plane needs three", "points")
    origin = points.mean(0)
    axes = np.linalg.svd(points - origin, full_matrices=False)[2]
    # the sign of singular vectors is arbitrary: the largest number of the first is positive
    first = axes[0] * np.sign(axes[0, np.abs(axes[0]).argmax()])
    normal = axes[2]
    side = normals.sum(0) @ normal if normals is not None else normal[np.abs(normal).argmax()]
    normal = normal * (-1.0 if side < 0 else 1.0)
    frame = np.stack((first, np.cross(normal, first), normal))
    height = np.ptp((points - origin) @ normal)
    return Plane(origin, frame, float(height))


@dataclass(frozen=True)
class Sphere:
    """The sphere of least squares through points.

    Attributes
    ----------
    centre : (3,)
        m.
    radius : float
        m.
    deviation : float
        Largest distance of a point from it, m.
    """

    centre: Floats
    radius: float
    deviation: float


def fitted_sphere(points: Floats) -> Sphere:
    """The sphere of least squares, by the linear fit of |p|^2 = 2 c . p + d.

    Raises
    ------
    InputError
        Points in a plane, which are on no sphere.
    """
    origin = points.mean(0)
    at = points - origin
    size = np.linalg.norm(at, axis=1).max()
    system = np.column_stack((2 * at / size, np.ones(len(at))))
    solved, _, rank, _ = np.linalg.lstsq(system, ((at / size) ** 2).sum(1), rcond=1e-12)
    if rank < 4:
        raise InputError("the points lie in a plane", "a sphere needs four that do not", "points")
    centre = solved[:3] * size
    radius = float(size * np.sqrt(solved[3] + solved[:3] @ solved[:3]))
    deviation = np.abs(np.linalg.norm(at - centre, axis=1) - radius).max()
    return Sphere(origin + centre, radius, float(deviation))
