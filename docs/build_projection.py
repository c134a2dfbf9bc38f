"""Pictures of guided projection: the paper's figures 6 to 10 with surfaces of our own.

Run alone by `python docs/build_projection.py`, half a minute. The paper's "Ocean" is replaced by a film of H = 0.68
over a rim of our own. The figures that docs/projection.md quotes are printed.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import shortest_path

from lamella import Unduloid, deform, foot_surface, planar_strips, quad_mesh, sphere_stars, straighten
from lamella.command.optimise_mesh import strip_mesh
from lamella.network.elements.element_network import element_network
from lamella.network.network import Network
from lamella.projection.polylines import diagonal_ring
from lamella.projection.problems.planar_strips import PlanarStrips
from lamella.projection.quad_mesh import QuadMesh
from lamella.projection.star_measures import circle_angles
from lamella.surface.boundary import make_loop
from lamella.surface.boundary.splines import closed_spline
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.find import find_film
from lamella.view.net_picture import NetPanel, draw_nets

PICTURES = Path(__file__).parent / "pictures"
UNDULOID = Unduloid(0.6, 1.4, (-8.0, 8.0))
# as the paper's Ocean; its rim, m
H, WIDE, DEEP, RISE = 0.68, 1.0, 0.8, 0.2
RED = "#d60000"


def grid_faces(rows: int, around: int) -> np.ndarray:
    """Quads of rows that close around an axis, seen from outside."""
    i, j = (x.ravel() for x in np.meshgrid(np.arange(rows - 1), np.arange(around), indexing="ij"))
    k = (j + 1) % around
    return np.column_stack([i * around + j, i * around + k, (i + 1) * around + k, (i + 1) * around + j])


def principal_mesh(around: int = 24, rows: int = 12) -> QuadMesh:
    """M0: meridians and parallels of the unduloid, parallels too far apart and unevenly spread."""
    i, j = (x.ravel() for x in np.meshgrid(np.arange(rows), np.arange(around), indexing="ij"))
    u = np.linspace(-1, 1, rows)
    u = 1.3 * u * (rows - 1) * np.pi / around + 0.2 * np.sin(3 * u)
    return quad_mesh(UNDULOID.at(u[i] + 2j * np.pi * j / around).position, grid_faces(rows, around))


def lamella_net(around: int, rows: int, start: float) -> QuadMesh:
    """Lamellas once around the unduloid, row k of nodes at U = start + k pi / around."""
    k, j = (x.ravel() for x in np.meshgrid(np.arange(rows), np.arange(around), indexing="ij"))
    where = start + k * np.pi / around + 1j * (2 * j + k % 2) * np.pi / around
    k, j = (x.ravel() for x in np.meshgrid(np.arange(rows - 2), np.arange(around), indexing="ij"))
    right, left = (j + k % 2) % around, (j - 1 + k % 2) % around
    faces = np.column_stack([k * around + j, (k + 1) * around + right, (k + 2) * around + j, (k + 1) * around + left])
    return quad_mesh(UNDULOID.at(where).position, faces)


def figure_6(folder: Path) -> None:
    """Straightening."""
    mesh = principal_mesh()
    found = straighten(mesh, foot_surface(UNDULOID))
    angles = circle_angles(found.lamellas, found.lamellas.inner)
    print(f"figure 6: {found.solution.verdict}, angles of M2 off 90 degrees by {np.abs(angles - 90).max():.3f} at most")
    panels = [
        NetPanel("M0, principal", mesh),
        NetPanel("M1, isothermic", found.isothermic),
        NetPanel("M2, lamellas", found.lamellas, "angle"),
    ]
    draw_nets(panels, folder / "figure_6.png", view=(-60, 20), width=330)


def say_strips(name: str, strips: PlanarStrips) -> None:
    figures = ", ".join(f"{key.replace('_', ' ')} {value:.2g}" for key, value in strips.figures().items())
    print(f"{name}: {', '.join(s.verdict for s in strips.solutions)}; {figures}")


def strip_panel(title: str, lowers: tuple[np.ndarray, ...], uppers: tuple[np.ndarray, ...]) -> NetPanel:
    return NetPanel(title, strip_mesh(lowers, uppers)[0], "planarity", edges="boundary")


def along_normals(curves: list[np.ndarray], strips: PlanarStrips, surface: object) -> NetPanel:
    """Strips that follow the surface normals."""
    feet = [surface.foot(curve) for curve in curves]  # type: ignore[attr-defined]
    lowers = tuple(foot.position for foot in feet)
    return strip_panel("strips along normals", lowers, tuple(f.position + strips.height * f.normal for f in feet))


def figure_7(folder: Path, height: float = 0.08) -> None:
    """Planar strips on the unduloid, between neck and bulge: across them no developable strip exists."""
    around = 20
    half = UNDULOID.period / 2
    rows = int(0.5 * half * around / np.pi) + 1
    net = lamella_net(around, rows, 0.25 * half)
    u = 0.25 * half + np.arange(rows) * np.pi / around
    curves = [
        UNDULOID.at(u + 1j * (2 * np.pi * j / around + sign * (u - u[0]))).position
        for sign in (1, -1)
        for j in range(around)
    ]
    surface = foot_surface(UNDULOID)
    strips = planar_strips(curves, surface, height, rounds=1)
    say_strips("figure 7", strips)
    panels = [
        NetPanel("lamellas", net),
        along_normals(curves, strips, surface),
        strip_panel("after one round", strips.lower, strips.upper),
    ]
    draw_nets(panels, folder / "figure_7.png", view=(-60, 28), width=400)


def figure_8(folder: Path) -> None:
    """Deformation of the unduloid."""
    around, rows = 24, 23
    start = sphere_stars(lamella_net(around, rows, -(rows // 2) * np.pi / around), radius=2.0).mesh
    ring = diagonal_ring(start, around * (rows // 2))
    states = deform(start, ring, 0.8, radius=2.0)
    panels = []
    for share in (1.0, 0.9, 0.8):
        state = min(states, key=lambda s: abs(s.share - share))
        change = np.abs(state.angle_change)
        residual = max(state.solution.last.residual[name] for name in ("edges", "stars"))
        print(
            f"figure 8: {share:.0%} {state.solution.verdict}, edges and stars to {residual:.0e}, "
            f"angles changed by {change.min():.1f} to {change.max():.1f} degrees"
        )
        line = state.mesh.vertices[np.append(ring, ring[0])]
        title = "as designed" if share == 1 else f"red ring {1 - share:.0%} smaller"
        panels.append(NetPanel(title, state.mesh, "angle", ((line, RED),)))
    draw_nets(panels, folder / "figure_8.png", view=(-60, 14), width=330)


@cache
def ocean() -> tuple[ElementSurface, Network]:
    """A film of H = 0.68 over a free-form rim, and its net."""
    t = np.arange(36) * 2 * np.pi / 36
    rim = np.column_stack([WIDE * np.cos(t), DEEP * np.sin(t), RISE * np.cos(2 * t)])
    surface = find_film((make_loop("rim", closed_spline(rim)),), H).surface("form-found")
    return surface, element_network(surface, cells=12, minimum_length=0.3).network


def quads_of(network: Network) -> QuadMesh:
    """The quads of a network that hang together around its middle."""
    sizes = np.diff(network.face_offsets)
    starts = network.face_offsets[:-1][sizes == 4]
    faces = network.face_nodes[starts[:, None] + np.arange(4)]
    used, index = np.unique(faces, return_inverse=True)
    return quad_mesh(network.node_points[used], index.reshape(-1, 4))


def isothermic_of(net: QuadMesh) -> QuadMesh:
    """Squares whose middles are every other node of a net: their edges are principal, they run across its diagonals."""
    count = len(net.vertices)
    ends = np.concatenate([net.edges, net.edges[:, ::-1]])
    graph = sp.coo_matrix((np.ones(len(ends)), tuple(ends.T)), (count, count)).tocsr()
    colour = shortest_path(graph, unweighted=True, indices=int(net.inner[0])) % 2
    faces = net.stars(net.inner[colour[net.inner] == 1])
    used, index = np.unique(faces, return_inverse=True)
    return quad_mesh(net.vertices[used], index.reshape(-1, 4))


def quads_of_surface(surface: ElementSurface) -> QuadMesh:
    """A fine mesh of the surface, each triangle as three quads."""
    mesh = surface.subdivided(3)
    triangles = mesh.faces[:, :3]
    pairs = np.sort(np.stack([triangles, np.roll(triangles, -1, 1)], 2).reshape(-1, 2), axis=1)
    edges, side = np.unique(pairs, axis=0, return_inverse=True)
    count = len(mesh.points)
    side = side.reshape(-1, 3) + count
    middle = count + len(edges) + np.arange(len(triangles))
    points = [mesh.points, mesh.points[edges].mean(1), mesh.points[triangles].mean(1)]
    faces = [np.column_stack([triangles[:, k], side[:, k], middle, side[:, k - 1]]) for k in range(3)]
    return quad_mesh(np.concatenate(points), np.concatenate(faces))


@cache
def ocean_curves(spacing: float = 0.06) -> tuple[np.ndarray, ...]:
    """The lamellas, at even steps."""
    network = ocean()[1]
    found = []
    for first, end in zip(network.sample_offsets[:-1], network.sample_offsets[1:], strict=True):
        s, points = network.sample_arclengths[first:end], network.sample_points[first:end]
        even = np.linspace(0, s[-1], max(6, int(s[-1] / spacing)))
        found.append(np.stack([np.interp(even, s, x) for x in points.T], 1))
    return tuple(found)


def figures_9_and_10(folder: Path, height: float = 0.05) -> None:
    """A free-form surface: from the surface to strips, and the strips round by round."""
    surface, network = ocean()
    net = quads_of(network)
    feet = foot_surface(surface)
    curves = list(ocean_curves())
    rounds = [planar_strips(curves, feet, height, rounds=k) for k in (1, 2)]
    before = along_normals(curves, rounds[0], feet)
    angles = circle_angles(net, net.inner)
    print(f"figure 9: {len(net.inner)} nodes, angles between vertex circles off 90 by {np.abs(angles - 90).max():.2f}")
    panels = [
        NetPanel(f"surface, H = {H}", quads_of_surface(surface), edges="boundary"),
        NetPanel("isothermic mesh", isothermic_of(net)),
        NetPanel("lamellas", net),
        before,
    ]
    draw_nets(panels, folder / "figure_9.png", view=(-50, 40), width=330)
    for k, strips in enumerate(rounds, 1):
        say_strips(f"figure 10, {k} rounds", strips)
    after = [strip_panel(f"{k} {'round' if k == 1 else 'rounds'}", s.lower, s.upper) for k, s in enumerate(rounds, 1)]
    draw_nets([before, *after], folder / "figure_10.png", view=(-50, 40), width=430)


def make_pictures(folder: Path = PICTURES) -> None:
    """All of them."""
    for make in (figure_6, figure_7, figure_8, figures_9_and_10):
        make(folder)


if __name__ == "__main__":
    make_pictures()
