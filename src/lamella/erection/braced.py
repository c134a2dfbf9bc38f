"""How far a net springs back once its joints are locked: alone, with diagonals, with edge beams."""

from __future__ import annotations

from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.erection.bracings import Bracings
from lamella.erection.free_body import free_body
from lamella.erection.rigid_motion import moved_onto
from lamella.strip.lamellas import Lamellas
from lamella.structure.loads import no_loads
from lamella.structure.static import at_rest


def spring_backs(
    lamellas: Lamellas, bracings: Bracings, *, elements: int = 2, progress: Progress = silent
) -> dict[str, float | None]:
    """Largest distance of a node from where it was designed, after the best rigid motion, by what braces the net.

    Joints are locked at their designed angles, edge beams are stress-free as they stand, cables have their prestress in
    the designed shape and go slack under compression; nothing else holds the net.

    Parameters
    ----------
    lamellas : Lamellas
    bracings : Bracings
    elements : int
        Beam elements in a cell edge.
    progress : callable

    Returns
    -------
    dict
        By `Bracings.names`, m; None where no equilibrium is found.
    """
    found: dict[str, float | None] = {}
    supports = free_body(lamellas.network)
    for name in bracings.names:
        progress(Report.step(f"joints locked, braced by {name.replace('_', ' ')}"))
        model = bracings.model(lamellas, supports, elements, name)
        structure = model.structure
        try:
            here = at_rest(structure, no_loads(structure))
        except InputError:
            found[name] = None
            continue
        nodes = slice(0, model.nodes)
        found[name] = float(moved_onto(here.poses.points[nodes], structure.poses.points[nodes]).max())
    return found
