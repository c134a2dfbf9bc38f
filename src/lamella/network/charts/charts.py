"""What lines are traced on: a surface with flat charts, whether it is made of elements or known in closed form.

A place is an element with local coordinates (x, y). A chart goes on smoothly a little beyond its element, so that a
step may leave it and is handed on to the neighbour afterwards. A closed form is one element, its local coordinates
those of the parameter plane.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.surface.element.places import Places


class ChartSample(NamedTuple):
    """What is seen at n places.

    Attributes
    ----------
    position, normal, e_u, e_v : (n, 3)
        m; orthonormal frame.
    mean : (n,)
        H, 1/m.
    deviator : (n,) complex
        See `lamella.surface.points.SurfacePoints`.
    to_local : (n, 2, 2)
        d(x, y) of components along e_u, e_v.
    """

    position: Floats
    normal: Floats
    e_u: Floats
    e_v: Floats
    mean: Floats
    deviator: Complexes
    to_local: Floats

    def take(self, some: Booleans | Integers) -> ChartSample:
        """Some of the places."""
        return ChartSample(
            self.position[some],
            self.normal[some],
            self.e_u[some],
            self.e_v[some],
            self.mean[some],
            self.deviator[some],
            self.to_local[some],
        )


class RimPlaces(NamedTuple):
    """Where places on the rim are: the loop, a number that grows along it, the surface to its left, and its direction.

    Attributes
    ----------
    loop : (n,) int
    along : (n,)
    tangent : (n, 3)
    """

    loop: Integers
    along: Floats
    tangent: Floats


class Charts(Protocol):
    """A surface lines are traced on."""

    def evaluate(self, where: Places) -> ChartSample:
        """What is seen at n places; a little outside of their elements too."""

    def measured(self, where: Places) -> tuple[Floats, Complexes]:
        """H and deviator at n places from positions alone, 1/m, each (n,), in the frames of `sample`."""

    def uncertain(self, where: Places) -> Floats:
        """How far normal curvatures at n places may be off those of the surface that is meant, 1/m, (n,)."""

    def settle(self, where: Places) -> Places:
        """The same points of the surface, seen from the elements they are in."""

    def gap(self, where: Places) -> Floats:
        """Below 0 beyond the rim, above 0 inside, (n,)."""

    def reach(self, where: Places) -> Floats:
        """How far a step in local coordinates may go, (n,)."""

    def samples(self) -> tuple[Places, Floats]:
        """Places spread evenly, and the area each stands for, m^2."""

    def rim_places(self, where: Places) -> RimPlaces:
        """Places on the rim."""

    def rim_points(self, count: int) -> Places:
        """Places all around the loops of the rim, some `count` on each."""

    def hole(self, count: int) -> tuple[Places, float] | None:
        """Places at equal arcs around the first hole, and its length, m; None: there is no hole."""
