"""Nodes moved within a film: the linear model behind it, what it gains on closed forms, and what it leaves alone."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.surface.boundary.curve import make_loop
from lamella.surface.boundary.pieces import lines
from lamella.surface.element.curvature import element_points
from lamella.surface.element.geometry import smooth_normals
from lamella.surface.form_finding.adaptivity import away_from_corners
from lamella.surface.form_finding.meshing import with_sizes
from lamella.surface.form_finding.newton import find_equilibrium
from lamella.surface.form_finding.redistribution import (
    check_rule,
    redistributed,
    tangent_frames,
    variation_of_mean_curvature,
)
from surface.form_finding.exact_patches import CatenoidPatch, EnneperPatch, HelicoidPatch, SphereCap, UnduloidPatch
from surface.form_finding.films import order_of, random_places, start, surface

PATCHES = {
    "catenoid": (CatenoidPatch(), 0.25),
    "unduloid": (UnduloidPatch(), 0.2),
    "helicoid": (HelicoidPatch(), 0.25),
    "Enneper": (EnneperPatch(), 0.25),
}


def film_of(patch, size: float, order: int = 4):
    """A film as Newton's method leaves it on new elements."""
    first = find_equilibrium(start([patch.rim()], order), patch.mean_curvature).film
    return find_equilibrium(with_sizes(first, lambda x: np.full(len(x), size)), patch.mean_curvature).film


def rms_off(film, mean_curvature: float) -> float:
    """Root mean square of H - H0 inside the elements, 1/m."""
    measured = surface(film, mean_curvature).measured_mean_curvature(random_places(film, 20_000))
    return float(np.sqrt(np.mean((measured - mean_curvature) ** 2)))


def test_change_of_mean_curvature_is_its_first_variation() -> None:
    """Against differences: what is left out is |A|^2 u / 2, of u = O(h delta) against Laplace u = O(delta / h)."""
    patch, errors, counts = CatenoidPatch(), [], []
    for size in (0.5, 0.25, 0.125):
        film = film_of(patch, size)
        connectivity = film.connectivity
        normals = smooth_normals(connectivity, film.nodes)
        frames = tangent_frames(film, normals)
        points, _ = check_rule(connectivity.basis.order)
        rates, _, _ = variation_of_mean_curvature(film, normals, frames, slice(None))
        rng = np.random.default_rng(1)
        shifts = rng.normal(size=(len(film.nodes), 2))
        ends = [
            element_points(
                connectivity,
                (film.nodes + step * np.einsum("nct,nt->nc", frames, shifts))[connectivity.elements],
                points,
                False,
            ).mean_curvature
            for step in (1e-6, -1e-6)
        ]
        wanted = ((ends[0] - ends[1]) / 2e-6).reshape(len(connectivity.elements), -1)
        local = shifts[connectivity.elements[:, 3:]].reshape(len(wanted), -1)
        told = np.einsum("eqk,ek->eq", rates, local)
        errors.append(np.linalg.norm(told - wanted) / np.linalg.norm(wanted))
        counts.append(len(film.nodes))
    assert errors[-1] < 5e-4
    assert order_of(errors, counts) > 2


@pytest.mark.parametrize("name", PATCHES)
def test_gain_on_closed_forms(name: str) -> None:
    """Mean curvature, place and principal directions against the exact surface, at places not looked at."""
    patch, size = PATCHES[name]
    film = film_of(patch, size)
    moved = find_equilibrium(redistributed(film, patch.mean_curvature), patch.mean_curvature).film
    figures = []
    for each in (film, moved):
        found, where = surface(each, patch.mean_curvature), random_places(each, 20_000)
        at = found.at(where)
        _, d1, _ = patch.curvatures(*patch.parameters(at.position))
        off = np.linalg.norm(np.cross(at.principal_directions[0], d1), axis=1)
        h = found.measured_mean_curvature(where) - patch.mean_curvature
        figures.append([np.sqrt(np.mean(v**2)) for v in (h, patch.distance(at.position), off)])
    h, distance, direction = np.divide(*figures)
    assert h > 3
    assert distance > 1.5
    assert direction > 1.5


def test_vertices_boundary_and_corners_stay() -> None:
    """What a corner's surroundings, left out of the measure, would be moved by is not known."""
    points = np.array([[0, 0, 0], [2, 0, 0.5], [2, 2, 0], [0, 2, 0.5]], float)
    film = find_equilibrium(start([make_loop("outer", lines(points, closed=True))], 4), 0.0).film
    moved = redistributed(film, 0.0)
    step = np.linalg.norm(moved.nodes - film.nodes, axis=1)
    held = np.zeros(len(step), bool)
    held[: len(film.mesh.points)] = held[film.connectivity.rim_nodes] = True
    elements = film.connectivity.elements
    held[elements[~away_from_corners(film, film.nodes)[elements].all(1)]] = True
    assert (step[held] == 0).all()
    assert (step[~held] > 0).mean() > 0.9
    normals = smooth_normals(film.connectivity, film.nodes)
    assert np.abs(((moved.nodes - film.nodes) * normals).sum(1)).max() < 1e-12


@pytest.mark.parametrize("order", [2, 3, 4])
def test_a_sphere_of_few_elements(order: int) -> None:
    """No step is so long that elements leave their shape, where the curvature of coarse elements is far off."""
    patch = SphereCap(0.95)
    film = find_equilibrium(start([patch.rim()], order), patch.mean_curvature).film
    moved = redistributed(film, patch.mean_curvature)
    corners = film.nodes[film.connectivity.faces]
    edge = np.linalg.norm(corners - np.roll(corners, 1, 1), axis=2)
    assert np.linalg.norm(moved.nodes - film.nodes, axis=1).max() <= 0.05 * edge.max()
    again = find_equilibrium(moved, patch.mean_curvature).film
    before, after = (rms_off(each, patch.mean_curvature) for each in (film, again))
    assert after < before
