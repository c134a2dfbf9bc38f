"""A film of another boundary on the elements of a reference, and whether they hold for it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from lamella.surface.boundary.curve import Loop
from lamella.surface.form_finding.adaptivity import Deviation, deviation_of
from lamella.surface.form_finding.carried_rim import NotKeptError, carried_parameters, rim_places
from lamella.surface.form_finding.chord import Settled, settled
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.meshing import SLENDER_CHART, least_angle
from lamella.surface.form_finding.newton import Equilibrium, least_cosine
from lamella.surface.form_finding.redistribution import redistributed
from lamella.surface.form_finding.reference_film import ReferenceFilm
from lamella.surface.form_finding.refinement import WRONG

# parts of the way from the reference in which a film is sought, one after the other
PARTS = (1, 2, 4)
# of the reference's smallest angle: elements are slender below it where they are below `SLENDER_CHART` as well
ANGLE_LEFT = 0.75
# least cosine between the film's normals and the lines its nodes are sought on
ALONG_LINES = 0.5


class Boundary(NamedTuple):
    """What a film is found from: loops, and H (1/m) or a volume (m^3), with which H is where the search starts."""

    loops: tuple[Loop, ...]
    mean_curvature: float
    volume: float | None


@dataclass(frozen=True)
class Kept:
    """A film on the elements of a reference.

    Attributes
    ----------
    equilibrium : Equilibrium
    deviation : Deviation
    factorisations : int
    """

    equilibrium: Equilibrium
    deviation: Deviation
    factorisations: int


def kept(reference: ReferenceFilm, boundary: Boundary, tolerance: float, leeway: float) -> Kept:
    """The film of a boundary on the elements of a reference: it depends on these two alone.

    Parameters
    ----------
    reference : ReferenceFilm
    boundary : Boundary
    tolerance : float
        Largest |H - H0| over the curvature scale; where it is more, the nodes are distributed anew.
    leeway : float
        Times the tolerance, up to which elements hold, as long as there is a film to speak of.

    Raises
    ------
    NotKeptError
        The elements do not hold for this boundary.
    """
    found = _found(reference, boundary)
    deviation = deviation_of(found.film, found.mean_curvature)
    factorisations = found.factorisations
    if deviation.weighted > tolerance:
        found, deviation, more = _redistributed(reference, found, deviation, boundary.volume)
        factorisations += more
    _refuse_worn(reference, found)
    own = max(tolerance, reference.deviation)
    limit = max(own, min(leeway * own, WRONG))
    if deviation.weighted > limit:
        raise NotKeptError(
            f"H is off by up to {deviation.weighted:.2g} of the curvature scale on them (limit {limit:.2g})"
        )
    moves = found.moves
    equilibrium = Equilibrium(found.film, found.mean_curvature, len(moves), found.factored.negative, moves)
    return Kept(equilibrium, deviation, factorisations)


def _found(reference: ReferenceFilm, boundary: Boundary) -> Settled:
    """The film on the lines of the reference, at once or in a few parts of the way."""
    parameter = carried_parameters(reference.film.mesh, reference.loops, boundary.loops)
    rim = rim_places(reference.film, boundary.loops, parameter)
    start = replace(reference.film, mesh=replace(reference.film.mesh, parameter=parameter), loops=boundary.loops)
    begin = reference.film.nodes[reference.film.connectivity.rim_nodes]
    h_begin = reference.mean_curvature
    v_begin = 0.0 if boundary.volume is None else enclosed_volume(reference.film)
    failed = NotKeptError()
    for parts in PARTS:
        shift, factorisations, curvature = np.zeros_like(start.nodes), 0, h_begin
        try:
            for part in range(1, parts + 1):
                share = part / parts
                carried = reference.carried(begin + share * (rim - begin) if part < parts else rim)
                if boundary.volume is None:
                    curvature, volume = h_begin + share * (boundary.mean_curvature - h_begin), None
                else:
                    volume = v_begin + share * (boundary.volume - v_begin)
                found = settled(reference, start.at(carried + shift), curvature, volume)
                curvature, shift = found.mean_curvature, found.film.nodes - carried
                factorisations += found.factorisations
            return replace(found, factorisations=factorisations)
        except NotKeptError as error:
            failed = error
    raise failed


def _redistributed(
    reference: ReferenceFilm, found: Settled, deviation: Deviation, volume: float | None
) -> tuple[Settled, Deviation, int]:
    """A film with its nodes where its mean curvature comes out best, as far as that helps; factorisations it took."""
    try:
        moved = settled(
            reference, redistributed(found.film, found.mean_curvature), found.mean_curvature, volume, found.factored
        )
    except NotKeptError:
        return found, deviation, 0
    after = deviation_of(moved.film, moved.mean_curvature)
    if after.weighted < deviation.weighted:
        return replace(moved, moves=found.moves + moved.moves), after, moved.factorisations
    return found, deviation, moved.factorisations


def _refuse_worn(reference: ReferenceFilm, found: Settled) -> None:
    """Refuse a film that has outgrown its elements, or that is of another kind than the reference.

    Raises
    ------
    NotKeptError
    """
    negative = found.factored.negative
    if negative != reference.negative:
        raise NotKeptError(f"its second variation has {negative} negative eigenvalues, not {reference.negative}")
    angle, least = float(least_angle(found.film).min()), min(SLENDER_CHART, ANGLE_LEFT * reference.least_angle)
    if angle < least:
        raise NotKeptError(f"its elements have angles of {angle:.3g} deg (limit {least:.3g} deg)")
    first = reference.variation.first(found.film.nodes)
    if least_cosine(found.film, reference.directions, first) < ALONG_LINES:
        raise NotKeptError("its normals turn too far from those its nodes are moved along")
