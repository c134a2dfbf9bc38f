"""From the lattice to centre lines on the surface: exact points, equal arcs, exact arc lengths."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamella.base.blocks import blocks
from lamella.base.errors import InputError
from lamella.network.arcs import ArcLengths, Segments, Stretched
from lamella.network.elements.sharp_turns import more_samples
from lamella.network.faces import trace_faces
from lamella.network.lattice.density import Density
from lamella.network.lattice.domain import A
from lamella.network.lattice.domain_of import domain_of
from lamella.network.lattice.lattice import Lattice, build_lattice, ragged_ranges
from lamella.network.lattice.skew_band import LeaningBand, line_darboux
from lamella.network.network import BOUNDARY, Network
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.darboux import Darboux, lamella_darboux, sideways_slope

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Integers = NDArray[np.int64]

# samples a cell (docs/files.md)
FINE, COARSE, FINE_LIMIT = 16, 8, 20_000
# of a ray's first cell: where a limit at the singular node is taken
BESIDE_ZERO = 1e-6


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


class _Samples(NamedTuple):
    points: Floats
    normals: Floats
    tangents: Floats
    darboux: Floats
    slopes: Floats
    where: Complexes


def _sample(surface: ClosedForm, segments: Segments, arcs: ArcLengths, segment: Integers, fraction: Floats) -> _Samples:
    """Points at fractions of the arc lengths of segments, with all that is told of them."""
    count = len(segment)
    samples = _Samples(
        np.empty((count, 3)),
        np.empty((count, 3)),
        np.empty((count, 3)),
        np.empty((3, count)),
        np.empty(count),
        np.empty(count, np.complex128),
    )
    leaning = isinstance(segments.domain, LeaningBand)
    for block in blocks(count):
        zeta, derivative = segments.where(segment[block], arcs.parameter(segment[block], fraction[block]))
        at = surface.at(zeta)
        heading = derivative / np.abs(derivative)
        samples.points[block], samples.normals[block] = at.position, at.normal
        samples.tangents[block] = at.vector(heading)
        samples.darboux[:, block] = line_darboux(at, heading) if leaning else lamella_darboux(at, heading)
        samples.slopes[block] = sideways_slope(at, heading)
        # at a singular node, where rays begin, the gradient of ln mu has no bound, and its product with mu^2 a limit
        zero = np.flatnonzero(at.deviator == 0)
        if len(zero):
            zeta_beside, derivative = segments.where(segment[block][zero], np.full(len(zero), BESIDE_ZERO))
            beside = surface.at(zeta_beside)
            samples.slopes[block.start + zero] = sideways_slope(beside, derivative / np.abs(derivative))
        samples.where[block] = zeta
    return samples


def trace_closed_form(surface: ClosedForm, density: Density, *, minimum_length: float = 0.5) -> Network:
    """The network of a closed-form surface: lamellas u + v = i l0 and u - v = j l0, or principal lines, exactly on it.

    Parameters
    ----------
    surface : ClosedForm
    density : Density
        See `lamella.network.lattice.density.choose_density`.
    minimum_length : float
        Lamellas shorter than this many median cell edges are left out.

    Returns
    -------
    Network

    Raises
    ------
    InputError
        No lamella crosses another one; or cells that stretch too much, next to where a surface runs to infinity.
    """
    try:
        return _traced(surface, density, minimum_length)
    except Stretched as error:
        from lamella.network.less_stretched import less_stretched

        remedy = less_stretched(surface, density, lambda other, there: _traced(other, there, minimum_length))
        raise InputError(error.message, remedy, error.where) from None


def _traced(surface: ClosedForm, density: Density, minimum_length: float) -> Network:
    domain = domain_of(surface, density.step, density.pattern)
    lines = domain.lines().every(density.pattern)
    lines = lines.take(lines.end > lines.start)
    # cells between the curves that cross those of A, and of B
    wide = np.array(density.pattern.every[::-1])
    left_out = 0
    while True:
        lattice = build_lattice(domain, lines)
        segments = Segments(domain, lattice)
        arcs = ArcLengths(segments)
        length = arcs.length
        if not len(length) or not (lattice.kinds == 0).any():
            if left_out:
                raise InputError(
                    f"no two lamellas cross once the {left_out} shorter than minimum_length = {minimum_length:g} cell "
                    "edges are left out",
                    "write minimum_length = 0, with which none is left out",
                    "network.minimum_length",
                )
            reach = float((lines.end - lines.start).max(initial=0.0))
            raise InputError(
                f"no two lamellas cross: with {density.cells} cells the longest one runs over {reach:.2g} cells",
                f"raise network.cells to about {np.ceil(2 * density.cells / max(reach, 1e-3)):.0f}, or lower "
                "network.spacing",
                "network.cells",
            )
        whole = length[segments.span > wide[lines.family[segments.owner]] - 1e-9]
        total = np.bincount(segments.owner, length, minlength=len(lines.family))
        short = total < minimum_length * np.median(whole if len(whole) else length)
        if not short.any():
            break
        if short.all():
            raise InputError(
                f"all {len(short)} lamellas are shorter than minimum_length = {minimum_length:g} cell edges",
                "write minimum_length = 0, with which none is left out",
                "network.minimum_length",
            )
        left_out += int(short.sum())
        lines = lines.take(~short)

    per_cell = FINE if len(lattice.kinds) <= FINE_LIMIT else COARSE
    # a lamella shorter than a cell is sampled as finely as a whole cell
    cells = np.minimum(np.bincount(segments.owner, segments.span), wide[lines.family])[segments.owner]
    count = np.maximum(np.ceil(segments.span / cells * per_cell - 1e-6), 1).astype(np.int64)
    # every segment gives the samples from its start on; a line's last segment also gives its end
    last = np.r_[segments.owner[1:] != segments.owner[:-1], True]
    first_count = count
    while True:
        given = count + last
        segment = np.repeat(np.arange(len(count)), given)
        fraction = ragged_ranges(given) / count[segment]
        samples = _sample(surface, segments, arcs, segment, fraction)
        before, count = count, more_samples(first_count, count, given, samples.tangents)
        if (count == before).all():
            break

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
    normals, tangents = samples.normals, samples.tangents
    node_where = samples.where[node_sample]
    faces = trace_faces(
        normals[node_sample],
        np.r_[tails, heads],
        np.r_[heads, tails],
        _edge_directions(tangents, starts, ends),
        _loops(lattice),
        surface.at(node_where).vector(domain.rim(node_where).tangent),
    )
    return Network(
        mean_curvature=surface.mean_curvature,
        step=density.step,
        cells=density.cells,
        periods=domain.periods,
        left_out=left_out,
        node_points=samples.points[node_sample],
        node_normals=normals[node_sample],
        node_kinds=lattice.kinds,
        ids=_ids(lines.family),
        families=np.where(lines.family == A, "A", "B"),
        closed=lines.closed,
        sample_offsets=offsets,
        sample_points=samples.points,
        sample_normals=normals,
        sample_tangents=tangents,
        sample_darboux=Darboux(*samples.darboux),
        sample_mean_curvature=np.full(len(samples.points), surface.mean_curvature),
        sample_slopes=samples.slopes,
        sample_where=samples.where,
        sample_arclengths=arclengths,
        stop_offsets=lattice.offsets,
        stop_nodes=lattice.nodes,
        stop_samples=stop_sample - offsets[stop_owner],
        stop_arclengths=arclengths[stop_sample],
        face_offsets=faces.offsets,
        face_nodes=faces.nodes,
        faces_left_out=faces.large,
        pattern=density.pattern,
    )


def _running(values: Floats, owner: Integers) -> Floats:
    """Sum of the values before each one, within its owner (owners in order)."""
    position = np.arange(len(values)) - np.searchsorted(owner, owner)
    wide = np.zeros((owner[-1] + 1, position.max() + 1))
    wide[owner, position] = values
    return np.asarray((np.cumsum(wide, axis=1) - wide)[owner, position])
