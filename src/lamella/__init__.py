"""Strained gridshells from straight or circular lamellas with congruent nodes.

Signs and names, the same everywhere (Schling, Kilian, Wang, Schikore, Pottmann: Design and
Construction of Curved Support Structures with Repetitive Parameters, AAG 2018, section 2; docs/sign-conventions.md):

unit tangent t, surface normal n, sideways u = n x t, and

    t' =  kg u + kn n        kg  geodesic curvature
    u' = -kg t + tg n        kn  normal curvature
    n' = -kn t - tg u        tg  geodesic torsion

Principal curvatures k1 >= k2 with unit directions (d1, d2, n) right-handed, H = (k1 + k2) / 2, K = k1 k2. A sphere has
H > 0 for its inward normal. Isothermic coordinates: du = mu <d1, .>, dv = mu <d2, .>, mu = (H^2 - K)^(1/4). Family A
are the lamellas with tg > 0, along u + v = const; family B those with tg < 0, along u - v = const.

Lengths are metres, angles degrees, stresses Pa.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from lamella.base.errors import InputError as InputError
    from lamella.fabrication import make_parts as make_parts
    from lamella.fabrication import nest as nest
    from lamella.files.compas_json import compas_at as compas_at
    from lamella.files.compas_json import quad_mesh_of_compas as quad_mesh_of_compas
    from lamella.files.quad_mesh_files import read_quad_mesh as read_quad_mesh
    from lamella.network.make import make_network as make_network
    from lamella.network.network import Network as Network
    from lamella.project.read import parse_project as parse_project
    from lamella.project.read import read_project as read_project
    from lamella.project.tables import Project as Project
    from lamella.projection.foot_points import foot_surface as foot_surface
    from lamella.projection.problems.asymptotic import asymptotic as asymptotic
    from lamella.projection.problems.deform import deform as deform
    from lamella.projection.problems.planar_strips import planar_strips as planar_strips
    from lamella.projection.problems.sphere_stars import sphere_stars as sphere_stars
    from lamella.projection.problems.straighten import straighten as straighten
    from lamella.projection.quad_mesh import QuadMesh as QuadMesh
    from lamella.projection.quad_mesh import quad_mesh as quad_mesh
    from lamella.stages.pipeline import Results as Results
    from lamella.stages.pipeline import compute as compute
    from lamella.stages.pipeline import make_surface as make_surface
    from lamella.stages.pipeline import run as run
    from lamella.stages.pipeline import write as write
    from lamella.strip.lamellas import Lamellas as Lamellas
    from lamella.strip.lamellas import Section as Section
    from lamella.strip.lamellas import make_lamellas as make_lamellas
    from lamella.strip.material import Material as Material
    from lamella.strip.material import find_material as find_material
    from lamella.surface.boundary import Loop as Loop
    from lamella.surface.boundary import make_loop as make_loop
    from lamella.surface.closed_forms.catenoid import Catenoid as Catenoid
    from lamella.surface.closed_forms.cylinder import Cylinder as Cylinder
    from lamella.surface.closed_forms.delaunay import Nodoid as Nodoid
    from lamella.surface.closed_forms.delaunay import Unduloid as Unduloid
    from lamella.surface.closed_forms.enneper import Enneper as Enneper
    from lamella.surface.closed_forms.helicoid import Helicoid as Helicoid
    from lamella.surface.closed_forms.scherk import Scherk as Scherk
    from lamella.surface.element.places import Places as Places
    from lamella.surface.element.surface import ElementSurface as ElementSurface
    from lamella.surface.form_finding.find import find_film as find_film

# imported on first use: `lamella --help` must not wait for scipy
_HOMES = {
    "InputError": "base.errors",
    "compas_at": "files.compas_json",
    "quad_mesh_of_compas": "files.compas_json",
    "read_quad_mesh": "files.quad_mesh_files",
    "make_parts": "fabrication",
    "nest": "fabrication",
    "make_network": "network.make",
    "Network": "network.network",
    "Results": "stages.pipeline",
    "compute": "stages.pipeline",
    "make_surface": "stages.pipeline",
    "run": "stages.pipeline",
    "write": "stages.pipeline",
    "Project": "project.tables",
    "parse_project": "project.read",
    "read_project": "project.read",
    "foot_surface": "projection.foot_points",
    "asymptotic": "projection.problems.asymptotic",
    "deform": "projection.problems.deform",
    "planar_strips": "projection.problems.planar_strips",
    "sphere_stars": "projection.problems.sphere_stars",
    "straighten": "projection.problems.straighten",
    "QuadMesh": "projection.quad_mesh",
    "quad_mesh": "projection.quad_mesh",
    "Lamellas": "strip.lamellas",
    "Section": "strip.lamellas",
    "make_lamellas": "strip.lamellas",
    "Material": "strip.material",
    "find_material": "strip.material",
    "Loop": "surface.boundary",
    "make_loop": "surface.boundary",
    "Catenoid": "surface.closed_forms.catenoid",
    "Cylinder": "surface.closed_forms.cylinder",
    "Nodoid": "surface.closed_forms.delaunay",
    "Unduloid": "surface.closed_forms.delaunay",
    "Places": "surface.element.places",
    "ElementSurface": "surface.element.surface",
    "Enneper": "surface.closed_forms.enneper",
    "find_film": "surface.form_finding.find",
    "Helicoid": "surface.closed_forms.helicoid",
    "Scherk": "surface.closed_forms.scherk",
}

__all__ = ["__version__", *_HOMES]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'lamella' has no attribute {name!r}")
    return getattr(import_module(f"lamella.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
