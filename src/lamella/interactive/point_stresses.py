"""Stresses along a net's lines before the net is traced: curvatures follow from the shape operator at each point."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Complexes, Floats
from lamella.base.material import Material
from lamella.base.vectors import dots, images
from lamella.network.elements.followed_net import FollowedNet
from lamella.network.isothermic.integration_mesh import IntegrationMesh
from lamella.strip.lamellas import Section
from lamella.strip.stress import stresses
from lamella.surface.darboux import lamella_darboux, sideways_slope
from lamella.surface.element.curvature import frames
from lamella.surface.element.places import Places
from lamella.surface.element.polynomials import Polynomials
from lamella.surface.points import SurfacePoints

# cells from an umbilic within which lamellas count as rays that end in it: the film's error would have them pass beside
RAY_CELLS = 0.25
# utilisation
ROUNDING = 1e-9
# of the largest H^2 - K: less is an umbilic itself, where slopes of ln mu have no bound
UMBILIC_SHARE = 1e-12


def line_utilisation(net: FollowedNet, section: Section, material: Material) -> Floats:
    """Utilisation at the points of a net's lines, (k,); within `RAY_CELLS` of an umbilic that of a ray, kg = 0.

    Parameters
    ----------
    net : FollowedNet
    section : Section
    material : Material
    """
    lines = net.lines
    points = mesh_points(net.coordinates.mesh, net.surface.mean_curvature, lines.places)
    heading = np.exp(-0.5j * np.angle(points.deviator))
    # tg = -Im(D h^2) is positive along A
    is_b = np.repeat(lines.families == "B", np.diff(lines.offsets))
    heading *= np.exp(np.where(is_b, 0.25j, -0.25j) * np.pi)
    there = lamella_darboux(points, heading)
    farthest = np.abs(section.layer_offsets).max()
    beside = farthest * np.abs(sideways_slope(points, heading))
    ray = _beside_umbilic(net, points)
    made = stresses(
        material,
        section.height,
        section.thickness,
        curvature_error=np.zeros_like(there.kg),
        layer_curvature=np.where(ray | (section.layer_curves != "offset"), 0.0, beside),
        kg=np.where(ray, 0.0, there.kg),
        tg=there.tg,
        held=section.marks == "arc-length",
    )
    # at umbilics nothing is left but rounding
    return np.where(made.utilisation > ROUNDING, made.utilisation, 0.0)


def mesh_points(mesh: IntegrationMesh, mean_curvature: float, where: Places) -> SurfacePoints:
    """Everything about places on the elements that a net's coordinates were integrated on, of a surface of given H."""
    elements = mesh.connectivity.elements
    mean = mesh.shape[:, [0, 3, 5]].sum(1) / 2
    # of the shape operator S: tr(S^2) / 2 = 2 H^2 - K
    square = np.square(mesh.shape) @ np.array([0.5, 1, 1, 0.5, 1, 0.5]) - mean**2
    fields = np.concatenate([mesh.nodes, mesh.shape, square[:, None]], 1)
    jet = Polynomials.through(mesh.connectivity.basis, fields[elements]).jet(where)
    there = frames(*np.ascontiguousarray(jet[:, :3].transpose(0, 2, 1)))
    shape = np.ascontiguousarray(jet[0, 3:9].T)
    u, v = images(shape, there.e_u), images(shape, there.e_v)
    deviator = (dots(u, there.e_u) - dots(v, there.e_v)) / 2 - 1j * dots(u, there.e_v)
    along = there.to_local[:, 0] * jet[1, 9][:, None] + there.to_local[:, 1] * jet[2, 9][:, None]
    slope = along[:, 0] + 1j * along[:, 1]
    size: Floats = np.square(np.abs(deviator))
    least = UMBILIC_SHARE * size.max(initial=0.0)
    gradient: Complexes = np.where(size > least, slope / (4 * np.maximum(size, least)), 0.0)
    everywhere = np.full(len(size), float(mean_curvature))
    return SurfacePoints(there.position, there.e_u, there.e_v, there.normal, everywhere, deviator, gradient)


def _beside_umbilic(net: FollowedNet, points: SurfacePoints) -> Booleans:
    """Whether points are so near to an umbilic: |w| is about mu times the distance over 1 + m / 2 there."""
    apart = np.full(len(points.position), np.inf)
    for umbilic, order in zip(net.umbilics.position, net.umbilics.orders, strict=True):
        distance = np.linalg.norm(points.position - umbilic, axis=1)
        apart = np.minimum(apart, distance / (1 + order / 2))
    return np.asarray(points.mu * apart < RAY_CELLS * net.step)
