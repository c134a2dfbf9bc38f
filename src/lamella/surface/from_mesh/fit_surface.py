"""The surface of a mesh as it is: smooth elements nearest to its vertices.

Elements are laid on the mesh, their nodes then move by shifts s along smooth normals to the least

    sum_v A_v r_v^2  +  a sum_e h_e^3 int_e [dX/dnu . n]^2 dl  +  b sum_e h_e^5 int_e [II(nu, nu)]^2 dl,

r_v being the signed distance of the vertex v, A_v the area around it, and [.] the jumps across the edges e between
elements, of length h_e and conormal nu. A smooth surface has no such jumps, and elements of order p on it have jumps of
the orders h^p and h^(p - 1): neither term costs order of convergence, and both settle what vertices leave open. (Jumps
of normal derivatives as a stabilisation: Burman and Hansbo, Comput. Methods Appl. Mech. Engrg. 193 (2004), 1437-1453,
doi:10.1016/j.cma.2003.12.032.)
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.linalg import splu

from lamella.base.arrays import Floats, Integers
from lamella.base.drawing_origin import origin_figure
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.progress import Progress, Report, silent
from lamella.base.triangle import CORNERS
from lamella.surface.boundary import Loop
from lamella.surface.element.closest import ClosestPoint
from lamella.surface.element.curvature import element_points, frames
from lamella.surface.element.edge_basis import edge_rule
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.element.varying import VaryingSurface
from lamella.surface.form_finding.film import Film, NoFilmError
from lamella.surface.form_finding.meshing import start_sizes, with_sizes
from lamella.surface.from_mesh.clean import CleanMesh, clean
from lamella.surface.from_mesh.edges import vertex_areas
from lamella.surface.from_mesh.fit_options import FitOptions
from lamella.surface.from_mesh.raw_mesh import RawMesh, mesh_of_arrays
from lamella.surface.from_mesh.scatter_limits import FIT_OPEN, moved_by_scatter, too_scattered
from lamella.surface.from_mesh.to_elements import as_film, checked_loops
from lamella.surface.from_mesh.vertex_fits import VertexFits, disagreement, fit_vertices, through_vertices
from lamella.surface.from_mesh.vertex_noise import READING, Smoothed, without_scatter
from lamella.surface.remesh.size_field import SizeField

# weights of the jumps of slope and of curvature
SLOPE, CURVATURE = 1e-3, 1e-5
# vertices an unknown: with fewer the fit follows every one of them
VERTICES_PER_NODE = 1.2
# of the tolerance that the jump of the curvature aims at: its root mean square is well below the largest error
FIT_AIM = 0.2
# Gauss-Newton's steps, and the shift over the size after which it ends
FIT_STEPS_MAX, LAST_MOVE = 12, 1e-7
# elements at least, and of the sizes that loops and bend ask for, the share of each round
LEAST_ELEMENTS, SHARES = 8, (1.0, 0.6, 0.36, 0.22)
# of the curvature scale: elements through the vertices whose curvature jumps by more are smoothed, or given up; a
# disagreement of the fits around vertices by more is scatter where they scatter
SMOOTH, ROUGH = 0.1, 0.05
# most of elements whose nodes are moved to the least jumps: of order 4 these leave too much open
RELAXED_ORDER = 3
# Newton's steps to the least jumps: nearly linear, for nodes are moved little
RELAXING = 3
# of the curvature scale: a mesh whose curvature jumps by more is refused
ROUGHEST = 0.5


class Kept(NamedTuple):
    """Elements on a mesh.

    Attributes
    ----------
    film : Film
    jump : float
        Root mean square of the jump of the curvature between elements, over the curvature scale.
    """

    film: Film
    jump: float


def fitted_film(film: Film, points: Floats, areas: Floats, progress: Progress) -> tuple[Film, Floats]:
    """The film nearest to points, its rim held, and their distances, m, (n,)."""
    connectivity, basis = film.connectivity, film.connectivity.basis
    free = connectivity.inner_unknowns >= 0
    distance = np.zeros(len(points))
    for step in range(FIT_STEPS_MAX):
        directions = film.directions()
        places, position = ClosestPoint(connectivity, film.nodes)(points)
        nodes = connectivity.elements[places.element]
        value, x, y = (basis.basis(places.local, *d) for d in ((0, 0), (1, 0), (0, 1)))
        first, second = (np.einsum("nk,nkc->nc", f, film.nodes[nodes]) for f in (x, y))
        normal = np.cross(first, second)
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        off = points - position
        distance = np.linalg.norm(off, axis=1)
        off = (off * normal).sum(1)
        answer = value * np.einsum("nkc,nc->nk", directions[nodes], normal)
        rows = np.repeat(np.arange(len(points)), nodes.shape[1])
        data = csr_array((answer.ravel(), (rows, nodes.ravel())), (len(points), connectivity.node_count))
        jumps, weights, now = _jumps(film, directions)
        matrix = data.T @ diags_array(areas) @ data + jumps.T @ diags_array(weights) @ jumps
        right = data.T @ (areas * off) - jumps.T @ (weights * now)
        inner = csr_array(matrix)[free][:, free].tocsc()
        # what neither vertices nor jumps tell stays as it is
        inner = (inner + diags_array(np.full(inner.shape[0], 1e-12 * inner.diagonal().max()))).tocsc()
        shift = np.zeros(connectivity.node_count)
        shift[free] = splu(inner).solve(right[free])
        film = film.at(film.nodes + shift[:, None] * directions)
        move = float(np.abs(shift).max())
        progress(Report.detail(f"fit, step {step + 1}: largest shift {move:.2e} m"))
        if move <= LAST_MOVE * film.size:
            break
    return film, distance


def _jumps(film: Film, directions: Floats) -> tuple[csr_array, Floats, Floats]:
    """Jumps of slope and curvature across inner edges by the nodes' shifts, their weights, and their present values."""
    connectivity, basis = film.connectivity, film.connectivity.basis
    element, edge = np.nonzero(connectivity.neighbours >= 0)
    other, other_edge = connectivity.neighbours[element, edge], connectivity.neighbour_edges[element, edge]
    once = element < other
    sides = ((element[once], edge[once]), (other[once], other_edge[once]))
    points, weight = edge_rule(basis.order)
    count, q, k = int(once.sum()), len(points), len(basis.nodes)
    corners = CORNERS
    slope, bend, columns = [], [], []
    normals, speeds = [], []
    for side, (own, at) in enumerate(sides):
        # edges of two elements run in opposite directions
        t = points if side == 0 else 1 - points
        begin = corners[at]
        along = corners[(at + 1) % 3] - begin
        local = (begin[:, None] + t[None, :, None] * along[:, None]).reshape(-1, 2)
        nodes = connectivity.elements[np.repeat(own, q)]
        _, x, y, xx, xy, yy = basis.second_jet(local)
        first, second = (np.einsum("nk,nkc->nc", f, film.nodes[nodes]) for f in (x, y))
        there = frames(np.empty((len(first), 0)), first, second)
        edge_along = np.repeat(along, q, 0)
        tangent = edge_along[:, :1] * first + edge_along[:, 1:] * second
        speed = np.linalg.norm(tangent, axis=1)
        conormal = np.cross(tangent / speed[:, None], there.normal)
        normals.append(there.normal)
        speeds.append(speed.reshape(count, q))
        components = np.stack([(conormal * there.e_u).sum(1), (conormal * there.e_v).sum(1)], 1)[:, :, None]
        c = np.matmul(there.to_local, components)[:, :, 0]
        slope.append(c[:, :1] * x + c[:, 1:] * y)
        sign = 1 - 2 * side
        bend.append(sign * (c[:, :1] ** 2 * xx + 2 * c[:, :1] * c[:, 1:] * xy + c[:, 1:] ** 2 * yy))
        columns.append(nodes)
    # both sides share the edge
    length, dl = (speeds[0] * weight).sum(1), (speeds[0] * weight).ravel()
    nodes = np.hstack(columns)
    rows = np.repeat(np.arange(2 * count * q), 2 * k)
    tables = np.vstack([np.hstack(slope), np.hstack(bend)])
    both = np.vstack([nodes, nodes])
    normal = np.vstack([normals[0], normals[0]])
    along_normal = np.einsum("nkc,nc->nk", directions[both], normal)
    now = np.einsum("nk,nkc,nc->n", tables, film.nodes[both], normal)
    matrix = coo_array(
        ((tables * along_normal).ravel(), (rows, both.ravel())), (2 * count * q, connectivity.node_count)
    ).tocsr()
    h = np.repeat(length, q)
    return matrix, np.concatenate([SLOPE * h**3 * dl, CURVATURE * h**5 * dl]), now


def kept_film(
    mesh: CleanMesh, loops: tuple[Loop, ...], order: int, tolerance: float, most_nodes: int, progress: Progress
) -> Kept:
    """Elements on a mesh, finer until the curvature jumps by less than the tolerance or the vertices tell no more.

    Parameters
    ----------
    mesh : CleanMesh
    loops : tuple of Loop
        Smooth curves through its borders.
    order : int
        Of the elements.
    tolerance : float
        Wanted jump of the curvature between elements, over the curvature scale.
    most_nodes : int
    progress : callable
    """
    flat = as_film(mesh, loops)
    areas = vertex_areas(mesh.points, mesh.faces)
    # area of an element with enough vertices for its nodes, of which there are order^2 / 2 an element
    element_area = VERTICES_PER_NODE * order**2 / 2 * areas
    element_area = np.minimum(element_area, areas.sum() / LEAST_ELEMENTS)
    least = SizeField(mesh.points, np.sqrt(4 / np.sqrt(3) * element_area), flat.size / 3)
    best: Kept | None = None
    for share in SHARES:
        wanted = start_sizes(flat, loops, share)

        def size(points: Floats, wanted: SizeField = wanted) -> Floats:
            return np.maximum(wanted(points), least(points))

        try:
            film = with_sizes(flat, size, order)
        except NoFilmError as error:
            if best is not None:
                break
            raise InputError(
                f"no elements could be laid on the mesh: {error}",
                "mend the mesh where it overlaps, folds or is very thin",
                "faces",
            ) from None
        if film.connectivity.node_count > most_nodes and best is not None:
            break
        film, distance = fitted_film(film, mesh.points, areas, progress)
        jump = curvature_jump(film)
        progress(
            Report.step(
                f"{len(film.connectivity.faces):,} elements: vertices off by up to {distance.max():.2g} m, curvature "
                f"jumps by {jump:.2g} of its scale"
            )
        )
        if best is not None and jump >= best.jump:
            break
        best = Kept(film, jump)
        if jump <= FIT_AIM * tolerance or bool((least(mesh.points) >= wanted(mesh.points)).all()):
            break
    assert best is not None
    return best


def curvature_jump(film: Film) -> float:
    """Root mean square of the jump of II(nu, nu) between elements, over the curvature scale."""
    _, weights, now = _jumps(film, np.zeros_like(film.nodes))
    half = len(now) // 2
    # the weights of slope are SLOPE h^3 dl, those of curvature CURVATURE h^5 dl
    h = np.sqrt(weights[half:] / weights[:half] * SLOPE / CURVATURE)
    dl = weights[:half] / (SLOPE * h**3)
    return float(np.sqrt((dl * now[half:] ** 2).sum() / max(dl.sum(), 1e-300))) / _scale(film)


def _scale(film: Film) -> float:
    """Curvature scale: root mean square of sqrt((k1^2 + k2^2) / 2), at least 0.01 / size, 1/m."""
    points, weights = triangle_rule(6)
    there = element_points(film.connectivity, film.nodes[film.connectivity.elements], points, False)
    area = np.tile(weights, len(film.connectivity.elements)) / np.linalg.det(there.to_local)
    square = np.average(there.mean_curvature**2 + np.abs(there.deviator) ** 2, weights=area)
    return max(float(np.sqrt(square)), 0.01 / film.size)


def through_film(
    mesh: CleanMesh, flat: Film, loops: tuple[Loop, ...], fits: VertexFits, options: FitOptions, progress: Progress
) -> Kept | None:
    """Elements on the mesh's own triangles, through its vertices; None: these scatter, or are too many.

    They are blended from the fits around the vertices. Where the mesh is so coarse that these disagree, the nodes
    between the vertices move to the least jumps of slope and curvature.
    """
    if len(mesh.faces) * options.order**2 / 2 > options.most_nodes:
        return None
    film = through_vertices(flat, loops, fits, options.order)
    jump = curvature_jump(film)
    if jump > SMOOTH:
        film = through_vertices(flat, loops, fits, min(options.order, RELAXED_ORDER))
        film = _relaxed(film, len(mesh.points), progress)
        jump = curvature_jump(film)
    progress(
        Report.step(
            f"{len(film.connectivity.faces):,} elements through the vertices: curvature jumps by {jump:.2g} of its "
            "scale"
        )
    )
    if jump > SMOOTH:
        return None
    return Kept(film, jump)


def _relaxed(film: Film, vertices: int, progress: Progress) -> Film:
    """The film of the least jumps whose first nodes, the vertices, and whose rim are held."""
    free = film.connectivity.inner_unknowns >= 0
    free[:vertices] = False
    for step in range(RELAXING):
        directions = film.directions()
        jumps, weights, now = _jumps(film, directions)
        matrix = csr_array(jumps.T @ diags_array(weights) @ jumps)[free][:, free].tocsc()
        matrix = (matrix + diags_array(np.full(matrix.shape[0], 1e-12 * matrix.diagonal().max()))).tocsc()
        shift = np.zeros(len(free))
        shift[free] = -splu(matrix).solve((jumps.T @ (weights * now))[free])
        film = film.at(film.nodes + shift[:, None] * directions)
        progress(Report.detail(f"least jumps, step {step + 1}: largest shift {np.abs(shift).max():.2e} m"))
    return film


def vertex_errors(film: Film, fits: VertexFits, faces: Integers, smoothed: Smoothed | None) -> Floats:
    """How far normal curvatures of a film may be off at each vertex of its mesh, 1/m, (v,).

    What the fits around neighbouring vertices disagree by is what they are off themselves, and the film may depart
    from them. Of vertices that scattered, what the scatter leaves unknown comes in addition, at the border as well.
    """
    connectivity = film.connectivity
    vertex, element, local = _seen_at_vertices(film, fits.points, faces)
    there = element_points(connectivity, film.nodes[connectivity.elements[element]], local, True)
    mean, re, im = there.mean_curvature, there.deviator.real, there.deviator.imag
    own = np.array([[mean + re, -im], [-im, mean - re]])
    axes = np.array([there.e_u, there.e_v])
    off = np.einsum("abn,anc,bnd->ncd", own, axes, axes) - fits.second_forms(vertex, fits.points[vertex])
    result = np.zeros(len(fits.points))
    np.maximum.at(result, vertex, np.linalg.norm(off, axis=(1, 2)))
    if smoothed is None:
        return np.asarray(disagreement(fits, faces) + result)
    return np.asarray(disagreement(fits, faces, 1.0) + smoothed.curvature_error + result)


def _seen_at_vertices(film: Film, points: Floats, faces: Integers) -> tuple[Integers, Integers, Floats]:
    """Vertices, elements at each of them (n,) and the places in these (n, 2)."""
    if np.array_equal(film.connectivity.faces, faces):
        # all elements that meet at a vertex: their curvatures differ, and none of them is the nearest one
        corners = CORNERS
        return faces.ravel(), np.repeat(np.arange(len(faces)), 3), np.tile(corners, (len(faces), 1))
    places, _ = ClosestPoint(film.connectivity, film.nodes)(points)
    return np.arange(len(points)), places.element, places.local


def fit_surface(
    points: ArrayLike,
    faces: ArrayLike,
    *,
    corner_angle: float = 40.0,
    order: int = 4,
    tolerance: float = 2e-3,
    most_nodes: int = 100_000,
    progress: Progress = silent,
) -> VaryingSurface:
    """The surface of a mesh as it is, whatever its mean curvature: smooth elements nearest to its vertices.

    Parameters
    ----------
    points : (n, 3)
        m.
    faces : (m, 3) or (m, 4) int
        Triangles or quads, counter-clockwise about the normal.
    corner_angle, order, tolerance, most_nodes
        See `FitOptions`.
    progress : callable

    Raises
    ------
    InputError
        No disc with holes, or a mesh so rough that it tells no curvature.

    Examples
    --------
    >>> import lamella, numpy as np
    >>> x, y = np.mgrid[0:7, 0:7].reshape(2, -1) / 3 - 1
    >>> k = np.arange(49).reshape(7, 7)
    >>> faces = np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]], -1).reshape(-1, 4)
    >>> surface = lamella.fit_surface(np.stack([x, y, x * y / 2], 1), faces, tolerance=0.05)
    >>> lamella.net(surface, cells=6, normal_curvature=0.0).normal_curvature
    0.0
    """
    options = FitOptions(corner_angle=corner_angle, order=order, tolerance=tolerance, most_nodes=most_nodes)
    return varying_surface(mesh_of_arrays(points, faces), options, progress)


def varying_surface(raw: RawMesh, options: FitOptions, progress: Progress = silent) -> VaryingSurface:
    """`fit_surface` of a mesh from a file."""
    mesh = clean(raw)
    progress(Report.step(f"{raw.source}: {len(mesh.points):,} vertices, {len(mesh.faces):,} triangles"))
    loops, notes = checked_loops(mesh, options.corner_angle)
    kept = kept_surface(mesh, loops, options, raw.source, notes, progress)
    return replace(kept, figures=kept.figures | origin_figure(raw.origin))


def kept_surface(
    mesh: CleanMesh,
    loops: tuple[Loop, ...],
    options: FitOptions,
    source: str,
    notes: tuple[Message, ...],
    progress: Progress,
) -> VaryingSurface:
    """The mesh's own surface as later stages see it.

    Raises
    ------
    InputError
        The mesh is so rough that it has no curvature to speak of.
    """
    progress(Report.step("laying smooth elements through the vertices"))
    given = mesh.points
    flat = as_film(mesh, loops)
    # the border's vertices are where their curves are
    fits = fit_vertices(flat.nodes, mesh.faces)
    kept = through_film(mesh, flat, loops, fits, options, progress)
    smoothed = None
    uneven = float(np.sqrt((disagreement(fits, mesh.faces) ** 2).mean()))
    if kept is None or uneven > ROUGH * _scale(kept.film):
        smoothed = without_scatter(given, mesh.faces, flat.mesh.loop >= 0)
    if smoothed is not None:
        mesh = replace(mesh, points=smoothed.points)
        loops, notes = checked_loops(mesh, options.corner_angle)
        notes += (moved_by_scatter(smoothed, given, flat.mesh.loop >= 0),)
        flat = as_film(mesh, loops)
        fits = fit_vertices(flat.nodes, mesh.faces, READING)
        kept = through_film(mesh, flat, loops, fits, options, progress)
    if kept is None:
        kept = kept_film(mesh, loops, options.order, options.tolerance, options.most_nodes, progress)
    film, scale = kept.film, _scale(kept.film)
    if kept.jump > ROUGHEST:
        raise InputError(
            f"the mesh is too rough, or too coarse, to tell a curvature: between smooth elements through its vertices "
            f"it still jumps by {kept.jump:.2g} of the curvature scale {scale:.4g} 1/m (limit {ROUGHEST:g})",
            "give a smoother or a finer mesh, its vertices on the surface",
            "faces",
        )
    for note in (*mesh.notes, *notes):
        progress(Report.step(note))
    errors = vertex_errors(film, fits, mesh.faces, smoothed)
    typical = float(np.sqrt(np.average(errors**2, weights=vertex_areas(mesh.points, mesh.faces)))) / scale
    if smoothed is not None and np.median(errors) > FIT_OPEN * scale:
        raise too_scattered(smoothed, mesh.faces, flat.mesh.loop >= 0, float(np.median(errors)) / scale, scale)
    rim_loop = film.mesh.loop[film.connectivity.rim_nodes[:, 0]]
    figures = _figures(film, given, options.tolerance) | {
        "curvature_scale": scale,
        "curvature_jump": kept.jump,
        "curvature_error": typical,
        "source": source,
        "treatment": [*mesh.notes, *notes],
        "vertex_scatter": smoothed.scatter if smoothed else 0.0,
    }
    return VaryingSurface(
        "mesh",
        _mean(film),
        film.connectivity,
        film.nodes,
        rim_loop,
        figures,
        _doubts(typical, options.tolerance),
        vertices=mesh.points,
        vertex_errors=errors,
    )


def _figures(film: Film, given: Floats, tolerance: float) -> dict[str, Any]:
    """Figures of the elements, and their distances from the vertices as they were given."""
    distance = distances(film, given)
    return {
        "order": film.connectivity.basis.order,
        "surface_nodes": film.connectivity.node_count,
        "elements": len(film.connectivity.elements),
        "distance_max": float(distance.max()),
        "distance_rms": float(np.sqrt((distance**2).mean())),
        "tolerance": tolerance,
    }


def _doubts(typical: float, tolerance: float) -> tuple[Message, ...]:
    """That the mesh tells its curvature less well than requested."""
    if typical <= tolerance:
        return ()
    return (
        Message(
            "mesh_rough",
            f"the mesh tells its curvature to {typical:.2g} of the curvature scale only (tolerance = {tolerance:g}): "
            "by so much the surfaces around neighbouring vertices differ; a smoother or a finer mesh tells more",
        ),
    )


def distances(film: Film, points: Floats) -> Floats:
    """Distances of points from a film, m, (n,)."""
    _, position = ClosestPoint(film.connectivity, film.nodes)(points)
    return np.asarray(np.linalg.norm(position - points, axis=1))


def _mean(film: Film) -> float:
    """Mean of H over the area, 1/m."""
    points, weights = triangle_rule(6)
    there = element_points(film.connectivity, film.nodes[film.connectivity.elements], points, False)
    area = np.tile(weights, len(film.connectivity.elements)) / np.linalg.det(there.to_local)
    return float(np.average(there.mean_curvature, weights=area))
