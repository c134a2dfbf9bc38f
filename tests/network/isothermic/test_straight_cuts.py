"""Cuts along straight lines of the plane of w: the same coordinates, cut where the surface itself says.

|dw| = sqrt(2 |D|) |dz|: the first fundamental form times |k1 - k2| is flat (Bonnet; DESIGN section 2), so shortest
lines in it are straight in w, and w changes across a cut by a motion of the plane that no cut alters.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from lamella.network.isothermic.holonomy import holonomies
from lamella.network.isothermic.isothermic import Isothermic, sectors
from lamella.network.isothermic.mesh_layout import make_integration_mesh
from lamella.network.isothermic.poisson import Poisson, Unknowns
from lamella.network.isothermic.recut import cut_straight
from lamella.network.isothermic.seamless_transitions import integrate, links
from lamella.surface.boundary import make_loop
from lamella.surface.boundary.splines import closed_spline
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.find import find_film

TAU = 2 * np.pi


def rim(count: int, radius: float, waves: int, height: float, phase: float = 0.4) -> np.ndarray:
    t = TAU * np.arange(count) / count
    reach = radius * (1 + 0.06 * np.cos(2 * t + 1))
    return np.column_stack(
        [reach * np.cos(t), 0.9 * reach * np.sin(t), height * np.cos(waves * t + phase) + 0.2 * np.cos(t)]
    )


DISC = (rim(20, 5.0, 3, 1.3),)
HOLES = {
    "one hole": (rim(24, 6.0, 2, 1.6), rim(12, 1.4, 2, 0.1)),
    "two holes": (
        rim(24, 7.0, 3, 1.6),
        rim(12, 1.1, 2, 0.1) + np.array([2.6, 0.4, 0.5]),
        rim(12, 0.9, 2, 0.1, 1.0) + np.array([-2.7, -0.3, 0.2]),
    ),
}


@cache
def cut_twice(name: str) -> tuple[ElementSurface, Isothermic, Isothermic]:
    """A film, its coordinates cut along edges of elements, and cut straight."""
    curves = DISC if name == "disc" else HOLES[name]
    loops = tuple(make_loop(f"loop {k}", closed_spline(points)) for k, points in enumerate(curves))
    surface = find_film(loops, 0.0, tolerance=2e-2).surface("form-found")
    umbilics = surface.umbilics
    mesh = make_integration_mesh(surface, umbilics)
    iso = integrate(mesh, mesh.umbilics[(umbilics.orders % 2 == 1) & (mesh.umbilics >= 0)])
    return surface, iso, cut_straight(iso, surface)


NAMES = ["disc", "one hole", pytest.param("two holes", marks=pytest.mark.slow)]


@pytest.mark.parametrize("name", NAMES)
def test_coordinates_stay_the_same(name: str) -> None:
    surface, iso, new = cut_twice(name)
    assert new is not iso
    assert len(iso.odd) >= 1
    assert new.residual == pytest.approx(iso.residual)
    assert new.area == pytest.approx(iso.area, rel=1e-12)
    # parts are straight in their elements: the surface is the same polynomials
    assert new.mesh.connectivity.faces.max() > iso.mesh.connectivity.faces.max()
    assert new.plain.residual(new.value) == pytest.approx(iso.plain.residual(iso.value), rel=1e-3)
    on_surface = surface.frames(new.mesh.places).position
    inside = new.mesh.patch[np.unique(new.mesh.connectivity.elements, return_index=True)[1] // 15] < 0
    off = np.linalg.norm(on_surface - new.mesh.nodes, axis=1)[inside]
    assert off.max() < 1e-3 * np.linalg.norm(np.ptp(new.mesh.nodes, axis=0))
    for before, after in zip(holonomies(iso), holonomies(new), strict=True):
        assert after.sign == before.sign
        if before.sign == 1:
            # up to the sign of w itself
            assert min(abs(after.shift - s * before.shift) for s in (1, -1)) < 1e-9 * iso.longest


@pytest.mark.parametrize("name", NAMES)
def test_pieces_are_straight_and_join_loops_and_umbilics(name: str) -> None:
    _, iso, new = cut_twice(name)
    pieces = [piece for piece in new.transitions if not piece.stub]
    loops = int(new.mesh.loop.max())
    assert len(pieces) == loops + len(new.odd)
    assert sorted(end for piece in pieces for end in piece.ends if end >= 0) == sorted(new.odd.tolist())
    nodes = new.mesh.connectivity.basis.edge_nodes
    for piece in pieces:
        w = new.value[piece.left[:, None], nodes[piece.left_edge]]
        # the ends of its edges lie on one line
        corners = np.append(w[:, 0], w[-1, -1])
        along = corners[-1] - corners[0]
        apart = np.abs(((corners - corners[0]) / along).imag) * abs(along)
        assert apart.max() < 1e-3 * abs(along)
        # and w goes over as it should on each of its nodes
        right = new.value[piece.right[:, None], nodes[piece.right_edge][:, ::-1]]
        assert np.abs(right - (piece.sign * w + piece.shift)).max() < 1e-9 * iso.longest


def test_lines_from_umbilics_are_the_shortest() -> None:
    """Against the least distance over the whole rim in the triangles' own w, from the umbilic on one sheet."""
    _, _, new = cut_twice("disc")
    (piece,) = new.transitions
    nodes = new.mesh.connectivity.basis.edge_nodes
    w = new.value[piece.left[:, None], nodes[piece.left_edge]]
    origin = complex(new.value[:, :3][new.mesh.connectivity.faces == new.odd[0]][0])
    length = abs(w[0, 0] - w[-1, -1])
    # any place of the rim is reached by a line no shorter than the distance of its w
    assert np.abs(new.on_rim - origin).min() > (1 - 2e-3) * length


def test_corrections_are_those_of_the_new_cut() -> None:
    """How w changes with the new shifts, counted over from the old ones, against solving for it on the new mesh."""
    _, _, new = cut_twice("one hole")
    sector = sectors(new.mesh.connectivity, new.cut)
    system = Poisson.of(new.mesh, new.sign).weighted()
    base, moves = system.solve(Unknowns(sector, *links(new.mesh, new.transitions, sector)))
    gram, _ = system.quadratic(base, moves)
    # over their traces, as the weight is relative to its mean over the elements; parts follow a little better
    mine, theirs = new.gram / np.trace(new.gram), gram / np.trace(gram)
    assert np.abs(mine - theirs).max() < 2e-3


def test_what_has_no_cut_stays_as_it_is() -> None:
    t = TAU * np.arange(16) / 16
    saddle = np.column_stack([3 * np.cos(t), 3 * np.sin(t), 0.8 * np.cos(2 * t)])
    surface = find_film((make_loop("rim", closed_spline(saddle)),), 0.0, tolerance=2e-2).surface("form-found")
    iso = integrate(make_integration_mesh(surface, surface.umbilics), np.zeros(0, np.int64))
    assert not iso.transitions
    assert cut_straight(iso, surface) is iso
