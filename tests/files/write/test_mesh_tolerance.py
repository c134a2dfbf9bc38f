"""surface.obj and surface.ply keep the tolerance that was asked for, and say which: read back and measured."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from lamella.files.read.mesh import read_mesh
from lamella.files.write.meshes import write_surface_obj, write_surface_ply
from lamella.surface.closed_forms.catenoid import Catenoid
from lamella.surface.closed_forms.enneper import Enneper
from lamella.surface.element.surface import ElementSurface
from surface.form_finding.exact_patches import CatenoidPatch, SphereCap
from surface.form_finding.films import find_equilibrium, start, surface


def off_the_faces(points, faces, distance, seed: int = 0) -> float:
    """Largest distance from a surface of random places on the triangles of faces."""
    rng = np.random.default_rng(seed)
    share = rng.dirichlet(np.ones(3), (8, len(faces)))
    places = np.einsum("rfk,fkc->rfc", share, points[faces]).reshape(-1, 3)
    return float(distance(places).max())


def found(patch) -> ElementSurface:
    return surface(find_equilibrium(start([patch.rim()], 4), patch.mean_curvature).film, patch.mean_curvature)


def of_elements(patch):
    film = found(patch)
    return film, lambda x: np.linalg.norm(film.closest(x)[1] - x, axis=1)


def catenoid():
    """r = c cosh(z / c): the distance is |r - c cosh(z / c)| / cosh(z / c) but for terms of second order."""
    return Catenoid(
        2.0, (-1.5, 2.5)
    ), lambda x: np.abs(np.hypot(x[:, 0], x[:, 1]) - 2 * np.cosh(x[:, 2] / 2)) / np.cosh(x[:, 2] / 2)


CASES = {
    "catenoid": catenoid,
    "found catenoid": lambda: of_elements(CatenoidPatch()),
    "found cap": lambda: of_elements(SphereCap(0.8)),
}


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("case", CASES)
@pytest.mark.few(4)
def test_read_back(case: str, tolerance: float, tmp_path: Path) -> None:
    body, distance = CASES[case]()
    mesh = body.mesh(tolerance)
    size = np.linalg.norm(np.ptp(mesh.points, axis=0))
    meshes, reported = [], []
    for write, file in ((write_surface_obj, "surface.obj"), (write_surface_ply, "surface.ply")):
        write(tmp_path / file, mesh, name="", version="")
        reported += re.findall(rb"faces within (\S+) m of the surface", (tmp_path / file).read_bytes())
        meshes.append(read_mesh(tmp_path / file, "m"))
    # one mesh in both files
    assert np.array_equal(meshes[0].faces, meshes[1].faces)
    assert np.array_equal(meshes[0].points, meshes[1].points)
    assert len(reported) == 2
    assert len(set(reported)) == 1
    worst, told = off_the_faces(meshes[0].points, meshes[0].faces, distance), float(reported[0])
    assert worst <= told * 1.05
    assert told <= 1.05 * tolerance * size
    # not a great many more triangles than that takes
    assert tolerance > 1e-3 or worst > 0.05 * tolerance * size


def test_a_limit_of_triangles_is_told() -> None:
    mesh = Enneper(2, 0.9, 4.0).mesh(1e-7)
    assert 500_000 < len(mesh.faces) < 1_500_000
    assert mesh.sag() > 1e-7 * np.linalg.norm(np.ptp(mesh.points, axis=0))
