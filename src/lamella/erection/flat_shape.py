"""The flat state of a net: planar where H = 0, on a sphere of radius 1/H otherwise."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Integers
from lamella.erection.flatness import Plane, fitted_plane, fitted_sphere
from lamella.erection.floor import floor_rectangle
from lamella.erection.overlaps import crossings_beside_nodes
from lamella.structure.beam.helices import points_between
from lamella.structure.beam.poses import Poses
from lamella.structure.model.model import Model

# pieces of an element whose crossings with those of others are looked for
CROSSED_PIECES = 4
# over the size: nets of straight strips farther off their plane, and those of arcs farther off a sphere, do not lie;
# below that is what strips give about their strong axis
OFF_FLOOR, OFF_SPHERE = 1e-4, 0.02
# over the size: less is rounding
FLAT_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class FlatShape:
    """How a net lies.

    Attributes
    ----------
    plane : Plane
        Of least squares through its nodes.
    radius : float
        Of the sphere of least squares, m; infinite where strips are straight, so that the net should be planar.
    off : float
        Largest distance of a node from that sphere or from the plane, m.
    lies : bool
        Whether it lies on them, but for what strips give.
    overlaps : (o, 2) int
        Pairs of lamellas that cross in the plan where they are not joined.
    size : (float, float)
        Of the smallest rectangle that it lies in, along the plane's axes, m.
    """

    plane: Plane
    radius: float
    off: float
    lies: bool
    overlaps: Integers
    size: tuple[float, float]

    @property
    def planar(self) -> bool:
        """Whether it should lie in a plane."""
        return bool(np.isinf(self.radius))

    @property
    def height(self) -> float:
        """Over the plane, m; 0 where it is rounding."""
        return self.plane.height if self.plane.height > FLAT_ROUNDING * float(np.hypot(*self.size)) else 0.0

    @classmethod
    def of(cls, model: Model, poses: Poses, *, laid: bool = True) -> FlatShape:
        """The shape in a pose; of one that is not laid flat no overlaps are looked for."""
        count = model.nodes
        points, normals = poses.points[:count], poses.frames[:count, :, 2]
        plane = _turned(fitted_plane(points, normals), poses, model)
        length, width = np.ptp(plane.project(poses.points), axis=0).tolist()
        size = float(np.hypot(length, width))
        radius, off = np.inf, plane.height / 2
        limit = OFF_FLOOR
        if model.lamellas.network.normal_curvature:
            sphere = fitted_sphere(points)
            radius, off, limit = sphere.radius, sphere.deviation, OFF_SPHERE
        if off < FLAT_ROUNDING * size:
            off = 0.0
        overlaps = _overlaps(model, poses, plane) if laid else np.zeros((0, 2), np.int64)
        return cls(plane, radius, off, off <= limit * size, overlaps, (length, width))


def _turned(plane: Plane, poses: Poses, model: Model) -> Plane:
    """The plane with its axes along the sides of the smallest rectangle around all nodes.

    Of several alike the one nearest to the first lamella.
    """
    flat = plane.project(poses.points)
    first = model.structure.beams.attachment.nodes[model.lines.lamella == 0]
    sides = floor_rectangle(flat, flat[first[-1, 1]] - flat[first[0, 0]])
    return replace(plane, axes=np.concatenate((sides @ plane.axes[:2], plane.axes[2:])))


def _overlaps(model: Model, poses: Poses, plane: Plane) -> Integers:
    """Pairs of lamellas (o, 2)."""
    crossed = _crossed(model, poses, plane)
    return np.unique(np.sort(model.lines.lamella[crossed], axis=1), axis=0)


def overlapping_nodes(model: Model, poses: Poses, plane: Plane) -> Integers:
    """Nodes of the network before the places where lamellas overlap, on either one, (c, 2)."""
    return np.unique(_edge_ends(model)[_crossed(model, poses, plane), 0], axis=0)


def _crossed(model: Model, poses: Poses, plane: Plane) -> Integers:
    """Elements that cross in the plan where their lamellas are not joined, (c, 2)."""
    attachment = model.structure.beams.attachment
    shares = np.linspace(0, 1, CROSSED_PIECES + 1)
    along, _ = points_between(*attachment.ends(poses), shares)
    flat = plane.project(along)
    pieces = np.stack((flat[:, :-1], flat[:, 1:]), 2).reshape(-1, 2, 2)
    crossed, _ = crossings_beside_nodes(pieces, np.repeat(_edge_ends(model), CROSSED_PIECES, axis=0))
    return crossed // CROSSED_PIECES


def _edge_ends(model: Model) -> Integers:
    """Nodes of the network at the ends of the cell edge that each element is of, (m, 2)."""
    count = model.rules.elements
    nodes = model.structure.beams.attachment.nodes.reshape(-1, count, 2)
    ends = np.stack((nodes[:, 0, 0], nodes[:, -1, 1]), 1)
    return np.repeat(ends, count, axis=0)
