"""How far a net springs back once its joints are locked: alone, with diagonals, with edge beams."""

from __future__ import annotations

from collections.abc import Mapping

from lamella.base.errors import InputError
from lamella.base.material import MATERIALS, Material
from lamella.base.progress import Progress, Report, silent
from lamella.erection.free_body import free_body
from lamella.erection.rigid_motion import moved_onto
from lamella.hardware.axis_ends import EdgeBeamAxes
from lamella.hardware.rules import CableRules
from lamella.strip.lamellas import Lamellas
from lamella.structure.loads import no_loads
from lamella.structure.model.model import make_model
from lamella.structure.model.rules import ModelRules
from lamella.structure.static import at_rest


def spring_backs(
    lamellas: Lamellas,
    *,
    elements: int = 2,
    cables: CableRules | None = None,
    edge_beams: EdgeBeamAxes | None = None,
    materials: Mapping[str, Material] = MATERIALS,
    progress: Progress = silent,
) -> dict[str, float | None]:
    """Largest distance of a node from where it was designed, after the best rigid motion, by what braces the net.

    Joints are locked at their designed angles, edge beams are stress-free as they stand, cables have their prestress in
    the designed shape and go slack under compression; nothing else holds the net.

    Parameters
    ----------
    lamellas : Lamellas
    elements : int
        Beam elements in a cell edge.
    cables, edge_beams
        What there is; None: none.
    materials : mapping
        Those of edge beams by name.
    progress : callable

    Returns
    -------
    dict
        "cables", "edge_beams", "both": those that are there, m; None where no equilibrium is found.
    """
    given = {"cables": (cables, None), "edge_beams": (None, edge_beams), "both": (cables, edge_beams)}
    wanted = [key for key, on in (("cables", cables), ("edge_beams", edge_beams)) if on is not None]
    if len(wanted) == 2:
        wanted.append("both")
    found: dict[str, float | None] = {}
    supports = free_body(lamellas.network)
    rules = ModelRules(elements=elements, joints="locked", slots="whole", near_design=False)
    for key in wanted:
        progress(Report.step(f"joints locked, braced by {key.replace('_', ' ')}"))
        ropes, rims = given[key]
        model = make_model(lamellas, supports, rules, cables=ropes, edge_beams=rims, materials=materials)
        structure = model.structure
        try:
            here = at_rest(structure, no_loads(structure))
        except InputError:
            found[key] = None
            continue
        nodes = slice(0, model.nodes)
        found[key] = float(moved_onto(here.poses.points[nodes], structure.poses.points[nodes]).max())
    return found
