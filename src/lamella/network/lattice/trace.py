"""From the lattice to centre lines on the surface: exact points, equal arcs, exact arc lengths."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Complexes, Floats, Integers
from lamella.base.blocks import blocks
from lamella.base.errors import InputError
from lamella.network.arc_length import ArcLengths, Stretched
from lamella.network.assemble import Curves, CurveSamples, RimNodes, SampledCurves, assemble
from lamella.network.lattice.density import Density
from lamella.network.lattice.domain import Domain, Lines
from lamella.network.lattice.domain_of import domain_of
from lamella.network.lattice.lattice import Lattice, build_lattice
from lamella.network.lattice.less_stretched import less_stretched
from lamella.network.lattice.segments import Segments
from lamella.network.lattice.skew_band import SkewBand, line_darboux
from lamella.network.network import BOUNDARY, REGULAR, Network
from lamella.network.pattern import Pattern
from lamella.network.sampling import Division, divide, parts_of
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.darboux import Darboux, lamella_darboux, sideways_slope

# of a ray's first cell: where a limit at the singular node is taken
BESIDE_ZERO = 1e-6


def _loops(lattice: Lattice) -> list[Integers]:
    """Boundary nodes of every rim loop in order."""
    boundary = np.flatnonzero(lattice.kinds == BOUNDARY)
    loop = lattice.rim.loop[boundary]
    order = np.lexsort((lattice.rim.place[boundary], loop))
    boundary, loop = boundary[order], loop[order]
    return np.split(boundary, np.flatnonzero(np.diff(loop)) + 1)


class _Samples(NamedTuple):
    points: Floats
    normals: Floats
    tangents: Floats
    darboux: Floats
    slopes: Floats
    where: Complexes


def _sample(surface: ClosedForm, segments: Segments, arcs: ArcLengths, division: Division) -> _Samples:
    """Points that divide the arc lengths of segments evenly, with what the net says of its samples."""
    segment, fraction = division.piece, division.fraction
    count = len(segment)
    samples = _Samples(
        np.empty((count, 3)),
        np.empty((count, 3)),
        np.empty((count, 3)),
        np.empty((3, count)),
        np.empty(count),
        np.empty(count, np.complex128),
    )
    skew = isinstance(segments.domain, SkewBand)
    for block in blocks(count):
        zeta, derivative = segments.where(segment[block], arcs.parameter(segment[block], fraction[block]))
        at = surface.at(zeta)
        heading = derivative / np.abs(derivative)
        samples.points[block], samples.normals[block] = at.position, at.normal
        samples.tangents[block] = at.vector(heading)
        samples.darboux[:, block] = line_darboux(at, heading) if skew else lamella_darboux(at, heading)
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
        remedy = less_stretched(surface, density, lambda other, there: _traced(other, there, minimum_length))
        raise InputError(error.message, remedy, error.where) from None


def _traced(surface: ClosedForm, density: Density, minimum_length: float) -> Network:
    domain = domain_of(surface, density.step, density.pattern)
    lattice, segments, arcs, left_out = _long_enough(domain, density, minimum_length)
    lines = lattice.lines
    # a lamella shorter than a cell is sampled as finely as a whole cell
    cells = np.minimum(np.bincount(segments.owner, segments.span), _cell_spans(density.pattern)[lines.family])
    first = parts_of(segments.span / cells[segments.owner], len(lattice.kinds), least=1)
    division, samples = divide(first, arcs.length, segments.owner, partial(_sample, surface, segments, arcs))
    sampled = SampledCurves(Curves(lines.family, lines.closed, lattice.owner, lattice.nodes, lattice.kinds), division)
    where = samples.where[sampled.node_samples]
    return assemble(
        sampled,
        CurveSamples(
            samples.points,
            samples.normals,
            samples.tangents,
            Darboux(*samples.darboux),
            np.full(len(samples.points), surface.mean_curvature),
            samples.slopes,
            samples.where,
            _running(arcs.length, segments.owner)[division.piece] + division.fraction * arcs.length[division.piece],
        ),
        RimNodes(_loops(lattice), surface.at(where).vector(domain.rim(where).tangent)),
        pattern=density.pattern,
        mean_curvature=surface.mean_curvature,
        step=density.step,
        cells=density.cells,
        periods=domain.periods,
        left_out=left_out,
    )


def _cell_spans(pattern: Pattern) -> Integers:
    """Cells of the whole lattice between the kept curves that cross those of A, and of B."""
    return np.array(pattern.every[::-1])


def _long_enough(domain: Domain, density: Density, minimum_length: float) -> tuple[Lattice, Segments, ArcLengths, int]:
    """The lattice of the lamellas that are not too short, and how many were left out for it."""
    lines = domain.lines().every(density.pattern)
    lines = lines.take(lines.end > lines.start)
    spans = _cell_spans(density.pattern)
    left_out = 0
    while True:
        lattice = build_lattice(domain, lines)
        segments = Segments(domain, lattice)
        arcs = ArcLengths(segments)
        length = arcs.length
        if not len(length) or not (lattice.kinds == REGULAR).any():
            raise _none_cross(lines, density, minimum_length, left_out)
        whole = length[segments.span > spans[lines.family[segments.owner]] - 1e-9]
        total = np.bincount(segments.owner, length, minlength=len(lines.family))
        short = total < minimum_length * np.median(whole if len(whole) else length)
        if not short.any():
            return lattice, segments, arcs, left_out
        if short.all():
            raise InputError(
                f"all {len(short)} lamellas are shorter than minimum_length = {minimum_length:g} cell edges",
                "write minimum_length = 0, with which none is left out",
                "minimum_length",
            )
        left_out += int(short.sum())
        lines = lines.take(~short)


def _none_cross(lines: Lines, density: Density, minimum_length: float, left_out: int) -> InputError:
    """Why no two lamellas cross, and with what they do."""
    if left_out:
        return InputError(
            f"no two lamellas cross once the {left_out} shorter than minimum_length = {minimum_length:g} cell "
            "edges are left out",
            "write minimum_length = 0, with which none is left out",
            "minimum_length",
        )
    reach = float((lines.end - lines.start).max(initial=0.0))
    return InputError(
        f"no two lamellas cross: with {density.cells} cells the longest one runs over {reach:.2g} cells",
        f"raise cells to about {np.ceil(2 * density.cells / max(reach, 1e-3)):.0f}, or lower spacing",
        "cells",
    )


def _running(values: Floats, owner: Integers) -> Floats:
    """Sum of the values before each one, within its owner (owners in order)."""
    position = np.arange(len(values)) - np.searchsorted(owner, owner)
    wide = np.zeros((owner[-1] + 1, position.max() + 1))
    wide[owner, position] = values
    return np.asarray((np.cumsum(wide, axis=1) - wide)[owner, position])
