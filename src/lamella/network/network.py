"""The network of lamella centre lines: nodes, lamellas and faces as flat arrays."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.message import Message
from lamella.base.onward import onward
from lamella.base.result import Shown
from lamella.base.wording import counted
from lamella.network.pattern import LAMELLAS, Pattern
from lamella.surface.darboux import Darboux

A, B = range(2)
FAMILIES = ("A", "B")
if TYPE_CHECKING:
    from lamella.base.material import Material
    from lamella.strip.lamellas import Lamellas, Section
    from lamella.surface.surface import Surface

NODE_KINDS = ("regular", "boundary", "singular", "seam")
REGULAR, BOUNDARY, SINGULAR, SEAM = range(4)


class Period(NamedTuple):
    """Lamellas crossed on a loop: (a + b) / l0 and (a - b) / l0 for a period (a, b) of (u, v)."""

    around: str
    a_cells: float
    b_cells: float


@dataclass(frozen=True, eq=False, repr=False)
class Network(Shown):
    """A net of lamella centre lines on a surface of mean curvature H.

    Lists of unequal length are stored one after the other: item ``k`` of a list with ``offsets`` is
    ``values[offsets[k]:offsets[k + 1]]``.

    Attributes
    ----------
    mean_curvature : float
        H of the surface, 1/m, for the normals given here; where it varies, the normal curvature that was asked for, in
        a principal net the mean of H.
    step : float
        l0, the distance of neighbouring lamellas in u + v and in u - v, or of principal lines in u and in v, before
        any are left out, sqrt(m); of lines from seeds, the distance of these along their first guide, m.
    cells : int
        Cells around the axis, or along the longest principal line; of lines from seeds, seeds along the first guide.
    periods : tuple of Period
        One for each hole.
    left_out : int
        Lamellas left out for being short.
    node_points, node_normals : (n, 3)
        Positions (m) and unit surface normals.
    node_kinds : (n,) int
        Index into `NODE_KINDS`.
    ids : tuple of str
        "A1", "A2", ..., "B1", ...
    families : (m,) str
        "A" (geodesic torsion > 0) or "B" (< 0) of each lamella; in a principal net "A" along the larger principal
        curvature and "B" along the smaller one.
    closed : (m,) bool
        Whether the lamella returns to its start; its first sample and node are then repeated at the end.
    sample_offsets : (m + 1,) int
        Where each lamella's samples begin.
    sample_points, sample_normals, sample_tangents : (k, 3)
        Centre line samples (m), unit surface normals, unit tangents in the lamella's own direction.
    sample_darboux : Darboux
        kn, kg and tg of the lamellas at their samples, 1/m, each (k,).
    sample_mean_curvature : (k,)
        H of the surface at the samples, 1/m.
    sample_slopes : (k,)
        Change of the normal curvature from a centre line to the curves beside it, d kn / d u towards u = n x t, 1/m^2:
        tg' + 2 kg (kn - H), see `lamella.surface.darboux.sideways_slope`.
    sample_where : (k,) or (k, d)
        The samples' places on the surface, in the surface's own coordinates.
    sample_arclengths : (k,)
        Arc length from the lamella's start, m.
    stop_offsets : (m + 1,) int
        Where each lamella's list of nodes begins.
    stop_nodes : (q,) int
        Node index.
    stop_samples : (q,) int
        Index of the node's sample within its lamella's samples.
    stop_arclengths : (q,)
        Arc length of the node from the lamella's start, m.
    face_offsets : (f + 1,) int
    face_nodes : (e,) int
        Faces, counter-clockwise about the normal.
    faces_left_out : (l,) int
        A node of each face with more corners than are written.
    pattern : Pattern
        Which curves of the isothermic lattice these are.
    surface : Surface, optional
        The surface it lies on, where `lamella.net` made it.
    figures : dict
        What `describe` returns.
    notes : tuple of str
        What `warnings` returns.

    Examples
    --------
    >>> import lamella
    >>> net = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12)
    >>> net.node_points.shape, net.ids[:2]
    ((144, 3), ('A1', 'A2'))
    >>> print(f"{net.lengths.max():.3f} m")
    8.477 m
    >>> first = slice(*net.sample_offsets[:2])
    >>> net.sample_points[first].shape
    (124, 3)
    """

    mean_curvature: float
    step: float
    cells: int
    periods: tuple[Period, ...]
    left_out: int
    node_points: Floats
    node_normals: Floats
    node_kinds: Integers
    ids: tuple[str, ...]
    families: NDArray[np.str_]
    closed: Booleans
    sample_offsets: Integers
    sample_points: Floats
    sample_normals: Floats
    sample_tangents: Floats
    sample_darboux: Darboux
    sample_mean_curvature: Floats
    sample_slopes: Floats
    sample_where: NDArray[np.generic]
    sample_arclengths: Floats
    stop_offsets: Integers
    stop_nodes: Integers
    stop_samples: Integers
    stop_arclengths: Floats
    face_offsets: Integers
    face_nodes: Integers
    faces_left_out: Integers
    pattern: Pattern = LAMELLAS
    surface: Surface[Any] | None = field(default=None, compare=False)
    figures: dict[str, Any] = field(default_factory=dict, compare=False)
    notes: tuple[Message, ...] = field(default=(), compare=False)

    def _line(self) -> str:
        what = "lamella" if self.pattern.kind == "lamellas" else "principal line"
        return (
            f"{self.cells} cells: {counted(len(self.ids), what)}, {counted(len(self.node_points), 'node')}, "
            f"{counted(len(self.face_offsets) - 1, 'face')}"
        )

    def describe(self) -> dict[str, Any]:
        """Further figures: umbilics, what is missing where the net does not close, corners (docs/files.md)."""
        return dict(self.figures)

    def warnings(self) -> tuple[Message, ...]:
        """What a user should know about this net before building it."""
        return self.notes

    def strips(
        self, section: Section | tuple[float, float] = (0.1, 0.0015), material: Material | str = "1.4301"
    ) -> Lamellas:
        """Flat strips that stand normal to the surface along every lamella, with their stresses.

        Parameters
        ----------
        section : Section or (float, float)
            Height and thickness, m, two layers 25 mm apart; or all of it as a `lamella.Section`.
        material : Material or str
            Or its name, one of those of `lamella.find_material`.

        Raises
        ------
        InputError
            The strips are as high as their radius; principal lines have none; an unknown material.

        Examples
        --------
        >>> import lamella
        >>> net = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12)
        >>> net.strips((0.1, 0.0015), "S355")
        Lamellas(24 lamellas of 2 x 100 x 1.5 mm, 203.4 m, utilisation up to 0.27)
        """
        lamellas: Lamellas = onward("lamella.strip.lamellas.strips_of")(self, section, material)
        return lamellas

    @property
    def normal_curvature(self) -> float:
        """kn of the lamellas, 1/m: H where no other was asked for."""
        wanted = self.pattern.normal_curvature
        return self.mean_curvature if wanted is None else wanted

    @property
    def lengths(self) -> Floats:
        """Arc length of each lamella, m, shape (m,)."""
        return self.sample_arclengths[self.sample_offsets[1:] - 1]

    @property
    def stop_owner(self) -> Integers:
        """Lamella of each stop, (q,)."""
        return np.repeat(np.arange(len(self.ids)), np.diff(self.stop_offsets))

    @property
    def cell_edges(self) -> Floats:
        """Arc length between neighbouring nodes of each lamella, m, one after the other."""
        owner = self.stop_owner
        return np.asarray(np.diff(self.stop_arclengths)[owner[1:] == owner[:-1]])

    @property
    def node_angles(self) -> Floats:
        """Angle between the A and the B lamella at every regular node, degrees, from their tangents on the surface."""
        return self.angles_between(self.sample_tangents)

    def angles_between(self, sample_tangents: Floats) -> Floats:
        """The same from other unit tangents at the samples, (k, 3)."""
        owner = self.stop_owner
        tangents = sample_tangents[self.sample_offsets[owner] + self.stop_samples]
        is_a = self.families[owner] == "A"
        pair = np.zeros((2, len(self.node_points), 3))
        pair[0, self.stop_nodes[is_a]] = tangents[is_a]
        pair[1, self.stop_nodes[~is_a]] = tangents[~is_a]
        a, b = pair[:, self.node_kinds == REGULAR]
        across = np.linalg.norm(np.cross(a, b), axis=1)
        # arctan keeps all digits near 90 degrees
        return np.asarray(np.degrees(np.arctan2(across, np.abs(np.einsum("ij,ij->i", a, b)))))

    def node_degrees(self) -> tuple[Integers, Integers]:
        """Number of A and of B lamella stops at each node, two arrays of shape (n,)."""
        is_a = np.repeat(self.families == "A", np.diff(self.stop_offsets))
        count = len(self.node_points)
        return (
            np.bincount(self.stop_nodes[is_a], minlength=count),
            np.bincount(self.stop_nodes[~is_a], minlength=count),
        )
