"""New elements on a film: of other sizes, or the same with a smoother parametrisation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.surface.element.closest import ClosestPoint
from lamella.surface.element.connectivity import connect
from lamella.surface.element.geometry import smooth_normals
from lamella.surface.element.lagrange import local_faces
from lamella.surface.element.placing import rim_parameters
from lamella.surface.form_finding.chart import Chart
from lamella.surface.form_finding.film import Film, Loop
from lamella.surface.form_finding.free_boundary import settled_rims
from lamella.surface.form_finding.harmonic import harmonic_surface
from lamella.surface.form_finding.newton import NoFilmError
from lamella.surface.remesh.remesh import Rim, TriangleMesh, remesh
from lamella.surface.remesh.size_field import SizeField
from lamella.surface.remesh.tangent_planes import TangentPlanes

# coarsest elements, as parts of a loop, as turns of its tangent or of the normal, and as parts of a narrow place
EDGES_OF_A_LOOP, TURN_OF_AN_EDGE, EDGES_ACROSS = 12, 0.7, 2
MOST_EDGES_OF_A_LOOP, SAMPLES_OF_A_LOOP = 100, 240
# a strip between parallel edges has chords of which just a third of the arc is left at its ends: off any such tie
ARC_OVER_CHORD = 3.01
# elements of a first film at most
MOST_COARSE = 1500


# elements are made anew below this angle, deg, or where their normals turn by this many times what they should
SLENDER_CHART, BENT = 18.0, 1.7
# flat triangles along the edge of a curved one that new elements start from
FACETS = 2


def coarse_sizes(loops: tuple[Loop, ...], extent: float) -> SizeField:
    """Sizes to begin with: finer where a loop bends and where the surface between loops is narrow, growing inwards.

    Parameters
    ----------
    loops : tuple of Loop
    extent : float
        Diagonal of the surface's bounding box, m.
    """
    places, sizes, along = [], [], []
    t = np.arange(SAMPLES_OF_A_LOOP) / SAMPLES_OF_A_LOOP
    for loop in loops:
        curve = loop.at(t)
        step = np.roll(curve, -1, 0) - curve
        tangent = step / np.maximum(np.linalg.norm(step, axis=1), 1e-300)[:, None]
        turn = np.arccos(np.clip((tangent * np.roll(tangent, 1, 0)).sum(1), -1, 1))
        # the turn over a few samples, so that a corner counts as one
        bend = np.convolve(np.r_[turn[-2:], turn, turn[:2]], np.ones(5), "valid") / (5 * loop.length / len(t))
        places.append(curve)
        sizes.append(np.minimum(loop.length / EDGES_OF_A_LOOP, TURN_OF_AN_EDGE / np.maximum(bend, 1e-12)))
        along.append(t * loop.length)
    points = np.concatenate(places)
    of_loop = np.repeat(np.arange(len(loops)), len(t))
    place = np.concatenate(along)
    length = np.array([loop.length for loop in loops])[of_loop]
    width = np.empty(len(points))
    for first in range(0, len(points), len(t)):
        rows = slice(first, first + len(t))
        apart = np.linalg.norm(points[rows, None] - points, axis=2)
        arc = np.abs(place[rows, None] - place)
        arc = np.where(of_loop[rows, None] == of_loop, np.minimum(arc, length - arc), np.inf)
        # a chord much shorter than the arc it cuts off crosses the surface
        width[rows] = np.where(arc > ARC_OVER_CHORD * apart, apart, np.inf).min(1)
    wanted = np.minimum(np.concatenate(sizes), width / EDGES_ACROSS)
    return SizeField(points, np.maximum(wanted, length / MOST_EDGES_OF_A_LOOP), extent / 6)


def bend_sizes(film: Film) -> tuple[Floats, Floats]:
    """Middles of the elements (m, 3) and sizes over which the film's normals turn by a fixed angle, m, (m,)."""
    normals = smooth_normals(film.connectivity, film.nodes)[: len(film.mesh.points)]
    faces = film.connectivity.faces
    corners, turned = film.nodes[faces], normals[faces]
    edge = np.linalg.norm(corners - np.roll(corners, 1, 1), axis=2)
    turn = np.arccos(np.clip((turned * np.roll(turned, 1, 1)).sum(2), -1, 1))
    return corners.mean(1), TURN_OF_AN_EDGE / np.maximum((turn / edge).max(1), 1e-12)


def start_sizes(film: Film, loops: tuple[Loop, ...], share: float = 1.0) -> SizeField:
    """Sizes that the loops and the bend of a film ask for, times a share."""
    middle, bend = bend_sizes(film)
    least = film.size / 150
    by_loops = coarse_sizes(loops, film.size)
    sizes = np.minimum(np.maximum(bend, least), by_loops(middle))
    rim = np.concatenate([loop.at(np.arange(SAMPLES_OF_A_LOOP) / SAMPLES_OF_A_LOOP) for loop in loops])
    corners = film.nodes[film.connectivity.faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    field = SizeField(np.concatenate([middle, rim]), share * np.concatenate([sizes, by_loops(rim)]), film.size / 6)
    # a film about to break bends without bound: its elements do not follow it there
    count = float((area / (np.sqrt(3) / 4 * field(middle) ** 2)).sum())
    return field if count <= MOST_COARSE else field.scaled(float(np.sqrt(count / MOST_COARSE)))


def start_film(chart: Chart, loops: tuple[Loop, ...], order: int, rounds: int = 0, share: float = 1.0) -> Film:
    """Elements on the harmonic surface over a chart.

    Parameters
    ----------
    chart : Chart
    loops : tuple of Loop
    order : int
    rounds : int
        See `harmonic_surface`.
    share : float
        Of the sizes that the loops and the surface's bend ask for.
    """
    points = harmonic_surface(chart, loops, rounds)
    return on_surface(
        Film.on_mesh(TriangleMesh(points, chart.faces, chart.loop, chart.parameter), loops, 1), order, share
    )


def on_surface(flat: Film, order: int, share: float = 1.0) -> Film:
    """Coarse elements of an order on a surface of flat ones, as small as its loops and its bend ask for."""
    return Film.on_mesh(_remeshed(flat, start_sizes(flat, flat.loops, share), flat.loops), flat.loops, order)


def facets(film: Film, parts: int) -> TriangleMesh:
    """A film's elements cut into flat triangles, each edge into `parts`."""
    grid = connect(film.connectivity.faces, len(film.mesh.points), parts)
    points = np.empty((grid.node_count, 3))
    points[grid.elements] = np.matmul(
        film.connectivity.basis.basis(grid.basis.nodes), film.nodes[film.connectivity.elements]
    )
    loop = np.full(grid.node_count, -1)
    parameter = np.full(grid.node_count, np.nan)
    rim_nodes = grid.rim_nodes
    loop[rim_nodes] = film.mesh.loop[rim_nodes[:, :1]]
    parameter[rim_nodes] = rim_parameters(grid, film.mesh.parameter)
    return TriangleMesh(points, grid.elements[:, local_faces(parts)].reshape(-1, 3), loop, parameter)


def _remeshed(film: Film, size: Callable[[Floats], Floats], loops: Sequence[Rim]) -> TriangleMesh:
    # the curved elements' own shape, which their corners alone do not tell
    parts = 1 if film.connectivity.basis.order == 1 else FACETS
    try:
        return remesh(facets(film, parts), size=size, project=TangentPlanes(film.connectivity, film.nodes), rims=loops)
    except ValueError as error:
        raise NoFilmError(f"its elements cannot be made anew: {error}", film) from None


def with_sizes(film: Film, size: Callable[[Floats], Floats], order: int | None = None) -> Film:
    """The same surface with elements of wanted sizes."""
    film = settled_rims(film)
    mesh = _remeshed(film, size, film.loops)
    new = Film.on_mesh(mesh, film.loops, order or film.connectivity.basis.order)
    inside = np.setdiff1d(np.arange(new.connectivity.node_count), new.connectivity.rim_nodes)
    places, position = ClosestPoint(film.connectivity, film.nodes)(new.nodes[inside])
    normals = smooth_normals(film.connectivity, film.nodes)
    basis = film.connectivity.basis.basis(places.local)
    along = np.einsum("nk,nkc->nc", basis, normals[film.connectivity.elements[places.element]])
    along /= np.linalg.norm(along, axis=1)[:, None]
    nodes = new.nodes.copy()
    nodes[inside] += ((position - nodes[inside]) * along).sum(1)[:, None] * along
    return new.at(nodes)


def straightened(film: Film) -> Film:
    """The same surface and elements, with nodes along smooth normals over the flat triangles of its vertices.

    Newton's shifts leave the parametrisation as rough as the directions they were taken along; on the found surface
    those are smooth.
    """
    film = settled_rims(film)
    mesh = replace(film.mesh, points=film.nodes[: len(film.mesh.points)])
    flat = Film.on_mesh(mesh, film.loops, film.connectivity.basis.order)
    normals = smooth_normals(film.connectivity, film.nodes)
    shift = ((film.nodes - flat.nodes) * normals).sum(1)
    shift[flat.connectivity.rim_nodes] = 0
    return flat.at(flat.nodes + shift[:, None] * normals)


def least_angle(film: Film) -> Floats:
    """Smallest angle of the triangles of each element's corners, deg, (m,)."""
    corners = film.nodes[film.connectivity.faces]
    sides = np.roll(corners, -1, 1) - corners
    sides /= np.linalg.norm(sides, axis=2)[..., None]
    cosines = -(sides * np.roll(sides, 1, 1)).sum(2)
    return np.asarray(np.degrees(np.arccos(np.clip(cosines.max(1), -1, 1))))


def is_worn(film: Film) -> bool:
    """Whether a film has outgrown its elements: slender ones, or such that its normal turns too much in them."""
    if least_angle(film).min() < SLENDER_CHART:
        return True
    corners = film.nodes[film.connectivity.faces]
    edges = np.linalg.norm(corners - np.roll(corners, 1, 1), axis=2).max(1)
    return bool((edges > BENT * np.maximum(bend_sizes(film)[1], film.size / 150)).any())


def renewed(film: Film, share: float = 1.0) -> Film:
    """The film with elements made anew, as small as its loops and its bend ask for."""
    film = settled_rims(film)
    return straightened(with_sizes(film, start_sizes(film, film.loops, share)))
