"""The questions every surface answers: closed forms, and a surface with another idea of a place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import orjson
import pytest

from conftest import KINDS, draw_surface
from lamella import Catenoid, Cylinder, Enneper, InputError, Scherk, Unduloid, parse_project
from lamella.base.arrays import Floats
from lamella.stages.figure import evaluate
from lamella.stages.surface.output import SurfaceOutput
from lamella.stages.surface.stage import SurfaceStage
from lamella.surface.closed_forms.kinds import CLOSED_FORMS
from lamella.surface.mesh import SurfaceMesh
from lamella.surface.points import SurfacePoints
from lamella.surface.surface import Surface
from lamella.surface.umbilic import refuse_umbilic, umbilic_reason

QUESTIONS = {name for name in vars(Surface) if not name.startswith("_")}


def is_surface(surface: Surface[Any]) -> Surface[Any]:
    assert all(hasattr(surface, name) for name in QUESTIONS)
    return surface


def mesh_area(mesh: SurfaceMesh) -> float:
    p, f = mesh.points, mesh.faces
    return float(np.linalg.norm(np.cross(p[f[:, 2]] - p[f[:, 0]], p[f[:, 3]] - p[f[:, 1]]), axis=1).sum() / 2)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(3))
def test_closed_forms_answer_everything(kind: str, seed: int) -> None:
    surface = is_surface(draw_surface(kind, np.random.default_rng([seed, 31])))
    assert isinstance(surface, CLOSED_FORMS[surface.kind])
    where = surface.check_places()
    at = surface.at(where)
    count = len(at.position)
    assert count >= 200
    scale = np.abs(at.principal_curvatures).max()
    measured = surface.measured_mean_curvature(where)
    assert measured.shape == (count,)
    assert np.abs(measured - surface.mean_curvature).max() < 1e-6 * scale
    # the check places reach as far as the surface does
    mesh = surface.mesh()
    reach, size = np.ptp(at.position, axis=0), np.ptp(mesh.points, axis=0)
    assert (reach > 0.9 * size).all()
    assert mesh_area(mesh) == pytest.approx(surface.area(), rel=0.02)
    assert len(surface.mesh(1e-4).points) > len(surface.mesh(1e-3).points)
    orjson.dumps(surface.describe())
    assert all(isinstance(message, str) for message in surface.warnings())


@pytest.mark.parametrize("order", [2, 3, 4, 6])
def test_singular_orders_are_the_turns_of_the_principal_frame(order: int) -> None:
    """Around a zero of order m the trace-free shape operator turns m times against a fixed frame."""
    surface = Enneper(order, 1.0)
    circle = 0.5 * np.exp(1j * np.linspace(0, 2 * np.pi, 401))
    turns = np.diff(np.unwrap(np.angle(surface.at(circle).deviator))).sum() / (2 * np.pi)
    assert surface.singular_orders() == ((round(turns),) if round(turns) else ())
    assert Scherk(1.0).singular_orders() == Catenoid(1.0, (-1, 1)).singular_orders() == ()


@dataclass(frozen=True)
class Places:
    """Colatitude and longitude."""

    theta: Floats
    phi: Floats


class Cap:
    """Spherical cap up to a colatitude of 1, by its inward normal: every point is umbilic."""

    kind = "cap"

    def __init__(self, radius: float, stability: str | None = None) -> None:
        self.radius, self.stability, self.mean_curvature = radius, stability, 1 / radius

    def at(self, where: Places) -> SurfacePoints:
        st, ct, sp, cp = np.sin(where.theta), np.cos(where.theta), np.sin(where.phi), np.cos(where.phi)
        outwards = np.column_stack([st * cp, st * sp, ct])
        by_theta, by_phi = np.column_stack([ct * cp, ct * sp, -st]), np.column_stack([-sp, cp, 0 * cp])
        flat = np.zeros(len(ct), complex)
        return SurfacePoints(
            self.radius * outwards, by_phi, by_theta, -outwards, np.full(len(ct), 1 / self.radius), flat, flat
        )

    def _grid(self, count: int) -> Places:
        theta, phi = np.meshgrid(np.linspace(0, 1, count), np.linspace(0, 2 * np.pi, 4 * count), indexing="ij")
        return Places(theta.ravel(), phi.ravel())

    def mesh(self, tolerance: float = 1e-3) -> SurfaceMesh:
        count = int(1 / tolerance**0.5)
        at = self.at(self._grid(count))
        i = np.arange((count - 1) * 4 * count)
        i = i[(i + 1) % (4 * count) > 0]
        faces = np.column_stack([i, i + 4 * count, i + 4 * count + 1, i + 1])
        k1, k2 = at.principal_curvatures
        return SurfaceMesh(at.position, at.normal, faces, at.mean_curvature, k1 * k2, k1, k2)

    def has_lattice(self, normal_curvature: float | None = None) -> bool:
        return True

    def area(self) -> float:
        return 2 * np.pi * self.radius**2 * (1 - np.cos(1.0))

    def check_places(self) -> Places:
        return self._grid(9)

    def check_points(self) -> SurfacePoints:
        return self.at(self.check_places())

    def measured_mean_curvature(self, where: Places) -> Floats:
        return np.asarray(1 / np.linalg.norm(self.at(where).position, axis=1)) + 1e-3 * (where.theta == 1)

    def singular_orders(self) -> tuple[int, ...]:
        return ()

    def describe(self) -> dict[str, Any]:
        return {"stability": self.stability, "period": self.radius} if self.stability else {}

    def warnings(self) -> tuple[str, ...]:
        return ("it is round",)


def summary_of(surface: Surface[Any]) -> dict[str, Any]:
    project = parse_project({"surface": {"kind": "cylinder", "radius": 1.0, "height": [0, 1]}})
    return evaluate(SurfaceStage.figures, SurfaceOutput(project, surface, surface.mesh(), None, ""))


def test_the_summary_asks_the_surface_alone() -> None:
    cap = is_surface(Cap(2.0))
    summary = summary_of(cap)
    assert summary == {
        "kind": "cap",
        "mean_curvature": 0.5,
        "mean_curvature_deviation_max": pytest.approx(1e-3, rel=1e-9),
        "area": pytest.approx(8 * np.pi * (1 - np.cos(1.0))),
        "size": pytest.approx([4 * np.sin(1.0), 4 * np.sin(1.0), 2 * (1 - np.cos(1.0))], rel=1e-2),
        "k1_max": 0.5,
        "k2_min": 0.5,
        "stability": None,
    }
    told = summary_of(is_surface(Cap(2.0, "stable")))
    assert told["stability"] == "stable"
    assert told["period"] == 2.0
    assert list(told)[:-1] == list(summary)


def test_spheres_and_planes_are_surfaces_without_a_net() -> None:
    cap = Cap(2.0)
    reason = umbilic_reason(cap.at(cap.check_places()))
    assert reason is not None
    assert reason.startswith("a piece of a sphere of radius 2 m")
    with pytest.raises(InputError) as refused:
        refuse_umbilic(cap)
    assert reason in str(refused.value)
    assert "the surface is" in str(refused.value)
    flat = Enneper(2, 1e-7)
    assert str(umbilic_reason(flat.at(flat.check_places()))).startswith("flat: ")
    for bent in (Cylinder(1.0, (0, 1)), Unduloid(0.5, 1.0, (-1, 1))):
        assert umbilic_reason(bent.at(bent.check_places())) is None
