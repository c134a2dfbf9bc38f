"""The public names of lamella and where each is made.

Type checkers read this file; the package itself imports each name from where it says, on first use.
"""

from lamella.base.errors import InputError as InputError
from lamella.base.material import Material as Material
from lamella.base.material import find_material as find_material
from lamella.base.result import Result as Result
from lamella.base.result import Shown as Shown
from lamella.fabrication.part import Part as Part
from lamella.fabrication.part import Parts as Parts
from lamella.fabrication.sheet import Nesting as Nesting
from lamella.files.compas_json import compas_at as compas_at
from lamella.files.compas_json import quad_mesh_of_compas as quad_mesh_of_compas
from lamella.files.quad_mesh_files import read_quad_mesh as read_quad_mesh
from lamella.files.read.loop import read_loop as read_loop
from lamella.files.read.network_json import network_of_compas as network_of_compas
from lamella.files.read.network_json import read_network as read_network
from lamella.files.write.compas_graph import write_compas as write_compas
from lamella.interactive.notebook import Studio as Studio
from lamella.interactive.notebook import studio as studio
from lamella.network.elements.followed_net import FollowedNet as FollowedNet
from lamella.network.elements.followed_net import follow_net as follow_net
from lamella.network.elements.level_lines import LevelLines as LevelLines
from lamella.network.net import net as net
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
from lamella.stages.computation import compute as compute
from lamella.stages.memory import Memory as Memory
from lamella.stages.results import Results as Results
from lamella.stages.surface.surface_of_table import make_surface as make_surface
from lamella.stages.write import run as run
from lamella.stages.write import write as write
from lamella.strip.lamellas import Lamellas as Lamellas
from lamella.strip.lamellas import Section as Section
from lamella.studies.study import Study as Study
from lamella.studies.study import study as study
from lamella.surface.boundary import Loop as Loop
from lamella.surface.boundary.curves import arc as arc
from lamella.surface.boundary.curves import circle as circle
from lamella.surface.boundary.curves import ellipse as ellipse
from lamella.surface.boundary.curves import joined as joined
from lamella.surface.boundary.curves import polyline as polyline
from lamella.surface.boundary.curves import spline as spline
from lamella.surface.closed_forms.catenoid import Catenoid as Catenoid
from lamella.surface.closed_forms.cylinder import Cylinder as Cylinder
from lamella.surface.closed_forms.delaunay import Nodoid as Nodoid
from lamella.surface.closed_forms.delaunay import Unduloid as Unduloid
from lamella.surface.closed_forms.enneper import Enneper as Enneper
from lamella.surface.closed_forms.helicoid import Helicoid as Helicoid
from lamella.surface.closed_forms.scherk import Scherk as Scherk
from lamella.surface.element.places import Places as Places
from lamella.surface.element.surface import ElementSurface as ElementSurface
from lamella.surface.form_finding.film_in_loops import film as film
from lamella.surface.form_finding.followed_film import FollowedFilm as FollowedFilm
from lamella.surface.form_finding.followed_film import follow as follow
from lamella.surface.from_mesh.fit_cmc import fit_cmc as fit_cmc
from lamella.surface.from_mesh.fit_surface import fit_surface as fit_surface
from lamella.surface.mesh import SurfaceMesh as SurfaceMesh
from lamella.surface.points import SurfacePoints as SurfacePoints

__version__: str
