"""From the lattice to centre lines on the surface: exact points, equal arcs, exact arc lengths."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lamella.errors import InputError
from lamella.network.density import Density
from lamella.network.domain import A, Domain, domain_of
from lamella.network.faces import trace_faces
from lamella.network.lattice import Lattice, build_lattice, ragged_ranges
from lamella.network.network import BOUNDARY, Network
from lamella.surface.closed_form import ClosedForm
from lamella.surface.darboux import lamella_darboux
from lamella.surface.points import SurfacePoints

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Integers = NDArray[np.int64]

# samples a cell (docs/files.md)
FINE, COARSE, FINE_LIMIT = 16, 8, 20_000
# Gauss-Legendre points a cell: the speed is analytic well beyond a cell, 12 points leave rounding only
POINTS = 12


class _Segments:
    """The pieces of lamella between neighbouring stops, each with a parameter 0 <= sigma <= 1."""

    def __init__(self, domain: Domain, lattice: Lattice) -> None:
        self.domain, lines = domain, lattice.lines
        owner = lattice.owner
        first = np.flatnonzero(owner[:-1] == owner[1:])
        self.owner = owner[first]
        self.first_stop = first
        self.sheet = lines.sheet[self.owner]
        self.base, self.direction = lines.base[self.owner], lines.direction[self.owner]
        self.t, self.span = lattice.t[first], lattice.t[first + 1] - lattice.t[first]
        # a ray's first cell is straight in zeta, where the surface is smooth, not in the cell plane
        self.radial = lines.singular[self.owner] & (self.t == 0)

    def where(self, segment: Integers, sigma: Floats) -> tuple[Complexes, Complexes]:
        """Places zeta and d zeta / d sigma at parameters of segments, arrays of equal shape (k,)."""
        radial = self.radial[segment]
        t = self.t[segment] + np.where(radial, 1.0, sigma) * self.span[segment]
        point = self.base[segment] + t * self.direction[segment]
        zeta = self.domain.place(self.sheet[segment], point)
        derivative = self.domain.derivative(self.sheet[segment], point) * self.direction[segment] * self.span[segment]
        return np.where(radial, sigma * zeta, zeta), np.where(radial, zeta, derivative)

    def arcs(self) -> tuple[Floats, Floats]:
        """Length of every segment, (s,), and its arc length as a polynomial of 2 sigma - 1 (Legendre, (13, s))."""
        x, weight = np.polynomial.legendre.leggauss(POINTS)
        count = len(self.owner)
        segment = np.repeat(np.arange(count), POINTS)
        zeta, derivative = self.where(segment, np.tile((x + 1) / 2, count))
        speed = (self.domain.surface.metric(zeta) * np.abs(derivative)).reshape(count, POINTS)
        degree = np.arange(POINTS)
        basis = np.polynomial.legendre.legvander(x, POINTS - 1)
        # einsum, not BLAS: starting its threads takes longer than this product
        transform: Floats = (basis * weight[:, None]) * ((2 * degree + 1) / 2)
        coefficients = np.einsum("pd,sp->ds", transform, speed)
        integral: Floats = np.asarray(np.polynomial.legendre.legint(coefficients, lbnd=-1, axis=0) / 2, np.float64)
        return np.einsum("sp,p->s", speed, weight) / 2, integral


def _equal_arcs(integral: Floats, length: Floats, segment: Integers, fraction: Floats) -> Floats:
    """sigma where the given fraction of each segment's arc length is reached (Newton from equal parameters)."""
    slope: Floats = np.asarray(np.polynomial.legendre.legder(integral, axis=0), np.float64)
    x = 2 * fraction - 1
    for _ in range(3):
        miss = _clenshaw(integral, segment, x) - fraction * length[segment]
        x = np.clip(x - miss / _clenshaw(slope, segment, x), -1, 1)
    return (x + 1) / 2


def _clenshaw(coefficients: Floats, segment: Integers, x: Floats) -> Floats:
    """Legendre series, one per segment, each at its own arguments."""
    after, now = np.zeros_like(x), np.zeros_like(x)
    for n in range(len(coefficients) - 1, -1, -1):
        term: Floats = (2 * n + 1) / (n + 1) * x * now - (n + 1) / (n + 2) * after
        after, now = now, coefficients[n, segment] + term
    return now


def _ids(families: Integers) -> tuple[str, ...]:
    rank = np.where(families == A, np.cumsum(families == A), np.cumsum(families != A))
    return tuple(f"{'AB'[f]}{r}" for f, r in zip(families.tolist(), rank.tolist(), strict=True))


def _loops(lattice: Lattice) -> list[Integers]:
    """Boundary nodes of every rim loop in order."""
    boundary = np.flatnonzero(lattice.kinds == BOUNDARY)
    loop = lattice.rim.loop[boundary]
    order = np.lexsort((lattice.rim.place[boundary], loop))
    boundary, loop = boundary[order], loop[order]
    return np.split(boundary, np.flatnonzero(np.diff(loop)) + 1)


def _edge_directions(tangents: Floats, starts: Integers, ends: Integers) -> Floats:
    """Directions in which half edges leave their nodes: forward from the start, backward from the end."""
    return np.vstack([tangents[starts], -tangents[ends]])


def _rim_directions(points: SurfacePoints, sample: Integers, tangent: Complexes) -> Floats:
    return tangent.real[:, None] * points.e_u[sample] + tangent.imag[:, None] * points.e_v[sample]


def trace_closed_form(surface: ClosedForm, density: Density, *, minimum_length: float = 0.5) -> Network:
    """The network of a closed-form surface: lamellas u + v = i l0 and u - v = j l0, exactly on it.

    Parameters
    ----------
    surface : ClosedForm
    density : Density
        See `lamella.network.density.choose_density`.
    minimum_length : float
        Lamellas shorter than this many median cell edges are left out.

    Returns
    -------
    Network

    Raises
    ------
    InputError
        No lamella crosses another one.
    """
    domain = domain_of(surface, density.step)
    lines = domain.lines()
    lines = lines.take(lines.end > lines.start)
    left_out = 0
    while True:
        lattice = build_lattice(domain, lines)
        segments = _Segments(domain, lattice)
        length, integral = segments.arcs()
        if not len(length) or not (lattice.kinds == 0).any():
            reach = float((lines.end - lines.start).max(initial=0.0))
            raise InputError(
                f"no two lamellas cross: with {density.cells} cells the longest one runs over {reach:.2g} cells",
                f"raise network.cells to about {np.ceil(2 * density.cells / max(reach, 1e-3)):.0f}, or lower "
                "network.spacing",
                "network.cells",
            )
        whole = length[segments.span > 1 - 1e-9]
        total = np.bincount(segments.owner, length, minlength=len(lines.family))
        short = total < minimum_length * np.median(whole if len(whole) else length)
        if not short.any():
            break
        if short.all():
            raise InputError(
                f"all {len(short)} lamellas are shorter than minimum_length = {minimum_length:g} cell edges",
                "lower network.minimum_length",
                "network.minimum_length",
            )
        left_out += int(short.sum())
        lines = lines.take(~short)

    per_cell = FINE if len(lattice.kinds) <= FINE_LIMIT else COARSE
    # a lamella shorter than a cell is sampled as finely as a whole cell
    cells = np.minimum(np.bincount(segments.owner, segments.span), 1.0)[segments.owner]
    count = np.maximum(np.ceil(segments.span / cells * per_cell - 1e-6), 1).astype(np.int64)
    # every segment gives the samples from its start on; a line's last segment also gives its end
    last = np.r_[segments.owner[1:] != segments.owner[:-1], True]
    given = count + last
    segment = np.repeat(np.arange(len(count)), given)
    fraction = ragged_ranges(given) / count[segment]
    sigma = _equal_arcs(integral, length, segment, fraction)
    sigma = np.where(fraction == 1, 1.0, np.where(fraction == 0, 0.0, sigma))
    where, derivative = segments.where(segment, sigma)
    points = surface.at(where)
    heading = derivative / np.abs(derivative)
    tangents = points.vector(heading)

    lines_count = len(lines.family)
    offsets = np.r_[0, np.cumsum(np.bincount(segments.owner, given, minlength=lines_count).astype(np.int64))]
    arclengths = _running(length, segments.owner)[segment] + fraction * length[segment]
    segment_start = np.cumsum(given) - given
    stop_sample = np.empty(len(lattice.t), np.int64)
    stop_sample[segments.first_stop] = segment_start
    stop_sample[segments.first_stop[last] + 1] = (segment_start + count)[last]
    stop_owner = lattice.owner

    node_sample = np.empty(len(lattice.kinds), np.int64)
    node_sample[lattice.nodes[::-1]] = stop_sample[::-1]
    starts, ends = stop_sample[segments.first_stop], stop_sample[segments.first_stop + 1]
    tails, heads = lattice.nodes[segments.first_stop], lattice.nodes[segments.first_stop + 1]
    node_where = where[node_sample]
    face_offsets, face_nodes = trace_faces(
        points.normal[node_sample],
        np.r_[tails, heads],
        np.r_[heads, tails],
        _edge_directions(tangents, starts, ends),
        _loops(lattice),
        _rim_directions(points, node_sample, domain.rim(node_where).tangent),
    )
    return Network(
        mean_curvature=surface.mean_curvature,
        step=density.step,
        cells=density.cells,
        periods=domain.periods,
        left_out=left_out,
        node_points=points.position[node_sample],
        node_normals=points.normal[node_sample],
        node_kinds=lattice.kinds,
        ids=_ids(lines.family),
        families=np.where(lines.family == A, "A", "B"),
        closed=np.zeros(lines_count, bool),
        sample_offsets=offsets,
        sample_points=points.position,
        sample_normals=points.normal,
        sample_tangents=tangents,
        sample_darboux=lamella_darboux(points, heading),
        sample_where=where,
        sample_arclengths=arclengths,
        stop_offsets=lattice.offsets,
        stop_nodes=lattice.nodes,
        stop_samples=stop_sample - offsets[stop_owner],
        stop_arclengths=arclengths[stop_sample],
        face_offsets=face_offsets,
        face_nodes=face_nodes,
    )


def _running(values: Floats, owner: Integers) -> Floats:
    """Sum of the values before each one, within its owner (owners in order)."""
    position = np.arange(len(values)) - np.searchsorted(owner, owner)
    wide = np.zeros((owner[-1] + 1, position.max() + 1))
    wide[owner, position] = values
    return np.asarray((np.cumsum(wide, axis=1) - wide)[owner, position])
